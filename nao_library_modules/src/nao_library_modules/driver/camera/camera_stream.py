"""Images of one camera while they are wanted: subscription at ALVideoDevice and the thread that reads. No ROS."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from naoqi.errors import NaoError, RobotError, RobotUnreachable
from naoqi.limits import FIRST_PICTURE_LIMIT, STREAM_LIMIT

from ...core.errors import Preempted
from ...core.health import Level, Report
from ...core.nao_facts import CAMERA_NAMES
from ...core.robot import ask, wait_for_calls
from ...core.robot_events import ImageClock
from ...core.waiting import CancellationToken
from ..base.lazy_subscription import CLOSE_LIMIT, LazySubscription
from ..base.polling import RateMeter
from .camera_images import RESOLUTIONS, SPACES, Picture, read_picture

log = logging.getLogger(__name__)

DEVICE = "ALVideoDevice"


@dataclass(frozen=True)
class StreamSettings:
    """A subscription to ALVideoDevice; camera, resolution and colour space are NAOqi's numbers."""

    camera: int
    resolution: int
    color_space: int
    frame_rate: int  # pictures a second

    @property
    def period(self) -> float:
        """Time between two pictures, s."""
        return 1.0 / self.frame_rate


CHANGES = {
    "resolution": "setResolution",
    "color_space": "setColorSpace",
    "frame_rate": "setFrameRate",
}
"""What of the settings can be changed while pictures come, and by which method."""


class CameraSubscriber:
    """Subscribes to the cameras of one robot under one name, for one subscription at a time. Has no state.

    Methods raise NaoError if the robot refuses or cannot be asked.
    """

    def __init__(self, robot: Any, name: str) -> None:
        self._robot = robot
        self._name = name

    def subscribe(self, wanted: StreamSettings) -> str:
        """The handle of a new subscription."""
        arguments = (self._name, wanted.camera, wanted.resolution, wanted.color_space, wanted.frame_rate)
        try:
            handle = self._ask("subscribeCamera", *arguments)
        except RobotUnreachable:
            raise
        except NaoError as error:
            handle, refused = "", error
        else:
            refused = NaoError(f"the robot does not accept {self._name} as a subscriber of its cameras")
        # A node that was killed leaves its subscriptions behind, and a name may have a few only.
        if not handle and self._end_leftovers():
            handle = self._ask("subscribeCamera", *arguments)
        if not handle:
            raise refused
        return handle

    def change(self, handle: str, before: StreamSettings, after: StreamSettings) -> None:
        """Apply new settings to a subscription, all but the camera."""
        for name, method in CHANGES.items():
            value = getattr(after, name)
            if value != getattr(before, name) and self._ask(method, handle, value) is False:
                raise NaoError(f"the robot refuses the {name} {value} for its {CAMERA_NAMES[after.camera]}")

    def unsubscribe(self, handle: str) -> None:
        try:
            self._ask("unsubscribe", handle)
        except RobotError as error:  # the robot has forgotten it
            log.debug("%s: %s", self._name, error)

    def _end_leftovers(self) -> int:
        leftovers = [each for each in self._ask("getSubscribers") if each.rpartition("_")[0] == self._name]
        for handle in leftovers:
            self.unsubscribe(handle)
        return len(leftovers)

    def _ask(self, method: str, *arguments: Any) -> Any:
        return ask(self._robot, DEVICE, method, *arguments)


FAILURE_PAUSE = 0.5
"""s after which a stream that failed begins again."""


@dataclass(frozen=True, eq=False)
class CameraSubscription:
    """A subscription at the robot; its interrupt ends all waits for its pictures."""

    handle: str
    interrupt: CancellationToken = field(default_factory=CancellationToken)


