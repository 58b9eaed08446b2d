"""Motion functions that walk."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from naoqi.errors import NaoError

from ..base.errors import WalkStopped
from ..base.places import Place
from ..functions.chain import checked_by
from ..robot.robot_task import wait_for_call
from .base import NEWS_TIME
from .facts import MOTION
from .gait import GaitPairs
from .walk_checks import (
    WalkBase,
    check_end,
    check_fast_steps,
    check_init,
    check_move_to,
    check_pace,
    check_path,
    check_timed_steps,
    places,
    require_way,
    step_speeds,
    steps,
)
from .walk_fields import (
    Gait,
    GaitOfEachFoot,
    GaitValues,
    LeastTime,
    PlaceFrame,
    Places,
    Replace,
    StepLegs,
    Steps,
    StepSpeed,
    StepSpeeds,
    StepTimes,
    Target,
    TfFrame,
    TimeOfWalk,
    Velocity,
    VelocityShares,
    Ways,
)

log = logging.getLogger(__name__)

WAIT = "waitUntilMoveIsFinished"

STANDING_LIMIT = 2.0
"""s that a robot whose walk was stopped may take to stand, before it is told how far it got."""
STOP_LIMIT = 10.0
"""s that the robot may take to stand on both feet; it takes about one."""


class WalkFailure:
    """Why a walk ended before time, as the robot tells in an event that may come a little after the end.

    Told from a thread of libqi, asked from the one that executes goals.
    """

    def __init__(self) -> None:
        """Nothing has failed yet."""
        self._cause = ""

    def tell(self, value: Any) -> None:
        """Take a value of ALMotion/MoveFailed: cause, 0 not started or 1 stopped on the way, place of an obstacle."""
        self._cause = str(value[0]) if isinstance(value, (list, tuple)) and value else str(value or "")

    def forget(self) -> None:
        """A new walk begins."""
        self._cause = ""

    @property
    def cause(self) -> str:
        """What the robot said last; empty if nothing since `forget`."""
        return self._cause


class WalkFunctions(WalkBase):
    """Functions of ALMotion that walk. Parameters are fields of MotionFunction.

    A walk ends on both feet, however the goal ends. Only a goal that succeeded leaves a robot walking, when `move`,
    `moveToward` or `setFootSteps` was its wish.
    """

    walk_failure: WalkFailure
    wait: Callable[[float], None]  # of NaoBasic: a wait that preemption ends
    walk_by_plan: Callable[[Place], Any] = staticmethod(lambda place: None)
    """Has the driver walk to a place seen from the robot, the way it plans; gives a call, or None where it cannot."""
    _walk_begun = False  # by this chain
    _left_walking = False  # by a chain that succeeded

    # To places

    @checked_by(check_init)
    def move_init(self) -> None:
        """Take the pose that walks begin with, and wait for the end."""
        self._walk("moveInit")

    @checked_by(check_move_to)
    def move_to(self, values: Ways, duration: LeastTime, gait: Gait, gait_values: GaitValues) -> list[float]:
        """Walk to a place seen from the robot, through others if there are more; answers how far it got: m, rad."""
        return self._walk_through(places(values), self.walk_config(gait, gait_values), duration)

    @checked_by(check_path)
    def walk_target(
        self,
        values: Target,
        frame: PlaceFrame,
        str_param: TfFrame,
        gait: Gait,
        gait_values: GaitValues,
    ) -> list[float]:
        """Walk to a place in the frame of /tf named in `str_param`, the world or, else, seen from the robot."""
        return self.walk_path(values, frame, str_param, gait, gait_values)

    @checked_by(check_path)
    def walk_path(
        self,
        values: Places,
        frame: PlaceFrame,
        str_param: TfFrame,
        gait: Gait,
        gait_values: GaitValues,
    ) -> list[float]:
        """Walk through places in the frame of /tf named in `str_param`, the world or, else, seen from the robot."""
        points = places(values)
        origin = self.origin(frame, str_param)
        if origin is None:
            origin = Place(0.0, 0.0, 0.0).seen_from(self._place())
        points = [origin.then(point) for point in points]
        for point in points:
            require_way(point)
        return self._walk_through(points, self.walk_config(gait, gait_values), 0.0, planned=True)

    # At a speed

    @checked_by(check_pace)
    def move(self, values: Velocity, duration: TimeOfWalk, gait: GaitOfEachFoot, gait_values: GaitValues) -> None:
        """Walk at x, y (m/s) and theta (rad/s), and go on at once; with `duration` walk that long, then stop."""
        self._walk_at("move", values, duration, self.walk_config(gait, gait_values, each_foot=True))

    @checked_by(check_pace)
    def move_toward(
        self, values: VelocityShares, duration: TimeOfWalk, gait: GaitOfEachFoot, gait_values: GaitValues
    ) -> None:
        """Walk at shares -1..1 of the top speed, and go on at once; with `duration` walk that long, then stop."""
        self._walk_at("moveToward", values, duration, self.walk_config(gait, gait_values, each_foot=True))

    # Footsteps

    @checked_by(check_timed_steps)
    def set_foot_steps(self, names: StepLegs, values: Steps, times: StepTimes, enable: Replace) -> None:
        """Put feet (x, y, theta seen from the other foot) where they are to be at given times, and go on at once."""
        with self._on_two_feet_if_interrupted():
            self.motion("setFootSteps", list(names), steps(names, values), list(times), enable)

    @checked_by(check_fast_steps)
    def set_foot_steps_with_speed(
        self,
        names: StepLegs,
        values: Steps,
        speed: StepSpeed,
        speeds: StepSpeeds,
        enable: Replace,
    ) -> None:
        """Put feet (x, y, theta seen from the other foot) down, all as fast as given, and wait for the end."""
        fractions = step_speeds(len(names), speed, speeds)
        self._walk("setFootStepsWithSpeed", list(names), steps(names, values), fractions, enable)

    # Ends

    @checked_by(check_end)
    def wait_until_move_is_finished(self) -> None:
        """Wait until the robot does not walk any more."""
        self._walk(WAIT)

    @checked_by(check_end)
    def stop_move(self) -> None:
        """Stop walking, and wait until both feet are down."""
        self._walk("stopMove")
        self._walk(WAIT)

    @checked_by(check_end)
    def kill_move(self) -> None:
        """Stop walking in the middle of the step: the robot may fall."""
        self.motion("killMove")

    def stop_walk(self) -> None:
        """Have the robot stand on both feet; preemption does not interrupt this, and it raises nothing."""
        self._walk_begun = self._left_walking = False
        proxy = self.robot.proxy(MOTION)
        try:
            for method in ("stopMove", WAIT):
                proxy.call_async(method).result(timeout=STOP_LIMIT)
        except NaoError as error:
            log.warning("the robot may go on walking: %s", error)

    def walk_ends(self, end: str) -> None:
        """A chain is over: unless it succeeded, the robot is to stand, because only a client knows where it would go.

        Args:
            end: "succeeded", "aborted" or "preempted".
        """
        if self._walk_begun and end == "succeeded":
            self._left_walking = self.plan.walk.walking
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
            call = self.walk_by_plan(points[0]) if planned and len(points) == 1 and not config else None
            return call or self.robot.proxy(MOTION).call_async("moveTo", *arguments)

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
            self.wait(duration)
            if any(values) and not self.motion("moveIsActive"):
                self._stopped(None, before)
        self.stop_move()

    def _stopped(self, goal: Place | None, before: Place) -> None:
        """Say that the walk was stopped by somebody else, who may walk on with the robot: that is left alone.

        Raises:
            WalkStopped: With how far it got.
            NaoError: If something else is known to have stopped it: a fall.
        """
        self._walk_begun = False
        wait_for_call(self.robot.proxy(MOTION).call_async(WAIT), self.interrupt, STANDING_LIMIT)
        # The news of a fall, or of the cause, may be on its way.
        if self.interrupt.wait(NEWS_TIME):
            self.interrupt.check()
        raise WalkStopped(goal, self._place().seen_from(before), self.walk_failure.cause)

    def _walk(self, method: str, *arguments: Any) -> Any:
        """Call a method that takes as long as the robot walks; preemption stops the walk, and then ends this."""
        return self._await_walk(lambda: self.robot.proxy(MOTION).call_async(method, *arguments))

    def _await_walk(self, begin: Callable[[], Any]) -> Any:
        with self._on_two_feet_if_interrupted():
            self.interrupt.check()
            call = begin()
            # Not cancelled on preemption: a walk that is told to stop ends on both feet, and its call with it.
            if not wait_for_call(call, self.interrupt):
                self.interrupt.check()
            return call.result(timeout=0)

    @contextmanager
    def _on_two_feet_if_interrupted(self) -> Iterator[None]:
        self._walk_begun = True
        self.walk_failure.forget()
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
