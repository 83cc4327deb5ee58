"""What one would write by hand with NumPy: Burmester's dyads of five poses, his curves of four, and paths to nine points, all side by side."""

import numpy as np

NAME = "NumPy, by hand"
# Angles of a link at which the curve of four poses is asked for: both closures of the compatibility linkage make 74 points.
ANGLES = 37
# Of the paths to nine points so many are followed.
PATHS = 361
PLACES = 8
# The largest change of a solution by Newton's last correction, in parts of it, and the least step, in parts of the way.
NEAR = 1e-7
LEAST = 1e-7


def relative(poses):
    """Turns and displacements from the first pose on, poses being x, y and angle."""
    places = poses[:, 0] + 1j * poses[:, 1]
    return np.exp(1j * (poses[1:, 2] - poses[0, 2])), places[1:] - places[0]


def conic(kernel, real):
    """The quadratic form that ties the product of both pivots to them, on the kernel of the linear equations."""
    z_re, z_im, g_re, g_im, h_re, h_im, one = kernel
    if real:
        form = np.outer(z_re, g_re) + np.outer(z_im, g_im) - np.outer(h_re, one)
    else:
        form = np.outer(z_im, g_re) - np.outer(z_re, g_im) - np.outer(h_im, one)
    return form + form.T


def quadratic(form):
    """A form as a quadratic in the second coordinate, the third being 1: coefficients over the first."""
    return (
        np.array([form[1, 1]]),
        np.array([2 * form[0, 1], 2 * form[1, 2]]),
        np.array([form[0, 0], 2 * form[0, 2], form[2, 2]]),
    )


def five(poses):
    """Fixed pivots and moving pivots (in the body's axes) of all links between the frame and a body with five poses."""
    turn, shift = relative(poses)
    along = np.conj(shift) * turn
    rows = np.stack(
        [along.real, -along.imag, -shift.real, -shift.imag, 1 - turn.real, turn.imag, 0.5 * np.abs(shift) ** 2], axis=1
    )
    kernel = np.linalg.svd(rows)[2][4:].T
    p2, p1, p0 = quadratic(conic(kernel, True))
    q2, q1, q0 = quadratic(conic(kernel, False))
    outer = np.polysub(np.polymul(p2, q0), np.polymul(p0, q2))
    left = np.polysub(np.polymul(p2, q1), np.polymul(p1, q2))
    right = np.polysub(np.polymul(p1, q0), np.polymul(p0, q1))
    found = []
    for a in np.roots(np.polysub(np.polymul(outer, outer), np.polymul(left, right))):
        if abs(a.imag) > 1e-7 * abs(a):
            continue
        a = a.real
        b = -np.polyval(outer, a) / np.polyval(left, a)
        products = kernel @ np.array([a, b, 1.0])
        z_re, z_im, g_re, g_im = products[:4] / products[6]
        found.append(polished(z_re + 1j * z_im, g_re + 1j * g_im, turn, shift))
    origin = poses[0, 0] + 1j * poses[0, 1]
    back = np.exp(-1j * poses[0, 2])
    return [(g + origin, z * back) for z, g in found]


def polished(z, g, turn, shift):
    """Two of Newton's steps in the equations themselves."""
    for _ in range(2):
        off = shift + turn * z - g
        first = z - g
        miss = 0.5 * (np.abs(off) ** 2 - abs(first) ** 2)
        by_z = np.conj(off) * turn - np.conj(first)
        by_g = np.conj(first) - np.conj(off)
        slopes = np.stack([by_z.real, -by_z.imag, by_g.real, -by_g.imag], axis=1)
        step = np.linalg.solve(slopes, miss)
        z -= step[0] + 1j * step[1]
        g -= step[2] + 1j * step[3]
    return z, g


def curves(poses):
    """Pivots along both curves of four poses, by the compatibility linkage of the standard form."""
    turn, shift = relative(poses[:4])
    a = turn - 1
    second = a[1] * shift[2] - a[2] * shift[1]
    third = a[2] * shift[0] - a[0] * shift[2]
    fourth = a[0] * shift[1] - a[1] * shift[0]
    first = -second - third - fourth
    b2 = np.exp(1j * 2 * np.pi * (np.arange(ANGLES) + 0.5) / ANGLES)
    rest = -first - second * b2
    cosine = (np.abs(rest) ** 2 + abs(third) ** 2 - abs(fourth) ** 2) / (2 * np.abs(rest) * abs(third))
    closes = np.abs(cosine) <= 1
    b2, rest, angle = b2[closes], rest[closes], np.arccos(cosine[closes])
    b2 = np.concatenate([b2, b2])
    b3 = np.concatenate([rest * np.exp(1j * angle), rest * np.exp(-1j * angle)])
    b3 = b3 / np.abs(b3) / (third / abs(third))
    whole = (b2 - 1) * a[1] - (b3 - 1) * a[0]
    w = (shift[0] * a[1] - shift[1] * a[0]) / whole
    z = ((b2 - 1) * shift[1] - (b3 - 1) * shift[0]) / whole
    origin = poses[0, 0] + 1j * poses[0, 1]
    return list(zip(origin - z - w, -z * np.exp(-1j * poses[0, 2])))


