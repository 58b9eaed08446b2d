"""Functions that follow something with the head: it turns to a ball or a face, and searches what is out of view."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import cycle
from typing import Any, Tuple

from naoqi.errors import NaoError

from ..core.chain import Part
from ..core.nao_facts import CAMERA_NAMES, load_head, look_at
from ..motion.effectors import HEAD
from ..motion.motion_plan import MOTION, JointLimits
from .detections import BALL, FACE, LocalizedDetection, merged
from .detectors import Detectors, WantedDetection, Watch
from .vision_fields import (
    SEARCH_TIMEOUT,
    AnyPerson,
    BallSize,
    Camera,
    Confidence,
    Duration,
    HeadRevert,
    HeadSize,
    Looks,
    NameConfidence,
    Patience,
    Search,
    SearchTimeout,
    Speed,
    Thing,
    ThingConfidence,
    ThingSize,
    camera_index,
    timeout_of,
    wanted_thing,
)

log = logging.getLogger(__name__)

Angles = Tuple[float, float]
"""HeadYaw and HeadPitch, rad."""

YAWS = (0.0, 0.8, 1.6, 2.0, -0.8, -1.6, -2.0)
"""rad: a camera sees 0.98 rad, so that pictures overlap."""
PITCHES = {BALL: (0.2, 0.45), FACE: (0.0, -0.35, -0.65)}
"""rad, positive downwards: a ball lies on the floor, and people who come near are high above the robot."""
USUAL_PITCHES = (0.0, -0.4, 0.3)
REACTION = 0.2
"""s in which the head is to reach its target: less is quicker, more is smoother."""
LEAST_FRACTION = 0.01
STILL = math.radians(0.7)
"""rad off the middle of the picture for which the head does not turn: pictures are not more exact."""
MIDDLE = math.radians(3.0)
"""rad off the middle of the picture that count as the middle."""


def aim(detection: LocalizedDetection) -> Angles:
    """Head angles that bring a detection into the middle of the picture, also beyond the head's limits.

    Raises ValueError if it is in the head.
    """
    head = load_head()
    return look_at(head, head.cameras[CAMERA_NAMES[detection.camera]], detection.in_torso)


def off_axis(detection: LocalizedDetection) -> float:
    """Angle of a detection off the camera's axis, rad."""
    x, y, z = detection.in_camera
    return math.atan2(math.hypot(y, z), x)


def fraction(angle: float, ranges: Sequence[JointLimits], most: float) -> float:
    """Fraction of the head's top speed for a turn: the smaller the angle (rad), the slower; at most `most`."""
    top = min(joint.max_speed for joint in ranges)
    return min(max(angle / REACTION / top, LEAST_FRACTION), most)


def travel_time(start: Angles, end: Angles, ranges: Sequence[JointLimits], speed: float) -> float:
    """Duration of a turn of the head at a fraction (0..1) of the top speeds, s."""
    return max(abs(b - a) / (joint.max_speed * speed) for a, b, joint in zip(start, end, ranges))


def search_angles(kind: str, ranges: Sequence[JointLimits]) -> Iterator[Angles]:
    """Head angles of a search for a kind of thing, without end: ahead first, then to the left, then to the right."""
    rows = PITCHES.get(kind, USUAL_PITCHES)
    places = []
    for column, yaw in enumerate(YAWS):
        # Down one column and up the next: shorter ways for the head.
        for pitch in rows if column % 2 == 0 else rows[::-1]:
            places.append((ranges[0].within(yaw), ranges[1].within(pitch)))
    return cycle(places)


def the_one(detections: Sequence[LocalizedDetection], last: LocalizedDetection | None) -> LocalizedDetection:
    """The detection to follow: of the same thing as the last one, else the nearest to it; at first the largest."""
    if last is None:
        return max(detections, key=lambda s: s.region.width * s.region.height)
    same = [s for s in detections if s.detection.key == last.detection.key]
    if len(same) == 1:
        return same[0]
    return min(detections, key=lambda s: math.dist(s.in_robot, last.in_robot))


