"""Motion functions that walk, and those that report the walk."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from naoqi.errors import NaoError
from naoqi.limits import STANDING_LIMIT, STOP_LIMIT

from ..core.chain import checked_by
from ..core.errors import BadGoal, WalkStopped
from ..core.geometry import Place
from ..core.robot import wait_for_call
from ..core.waiting import OncePerConnection
from .motion_fields import Commanded
from .motion_plan import ARMS, MOTION, NEWS_TIME, BodyPart, RobotBody
from .walk_fields import (
    DEFAULT,
    Enable,
    Gait,
    GaitOfEachFoot,
    GaitPairs,
    GaitValues,
    LeastTime,
    PlaceFrame,
    Places,
    Replace,
    SecurityDistance,
    StepLegs,
    Steps,
    StepSpeed,
    StepSpeeds,
    StepTimes,
    SwingingArms,
    Target,
    TfFrame,
    TimeOfWalk,
    Velocity,
    VelocityShares,
    WalkLimits,
    Ways,
    places,
    read_gait,
    read_ranges,
    require_way,
    step_speeds,
    steps,
    walk_time,
)

if TYPE_CHECKING:
    from ..nao_basic import NaoBasic
    from ..ros.nao_robot_driver import NaoRobotDriver


log = logging.getLogger(__name__)

WORLD = 1
"""The frame that `frame` means by this number."""
WAIT = "waitUntilMoveIsFinished"


class WalkFunctions(BodyPart):
    """Functions of ALMotion that walk.

    A walk ends on both feet, however the goal ends. Only a goal that succeeded leaves a robot walking, when `move`,
    `moveToward` or `setFootSteps` was its wish.
    """

    def __init__(
        self, module: NaoBasic, body: RobotBody, locate: Callable[[str], Sequence[float]], driver: NaoRobotDriver | None
    ) -> None:
        """Take what finds a frame of /tf, seen from the robot (x and y in m, heading in rad), and NaoRobotDriver."""
        super().__init__(body)
        self._module = module
        self.locate = locate
        self._driver = driver
        self._ranges = OncePerConnection(module.robot, lambda: read_ranges(body.motion))
        self._walk_begun = False  # by this chain
        self.left_walking = False  # by a chain that succeeded
        self._cause = ""  # why the robot ended a walk; written from a thread of libqi

    def walk_failed(self, value: Any) -> None:
        """Take a value of ALMotion/MoveFailed: cause, 0 not started or 1 stopped on the way, place of an obstacle.

        The event may come a little after the end of the walk, from a thread of libqi.
        """
        self._cause = str(value[0]) if isinstance(value, (list, tuple)) and value else str(value or "")

    # What checks need

    def _config(self, gait: Sequence[str], gait_values: Sequence[float], each_foot: bool = False) -> GaitPairs:
        """Parameters of a walk as ALMotion takes them; nothing is asked of the robot if a message gives none."""
        if not gait and not gait_values:
            return []
        return read_gait(gait, gait_values, self._ranges(), each_foot)

    def _origin(self, frame: int, str_param: str) -> Place | None:
        """Where the frame of a message is, seen from the robot; None for the world, that the walk itself knows."""
        if str_param.strip():
            return Place(*self.locate(str_param.strip()))
        return None if frame == WORLD else Place(0.0, 0.0, 0.0)

    def _check_walk(self) -> None:
        """What all walks need and do."""
        plan = self.body.plan
        joints = plan.walk.moved_joints()
        plan.walk.require_ready()
        plan.health.require_walk(joints, plan.moves)
        # Legs walk, arms swing: only the robot knows where they are afterwards.
        plan.forget(joints)

    def _check_way(self, points: Sequence[Place], config: GaitPairs, duration: float = 0.0) -> None:
        self._check_init()
        self.body.plan.takes(max(duration, walk_time(points, config, self._ranges())))

    # To places

    def _check_init(self) -> None:
        self._check_walk()
        self.body.plan.walk.stands()

    @checked_by(_check_init)
    def move_init(self) -> None:
        """Take the pose that walks begin with, and wait for the end."""
        self._walk("moveInit")

    def _check_move_to(
        self, values: Sequence[float], duration: float, gait: Sequence[str], gait_values: Sequence[float]
    ) -> None:
        points = places(values)
        if duration > 0.0 and len(points) > 1:
            raise BadGoal("duration", duration, "0 where there are places on the way")
        self._check_way(points, self._config(gait, gait_values), duration)

    @checked_by(_check_move_to)
    def move_to(self, values: Ways, duration: LeastTime, gait: Gait, gait_values: GaitValues) -> list[float]:
        """Walk to a place seen from the robot, through others if there are more; answers how far it got: m, rad."""
        return self._walk_through(places(values), self._config(gait, gait_values), duration)

    def _check_path(
        self, values: Sequence[float], frame: int, str_param: str, gait: Sequence[str], gait_values: Sequence[float]
    ) -> None:
        points = places(values)
        config = self._config(gait, gait_values)
        origin = self._origin(frame, str_param)
        if origin is not None:
            points = _from(origin, points)
        self._check_way(points, config)

    @checked_by(_check_path)
    def walk_target(
        self, values: Target, frame: PlaceFrame, str_param: TfFrame, gait: Gait, gait_values: GaitValues
    ) -> list[float]:
        """Walk to a place in the frame of /tf named in `str_param`, the world or, else, seen from the robot."""
        return self.walk_path(values, frame, str_param, gait, gait_values)

    @checked_by(_check_path)
    def walk_path(
        self, values: Places, frame: PlaceFrame, str_param: TfFrame, gait: Gait, gait_values: GaitValues
    ) -> list[float]:
        """Walk through places in the frame of /tf named in `str_param`, the world or, else, seen from the robot."""
        points = places(values)
        origin = self._origin(frame, str_param)
        if origin is None:
            origin = Place(0.0, 0.0, 0.0).seen_from(self._place())
        points = _from(origin, points)
        return self._walk_through(points, self._config(gait, gait_values), 0.0, planned=True)

    # At a speed

    def _check_pace(self, duration: float, gait: Sequence[str], gait_values: Sequence[float]) -> None:
        self._config(gait, gait_values, each_foot=True)
        self._check_walk()
        self.body.plan.takes(duration)
        if duration > 0.0:
            self.body.plan.walk.stands()
        else:
            self.body.plan.walk.goes()

    @checked_by(_check_pace)
    def move(self, values: Velocity, duration: TimeOfWalk, gait: GaitOfEachFoot, gait_values: GaitValues) -> None:
        """Walk at x, y (m/s) and theta (rad/s), and go on at once; with `duration` walk that long, then stop."""
        self._walk_at("move", values, duration, self._config(gait, gait_values, each_foot=True))

    @checked_by(_check_pace)
    def move_toward(
        self, values: VelocityShares, duration: TimeOfWalk, gait: GaitOfEachFoot, gait_values: GaitValues
    ) -> None:
        """Walk at shares -1..1 of the top speed, and go on at once; with `duration` walk that long, then stop."""
        self._walk_at("moveToward", values, duration, self._config(gait, gait_values, each_foot=True))

    # Footsteps

    def _check_timed_steps(self, names: Sequence[str], values: Sequence[float], times: Sequence[float]) -> None:
        steps(names, values)
        if len(times) != len(names):
            problem = f"{len(times)} times for {len(names)} steps"
            raise BadGoal("times", list(times), "one for each step", problem=problem)
        self._check_walk()
        self.body.plan.walk.goes()

    @checked_by(_check_timed_steps)
    def set_foot_steps(self, names: StepLegs, values: Steps, times: StepTimes, enable: Replace) -> None:
        """Put feet (x, y, theta seen from the other foot) where they are to be at given times, and go on at once."""
        with self._on_two_feet_if_interrupted():
            self.motion("setFootSteps", list(names), steps(names, values), list(times), enable)

    def _check_fast_steps(
        self, names: Sequence[str], values: Sequence[float], speed: float, speeds: Sequence[float]
    ) -> None:
        steps(names, values)
        step_speeds(len(names), speed, speeds)
        self._check_init()

    @checked_by(_check_fast_steps)
    def set_foot_steps_with_speed(
        self, names: StepLegs, values: Steps, speed: StepSpeed, speeds: StepSpeeds, enable: Replace
    ) -> None:
        """Put feet (x, y, theta seen from the other foot) down, all as fast as given, and wait for the end."""
        fractions = step_speeds(len(names), speed, speeds)
        self._walk("setFootStepsWithSpeed", list(names), steps(names, values), fractions, enable)

    # Ends

    def _check_end(self) -> None:
        self.body.plan.moves = True  # what falls meanwhile ends the goal
        self.body.plan.walk.stands()

    @checked_by(_check_end)
    def wait_until_move_is_finished(self) -> None:
        """Wait until the robot does not walk any more."""
        self._walk(WAIT)

    @checked_by(_check_end)
    def stop_move(self) -> None:
        """Stop walking, and wait until both feet are down."""
        self._walk("stopMove")
        self._walk(WAIT)

    @checked_by(_check_end)
    def kill_move(self) -> None:
        """Stop walking in the middle of the step: the robot may fall."""
        self.motion("killMove")

    def stop_walk(self) -> None:
        """Have the robot stand on both feet; preemption does not interrupt this, and it raises nothing."""
        self._walk_begun = self.left_walking = False
        proxy = self._module.robot.proxy(MOTION)
        try:
            for method in ("stopMove", WAIT):
                proxy.call_async(method).result(timeout=STOP_LIMIT)
        except NaoError as error:
            log.warning("the robot may go on walking: %s", error)

    def end_chain(self, succeeded: bool) -> None:
        """See that only a chain that succeeded leaves the robot walking: only a client knows where it would go."""
        if self._walk_begun and succeeded:
            self.left_walking = self.body.plan.walk.walking
        elif self._walk_begun:
            self.stop_walk()
        self._walk_begun = False

    # Inside

    def _walk_through(
        self, points: Sequence[Place], config: GaitPairs, duration: float, planned: bool = False
    ) -> list[float]:
        before = self._place()
        arguments: list[Any] = [list(map(list, points))] if len(points) > 1 else list(points[0])
        if duration > 0.0:
            arguments.append(duration)
        if config:
            arguments.append(config)

        def begin() -> Any:
            by_driver = planned and len(points) == 1 and not config
            call = self._driver.walk_to(points[0]) if by_driver and self._driver is not None else None
            return call or self._module.robot.proxy(MOTION).call_async("moveTo", *arguments)

        if self._await_walk(begin) is False:
            self._stopped(points[-1], before)
        return list(self._place().seen_from(before))

    def _walk_at(self, method: str, values: Sequence[float], duration: float, config: GaitPairs) -> None:
        arguments: list[Any] = [*values, config] if config else list(values)
        with self._on_two_feet_if_interrupted():
            if duration == 0.0:
                self.motion(method, *arguments)
                return
            before = self._place()
            self.motion(method, *arguments)
            self._module.wait(duration)
            if any(values) and not self.motion("moveIsActive"):
                self._stopped(None, before)
        self.stop_move()

    def _stopped(self, goal: Place | None, before: Place) -> None:
        """Say that the walk was stopped by somebody else, who may walk on with the robot: that is left alone.

        Raises WalkStopped with how far it got; NaoError if something else is known to have stopped it: a fall.
        """
        self._walk_begun = False
        wait_for_call(self._module.robot.proxy(MOTION).call_async(WAIT), self._module.interrupt, STANDING_LIMIT)
        # The news of a fall, or of the cause, may be on its way.
        if self._module.interrupt.wait(NEWS_TIME):
            self._module.interrupt.check()
        raise WalkStopped(goal, self._place().seen_from(before), self._cause)

    def _walk(self, method: str, *arguments: Any) -> Any:
        """Call a method that takes as long as the robot walks; preemption stops the walk, and then ends this."""
        return self._await_walk(lambda: self._module.robot.proxy(MOTION).call_async(method, *arguments))

    def _await_walk(self, begin: Callable[[], Any]) -> Any:
        with self._on_two_feet_if_interrupted():
            self._module.interrupt.check()
            call = begin()
            # Not cancelled on preemption: a walk that is told to stop ends on both feet, and its call with it.
            if not wait_for_call(call, self._module.interrupt):
                self._module.interrupt.check()
            return call.result(timeout=0)

    @contextmanager
    def _on_two_feet_if_interrupted(self) -> Iterator[None]:
        self._walk_begun = True
        self._cause = ""
        try:
            yield
        except BaseException:
            self.stop_walk()
            raise

    def _place(self) -> Place:
        """Where the robot is in the world, by its odometry."""
        return Place(*self.motion("getRobotPosition", True))

    functions = {
        "moveInit": move_init,
        "moveTo": move_to,
        "walkTo": move_to,
        "walkTarget": walk_target,
        "walk_target": walk_target,
        "walkPath": walk_path,
        "walk_path": walk_path,
        "move": move,
        "moveToward": move_toward,
        "setFootSteps": set_foot_steps,
        "setFootStepsWithSpeed": set_foot_steps_with_speed,
        "waitUntilMoveIsFinished": wait_until_move_is_finished,
        "stopMove": stop_move,
        "killMove": kill_move,
    }


def _from(origin: Place, points: Sequence[Place]) -> list[Place]:
    """Places in a frame as the robot sees them; BadGoal where one is too far."""
    points = [origin.then(point) for point in points]
    for point in points:
        require_way(point)
    return points


class WalkState(BodyPart):
    def get_robot_position(self, commanded: Commanded) -> list[float]:
        """Where the robot is in the world by its odometry: x, y (m), theta (rad)."""
        return list(self.motion("getRobotPosition", not commanded))

    def get_next_robot_position(self) -> list[float]:
        """Where the robot will be when the steps are done that can change no more: x, y (m), theta (rad)."""
        return list(self.motion("getNextRobotPosition"))

    def get_robot_velocity(self) -> list[float]:
        """How fast the robot walks: x, y (m/s), theta (rad/s)."""
        return list(self.motion("getRobotVelocity"))

    def get_foot_steps(self) -> list[Any]:
        """Where the feet are in the world, and the steps that are planned: those that are begun, then the others."""
        return list(self.motion("getFootSteps"))

    def move_is_active(self) -> bool:
        """Whether the robot walks."""
        return bool(self.motion("moveIsActive"))

    def get_move_config(self, str_param: WalkLimits) -> list[list[Any]]:
        """Names and values of the parameters of a walk: Default, Min or Max."""
        return [list(pair) for pair in self.motion("getMoveConfig", str_param.strip() or DEFAULT)]

    def set_orthogonal_security_distance(self, values: SecurityDistance) -> None:
        """How near (m) a walk comes to an obstacle ahead, at full speed."""
        self.motion("setOrthogonalSecurityDistance", values[0])

    def get_orthogonal_security_distance(self) -> float:
        """How near (m) a walk comes to an obstacle ahead, at full speed."""
        return float(self.motion("getOrthogonalSecurityDistance"))

    def set_tangential_security_distance(self, values: SecurityDistance) -> None:
        """How near (m) walk and arms come to any obstacle."""
        self.motion("setTangentialSecurityDistance", values[0])

    def get_tangential_security_distance(self) -> float:
        """How near (m) walk and arms come to any obstacle."""
        return float(self.motion("getTangentialSecurityDistance"))

    def set_move_arms_enabled(self, names: SwingingArms, enable: Enable) -> None:
        """Let arms swing while the robot walks, or stop it; both if none is named."""
        wanted = _arms(names)
        swing = [enable if arm in wanted else bool(self.motion("getMoveArmsEnabled", arm)) for arm in ARMS]
        self.motion("setMoveArmsEnabled", *swing)

    def get_move_arms_enabled(self, names: SwingingArms) -> list[bool]:
        """Whether arms swing while the robot walks; both if none is named."""
        return [bool(self.motion("getMoveArmsEnabled", arm)) for arm in ARMS if arm in _arms(names)]

    functions = {
        "getRobotPosition": get_robot_position,
        "getNextRobotPosition": get_next_robot_position,
        "getRobotVelocity": get_robot_velocity,
        "getFootSteps": get_foot_steps,
        "moveIsActive": move_is_active,
        "getMoveConfig": get_move_config,
        "setOrthogonalSecurityDistance": set_orthogonal_security_distance,
        "getOrthogonalSecurityDistance": get_orthogonal_security_distance,
        "setTangentialSecurityDistance": set_tangential_security_distance,
        "getTangentialSecurityDistance": get_tangential_security_distance,
        "setMoveArmsEnabled": set_move_arms_enabled,
        "getMoveArmsEnabled": get_move_arms_enabled,
    }


def _arms(names: Sequence[str]) -> Sequence[str]:
    return ARMS if not names or "Arms" in names else names
