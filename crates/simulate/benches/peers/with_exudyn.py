"""The benchmarks as models of Exudyn: planar rigid bodies, pins, loads and springs, as its own examples have them.

Closed loops are constraints, which its explicit integrators do not take; a pendulum is an open chain, which they do.
"""

import math
import sys

sys.exudynFast = True  # its library without range checks

import exudyn as exu
import numpy
from exudyn import itemInterface as item

exu.config.printToConsole = False
NAME = f"exudyn {exu.__version__}"
GRAVITY = 9.81
# Of more bodies and joints than so many, the sparse solver is the faster one: forty four-bars take five times as long with the dense one.
DENSE_OBJECTS = 20


class Model:
    """A planar mechanism of rigid bodies, drawn where it starts. Bodies are told by the pose of their own frame."""

    def __init__(self):
        self.system = exu.SystemContainer()
        self.mbs = self.system.AddSystem()
        self.ground = self.mbs.AddObject(item.ObjectGround())
        self.frames = {}

    def body(self, mass, inertia, center, origin=(0.0, 0.0), angle=0.0, velocity=(0.0, 0.0), spin=0.0):
        """A body whose centre of mass is at `center` of its frame; `velocity` is that of the centre."""
        c, s = math.cos(angle), math.sin(angle)
        x = origin[0] + c * center[0] - s * center[1]
        y = origin[1] + s * center[0] + c * center[1]
        node = self.mbs.AddNode(
            item.NodeRigidBody2D(referenceCoordinates=[x, y, angle], initialVelocities=[*velocity, spin])
        )
        body = self.mbs.AddObject(item.ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node))
        self.frames[body] = (center, node)
        return body

    def marker(self, body, place):
        """A marker at a place of the body's frame, or of the ground."""
        center = self.frames[body][0] if body in self.frames else (0.0, 0.0)
        local = [place[0] - center[0], place[1] - center[1], 0.0]
        return self.mbs.AddMarker(item.MarkerBodyPosition(bodyNumber=body, localPosition=local))

    def pin(self, one, at_one, other, at_other):
        markers = [self.marker(one, at_one), self.marker(other, at_other)]
        self.mbs.AddObject(item.ObjectJointRevolute2D(markerNumbers=markers))

    def weigh(self):
        """Gravity on all bodies so far."""
        for body in self.frames:
            marker = self.mbs.AddMarker(item.MarkerBodyMass(bodyNumber=body))
            self.mbs.AddLoad(item.LoadMassProportional(markerNumber=marker, loadVector=[0, -GRAVITY, 0]))

    def torque(self, body, moment):
        marker = self.mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=body))
        self.mbs.AddLoad(item.LoadTorqueVector(markerNumber=marker, loadVector=[0, 0, moment]))

    def telling(self, body):
        """The assembled system, and what tells angle and rate of the body where it came to."""
        node = self.frames[body][1]
        self.mbs.Assemble()
        return self.mbs, lambda: angle_and_rate(self.mbs, node, 2)


def angle_and_rate(mbs, node, coordinate):
    """A node's coordinate, which is told from its reference, and its rate."""
    kind = exu.OutputVariableType

    def told(*what):
        # Of a single coordinate it gives the number itself.
        return float(numpy.atleast_1d(mbs.GetNodeOutput(node, *what))[coordinate])

    return told(kind.Coordinates) + told(kind.Coordinates, exu.ConfigurationType.Reference), told(kind.Coordinates_t)


def pendulum():
    """A point mass: a body without inertia about its centre."""
    model = Model()
    rod = model.body(1.0, 0.0, (1.0, 0.0), angle=math.pi)
    model.pin(model.ground, (0.0, 0.0), rod, (0.0, 0.0))
    model.weigh()
    return model.telling(rod)


def four_bars(n):
    model = Model()
    upright = [
        model.body(1.0, 1.0 / 12.0, (0.5, 0.0), (i, 0.0), math.pi / 2.0, velocity=(0.5, 0.0), spin=-1.0)
        for i in range(n + 1)
    ]
    level = [model.body(1.0, 1.0 / 12.0, (0.5, 0.0), (i, 1.0), velocity=(1.0, 0.0)) for i in range(n)]
    for i, link in enumerate(upright):
        model.pin(model.ground, (i, 0.0), link, (0.0, 0.0))
    for i, link in enumerate(level):
        model.pin(upright[i], (1.0, 0.0), link, (0.0, 0.0))
        model.pin(upright[i + 1], (1.0, 0.0), link, (1.0, 0.0))
    model.weigh()
    return model.telling(upright[0])


