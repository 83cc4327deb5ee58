"""SciPy's SLSQP and its interior point for trust regions on problems of Hock and Schittkowski, with exact derivatives by Autograd."""

import warnings

import autograd.numpy as np
import scipy
from autograd import grad, jacobian
from scipy.optimize import NonlinearConstraint, minimize

NAME = f"SciPy {scipy.__version__}"

# Linear constraints are told as any other.
warnings.simplefilter("ignore", UserWarning)

WIDE = 100.0


def valley(x):
    return 100 * (x[1] - x[0] ** 2) ** 2 + (1 - x[0]) ** 2


def hs38(x):
    a, b, c, d = x
    return (
        100 * (b - a**2) ** 2
        + (1 - a) ** 2
        + 90 * (d - c**2) ** 2
        + (1 - c) ** 2
        + 10.1 * ((b - 1) ** 2 + (d - 1) ** 2)
        + 19.8 * (b - 1) * (d - 1)
    )


def hs35(x):
    a, b, c = x
    return 9 - 8 * a - 6 * b - 4 * c + 2 * a**2 + 2 * b**2 + c**2 + 2 * a * b + 2 * a * c


def hs43(x):
    a, b, c, d = x
    return a**2 + b**2 + 2 * c**2 + d**2 - 5 * a - 5 * b - 21 * c + 7 * d


def hs43_rows(x):
    a, b, c, d = x
    return np.array(
        [
            8 - a**2 - b**2 - c**2 - d**2 - a + b - c + d,
            10 - a**2 - 2 * b**2 - c**2 - 2 * d**2 + a + d,
            5 - 2 * a**2 - b**2 - c**2 - 2 * a + b + d,
        ]
    )


def hs71(x):
    a, b, c, d = x
    return a * d * (a + b + c) + c


def hs71_rows(x):
    squares = np.sum(x**2)
    return np.array([np.prod(x) - 25, 40 - squares, squares - 40])


def hs76(x):
    a, b, c, d = x
    return a**2 + b**2 / 2 + c**2 + d**2 / 2 - a * c + c * d - a - 3 * b + c - d


def hs76_rows(x):
    a, b, c, d = x
    return np.array([5 - a - 2 * b - c - d, 4 - 3 * a - b - 2 * c + d, b + 4 * c - 1.5])


def hs100(x):
    a, b, c, d, e, f, g = x
    return (
        (a - 10) ** 2
        + 5 * (b - 12) ** 2
        + c**4
        + 3 * (d - 11) ** 2
        + 10 * e**6
        + 7 * f**2
        + g**4
        - 4 * f * g
        - 10 * f
        - 8 * g
    )


def hs100_rows(x):
    a, b, c, d, e, f, g = x
    return np.array(
        [
            127 - 2 * a**2 - 3 * b**4 - c - 4 * d**2 - 5 * e,
            282 - 7 * a - 3 * b - 10 * c**2 - d + e,
            196 - 23 * a - b**2 - 6 * f**2 + 8 * g,
            -4 * a**2 - b**2 + 3 * a * b - 2 * c**2 - 5 * f + 11 * g,
        ]
    )


def hs113(x):
    a, b, c, d, e, f, g, h, i, j = x
    return (
        a**2
        + b**2
        + a * b
        - 14 * a
        - 16 * b
        + (c - 10) ** 2
        + 4 * (d - 5) ** 2
        + (e - 3) ** 2
        + 2 * (f - 1) ** 2
        + 5 * g**2
        + 7 * (h - 11) ** 2
        + 2 * (i - 10) ** 2
        + (j - 7) ** 2
        + 45
    )


def hs113_rows(x):
    a, b, c, d, e, f, g, h, i, j = x
    return np.array(
        [
            105 - 4 * a - 5 * b + 3 * g - 9 * h,
            -10 * a + 8 * b + 17 * g - 2 * h,
            12 + 8 * a - 2 * b - 5 * i + 2 * j,
            120 - 3 * (a - 2) ** 2 - 4 * (b - 3) ** 2 - 2 * c**2 + 7 * d,
            40 - 5 * a**2 - 8 * b - (c - 6) ** 2 + 2 * d,
            30 - (a - 8) ** 2 / 2 - 2 * (b - 4) ** 2 - 3 * e**2 + f,
            -(a**2) - 2 * (b - 2) ** 2 + 2 * a * b - 14 * e + 6 * f,
            3 * a - 6 * b - 12 * (i - 8) ** 2 + 7 * j,
        ]
    )


