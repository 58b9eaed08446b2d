"""Passes orders to walk on to ALMotion: the newest wins, and no caller waits for the robot. No ROS."""

from __future__ import annotations

import concurrent.futures
import logging
import threading
from collections.abc import Callable
from functools import partial
from typing import Any

from naoqi.errors import NaoError, RobotUnreachable
from naoqi.limits import ANSWER_LIMIT, CLEAN_UP_LIMIT

from ...core.errors import Preempted
from ...core.nao_facts import MOTION, ask_for_stiff_legs
from ...core.robot import run_task
from ...core.waiting import CancellationToken, WallClock
from .walk_commands import (
    Command,
    FootStep,
    GaitConfig,
    Mailbox,
    Order,
    Stop,
    Superseded,
    Target,
    Velocity,
    WalkEnded,
    WalkPace,
    WalkWatchdog,
)

log = logging.getLogger(__name__)

STEP_TIME = 0.5
"""s that a step takes."""
NOT_THERE = "another client or a protection of the robot stopped it"
CLOSED = "the node ends"


class Walker:
    """The one thread through which walking commands reach the robot.

    Orders come from any thread, as fast as they like. This thread takes the newest, keeps the pace, and starts calls
    that take long without waiting for their end, so that a newer order always gets through. Their ends are handled in
    threads of the proxy layer. The lock guards `_running`, `_doing` and `_owes_stop`; all other state belongs to the
    one thread.

    Attributes:
        frequency: Step frequency of velocities, 0 to 1.
        gait: Further gait parameters.
        needs_walk_pose: Whether the next walk begins with the pose for walking (ALMotion.moveInit).
        watchdog_stops: How often commands ceased and the robot was stopped.
    """

    def __init__(self, robot: Any, clock: Any, cmd_vel_timeout: float) -> None:
        """A watched velocity that is not renewed within `cmd_vel_timeout` s of the clock ends; 0: never."""
        self.frequency = 1.0
        self.gait: GaitConfig = []
        self.needs_walk_pose = False
        self.watchdog_stops = 0
        self._robot = robot
        self._clock = clock
        self._wall = WallClock()
        self._watchdog = WalkWatchdog(cmd_vel_timeout)
        self._box = Mailbox()
        self._news, self._halt = CancellationToken(), CancellationToken()
        self._closed = threading.Event()
        self._lock = threading.Lock()
        self._running: list[Order] = []
        self._doing: Command | None = None
        self._owes_stop = False
        self._pace = WalkPace()
        robot.connection.add_listener(self._connection_changed)
        self._thread = threading.Thread(target=self._run, name="walker", daemon=True)
        self._thread.start()

    @property
    def doing(self) -> Command | None:
        """What the robot does at the moment by its orders; None: it stands."""
        with self._lock:
            return self._doing

    def order(self, command: Command, source: str, watched: bool = False, to_the_end: bool = False) -> Order:
        """Have something done, instead of what is done now. Returns at once; `answer` of the order is its end.

        Args:
            source: Where the command came from, for texts.
            watched: Whether a velocity ends when it is not renewed in time.
            to_the_end: Whether a step counts as carried out when it is made, and not when the robot has taken it.
        """
        order = Order(command, source, watched, to_the_end, self._clock.now())
        if self._closed.is_set():
            order.superseded(CLOSED)
        else:
            self._put(order)
        return order

    def close(self, limit: float, only_own: bool = False) -> None:
        """Stop the walk, wait up to `limit` s of real time until the robot stands, and take no orders any more.

        With `only_own`, a walk continues unless an order to this object began it.
        """
        self._robot.connection.remove_listener(self._connection_changed)
        self._closed.set()
        if not only_own or self._box.first is not None or self.doing is not None:
            self._stop_at_the_end(limit)
        self._news.stop()
        self._thread.join(CLEAN_UP_LIMIT)

    def _stop_at_the_end(self, limit: float) -> None:
        last = Order(Stop(), CLOSED)
        self._put(last)
        try:
            last.answer.result(limit)
        except NaoError as error:
            log.warning("the walk cannot be stopped: %s", error)
        except concurrent.futures.TimeoutError:
            log.warning("the robot does not stand after %g s", limit)

    def _put(self, order: Order) -> None:
        self._box.put(order)
        if order.halts:
            self._halt.trigger()
        self._news.trigger()

    # --- the thread -----------------------------------------------------------------------------------------------

    def _run(self) -> None:
        while True:
            self._news.clear()
            if self._closed.is_set() and self._box.first is None:
                return
            try:
                self._turn()
            except Exception:  # a mistake in here must not leave a robot that no client can stop
                log.exception("an order to walk failed")

    def _turn(self) -> None:
        """Carry out the order whose turn it is, or wait for news."""
        order = self._box.first
        if order is not None:
            hasty = order.halts or isinstance(order.command, FootStep)
            pause = 0.0 if hasty else self._pace.pause(self._wall.now())
            if pause > 0.0:
                self._news.wait(pause)
            else:
                self._carry_out(self._box.take())
            return
        left = self._watchdog.left(self._clock.now())
        if left is None:
            self._news.wait(threading.TIMEOUT_MAX)
        elif left > 0.0:
            self._clock.wait(left, self._news)
        else:
            self._stop_by_watchdog()

    def _stop_by_watchdog(self) -> None:
        self.watchdog_stops += 1
        log.warning("no command on cmd_vel for %g s: the robot is stopped", self._watchdog.limit)
        self._watchdog.rest()
        self._stop_for("the end of the commands on cmd_vel")

    def _carry_out(self, order: Order) -> None:
        start: dict[type, Callable[[Order, Any], None]] = {
            Velocity: self._steer,
            Target: self._go_to,
            FootStep: self._step,
            Stop: self._stop,
        }
        try:
            start[type(order.command)](order, order.command)
        except Preempted:
            order.stopped_by = "an order to stand"
            self._ended(order)
        except NaoError as error:
            self._ended(order, error)
        except Exception as error:
            self._ended(order, NaoError(f"unexpected error: {error!r}"))
            raise

    def _steer(self, order: Order, velocity: Velocity) -> None:
        if order.halts and self._stopping():
            order.succeed()  # a client that lets go of a key and calls for a stop gets both answers
            return
        # Equal velocities are left out of a stream only: a client that commands once wants an answer of the robot.
        if not self._pace.is_news(velocity, self._wall.now()) and order.watched:
            if not order.halts:
                self._watchdog.feed(order.arrived)
            order.succeed()
            return
        # Noted before it is sent: what the robot refuses is not sent again with each message.
        self._begin(order, velocity)
        if order.halts:
            self._quick("moveToward", 0.0, 0.0, 0.0)
        else:
            self._get_ready()
            if order.watched:
                self._watchdog.feed(order.arrived)  # also if the call fails: the robot may have got it
            config = [["Frequency", self.frequency], *self.gait]
            self._quick("moveToward", velocity.x, velocity.y, velocity.theta, config)
        order.succeed()

    def _go_to(self, order: Order, target: Target) -> None:
        self._begin(order)
        self._get_ready()
        config = [self.gait] if self.gait else []
        call = self._start("moveTo", target.x, target.y, target.theta, *config)
        call.add_done_callback(partial(self._walked, order))

    def _step(self, order: Order, step: FootStep) -> None:
        self._begin(order)
        self._get_ready()
        self._quick("setFootSteps", [step.leg], [[step.x, step.y, step.theta]], [STEP_TIME], False)
        if order.to_the_end:
            self._start("waitUntilMoveIsFinished").add_done_callback(partial(self._walked, order))
        else:
            order.succeed()

    def _stop(self, order: Order, _: Stop) -> None:
        old = self._begin(order)
        stopping = self._start("stopMove")
        # Robots differ in whether stopMove waits for both feet to be down.
        standing = self._start("waitUntilMoveIsFinished")
        stopping.add_done_callback(lambda call: self._stopped(order, old, call, standing))
        standing.add_done_callback(lambda call: self._stopped(order, old, call, stopping))

    def _stopping(self) -> bool:
        with self._lock:
            return any(isinstance(old.command, Stop) and not old.answer.done() for old in self._running)

    def _begin(self, order: Order, velocity: Velocity | None = None) -> list[Order]:
        """Note what is done from now on, with the velocity that the robot gets; returns what is being stopped.

        Steps add up, everything else replaces what was before: that ends at once, or if it is stopped when the robot
        stands.
        """
        self._watchdog.rest()
        self._pace.sent(velocity, self._wall.now())
        with self._lock:
            before = [old for old in self._running if not old.answer.done()]
            steps = [old for old in before if isinstance(order.command, FootStep) and isinstance(old.command, FootStep)]
            self._running = [*steps, order]
            order.replaces = self._doing is not None
            self._doing = None if order.halts else order.command
        ending = [old for old in before if old not in steps]
        if isinstance(order.command, Stop):
            for old in ending:
                old.stopped_by = order.source
            return ending
        for old in ending:
            old.superseded(f"{order.source} came after it")
        return []

    def _get_ready(self) -> None:
        """See that the legs are stiff, also of a robot that walked; take the pose for walking if that is wanted."""
        ask_for_stiff_legs(self._robot)
        if not self.needs_walk_pose:
            return
        self._halt.clear()
        if self._box.halts:
            self._halt.trigger()
        run_task(self._start("moveInit"), self._halt, lambda: self._quick("stopMove"))
        self.needs_walk_pose = False

    def _start(self, method: str, *arguments: Any) -> Any:
        call = self._robot.proxy(MOTION).call_async(method, *arguments)
        with self._lock:
            self._owes_stop = False  # the newest order gets through
        return call

    def _quick(self, method: str, *arguments: Any) -> Any:
        return self._start(method, *arguments).result(timeout=ANSWER_LIMIT)

    # --- ends, in threads of the proxy layer, which must not wait -----------------------------------------------

    def _walked(self, order: Order, call: Any) -> None:
        try:
            arrived = call.result(timeout=0)
        except NaoError as error:
            self._ended(order, error)
            return
        if order.stopped_by and arrived is not True:
            return  # it ends when the robot stands: see `_stopped`
        if arrived is None or arrived is True:  # robots differ in whether they return it
            self._ended(order, arrived=arrived is True)
        else:
            self._ended(order, WalkEnded(order.command, NOT_THERE))

    def _stopped(self, order: Order, old: list[Order], call: Any, other: Any) -> None:
        """One of the two calls of a stop ended."""
        try:
            call.result(timeout=0)
        except NaoError as error:
            for stopped in old:
                self._ended(stopped, error)
            self._ended(order, error)
            return
        if other.done():
            for stopped in old:
                self._ended(stopped)
            self._ended(order)

    def _ended(self, order: Order, error: NaoError | None = None, arrived: bool = False) -> None:
        with self._lock:
            if isinstance(error, RobotUnreachable) and order.halts:
                self._owes_stop = True
            if order in self._running:
                self._running.remove(order)
                self._doing = self._doing if self._running else None
        if order.stopped_by and not arrived and not isinstance(order.command, Stop):
            order.superseded(f"{order.stopped_by} stopped it")
        elif error is not None:
            order.fail(error)
            if order.replaces and not order.halts and not isinstance(error, WalkEnded):
                self._stop_for("a command that failed")  # the older walk continues, without a watchdog
        else:
            order.succeed()

    def _stop_for(self, reason: str) -> None:
        stop = Order(Stop(), reason)
        stop.answer.add_done_callback(_log_failure)
        self._put(stop)

    def _connection_changed(self, *_: Any) -> None:
        with self._lock:
            owed = self._owes_stop
        if owed and self._robot.connection.state == "connected":
            self._stop_for("the return of the robot, which was to stop,")


def _log_failure(answer: Any) -> None:
    error = answer.exception()
    if error is not None and not isinstance(error, Superseded):
        log.error("the robot cannot be stopped: %s", error)