def andrews():
    """Links, places and the start as the test set has them."""
    beta, gamma, phi = -0.0617138900142764496, 0.455279819163070381, 0.222668390165885885
    delta, omega, epsilon = 0.487364979543842550, -0.222668390165885885, 1.23054744454982119
    a, b, c = (-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072)

    def beyond(place, length, angle):
        return place[0] + length * math.cos(angle), place[1] + length * math.sin(angle)

    f = beyond((0.0, 0.0), 0.007, beta)
    g = beyond(a, 0.04, delta)
    h = beyond(a, 0.04, epsilon - math.pi / 2.0)
    model = Model()
    k1 = model.body(0.04325, 2.194e-6, (0.00092, 0.0), angle=beta)
    k2 = model.body(0.00365, 4.410e-7, (-0.0115, 0.0), f, beta)
    k3 = model.body(0.02373, 5.255e-6, (0.01874, 0.01043), b, gamma)
    k4 = model.body(0.00706, 5.667e-7, (0.0, -0.00579), g, phi + delta)
    k5 = model.body(0.07050, 1.169e-5, (0.02308, 0.00916), a, delta)
    k6 = model.body(0.00706, 5.667e-7, (0.00579, 0.0), h, omega + epsilon)
    k7 = model.body(0.05498, 1.912e-5, (0.01228, 0.00449), a, epsilon)
    model.pin(model.ground, (0.0, 0.0), k1, (0.0, 0.0))
    model.pin(k1, (0.007, 0.0), k2, (0.0, 0.0))
    model.pin(model.ground, b, k3, (0.0, 0.0))
    model.pin(model.ground, a, k5, (0.0, 0.0))
    model.pin(model.ground, a, k7, (0.0, 0.0))
    model.pin(k5, (0.04, 0.0), k4, (0.0, 0.0))
    model.pin(k7, (0.0, -0.04), k6, (0.0, 0.0))
    e = (-0.028, 0.0)
    for link, place in [(k3, (0.0, -0.035)), (k4, (0.0, -0.02)), (k6, (0.02, 0.0))]:
        model.pin(k2, e, link, place)
    ends = [model.marker(model.ground, c), model.marker(k3, (0.02, -0.018))]
    model.mbs.AddObject(item.ObjectConnectorSpringDamper(markerNumbers=ends, stiffness=4530.0, referenceLength=0.07785))
    model.torque(k1, 0.033)
    return model.telling(k1)


def free_slider_crank():
    """The slider is a mass point on a line."""
    model = Model()
    crank = model.body(2.0, 2.0 / 12.0 * 0.25, (0.25, 0.0))
    rod = model.body(4.0, 4.0 / 12.0, (0.5, 0.0), (0.5, 0.0))
    point = model.mbs.AddNode(item.NodePoint2D(referenceCoordinates=[1.5, 0.0]))
    slider = model.mbs.AddObject(item.ObjectMassPoint2D(physicsMass=1.0, nodeNumber=point))
    model.pin(model.ground, (0.0, 0.0), crank, (0.0, 0.0))
    model.pin(crank, (0.5, 0.0), rod, (0.0, 0.0))
    model.pin(rod, (1.0, 0.0), slider, (0.0, 0.0))
    fixed = model.mbs.AddNode(item.NodePointGround())
    ends = [
        model.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=k)) for node, k in [(fixed, 0), (point, 1)]
    ]
    model.mbs.AddObject(item.ObjectConnectorCoordinate(markerNumbers=ends))
    model.torque(crank, 10.0)
    return model.telling(crank)


def crank_rocker():
    a, b, c, d, spin = 0.1, 0.25, 0.2, 0.25, 30.0
    # From the crank, upright, to the rocker's pivot; the pin of coupler and rocker is on the left.
    along = math.hypot(d, a)
    angle = math.atan2(-a, d) + math.acos((b * b + along * along - c * c) / (2.0 * b * along))
    pin = (b * math.cos(angle), a + b * math.sin(angle))
    rocker_angle = math.atan2(pin[1], pin[0] - d)
    # The crank's pin moves at (-a spin, 0); what the coupler and the rocker make of it at their pin is the same.
    ux, uy = pin[0], pin[1] - a
    vx, vy = pin[0] - d, pin[1]
    # -uy k3 + vy k4 = a spin, ux k3 - vx k4 = 0
    determinant = uy * vx - ux * vy
    k3, k4 = -a * spin * vx / determinant, -a * spin * ux / determinant
    model = Model()
    crank = model.body(a, a**3 / 12.0, (a / 2.0, 0.0), angle=math.pi / 2.0, velocity=(-spin * a / 2.0, 0.0), spin=spin)
    moves = (-a * spin - k3 * uy / 2.0, k3 * ux / 2.0)
    coupler = model.body(b, b**3 / 12.0, (b / 2.0, 0.0), (0.0, a), angle, velocity=moves, spin=k3)
    moves = (-k4 * vy / 2.0, k4 * vx / 2.0)
    rocker = model.body(c, c**3 / 12.0, (c / 2.0, 0.0), (d, 0.0), rocker_angle, velocity=moves, spin=k4)
    model.pin(model.ground, (0.0, 0.0), crank, (0.0, 0.0))
    model.pin(crank, (a, 0.0), coupler, (0.0, 0.0))
    model.pin(coupler, (b, 0.0), rocker, (c, 0.0))
    model.pin(model.ground, (d, 0.0), rocker, (0.0, 0.0))
    model.weigh()
    return model.telling(crank)


