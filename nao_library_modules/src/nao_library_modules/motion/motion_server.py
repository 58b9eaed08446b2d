"""The module for motion, and a robot whose motion goes through a driver."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nao_library_actions.msg import NaoMotionAction
from naoqi.errors import NaoError

from ..core.chain import ChainStep
from ..core.errors import PutToRest, RobotFell
from ..core.files import config_file
from ..core.geometry import Place
from ..core.goal_checks import NotKnownHere
from ..core.joint_trajectory import KeyFrames
from ..core.memory_functions import MEMORY, Outcome
from ..core.nao_facts import MOVE_FAILED
from ..core.processes import LaunchPath
from ..core.robot_events import EventRelay
from ..nao_basic import NaoBasic
from .body_switches import MotionState, MotionSwitches
from .effectors import CartesianFunctions, GazeFunctions
from .joint_motion import JointMotion, NamedPoses, PostureFunctions, StiffnessFunctions
from .motion_plan import RobotBody, in_chain
from .recorded_motion import MotionRecording, MotionStore
from .walk import WalkFunctions, WalkState

if TYPE_CHECKING:
    from ..ros.nao_robot_driver import NaoRobotDriver

log = logging.getLogger(__name__)


MOTION, POSTURE = "ALMotion", "ALRobotPosture"
WALKS = ("moveTo", "moveToward")
"""The node of the driver that walks owns the robot's walk as well, and goes on when who asked for it dies."""
SOON = 0.05
"""s in which stiffnesses are set that NAOqi would set at once: a trajectory takes time."""
SAME = 1e-6
"""s and rad that a tangent may be off what velocities say."""


class RobotByDriver:
    """Stands for a Robot whose driver may come and go. What it does not have, it has from the robot itself."""

    def __init__(self, robot: Any, driver: NaoRobotDriver) -> None:
        self._robot = robot
        self._proxies = {
            MOTION: ProxyByDriver(robot, MOTION, driver, _MotionWays(driver).all),
            POSTURE: ProxyByDriver(robot, POSTURE, driver, {"goToPosture": driver.take_posture}),
        }

    def proxy(self, name: str) -> Any:
        """Proxy of a NAOqi module, the same object every time."""
        return self._proxies.get(name) or self._robot.proxy(name)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._robot, name)


class ProxyByDriver:
    """Stands for the proxy of a module.

    `ways`: name of a method -> the call of the driver for its arguments, None if nao_robot has no words for them.
    """

    def __init__(self, robot: Any, module: str, driver: NaoRobotDriver, ways: dict[str, Callable[..., Any]]) -> None:
        self._proxy = robot.proxy(module)
        self._answering_time = robot.connection.answering_time
        self._witness = partial(robot.owners.sending, module)
        self._driver = driver
        self._ways = ways

    def call_async(self, method: str, *args: Any) -> Any:
        way = self._ways.get(method)
        call = way(*args) if way is not None and self._driver.there() else None
        if call is None:
            return self._proxy.call_async(method, *args)
        call.clock = self._answering_time
        # It would go on without this process all the same.
        ended = self._witness(method, args, self._driver.walk_cure() if method in WALKS else None)
        if ended is not None:
            call.add_done_callback(ended)
        return call

    def __getattr__(self, name: str) -> Any:
        return getattr(self._proxy, name)


class _MotionWays:
    """Methods of ALMotion; arguments are NAOqi's, in the forms that the functions of the module send."""

    def __init__(self, driver: NaoRobotDriver) -> None:
        self._driver = driver
        self.all = {
            "angleInterpolation": self._interpolation,
            "angleInterpolationBezier": self._bezier,
            "angleInterpolationWithSpeed": self._with_speed,
            "setStiffnesses": self._stiffnesses,
            "stiffnessInterpolation": self._stiffness_interpolation,
            "moveTo": self._move_to,
            "moveToward": self._move_toward,
            "stopMove": driver.leave_walk,  # and then NAOqi's own
        }

    def _interpolation(self, names: Any, values: Any, times: Any, absolute: bool) -> Any:
        frames = _frames(names, values, times, relative=not absolute)
        return frames and self._driver.follow(frames)

    def _bezier(self, names: Any, times: Any, points: Any) -> Any:
        frames = _hermite(names, times, points)
        return frames and self._driver.follow(frames)

    def _with_speed(self, names: Any, angles: Any, speed: Any) -> Any:
        return self._driver.go(names, angles, speed) if _one_each(names, angles) else None

    def _stiffnesses(self, names: Any, values: Any) -> Any:
        if not _one_each(names, values):
            return None
        return self._driver.stiffen(KeyFrames(tuple(names), (SOON,), tuple((float(value),) for value in values)))

    def _stiffness_interpolation(self, names: Any, values: Any, times: Any) -> Any:
        frames = _frames(names, values, times)
        return frames and self._driver.stiffen(frames)

    def _move_to(self, *args: Any) -> Any:
        return self._driver.walk_by(Place(*args)) if len(args) == 3 and not isinstance(args[0], list) else None

    def _move_toward(self, *args: Any) -> Any:
        return self._driver.walk_at(*args) if len(args) == 3 else None


def _one_each(names: Any, values: Any) -> bool:
    return isinstance(names, list) and isinstance(values, list) and len(names) == len(values)


def _frames(names: Any, values: Any, times: Any, relative: bool = False) -> KeyFrames | None:
    """Key frames, if all joints have the same times, as in a message of a trajectory."""
    if not _one_each(names, values) or not _one_each(names, times) or any(each != times[0] for each in times):
        return None
    return KeyFrames(tuple(names), tuple(times[0]), tuple(map(tuple, values)), None, relative)


def _hermite(names: Any, times: Any, points: Any) -> KeyFrames | None:
    """Key frames with velocities, if all tangents reach a third of the time, as velocities say nothing else."""
    values = [[point[0] for point in row] for row in points]
    frames = _frames(names, values, times)
    if frames is None:
        return None
    lengths = [time - before for before, time in zip((0.0, *frames.times), frames.times)]
    velocities = []
    for row in points:
        row_velocities = []
        for (_, (_, reach, rise), (_, ahead, ahead_rise)), before, after in zip(row, lengths, (*lengths[1:], 0.0)):
            velocity = rise / reach if reach else 0.0
            off = reach + before / 3.0, ahead - after / 3.0, ahead_rise - velocity * ahead
            if max(map(abs, off)) > SAME:
                return None
            row_velocities.append(velocity)
        velocities.append(tuple(row_velocities))
    return KeyFrames(frames.joints, frames.times, frames.values, tuple(velocities), False)


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
