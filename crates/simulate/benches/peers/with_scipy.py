"""The benchmarks as an engineer would script them: their one equation of motion derived by hand, integrated by SciPy.

Everything hangs on the first drive's angle q. A point is a triple: its place as a complex number, and its first and second
derivative to q. The equation is Eksergian's: I(q) q" + I'(q) q'^2 / 2 = Q(q).
"""

import cmath
import math

import scipy
from scipy.integrate import ode, solve_ivp

NAME = f"scipy {scipy.__version__}"
GRAVITY = 9.81


def dot(u, v):
    return u.real * v.real + u.imag * v.imag


def cross(u, v):
    return u.real * v.imag - u.imag * v.real


def turning(q, place):
    """A point of a link that turns about the origin with q."""
    at = place * cmath.exp(1j * q)
    return at, 1j * at, -at


def fixed(place):
    return place, 0j, 0j


def dyad(p, q, a, b, side):
    """The pin of two bars from `p` and `q`, `a` and `b` long, on the left (1) or the right (-1) of the way from `p` to `q`."""
    between = q[0] - p[0]
    square = abs(between) ** 2
    along = (a * a - b * b + square) / (2.0 * square)
    at = p[0] + between * complex(along, side * math.sqrt(a * a / square - along * along))
    u, v = at - p[0], at - q[0]
    area = cross(u, v)

    def solve(r, s):
        """The w with u.w = r and v.w = s."""
        return 1j * (s * u - r * v) / area

    first = solve(dot(u, p[1]), dot(v, q[1]))
    up, uq = first - p[1], first - q[1]
    return at, first, solve(dot(u, p[2]) - dot(up, up), dot(v, q[2]) - dot(uq, uq))


def on_line(p, length):
    """The end on the x axis, right of `p`, of a bar from `p`."""
    at = complex(p[0].real + math.sqrt(length * length - p[0].imag ** 2), 0.0)
    u = at - p[0]
    first = complex(dot(u, p[1]) / u.real, 0.0)
    difference = first - p[1]
    return at, first, complex((dot(u, p[2]) - dot(difference, difference)) / u.real, 0.0)


def of_link(p, q, ratio):
    """The point of the link through `p` and `q` at p + ratio (q - p)."""
    return tuple(a + ratio * (b - a) for a, b in zip(p, q))


class Sum:
    """I and I'/2 of masses and links, and the generalised force Q of their weight and of what is added to it."""

    def __init__(self, gravity=0.0, force=0.0):
        self.gravity, self.inertia, self.change, self.force = gravity, 0.0, 0.0, force

    def mass(self, mass, c):
        self.inertia += mass * dot(c[1], c[1])
        self.change += mass * dot(c[1], c[2])
        self.force -= mass * self.gravity * c[1].imag

    def link(self, mass, inertia, p, q, ratio):
        """A link through `p` and `q` whose centre is at p + ratio (q - p)."""
        self.mass(mass, of_link(p, q, ratio))
        u, first, second = (b - a for a, b in zip(p, q))
        square = abs(u) ** 2
        spin, change = cross(u, first) / square, cross(u, second) / square
        self.inertia += inertia * spin * spin
        self.change += inertia * spin * change

    def acceleration(self, rate):
        return (self.force - self.change * rate * rate) / self.inertia


ORIGIN = fixed(0j)


def pendulum(t, y):
    return [y[1], -GRAVITY * math.cos(y[0])]


def four_bars(n):
    a = GRAVITY * ((n + 1) / 2.0 + n) / ((n + 1) / 3.0 + n)
    return lambda t, y: [y[1], -a * math.cos(y[0])]


def andrews(t, y):
    a, b, c = fixed(-0.06934 - 0.00227j), fixed(-0.03635 + 0.03273j), 0.014 + 0.072j
    f = turning(y[0], 0.007)
    e = dyad(f, b, 0.028, 0.035, 1)
    g = dyad(a, e, 0.04, 0.02, 1)
    h = dyad(a, e, 0.04, 0.02, -1)
    total = Sum(force=0.033)
    total.link(0.04325, 2.194e-6, ORIGIN, f, 0.00092 / 0.007)
    total.link(0.00365, 4.410e-7, f, e, 0.0115 / 0.028)
    total.link(0.02373, 5.255e-6, b, e, (0.01874 + 0.01043j) / -0.035j)
    total.link(0.00706, 5.667e-7, g, e, 0.00579 / 0.02)
    total.link(0.07050, 1.169e-5, a, g, (0.02308 + 0.00916j) / 0.04)
    total.link(0.00706, 5.667e-7, h, e, 0.00579 / 0.02)
    total.link(0.05498, 1.912e-5, a, h, (0.01228 + 0.00449j) / -0.04j)
    d = of_link(b, e, (0.02 - 0.018j) / -0.035j)
    reach = d[0] - c
    length = abs(reach)
    total.force -= 4530.0 * (length - 0.07785) * dot(reach, d[1]) / length
    return [y[1], total.acceleration(y[1])]


def free_slider_crank(t, y):
    b = turning(y[0], 0.5)
    c = on_line(b, 1.0)
    total = Sum(force=10.0)
    total.link(2.0, 2.0 / 12.0 * 0.25, ORIGIN, b, 0.5)
    total.link(4.0, 4.0 / 12.0, b, c, 0.5)
    total.mass(1.0, c)
    return [y[1], total.acceleration(y[1])]


def crank_rocker(t, y):
    pivot = fixed(0.25 + 0j)
    b = turning(y[0], 0.1)
    c = dyad(b, pivot, 0.25, 0.2, 1)
    total = Sum(GRAVITY)
    for p, q, length in [(ORIGIN, b, 0.1), (b, c, 0.25), (pivot, c, 0.2)]:
        total.link(length, length**3 / 12.0, p, q, 0.5)
    return [y[1], total.acceleration(y[1])]


CASES = {
    "pendulum": (pendulum, [math.pi, 0.0]),
    "n-four-bar-2": (four_bars(2), [math.pi / 2.0, -1.0]),
    "n-four-bar-40": (four_bars(40), [math.pi / 2.0, -1.0]),
    "andrews": (andrews, [-0.0617138900142764496, 0.0]),
    "free-slider-crank": (free_slider_crank, [0.0, 0.0]),
    "crank-rocker": (crank_rocker, [math.pi / 2.0, 30.0]),
}
TOLERANCES = [1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13]


def by_solve_ivp(rates, start, until, tolerance):
    found = solve_ivp(rates, (0.0, until), start, method="DOP853", rtol=tolerance, atol=tolerance)
    return tuple(found.y[:, -1]) if found.success else None


def by_compiled(rates, start, until, tolerance):
    """The same formulas, the steps of them compiled."""
    solver = ode(rates).set_integrator("dop853", rtol=tolerance, atol=tolerance, nsteps=10**7)
    end = solver.set_initial_value(start, 0.0).integrate(until)
    return tuple(end) if solver.successful() else None


def runs(case, until):
    """Ways to solve a case, each a series of runs that get finer: name, and what gives value and rate at the end."""
    rates, start = CASES[case]

    def run(solve, tolerance):
        return lambda: solve(rates, start, until, tolerance)

    for name, solve in [("solve_ivp DOP853", by_solve_ivp), ("ode dop853", by_compiled)]:
        yield ((f"{name}, tolerance {tolerance:.0e}", run(solve, tolerance)) for tolerance in TOLERANCES)