def pendulum_as_chain():
    """The same pendulum as what Exudyn calls a kinematic tree: one joint, no constraint."""
    mbs = exu.SystemContainer().AddSystem()
    node = mbs.AddNode(
        item.NodeGenericODE2(
            referenceCoordinates=[math.pi], initialCoordinates=[0.0], initialCoordinates_t=[0.0], numberOfODE2Coordinates=1
        )
    )
    mbs.AddObject(
        item.ObjectKinematicTree(
            nodeNumber=node,
            gravity=[0.0, -GRAVITY, 0.0],
            jointTypes=[exu.JointType.RevoluteZ],
            linkParents=[-1],
            jointTransformations=exu.Matrix3DList([numpy.eye(3)]),
            jointOffsets=exu.Vector3DList([[0.0, 0.0, 0.0]]),
            linkInertiasCOM=exu.Matrix3DList([numpy.zeros((3, 3))]),
            linkCOMs=exu.Vector3DList([[1.0, 0.0, 0.0]]),
            linkMasses=[1.0],
        )
    )
    mbs.Assemble()
    return mbs, lambda: angle_and_rate(mbs, node, 0)


CASES = {
    "pendulum": pendulum,
    "n-four-bar-2": lambda: four_bars(2),
    "n-four-bar-40": lambda: four_bars(40),
    "andrews": andrews,
    "free-slider-crank": free_slider_crank,
    "crank-rocker": crank_rocker,
}


def generalised_alpha(settings):
    integration = settings.timeIntegration
    integration.solverType = exu.DynamicSolverType.GeneralizedAlpha
    # The least damping with which all cases run: they do not at 1, and 0.6 or 0.8 is no better.
    integration.generalizedAlpha.spectralRadius = 0.95


def modified_newton(settings):
    """The same; a Jacobian is kept while it serves. Slower, mostly, and surer where steps are very short."""
    generalised_alpha(settings)
    settings.timeIntegration.newton.useModifiedNewton = True


def trapezoidal(settings):
    settings.timeIntegration.solverType = exu.DynamicSolverType.TrapezoidalIndex2


def explicit(kind):
    def choose(settings):
        settings.timeIntegration.solverType = kind
        # Nobody asks for accelerations here, which cost an evaluation in every step.
        settings.timeIntegration.explicit.computeEndOfStepAccelerations = False

    return choose


def settings_for(until, steps):
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    integration = settings.timeIntegration
    integration.endTime = until
    integration.numberOfSteps = steps
    integration.verboseMode = 0
    # A new Jacobian in every iteration: of so few bodies it costs less than the iterations that it saves.
    integration.newton.useModifiedNewton = False
    # Steps that fail are told, not halved until nothing is left of them.
    integration.adaptiveStep = False
    return settings


def runs(case, until):
    """Ways to solve a case, each a series of runs that get finer: name, and what gives value and rate at the end."""
    steps = [500 * 2**k for k in range(12)]

    def run(build, choose, count, tolerance=None):
        mbs, tell = build()
        settings = settings_for(until, count)
        choose(settings)
        if mbs.systemData.NumberOfObjects() > DENSE_OBJECTS:
            settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        if tolerance is not None:
            settings.timeIntegration.absoluteTolerance = tolerance
            settings.timeIntegration.relativeTolerance = tolerance
            settings.timeIntegration.initialStepSize = 1e-3
            settings.timeIntegration.minimumStepSize = 1e-10

        def solve():
            return tell() if mbs.SolveDynamic(settings, showHints=False) else None

        return solve

    build = CASES[case]
    for name, choose in [
        ("alpha, full Newton", generalised_alpha),
        ("alpha, modified Newton", modified_newton),
        ("trapezoidal index 2", trapezoidal),
    ]:
        yield ((f"{name}, {count} steps", run(build, choose, count)) for count in steps)
    if case == "pendulum":
        kind = exu.DynamicSolverType
        yield ((f"RK67, {count} steps", run(pendulum_as_chain, explicit(kind.RK67), count)) for count in [50, 100, 200, *steps[:3]])
        yield (
            (f"DOPRI5, tolerance {tolerance:.0e}", run(pendulum_as_chain, explicit(kind.DOPRI5), 1, tolerance))
            for tolerance in [1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13]
        )
