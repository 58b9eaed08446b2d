"""Functions whose eyes follow: the head turns to a ball or a face, and looks for what is out of view."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..capture.fields import Camera
from .base import Wanted, Watch, timeout_of
from .events import BALL, FACE
from .fields import (
    SEARCH_TIMEOUT,
    AnyPerson,
    BallSize,
    Confidence,
    Duration,
    HeadSize,
    Looks,
    NameConfidence,
    Patience,
    Revert,
    Search,
    SearchTimeout,
    Speed,
    Thing,
    ThingConfidence,
    ThingSize,
)
from .goals import camera_index, wanted_thing
from .space import LocalizedDetection, merged
from .track_head import HeadUse, Neck
from .track_plan import MIDDLE, off_axis, search_angles, the_one

LOST = 0.7
"""s without being seen after which it is lost: single pictures may show nothing."""
GLANCE = 0.5
"""s that the head rests where it looks for something."""
SETTLING = 2.0
"""s that lookFor gives the head to bring what it found into the middle of the picture."""


class TrackingFunctions(HeadUse):
    """Following with the head. Parameters are fields of VisionFunction.

    Attributes as in DetectionBase. The feedback tells what the robot does: looking (nothing yet), following, lost,
    searching.
    """

    def track_ball(
        self,
        camera: Camera,
        timeout: Patience,
        confidence: Confidence,
        size: BallSize,
        duration: Duration,
        search: Search,
        speed: Speed,
        revert: Revert,
    ) -> list[float]:
        """Follow a red ball with the head; answers for how long it was in view, s."""
        wanted = Wanted(BALL, "", confidence, size, camera_index(camera))
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
        revert: Revert,
    ) -> list[float]:
        """Follow a face with the head, or only that of one person; answers for how long it was in view, s."""
        wanted = Wanted(FACE, str_param.strip(), confidence, size, camera_index(camera))
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
        revert: Revert,
    ) -> list[str]:
        """Turn the head until something is in view, look at it, and tell where it is; nothing if it is not found."""
        kind, name = wanted_thing(str_param)
        wanted = Wanted(kind, name, confidence, size, camera_index(camera))
        limit = timeout or SEARCH_TIMEOUT
        pictures: list[list[LocalizedDetection]] = []
        found: float | None = None
        with self.head(speed, revert) as neck, self.watching(wanted) as watch:
            chase = Chase(self, neck, watch, kind, search=True)
            for detection, at_limit in chase.detections(self.clock.now() + limit, limit):
                now = self.clock.now()
                found = now if found is None else found
                if off_axis(detection) <= MIDDLE or at_limit or now - found > SETTLING:
                    pictures.append([detection])
                    if len(pictures) >= max(count, 1):
                        break
        return self.note(merged(pictures))

    def _track(
        self, wanted: Wanted, timeout: float, duration: float, search: bool, speed: float, revert: bool
    ) -> list[float]:
        last: LocalizedDetection | None = None
        in_view = 0.0
        end = self.clock.now() + duration if duration > 0.0 else math.inf
        try:
            with self.head(speed, revert) as neck, self.watching(wanted) as watch:
                chase = Chase(self, neck, watch, wanted.kind, search)
                before = -math.inf
                for detection, _ in chase.detections(end, timeout_of(timeout)):
                    last, now = detection, self.clock.now()
                    in_view += now - before if now - before <= LOST else 0.0
                    before = now
        finally:  # who preempts it wants to know where it was last
            if last is not None:
                self.note([last])
        return [in_view]

    functions = {
        "trackBall": track_ball,
        "trackFace": track_face,
        "lookFor": look_for,
    }


class Chase:
    """Sees something again and again, the head behind it."""

    def __init__(self, base: HeadUse, neck: Neck, watch: Watch, kind: str, search: bool) -> None:
        """Begin.

        Args:
            base: Tells what happens.
            neck: Turns the head.
            watch: Sees.
            kind: What is chased.
            search: Whether the head turns to look for it.
        """
        self._base = base
        self._neck = neck
        self._watch = watch
        self._places = search_angles(kind, neck.ranges) if search else None
        self._last: LocalizedDetection | None = None

    def detections(self, end: float, patience: float) -> Iterator[tuple[LocalizedDetection, bool]]:
        """Each time that it is seen, and whether the head is as far as it can turn.

        Args:
            end: ROS time of the end, s.
            patience: s without being seen after which it ends as well.
        """
        clock = self._base.clock
        status = "looking"
        self._base.tell_seen(status)
        seen, glance = clock.now(), clock.now() + GLANCE
        while clock.now() < min(end, seen + patience):
            detection = self._next(min(end, seen + patience, glance))
            if detection is not None:
                status, seen = "following", clock.now()
                at_limit = self._neck.follow(detection)
                self._base.tell_seen(status, [detection])
                yield detection, at_limit
                glance = seen + LOST
            elif clock.now() >= glance:
                if status == "following":
                    status = "lost"
                    self._base.tell_seen(status)
                glance = math.inf
                if self._places is not None:
                    status = "searching"
                    self._base.tell_seen(status)
                    glance = clock.now() + self._neck.search(next(self._places)) + GLANCE

    def _next(self, end: float) -> LocalizedDetection | None:
        for detections in self._watch.until(end):
            self._last = the_one(detections, self._last)
            return self._last
        return None
