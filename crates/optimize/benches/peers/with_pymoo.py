"""pymoo's NSGA-II on problems of Zitzler, Deb and Thiele: as many designs as the benchmark gives Kempe's, and the part of the analytic volume."""

import numpy as np
import pymoo
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.indicators.hv import HV
from pymoo.optimize import minimize
from pymoo.problems import get_problem

NAME = f"pymoo {pymoo.__version__}"

POINTS = 100
REFERENCE = np.array([1.1, 1.1])


def analytic(second, start=0.0):
    """The volume under a front of the second goal over the first, from `start` to one, up to the reference."""
    root = np.linspace(np.sqrt(start), 1.0, 200_001)
    middle = (root[1:] + root[:-1]) / 2
    under = np.sum((1.1 - second(middle**2)) * 2 * middle * np.diff(root))
    return under + 0.1 * (1.1 - second(1.0))


def convex(f):
    return 1 - np.sqrt(f)


def hollow(f):
    return 1 - f**2


FRONTS = [
    ("ZDT1", 15_000, analytic(convex)),
    ("ZDT2", 15_000, analytic(hollow)),
    ("ZDT4", 30_000, analytic(convex)),
    ("ZDT6", 20_000, analytic(hollow, 0.2807753188)),
]


def runs(_):
    """Case, method, what is run, and words of what it finds: fronts have no error."""
    for case, designs, whole in FRONTS:
        problem = get_problem(case.lower())

        def run(problem=problem, designs=designs):
            return minimize(problem, NSGA2(pop_size=POINTS), ("n_eval", designs), seed=1, verbose=False)

        def told(found, designs=designs, whole=whole):
            return f"{designs} designs {HV(ref_point=REFERENCE)(found.F) / whole:.5f}", None

        yield case, "NSGA-II", run, told
