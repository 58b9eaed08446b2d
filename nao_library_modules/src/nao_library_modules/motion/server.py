"""The module for motion: angles, trajectories, poses, postures, stiffness, effectors, recorded motions, walks."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from nao_library_actions.msg import NaoMotionAction
from naoqi.errors import NaoError

from ..base.answers import Outcome
from ..base.errors import PutToRest, RobotFell
from ..base.paths import config_file
from ..base.places import Place
from ..functions.chain import ChainStep
from ..functions.goal_checks import NotKnownHere
from ..functions.memory_functions import MEMORY
from ..nao.joint_names import MOVE_FAILED
from ..processes.launcher import LaunchPath
from ..robot.event_relay import EventRelay
from ..server.nao_basic import NaoBasic
from .body import RobotBody
from .by_driver import RobotByDriver
from .cartesian import CartesianFunctions
from .health import in_chain
from .joints import JointMotion
from .look_at import GazeFunctions
from .poses import NamedPoses
from .postures import PostureFunctions
from .recording import MotionRecording
from .state import MotionState
from .stiffness import StiffnessFunctions
from .store import MotionStore
from .switches import MotionSwitches
from .walk import WalkFunctions
from .walk_state import WalkState

log = logging.getLogger(__name__)

DRIVER = ("nao_library", "nao_driver.launch")
MOTIONS = Path("~/.ros/nao_motions")
"""Folder for recorded motions and pose libraries where none is configured."""
SHIPPED = "motions"
"""Folder in `config` with motions that can be replayed without having been recorded."""
PARAMETERS = {"motion_dir": str(MOTIONS), "by_driver": True}
"""Private parameters of the node and their defaults."""
# Functions whose joints only the client moves on: what setAngles began goes on after the function.
ASKING = frozenset({"getAngles"})
FALLING = "ALMotion/RobotIsFalling"
DISABLED = "ALMotion/Protection/DisabledDevicesChanged"


class NaoMotion(NaoBasic):
    """Motion goals: ALMotion and ALRobotPosture, poses, trajectories, gaze, recorded motions, walks.

    A chain is checked as a whole before anything moves. With `dry_run` nothing moves at all.

    Attributes:
        body: The joints, and the plan of the chain that is checked, or runs.
        recordings: Functions of recorded motions, with their store.
        walks: Functions that walk.

    ROS API:
        Action `NaoMotion` (nao_library_actions/NaoMotionAction) and what NaoBasic offers. Where there is a driver: the
        actions and services of `NaoRobotDriver`. Parameters `~motion_dir`: folder of recorded motions and pose
        libraries; `~by_driver` (true): false goes to NAOqi past the driver.
    """

    typed_answers = ASKING
    without_robot = frozenset({"listMotions", "renameMotion", "deleteMotion"})

    part_types = (
        JointMotion,
        StiffnessFunctions,
        PostureFunctions,
        CartesianFunctions,
        GazeFunctions,
        MotionState,
        MotionSwitches,
        MotionRecording,
        WalkFunctions,
        WalkState,
    )

    def __init__(
        self,
        ip: str,
        port: int,
        autostart: bool = False,
        launchpath: LaunchPath | None = DRIVER,
        motion_dir: str | Path = MOTIONS,
        by_driver: bool = True,
        **options: Any,
    ) -> None:
        """Start the server; arguments as NaoBasic takes them, but for these.

        Args:
            launchpath: As NaoBasic takes it; None stands for the driver.
            motion_dir: Folder of recorded motions and pose libraries.
            by_driver: Whether calls that nao_robot has words for go through its driver, where there is one.
        """
        super().__init__(ip, port, autostart, launchpath or DRIVER, **options)
        driver = self._node.driver() if by_driver else None
        if driver is not None:
            self.robot = RobotByDriver(self.robot, driver)
        folder = Path(motion_dir).expanduser()
        self.body = RobotBody(self)
        self.recordings = MotionRecording(self, self.body, MotionStore(folder, config_file(SHIPPED)))
        self.walks = WalkFunctions(self, self.body, lambda frame: self._node.locate(frame), driver)
        self.add_parts(
            self.body,
            JointMotion(self, self.body, NamedPoses(folder), driver),
            StiffnessFunctions(self.body),
            PostureFunctions(self.body, self.robot),
            CartesianFunctions(self.body),
            GazeFunctions(self.body),
            MotionState(self.body),
            MotionSwitches(self.body),
            self.recordings,
            self.walks,
            WalkState(self.body),
        )
        self._dry_run = False
        self._mishaps = EventRelay(lambda: self.robot.proxy(MEMORY), self._told)
        self.at_end(self.with_robot(self._stop_left_walk), self._mishaps.close)
        self.serve("NaoMotion", NaoMotionAction)

    def begin_goal_check(self, now: bool) -> None:
        """Plan from where the joints are, or from where nobody knows."""
        self.body.begin_chain(now)
        if not now:
            self.walks.locate = _frame_not_known

    # The life of a goal

    def begin_chain(self) -> None:
        self.body.begin_chain()
        self.recordings.begin_chain()
        for event in (FALLING, MOVE_FAILED, DISABLED):
            try:
                self._mishaps.subscribe(event)
            except NaoError as error:
                log.debug("%s is not watched: %s", event, error)  # a robot that cannot be asked moves nothing either
        self._dry_run = False

    def end_chain(self, end: str) -> None:
        """See that only a chain that succeeded leaves the robot walking."""
        self.walks.end_chain(end == "succeeded")

    def begin_check(self, position: int) -> None:
        """Tell the plan which function comes."""
        self.body.plan.begin_function(position)

    def steps_to_run(self, goal: Any, steps: Sequence[ChainStep], outcomes: list[Outcome]) -> Sequence[ChainStep]:
        """Nothing for a dry run: each function answers how long it would take, with the wait after it, s."""
        self._dry_run = any(function.dry_run for function in goal.functions)
        if not self._dry_run:
            return steps
        for step in steps:
            duration = self.body.plan.durations[step.position] + step.sleep_time
            outcomes.append(Outcome(step.position, step.function, [f"{duration:.3f}"], 0.0))
        return []

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Add the joints that the chain moved, as they are now, and those that it asked for, as they were then.

        What an interrupted chain has set going is stopped.
        """
        super().fill_result(result, outcomes)
        result.results += self.recordings.cut_short
        plan = self.body.plan
        joints = list(plan.touched)
        if self.interrupt.is_set():
            self.body.halt()
        if not joints:
            return
        if self._dry_run:
            angles = plan.angles
            joints = [joint for joint in joints if angles[joint] is not None]
            result.position = [angles[joint] for joint in joints]
        else:
            answers = {joint: angle for joint, angle in plan.answers.items() if joint in plan.asked}
            now = [joint for joint in joints if joint not in answers]
            if now:
                answers.update(zip(now, self.body.motion_now("getAngles", now, True)))
            result.position = [answers[joint] for joint in joints]
        result.name = joints

    def _stop_left_walk(self) -> None:
        if self.walks.left_walking:
            self.walks.stop_walk()

    def connected(self, again: bool) -> None:
        if again:
            self._mishaps.renew()

    def _told(self, event: str, value: Any) -> None:
        """Called from a thread of libqi."""
        if event == MOVE_FAILED:
            self.walks.walk_failed(value)
        elif event == DISABLED:
            self._disabled(value)
        elif value and self.body.plan.moves and not self._idle.is_set():
            # A chain that goes on would move a robot that lies.
            self.interrupt.trigger(RobotFell())

    def _disabled(self, value: Any) -> None:
        """The robot has put chains to rest, or gives them back: pairs of name and whether it has."""
        if not self.body.plan.moves or self._idle.is_set():
            return
        resting = [str(name) for name, rests in value or () if rests]
        hit = [chain for chain in resting if any(in_chain(joint, chain) for joint in self.body.plan.moved)]
        if hit:
            self.interrupt.trigger(PutToRest(hit))


def _frame_not_known(frame: str) -> Place:
    raise NotKnownHere(f"where {frame} will be is not known before")
