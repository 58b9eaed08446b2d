"""A stand-in for the walk of ALMotion: walks end when the test says so."""

from __future__ import annotations

from naoqi.errors import RobotError

LIMP = "the legs are limp"


class FakeWalk:
    """The methods that walk.

    Attributes:
        walking: Whether the robot walks.
        limp: Whether it refuses to.
        holds: Methods that take their time: they end through `pending`.
        pending: Calls of these.
        walks: Calls of moveTo that are under way.
        waits: Calls of waitUntilMoveIsFinished that are under way.
    """

    def __init__(self, make_call):
        self._make_call = make_call
        self.walking = False
        self.limp = False
        self.holds = set()
        self.pending = []
        self.walks = []
        self.waits = []

    def arrive(self):
        """The robot gets to where it walks."""
        self._stand(arrived=True)

    def _stand(self, arrived=False):
        self.walking = False
        walks, waits = list(self.walks), list(self.waits)
        self.walks.clear()
        self.waits.clear()
        for call in walks:
            call.end(arrived)
        for call in waits:
            call.end()

    def _start(self, method):
        if self.limp:
            raise RobotError("ALMotion", method, LIMP)
        walks = list(self.walks)
        self.walks.clear()
        self.walking = True
        for call in walks:
            call.end(False)

    def _held(self, method):
        if method not in self.holds:
            return None
        call = self._make_call(f"ALMotion.{method}")
        self.pending.append(call)
        return call

    def moveInit(self):
        return self._held("moveInit")

    def moveToward(self, x, y, theta, config=()):
        if any((x, y, theta)):
            self._start("moveToward")
        else:
            self._stand()

    def moveTo(self, x, y, theta, config=()):
        self._start("moveTo")
        call = self._make_call("ALMotion.moveTo")
        self.walks.append(call)
        return call

    def setFootSteps(self, legs, steps, times, clear):
        self._start("setFootSteps")

    def stopMove(self):
        held = self._held("stopMove")
        if held is None:
            self._stand()
        return held

    def waitUntilMoveIsFinished(self):
        if not self.walking:
            return None
        call = self._make_call("ALMotion.waitUntilMoveIsFinished")
        self.waits.append(call)
        return call
