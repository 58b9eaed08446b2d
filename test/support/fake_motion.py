"""A stand-in for ALMotion and ALRobotPosture with a handful of joints; long motions end when the test says so."""

from __future__ import annotations

import threading

from fake_locomotion import FakeLocomotion

CHAINS = {
    "Head": ["HeadYaw", "HeadPitch"],
    "LArm": ["LShoulderPitch", "LShoulderRoll", "LHand"],
    "RArm": ["RShoulderPitch", "RShoulderRoll", "RHand"],
    "LLeg": ["LHipRoll"],
    "RLeg": ["RHipRoll"],
}
CHAINS["Body"] = [joint for chain in CHAINS.values() for joint in chain]
# lower, upper, top speed, torque
LIMITS = {joint: [-2.0, 2.0, 8.0, 1.0] for joint in CHAINS["Body"]}
LIMITS.update(LHand=[0.0, 1.0, 8.0, 1.0], RHand=[0.0, 1.0, 8.0, 1.0], LShoulderRoll=[-0.3, 1.3, 7.0, 1.0])


class FakeMotion(FakeLocomotion):
    """Joints that are where they are told to be.

    Attributes:
        angles: Joint -> rad.
        stiffnesses: Joint -> 0..1.
        slow: Methods that take their time: they end through `pending`.
    """

    def __init__(self, make_call):
        super().__init__()
        self._make_call = make_call
        self.angles = dict.fromkeys(CHAINS["Body"], 0.0)
        self.stiffnesses = dict.fromkeys(CHAINS["Body"], 1.0)
        self.slow = set()
        self.pending = []
        self.started = threading.Event()
        self.switches = {}

    def _slowly(self, name):
        if name not in self.slow:
            return None
        call = self._make_call(f"ALMotion.{name}")
        self.pending.append(call)
        self.started.set()
        return call

    def joints(self, names):
        names = [names] if isinstance(names, str) else names
        return [joint for name in names for joint in CHAINS.get(name, [name])]

    def getBodyNames(self, name):
        from naoqi.errors import RobotError

        if name not in CHAINS:
            raise RobotError("ALMotion", "getBodyNames", f"no chain {name}")
        return CHAINS[name]

    def getLimits(self, name):
        return [LIMITS[joint] for joint in self.joints(name)]

    def getAngles(self, names, use_sensors):
        return [self.angles[joint] for joint in self.joints(names)]

    def getStiffnesses(self, names):
        return [self.stiffnesses[joint] for joint in self.joints(names)]

    def setStiffnesses(self, names, values):
        self.stiffnesses.update(zip(self.joints(names), values))

    def setAngles(self, names, angles, fractions):
        self.angles.update(zip(names, angles))

    def changeAngles(self, names, changes, fraction):
        for joint, change in zip(names, changes):
            self.angles[joint] += change

    def angleInterpolation(self, names, lists, times, absolute):
        for joint, angles in zip(names, lists):
            self.angles[joint] = angles[-1] if absolute else self.angles[joint] + angles[-1]
        return self._slowly("angleInterpolation")

    def angleInterpolationWithSpeed(self, names, angles, fraction):
        self.angles.update(zip(names, angles))
        return self._slowly("angleInterpolationWithSpeed")

    def angleInterpolationBezier(self, names, times, points):
        self.angles.update({joint: row[-1][0] for joint, row in zip(names, points)})
        return self._slowly("angleInterpolationBezier")

    def stiffnessInterpolation(self, names, lists, times):
        self.stiffnesses.update({joint: values[-1] for joint, values in zip(names, lists)})

    def wakeUp(self):
        self.stiffnesses = dict.fromkeys(CHAINS["Body"], 1.0)
        return self._slowly("wakeUp")

    def rest(self):
        self.stiffnesses = dict.fromkeys(CHAINS["Body"], 0.0)

    def robotIsWakeUp(self):
        return min(self.stiffnesses.values()) > 0.0

    def openHand(self, name):
        self.angles[name] = 1.0

    def closeHand(self, name):
        self.angles[name] = 0.0

    def getTransform(self, name, frame, use_sensors):
        # The torso stands 0.3 m above the frame and is turned by 90 degrees to the left in it.
        return [0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.3, 0.0, 0.0, 0.0, 1.0]

    def getPosition(self, name, frame, use_sensors):
        return [0.1, 0.2, 0.3, 0.0, 0.0, float(frame)]

    def positionInterpolations(self, names, frame, paths, masks, times, absolute):
        return self._slowly("positionInterpolations")

    def setPositions(self, names, frame, poses, fraction, mask):
        return None

    def killTasksUsingResources(self, names):
        return None

    def killAll(self):
        return None

    def setBreathEnabled(self, chain, enabled):
        self.switches[chain] = enabled

    def getBreathEnabled(self, chain):
        return self.switches.get(chain, False)


class FakePostures:
    """Goes to any posture it knows, unless it is told to fail."""

    def __init__(self):
        self.posture = "Crouch"
        self.fails = False
        self.tries = 3

    def getPostureList(self):
        return ["Crouch", "Sit", "Stand"]

    def goToPosture(self, name, speed):
        if not self.fails:
            self.posture = name
        return not self.fails

    applyPosture = goToPosture

    def getPosture(self):
        return self.posture

    def getPostureFamily(self):
        return {"Crouch": "Crouching", "Sit": "Sitting"}.get(self.posture, "Standing")

    def setMaxTryNumber(self, count):
        self.tries = count
