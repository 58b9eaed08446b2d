"""ALRobotPosture of the simulated robot, its events, and the older ALRobotPose."""

from __future__ import annotations

from typing import Callable, Mapping

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance import posture_recognition as families
from nao_sim_bridge.control.balance.posture_recognition import PostureWatch, recognise
from nao_sim_bridge.core.posture_change import PostureChange
from nao_sim_bridge.core.posture_moves import load_moves
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.model.postures import load_postures
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.naoqi.binding.arguments import speed_share
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.wake import set_awake

POSTURE, FAMILY = "PostureChanged", "PostureFamilyChanged"
PERIOD = 1.0
"""Simulated time between two looks, s."""
DEFAULT_TRIES = 3
POSE = "ALRobotPose"
UNKNOWN = "Unknown"
# The old names of what the robot recognises now.
POSES: Mapping[str, str] = {
    families.STANDING: "Stand",
    families.CROUCHING: "Crouch",
    families.SITTING: "Sit",
    families.ON_CHAIR: "Sit",
    families.BELLY: "Belly",
    families.BACK: "Back",
    families.LEFT: "Left",
    families.RIGHT: "Right",
}
# Poses that the old module knew and that nothing recognises any more.
NEVER = ("Frog", "HeadBack", "Knee")
POSE_PERIOD = 0.5
"""As `PERIOD`, of the old module."""


class ALRobotPosture:
    """ALRobotPosture as the simulated robot offers it. Only NAOqi methods live here."""

    def __init__(self, runner: RobotRunner, memory: MemoryStore) -> None:
        self._simulation = runner.simulation
        self._runner = runner
        self._memory = memory
        self._tries = DEFAULT_TRIES
        # The change that runs, touched in the simulation thread only.
        self._change: Task | None = None

    def goToPosture(self, name: str, speed: float) -> Task:
        # It stiffens all joints, which is what being awake means.
        return self._begin("goToPosture", name, speed, PostureChange.start, lambda: set_awake(self._memory, True))

    def applyPosture(self, name: str, speed: float) -> Task:
        return self._begin("applyPosture", name, speed, PostureChange.start_straight)

    def stopMove(self) -> Task:
        def stop() -> None:
            if self._change is not None:
                self._change.kill()

        return self._runner.execute(stop, "stopMove")

    def setMaxTryNumber(self, tries: int) -> None:
        if tries < 1:
            raise BadValue("pMaxTryNumber", tries, "1 or more")
        self._tries = tries

    def getPosture(self) -> str:
        return recognise(self._simulation.model, self._runner.snapshot).posture

    def getPostureFamily(self) -> str:
        return recognise(self._simulation.model, self._runner.snapshot).family

    def getPostureList(self) -> list[str]:
        return sorted(load_postures().by_name)

    def getPostureFamilyList(self) -> list[str]:
        return list(families.FAMILIES)

    def _begin(
        self, call: str, name: str, speed: float, start: Callable[..., Task], before: Callable[[], None] = lambda: None
    ) -> Task:
        if name not in load_postures().by_name:
            raise BadValue("postureName", name, f"one of {', '.join(self.getPostureList())}")
        # Robots take a speed above 1 for the top speed, which many programs rely on.
        fraction = speed_share(min(speed, 1.0), "maxSpeedFraction")
        tries, moves, now = self._tries, load_moves(), lambda: self._simulation.snapshot

        def begin() -> Task:
            before()
            self._change = start(PostureChange(self._simulation.robot, now, name, fraction, tries, moves), call)
            return self._change

        return self._runner.execute(begin, call)


class PostureEvents:
    """Raises `PostureChanged` and `PostureFamilyChanged`; called after every tick, in the simulation thread."""

    def __init__(self, model: RobotModel, memory: MemoryStore) -> None:
        self._watch = PostureWatch(model)
        self._memory = memory
        self._due = 0.0
        self._known: dict[str, str] = {}
        for event in (POSTURE, FAMILY):
            memory.declare_event(event, "ALRobotPosture")

    def __call__(self, snapshot: Snapshot) -> None:
        if snapshot.time < self._due:
            return
        self._due = snapshot.time + PERIOD
        seen = self._watch.recognise(snapshot)
        for event, name in ((POSTURE, seen.posture), (FAMILY, seen.family)):
            if self._known.get(event) != name:
                self._known[event] = name
                self._memory.raise_event(event, name)


class ALRobotPose:
    """The module that ALRobotPosture has replaced: coarse poses and since when; called after every tick."""

    def __init__(self, runner: RobotRunner) -> None:
        self._runner = runner
        self._watch = PostureWatch(runner.simulation.model)
        # Pose, and the simulated time in s since which the robot is in it; replaced as a whole.
        self._state = (UNKNOWN, 0.0)
        self._next = 0.0

    def getActualPoseAndTime(self) -> list:
        pose, since = self._state
        return [pose, max(0.0, self._runner.snapshot.time - since)]

    def getPoseNames(self) -> list[str]:
        return sorted({*POSES.values(), *NEVER, UNKNOWN})

    def __call__(self, snapshot: Snapshot) -> None:
        if snapshot.time < self._next:
            return
        self._next = snapshot.time + POSE_PERIOD
        pose = POSES.get(self._watch.recognise(snapshot).family, UNKNOWN)
        if pose != self._state[0]:
            self._state = (pose, snapshot.time)