def equations(at, data):
    """Nine points: what the 24 equations of each path miss, and their derivatives to the unknowns and to the data (see `equations.rs`)."""
    count = len(at)
    g, h = at[:, 8::2], at[:, 9::2]
    d, c = data[:, :PLACES], data[:, PLACES:]
    miss = np.empty((count, 24), dtype=complex)
    slopes = np.zeros((count, 24, 24), dtype=complex)
    by_d = np.zeros((count, 24), dtype=complex), np.zeros((count, 24), dtype=complex)
    places = np.arange(PLACES)
    for link in range(2):
        x, a, x1, a1 = (at[:, 4 * link + k, None] for k in range(4))
        rows = 3 * places + link
        miss[:, rows] = (a1 - c) * x * g + (a - d) * x1 * h + (a1 - x1) * d + (a - x) * c - d * c
        slopes[:, rows, 4 * link] = (a1 - c) * g - c
        slopes[:, rows, 4 * link + 1] = x1 * h + c
        slopes[:, rows, 4 * link + 2] = (a - d) * h - d
        slopes[:, rows, 4 * link + 3] = x * g + d
        slopes[:, rows, 8 + 2 * places] = (a1 - c) * x
        slopes[:, rows, 9 + 2 * places] = (a - d) * x1
        by_d[0][:, rows] = a1 - x1 - c - x1 * h
        by_d[1][:, rows] = a - x - d - x * g
    rows = 3 * places + 2
    miss[:, rows] = g * h + g + h
    slopes[:, rows, 8 + 2 * places] = h + 1
    slopes[:, rows, 9 + 2 * places] = g + 1
    return miss, slopes, by_d


def follow(start, target, solutions):
    """Solutions at the target, of those at the start; and how many are lost."""
    at, rate = solutions.copy(), target - start
    gone, step = np.zeros(len(at)), np.full(len(at), 0.01)
    alive = np.arange(len(at))
    lost = 0

    def tangent(of, part):
        _, slopes, (by_d, by_c) = equations(of, start + part[:, None] * rate)
        change = by_d * np.repeat(rate[:PLACES], 3) + by_c * np.repeat(rate[PLACES:], 3)
        return np.linalg.solve(slopes, -change[..., None])[..., 0]

    while len(alive):
        here, part = at[alive], gone[alive]
        by = np.minimum(step[alive], 1 - part)
        wide = by[:, None]
        k1 = tangent(here, part)
        k2 = tangent(here + 0.5 * wide * k1, part + 0.5 * by)
        k3 = tangent(here + 0.5 * wide * k2, part + 0.5 * by)
        k4 = tangent(here + wide * k3, part + by)
        there = here + wide / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        data = start + (part + by)[:, None] * rate
        for _ in range(3):
            miss, slopes, _ = equations(there, data)
            change = np.linalg.solve(slopes, miss[..., None])[..., 0]
            there = there - change
        size = np.abs(there).max(axis=1)
        good = np.abs(change).max(axis=1) <= NEAR * size
        at[alive[good]], gone[alive[good]] = there[good], (part + by)[good]
        step[alive] = np.where(good, 1.5 * by, 0.5 * by)
        small = step[alive] < LEAST
        done = gone[alive] >= 1
        lost += np.count_nonzero(small & ~done)
        alive = alive[~(done | small)]
    return at[gone >= 1], lost


def worst_link(ends, target):
    """By how much the length of a link differs between places at most, in parts of it, hats and all."""
    d, c = target[:PLACES], target[PLACES:]
    g, h = ends[:, 8::2], ends[:, 9::2]
    worst = 0.0
    for link in range(2):
        x, a, x1, a1 = (ends[:, 4 * link + k, None] for k in range(4))
        squares = (x * (1 + g) + d - a) * (x1 * (1 + h) + c - a1)
        worst = max(worst, 0.5 * np.abs(squares / ((x - a) * (x1 - a1)) - 1).max())
    return worst


def spread(poses, fixed, moving):
    """By how much a link's length differs between poses, in parts of it."""
    ends = poses[:, 0] + 1j * poses[:, 1] + np.exp(1j * poses[:, 2]) * moving
    lengths = np.abs(ends - fixed)
    return (lengths.max() - lengths.min()) / lengths.max()


def runs(problems):
    """Case, method, what is run, its error, and in how many parts of it the time of one problem is."""
    poses = [np.array(row).reshape(5, 3) for row in problems["poses"]]

    def worst(solve, count):
        links = [(some[:count], *link) for some in poses for link in solve(some)]
        return max(spread(*link) for link in links)

    yield "five poses", "two conics", lambda: [five(some) for some in poses], lambda _: worst(five, 5), len(poses)
    yield (
        "four-pose curves",
        f"at most {2 * ANGLES} points by a link's angle",
        lambda: [curves(some) for some in poses],
        lambda _: worst(curves, 4),
        len(poses),
    )
    start, target = [pairs(row) for row in problems["data"]]
    solutions = np.array([pairs(row) for row in problems["solution"]])
    some = solutions[:: len(solutions) // PATHS][:PATHS]

    def error_of(found):
        ends, lost = found
        if lost:
            print(f"{lost} of {len(some)} paths are lost")
        return worst_link(ends, target)

    method = f"{len(some)} of {len(solutions)} paths, Runge and Kutta"
    yield "nine points", method, lambda: follow(start, target, some), error_of, len(some) / len(solutions)


def pairs(row):
    """Complex numbers of their parts."""
    return np.array(row[0::2]) + 1j * np.array(row[1::2])