LOST = 0.7
"""s without a detection after which a thing is lost: single pictures may show nothing."""
GLANCE = 0.5
"""s that the head rests at each place of a search."""
SETTLING = 2.0
"""s that the head may take in lookFor to bring what it found into the middle of the picture."""
DEFAULT_SPEED = 0.2
"""Fraction of the head's top speed where a message has none."""
WAY_BACK = 0.3
"""Fraction of the top speed with which the head goes back to where it was."""


class Neck:
    """Turns the head for one function. Used from the thread that executes goals."""

    def __init__(self, motion: Callable[..., Any], speed: float) -> None:
        """Read the limits of the head.

        `motion`: calls a method of ALMotion. `speed`: greatest fraction of the head's top speed, 0..1.
        """
        self._motion = motion
        self.speed = speed
        limits = [motion("getLimits", joint)[0] for joint in HEAD]
        self.ranges = [JointLimits(float(lower), float(upper), float(top)) for lower, upper, top, *_ in limits]

    def angles(self, measured: bool) -> Angles:
        """Where the head is measured, or commanded to be."""
        yaw, pitch = map(float, self._motion("getAngles", list(HEAD), measured))
        return yaw, pitch

    def turn(self, angles: Angles, speed: float) -> None:
        """Begin to turn the head; it goes on by itself."""
        self._motion("setAngles", list(HEAD), list(angles), speed)

    def follow(self, detection: LocalizedDetection) -> bool:
        """Turn towards a detection; whether that is beyond what the head can turn.

        The aim is the place of the thing, not its angle off the axis: it stays the same while the head is on its way,
        so that an old picture does no harm.
        """
        try:
            wanted = aim(detection)
        except ValueError as error:
            log.debug("%s: the head stays where it is", error)
            return True
        angle = off_axis(detection)
        yaw, pitch = (joint.within(value) for joint, value in zip(self.ranges, wanted))
        if angle > STILL:
            self.turn((yaw, pitch), fraction(angle, self.ranges, self.speed))
        return (yaw, pitch) != wanted

    def search(self, place: Angles) -> float:
        """Turn to a place of the search; how long that takes, s."""
        way = travel_time(self.angles(True), place, self.ranges, self.speed)
        self.turn(place, self.speed)
        return way