ROOT = 3.0**0.5

# The goal, its constraints (not below 0), bounds, start, published optimum.
PROBLEMS = {
    "HS1": (valley, None, [(-10, 10), (-1.5, 10)], [-2, 1], 0.0),
    "HS2": (valley, None, [(-10, 10), (1.5, 10)], [1.3, 1.6], 0.0504261879),
    "HS5": (
        lambda x: np.sin(x[0] + x[1]) + (x[0] - x[1]) ** 2 - 1.5 * x[0] + 2.5 * x[1] + 1,
        None,
        [(-1.5, 4), (-3, 3)],
        [0, 0],
        -ROOT / 2 - np.pi / 3,
    ),
    "HS21": (
        lambda x: 0.01 * x[0] ** 2 + x[1] ** 2 - 100,
        lambda x: np.array([10 * x[0] - x[1] - 10]),
        [(2, 50), (-50, 50)],
        [2, -1],
        -99.96,
    ),
    "HS24": (
        lambda x: ((x[0] - 3) ** 2 - 9) * x[1] ** 3 / (27 * ROOT),
        lambda x: np.array([x[0] / ROOT - x[1], x[0] + ROOT * x[1], 6 - x[0] - ROOT * x[1]]),
        [(0, WIDE)] * 2,
        [1, 0.5],
        -1.0,
    ),
    "HS35": (hs35, lambda x: np.array([3 - x[0] - x[1] - 2 * x[2]]), [(0, WIDE)] * 3, [0.5] * 3, 1 / 9),
    "HS38": (hs38, None, [(-10, 10)] * 4, [-3, -1, -3, -1], 0.0),
    "HS43": (hs43, hs43_rows, [(-WIDE, WIDE)] * 4, [0] * 4, -44.0),
    "HS71": (hs71, hs71_rows, [(1, 5)] * 4, [1, 5, 5, 1], 17.0140173),
    "HS76": (hs76, hs76_rows, [(0, WIDE)] * 4, [0.5] * 4, -4.681818181818),
    "HS100": (hs100, hs100_rows, [(-20, 20)] * 7, [1, 2, 0, 4, 0, 1, 1], 680.63005737),
    "HS113": (hs113, hs113_rows, [(-20, 20)] * 10, [2, 3, 5, 5, 1, 2, 7, 3, 6, 10], 24.306209068),
}


def runs(cases):
    """Case, method, what is run, and words and error of what it finds."""
    for case in cases:
        if case not in PROBLEMS:
            continue
        goal, rows, bounds, start, optimum = PROBLEMS[case]
        start = np.array(start, dtype=float)
        slope = grad(goal)
        slopes = jacobian(rows) if rows else None

        def told(found, goal=goal, rows=rows, optimum=optimum):
            missed = max(0.0, -np.min(rows(found.x))) if rows else 0.0
            error = abs(goal(found.x) - optimum) / max(1.0, abs(optimum))
            return f"{found.nfev} designs, {found.njev} derivatives", max(error, missed)

        def slsqp():
            held = [{"type": "ineq", "fun": rows, "jac": slopes}] if rows else []
            options = {"ftol": 1e-12, "maxiter": 500}
            return minimize(goal, start, jac=slope, bounds=bounds, constraints=held, method="SLSQP", options=options)

        def interior():
            held = [NonlinearConstraint(rows, 0, np.inf, jac=slopes)] if rows else []
            options = {"gtol": 1e-10, "xtol": 1e-12, "maxiter": 2000}
            return minimize(
                goal, start, jac=slope, bounds=bounds, constraints=held, method="trust-constr", options=options
            )

        yield case, "SLSQP", slsqp, told
        yield case, "trust-constr", interior, told