class CameraStream:
    """Asks the robot for one picture after the other, at the robot's own pace, while they are wanted.

    Three threads: that of the lazy subscription subscribes and unsubscribes, that of the pictures waits for them and
    passes them on, and any may change the settings. `_changing` keeps changes and subscriptions apart and is held
    during calls; `_news` guards the subscription and is not.
    """

    def __init__(
        self,
        robot: Any,
        name: str,
        settings: StreamSettings,
        clock: Any,
        sink: Callable[[Picture, float], None],
        prepare: Callable[[], None] = lambda: None,
    ) -> None:
        """Start without pictures; the robot need not be connected yet.

        Args:
            name: Name of the subscriber at the robot.
            clock: ROS time: `now()`.
            sink: Gets each picture and the ROS time at which it was taken, in s, in the thread of the pictures.
            prepare: Called before each subscription, in the thread of the lazy subscription. May make calls.
        """
        self._robot = robot
        self._name = name
        self._subscriber = CameraSubscriber(robot, name)
        self._settings = settings
        self._clock = clock
        self._sink = sink
        self._prepare = prepare
        self._changing = threading.Lock()
        self._news = threading.Condition()
        self._subscription: CameraSubscription | None = None
        self._closed = False
        self._times = ImageClock()
        self._rate = RateMeter(name, "pictures")
        self._last = (0.0, 0.0)
        self._shows = False
        self._problem = ""
        self._lazy = LazySubscription(robot, f"pictures for {name}", self._begin, self._end, self._is_alive)
        self._thread = threading.Thread(target=self._run, name=f"pictures {name}", daemon=True)
        self._thread.start()

    @property
    def settings(self) -> StreamSettings:
        return self._settings

    def want(self, wanted: bool) -> None:
        self._lazy.want(wanted)

    def change(self, settings: StreamSettings) -> None:
        """Change the settings. Pictures keep coming meanwhile, unless the camera changes.

        Raises NaoError if the robot refuses, or cannot be asked; then the former settings hold.
        """
        with self._changing:
            before, subscription = self._settings, self._subscription
            if subscription is None or not self._lazy.running or settings.camera != before.camera:
                self._settings = settings
                if settings.camera != before.camera:
                    self._lazy.restart()
                return
            try:
                self._subscriber.change(subscription.handle, before, settings)
            except NaoError:
                if self._subscription is subscription:
                    self._change_back(subscription.handle, settings, before)
                    raise
                # It ended meanwhile, for lack of subscribers: the settings are those of the next one.
            self._settings = settings
            if settings.frame_rate != before.frame_rate:
                self._rate.restart()

    def _change_back(self, handle: str, tried: StreamSettings, before: StreamSettings) -> None:
        try:
            self._subscriber.change(handle, tried, before)
        except NaoError as error:  # the first error is the one to report
            log.debug("%s: %s", self._name, error)
            self._lazy.restart()

    def report(self) -> Report:
        settings = self._settings
        values = {
            "camera": CAMERA_NAMES[settings.camera],
            "size": RESOLUTIONS[settings.resolution],
            "colour space": SPACES[settings.color_space][0],
            **self._rate.values(settings.frame_rate),
            "pictures": str(self._rate.count),
            "missed pictures": str(self._rate.missed),
            "last error": self._lazy.problem or self._problem,
        }
        if not self._lazy.wanted:
            return Report(Level.OK, "no subscriber", values)
        if not self._lazy.running or self._problem:
            problem = self._lazy.problem or self._problem or "the robot is not connected"
            return Report(Level.ERROR, f"no pictures: {problem}", values)
        slow = self._rate.problem(settings.frame_rate)
        return Report(Level.WARN, slow, values) if slow else Report(Level.OK, "pictures come", values)

    def close(self) -> None:
        self._lazy.close()
        with self._news:
            self._closed = True
            self._news.notify_all()
        self._forget()
        self._thread.join(CLOSE_LIMIT)

    # --- in the thread of the demand ------------------------------------------------------------------------------

    def _begin(self) -> None:
        self._forget()  # that of a connection that was lost
        self._prepare()  # without the lock: changes of settings hold others
        with self._changing:
            handle = self._subscriber.subscribe(self._settings)
            self._rate.restart()
            self._note_life()
            self._shows = False
            with self._news:
                self._subscription = CameraSubscription(handle)
                self._news.notify_all()

    def _end(self) -> None:
        subscription = self._forget()
        if subscription is not None:
            self._subscriber.unsubscribe(subscription.handle)

    def _forget(self) -> CameraSubscription | None:
        with self._news:
            subscription, self._subscription = self._subscription, None
        if subscription is not None:
            subscription.interrupt.stop()
        return subscription

    def _is_alive(self) -> bool:
        """Whether pictures come. On a simulation that stands still, none are due."""
        wall, ros = self._last
        quiet = min(self._robot.connection.answering_time() - wall, self._clock.now() - ros)
        limit = (STREAM_LIMIT if self._shows else FIRST_PICTURE_LIMIT) + self._settings.period
        if quiet < limit or self._subscription is None:
            return True
        self._fail_once("no picture has come for some time")
        return False

    # --- in the thread of the pictures ----------------------------------------------------------------------------

    def _run(self) -> None:
        subscription: CameraSubscription | None = None
        while True:
            with self._news:
                former = subscription
                self._news.wait_for(lambda former=former: self._closed or self._subscription not in (None, former))
                subscription = self._subscription
            if self._closed or subscription is None:
                return
            try:
                self._times.restart()
                self._look(subscription)
            except Preempted:
                continue
            except NaoError as error:
                # A lost connection is reported elsewhere, and one that has ended has no pictures.
                if not isinstance(error, RobotUnreachable) and not subscription.interrupt.is_set():
                    self._fail_once(str(error))
            except Exception as error:  # a mistake in here must not leave a node that lives and shows nothing
                log.exception("%s failed", self._name)
                self._problem = f"unexpected error: {error!r}"
            if not subscription.interrupt.wait(FAILURE_PAUSE):
                self._lazy.restart()

    def _look(self, subscription: CameraSubscription) -> None:
        """Pass on pictures until something goes wrong.

        Raises NaoError: what went wrong; Preempted when the subscription ends.
        """
        device, last = self._robot.proxy(DEVICE), None
        while True:
            call = device.call_async("getImageRemote", subscription.handle)
            (image,) = wait_for_calls([call], subscription.interrupt)
            picture = read_picture(image, self._settings.camera)
            period = self._settings.period
            if picture.time == last:  # a robot that does not wait for the next one gives the same again
                subscription.interrupt.wait(0.5 * period)
                subscription.interrupt.check()
                continue
            last = picture.time
            self._note_life()
            self._shows = True
            self._rate.note(last, self._settings.frame_rate)
            if self._problem:
                self._problem = ""
                log.info("%s: pictures come again", self._name)
            self._sink(picture, self._times.take(last, self._last[1]))

    def _note_life(self) -> None:
        self._last = (self._robot.connection.answering_time(), self._clock.now())

    def _fail_once(self, problem: str) -> None:
        if problem != self._problem:
            log.warning("%s: %s", self._name, problem)
        self._problem = problem