class TrackingFunctions(Part):
    """Following with the head. Parameters are fields of VisionFunction.

    Status of the feedback: looking (nothing seen yet), following, lost, searching.
    """

    def __init__(self, detectors: Detectors) -> None:
        self._detectors = detectors
        self._module = detectors.module

    def track_ball(
        self,
        camera: Camera,
        timeout: Patience,
        confidence: Confidence,
        size: BallSize,
        duration: Duration,
        search: Search,
        speed: Speed,
        revert: HeadRevert,
    ) -> list[float]:
        """Follow a red ball with the head; answers for how long it was in view, s."""
        wanted = WantedDetection(BALL, "", confidence, size, camera_index(camera))
        return self._track(wanted, timeout, duration, search, speed, revert)

    def track_face(
        self,
        str_param: AnyPerson,
        camera: Camera,
        timeout: Patience,
        confidence: NameConfidence,
        size: HeadSize,
        duration: Duration,
        search: Search,
        speed: Speed,
        revert: HeadRevert,
    ) -> list[float]:
        """Follow a face with the head, or only that of one person; answers for how long it was in view, s."""
        wanted = WantedDetection(FACE, str_param.strip(), confidence, size, camera_index(camera))
        return self._track(wanted, timeout, duration, search, speed, revert)

    def look_for(
        self,
        str_param: Thing,
        camera: Camera,
        timeout: SearchTimeout,
        confidence: ThingConfidence,
        count: Looks,
        size: ThingSize,
        speed: Speed,
        revert: HeadRevert,
    ) -> list[str]:
        """Turn the head until something is in view, look at it, and tell where it is; nothing if it is not found."""
        kind, name = wanted_thing(str_param)
        wanted = WantedDetection(kind, name, confidence, size, camera_index(camera))
        limit = timeout or SEARCH_TIMEOUT
        pictures: list[list[LocalizedDetection]] = []
        found: float | None = None
        with self._head(speed, revert) as neck, self._detectors.watching(wanted) as watch:
            chase = Chase(self._detectors, neck, watch, kind, search=True)
            for detection, at_limit in chase.detections(self._module.clock.now() + limit, limit):
                now = self._module.clock.now()
                found = now if found is None else found
                if off_axis(detection) <= MIDDLE or at_limit or now - found > SETTLING:
                    pictures.append([detection])
                    if len(pictures) >= max(count, 1):
                        break
        return self._detectors.note(merged(pictures))

    def _track(
        self, wanted: WantedDetection, timeout: float, duration: float, search: bool, speed: float, revert: bool
    ) -> list[float]:
        last: LocalizedDetection | None = None
        in_view = 0.0
        end = self._module.clock.now() + duration if duration > 0.0 else math.inf
        try:
            with self._head(speed, revert) as neck, self._detectors.watching(wanted) as watch:
                chase = Chase(self._detectors, neck, watch, wanted.kind, search)
                before = -math.inf
                for detection, _ in chase.detections(end, timeout_of(timeout)):
                    last, now = detection, self._module.clock.now()
                    in_view += now - before if now - before <= LOST else 0.0
                    before = now
        finally:  # also a goal that is preempted has the last place in its result
            if last is not None:
                self._detectors.note([last])
        return [in_view]

    @contextmanager
    def _head(self, speed: float, revert: bool) -> Iterator[Neck]:
        """Have the head during a block; it is stiff, and stops at the end.

        `speed`: greatest fraction of its top speed, 0..1; 0 for a moderate one. `revert`: whether it goes back to where
        it was after the function's `time`.
        """
        module = self._module
        proxy = module.robot.proxy(MOTION)

        def motion(method: str, *args: Any) -> Any:
            return module.call(proxy, method, *args)

        def now(method: str, *args: Any) -> Any:
            return module.call_now(proxy, method, list(HEAD), *args)

        neck = Neck(motion, speed or DEFAULT_SPEED)
        before = neck.angles(False)
        limp = [joint for joint, value in zip(HEAD, motion("getStiffnesses", list(HEAD))) if not value > 0.0]
        if limp:
            undo = "setStiffnesses", limp, [0.0] * len(limp)
            self._detectors.begin(MOTION, "setStiffnesses", [limp, [1.0] * len(limp)], *undo)
            module.after_wait(lambda: module.call_now(proxy, *undo))
        if revert:
            module.after_wait(lambda: now("angleInterpolationWithSpeed", list(before), WAY_BACK))
        try:
            yield neck
        finally:
            try:
                now("setAngles", now("getAngles", False), 1.0)
            except NaoError as error:
                log.warning("the head may go on turning: %s", error)

    functions = {
        "trackBall": track_ball,
        "trackFace": track_face,
        "lookFor": look_for,
    }


class Chase:
    """Detects something again and again, and turns the head after it; `search`: also to find it."""

    def __init__(self, detectors: Detectors, neck: Neck, watch: Watch, kind: str, search: bool) -> None:
        self._detectors = detectors
        self._neck = neck
        self._watch = watch
        self._places = search_angles(kind, neck.ranges) if search else None
        self._last: LocalizedDetection | None = None

    def detections(self, end: float, patience: float) -> Iterator[tuple[LocalizedDetection, bool]]:
        """Each detection, and whether the head is as far as it can turn.

        `end`: ROS time of the end, s. `patience`: s without a detection after which it ends as well.
        """
        clock = self._detectors.clock
        status = "looking"
        self._detectors.publish_seen(status)
        seen, glance = clock.now(), clock.now() + GLANCE
        while clock.now() < min(end, seen + patience):
            detection = self._next(min(end, seen + patience, glance))
            if detection is not None:
                status, seen = "following", clock.now()
                at_limit = self._neck.follow(detection)
                self._detectors.publish_seen(status, [detection])
                yield detection, at_limit
                glance = seen + LOST
            elif clock.now() >= glance:
                if status == "following":
                    status = "lost"
                    self._detectors.publish_seen(status)
                glance = math.inf
                if self._places is not None:
                    status = "searching"
                    self._detectors.publish_seen(status)
                    glance = clock.now() + self._neck.search(next(self._places)) + GLANCE

    def _next(self, end: float) -> LocalizedDetection | None:
        for detections in self._watch.until(end):
            self._last = the_one(detections, self._last)
            return self._last
        return None
