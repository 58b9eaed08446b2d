"""The robot's cameras for functions that see: fields of view, poses, and which one an extractor looks through."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from naoqi.errors import NaoError, UnknownMethod

from ...motion.facts import MOTION
from ...nao.camera_facts import CAMERA_NAMES
from ...server.extractor_use import ExtractorUse
from ..capture.cameras import CAMERAS, VIDEO
from .events import Detection, Lens, Pose, Region

TORSO, ROBOT = 0, 2
"""NAOqi's FRAME_TORSO and FRAME_ROBOT."""


class InUse(NaoError):
    """An extractor works for others, and what a function needs would disturb them.

    Attributes:
        module: NAOqi module.
        others: Who it works for.
    """

    def __init__(self, module: str, others: Sequence[str], how: str) -> None:
        """Compose the text.

        Args:
            module: NAOqi module.
            others: Who it works for.
            how: What it does for them that would have to change.
        """
        super().__init__(f"{module} {how} for {', '.join(others)}: it cannot be changed while they need it")
        self.module = module
        self.others = list(others)


class CameraAccess(ExtractorUse):
    """To be mixed into NaoBasic.

    Attributes:
        active_camera: The camera that functions use where a message names none: top or bottom.
    """

    active_camera: str
    _lenses: dict[tuple[int, int], Lens] | None = None

    @contextmanager
    def looking_through(self, module: str, wanted: int | None) -> Iterator[int]:
        """Have an extractor look through a camera during a block; who had it look through another gets that back."""
        owner = module
        try:
            now = int(self.call(self.robot.proxy(module), "getActiveCamera"))
        except UnknownMethod:  # it looks through the robot's active camera
            owner = VIDEO
            now = int(self.call(self.robot.proxy(VIDEO), "getActiveCamera"))
        camera = CAMERAS[self.active_camera] if wanted is None else wanted
        if camera == now:
            yield now
            return
        others = self.others_of(module)
        if others:
            if wanted is None:
                yield now
                return
            raise InUse(module, others, f"looks through {CAMERA_NAMES[now]}")
        if self.begin(owner, "setActiveCamera", [camera], "setActiveCamera", now) is False:
            raise NaoError(f"{owner} cannot look through {CAMERA_NAMES[camera]}")
        proxy = self.robot.proxy(owner)
        with self.ended_by(lambda: self.call_now(proxy, "setActiveCamera", now), f"{owner} keeps its camera"):
            yield camera

    def others_of(self, module: str) -> list[str]:
        """Who else has an extractor work."""
        subscribers = self.call(self.robot.proxy(module), "getSubscribersInfo")
        return [name for name, *_ in subscribers if not name.startswith(self.subscriber_for(""))]

    def camera_pose(self, camera: int, frame: int) -> Pose:
        """Where a camera is now, in one of NAOqi's frames."""
        position = self.call(self.robot.proxy(MOTION), "getPosition", CAMERA_NAMES[camera], frame, True)
        x, y, z, wx, wy, wz = map(float, position)
        return x, y, z, wx, wy, wz

    def lens(self, camera: int) -> Lens:
        """Field of view of a camera."""
        if self._lenses is None:
            self._lenses = {}
        key = (self.robot.connection.generation, camera)  # behind a new connection is another robot perhaps
        if key not in self._lenses:
            proxy = self.robot.proxy(VIDEO)
            methods = ("getHorizontalFOV", "getVerticalFOV")
            self._lenses[key] = Lens(*(float(self.call(proxy, method, camera)) for method in methods))
        return self._lenses[key]

    def region(self, camera: int, detection: Detection) -> Region:
        """Where a detection is in the picture, as the robot itself has it: angles of others are not all geometry's."""
        angles = [detection.alpha, detection.beta, detection.size_x, detection.size_y]
        numbers = self.call(self.robot.proxy(VIDEO), "getImageInfoFromAngularInfo", camera, angles)
        return Region(*map(float, numbers))
