"""A stand-in for the walk of ALMotion: it is where it is told to go at once, or when the test says so."""

from __future__ import annotations

import math

RANGES = {
    "MaxStepX": (0.04, 0.001, 0.08),
    "MaxStepY": (0.14, 0.101, 0.16),
    "MaxStepTheta": (0.349, 0.001, 0.524),
    "MaxStepFrequency": (1.0, 0.0, 1.0),
    "MinStepPeriod": (0.42, 0.42, 0.42),
    "StepHeight": (0.02, 0.005, 0.035),
    "TorsoWx": (0.0, -0.122, 0.122),
    "TorsoWy": (0.0, -0.122, 0.122),
}
"""Default, least and largest."""


class FakeLocomotion:
    """The walking half of a fake ALMotion; methods in `slow` take their time and end through `pending`.

    Attributes:
        place: x, y (m) and theta (rad) in the world.
        walking: Whether it walks.
        swing: Whether left and right arm do while it walks.
        share: How much of a way it goes when it is stopped.
    """

    def __init__(self):
        self.place = [0.0, 0.0, 0.0]
        self.walking = False
        self.swing = [True, True]
        self.share = 0.25
        self.distances = [0.4, 0.1]
        self._way = [0.0, 0.0, 0.0]
        self._under_way = []

    def go(self, x, y, theta):
        px, py, heading = self.place
        c, s = math.cos(heading), math.sin(heading)
        self.place = [px + c * x - s * y, py + s * x + c * y, heading + theta]

    def _long(self, name, done):
        """A walk that the test ends, or stopMove, or one that is over at once."""
        call = self._slowly(name)
        if call is None:
            return done
        self.walking = True
        self._under_way.append(call)
        return call

    def moveInit(self):
        return self._long("moveInit", None)

    def moveTo(self, *arguments):
        arguments = [a for a in arguments if not (isinstance(a, list) and a and isinstance(a[0][0], str))]
        self._way = list(arguments[0][-1] if isinstance(arguments[0], list) else arguments[:3])
        if "moveTo" not in self.slow:
            self.go(*self._way)
        return self._long("moveTo", True)

    def move(self, x, y, theta, config=()):
        self.walking = any((x, y, theta))

    moveToward = move

    def setFootSteps(self, legs, steps, times, clear):
        self.walking = True

    def setFootStepsWithSpeed(self, legs, steps, fractions, clear):
        return self._long("setFootStepsWithSpeed", None)

    def waitUntilMoveIsFinished(self):
        return self._long("waitUntilMoveIsFinished", None)

    def stopMove(self):
        self.walking = False
        for call in self._under_way:
            if call.name.endswith("moveTo") and not call.done():
                self.go(*(self.share * part for part in self._way))
            call.end(False if call.name.endswith("moveTo") else None)
        self._under_way.clear()

    killMove = stopMove

    def moveIsActive(self):
        return self.walking

    def getRobotPosition(self, use_sensors):
        return list(self.place)

    def getNextRobotPosition(self):
        return list(self.place)

    def getRobotVelocity(self):
        return [0.1 if self.walking else 0.0, 0.0, 0.0]

    def getFootSteps(self):
        return [[[0.0, 0.05, 0.0], [0.0, -0.05, 0.0]], [], []]

    def getMoveConfig(self, which):
        column = ("Default", "Min", "Max").index(which)
        return [[name, row[column]] for name, row in RANGES.items()]

    def setOrthogonalSecurityDistance(self, distance):
        self.distances[0] = distance

    def getOrthogonalSecurityDistance(self):
        return self.distances[0]

    def setTangentialSecurityDistance(self, distance):
        self.distances[1] = distance

    def getTangentialSecurityDistance(self):
        return self.distances[1]

    def setMoveArmsEnabled(self, left, right):
        self.swing = [left, right]

    def getMoveArmsEnabled(self, arm):
        return self.swing[arm == "RArm"]
