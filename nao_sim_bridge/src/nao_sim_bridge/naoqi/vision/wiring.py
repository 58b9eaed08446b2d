"""The extractors that look through the cameras put together, and those that tell what they see and nothing else."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Mapping, Sequence, Tuple

from nao_sim_bridge.base.imports import imported
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.cameras.settings import CAMERA_NAMES
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.later import Later
from nao_sim_bridge.naoqi.memory.extractor import Extractor
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision import face_detection, movement_detection
from nao_sim_bridge.naoqi.vision.names import (
    BACKLIGHT,
    BACKLIGHT_VALUE,
    BACKLIGHTING,
    COLOR_BLOB,
    COLOR_BLOBS,
    DARK,
    DARKNESS,
    DARKNESS_VALUE,
    PICTURE,
    RECOGNITION,
)
from nao_sim_bridge.naoqi.vision.vision_extractor import Sight, VisionExtractor, in_picture
from nao_sim_bridge.naoqi.vision.watching import QVGA, TOP, Watching
from nao_sim_bridge.vision.client import VisionProcess

if TYPE_CHECKING:
    from nao_sim_bridge.vision.ball import Ball
    from nao_sim_bridge.vision.barcodes import Barcode
    from nao_sim_bridge.vision.landmarks import Landmark

VGA = 2
SHAPE = 1
"""What NAOqi writes in front of the shape of a mark."""


def ball_value(frame: Frame, found: list[Ball]) -> list[Any]:
    """Value of `redBallDetected`, of the ball that looks most like one.

    [[seconds, microseconds], [centre X, centre Y, size X, size Y], pose of the camera in FRAME_TORSO, the same in
    FRAME_ROBOT, index of the camera]; angles in rad from the middle of the picture, X positive to the left and Y
    downwards, sizes are angular radii.
    """
    ball = found[0]
    return in_picture(frame, [ball.alpha, ball.beta, ball.radius, ball.radius], frame.camera)


def landmark_value(frame: Frame, found: list[Landmark]) -> list[Any]:
    """Value of `LandmarkDetected`.

    [[seconds, microseconds], [mark, ...], pose of the camera in FRAME_TORSO, the same in FRAME_ROBOT, name of the
    camera], with a mark as [[1, alpha, beta, size X, size Y, heading], [number]] in rad: middle, width and height of
    its black disc as angles in the picture (alpha positive to the left, beta downwards), heading its turn in the
    picture, counterclockwise.
    """
    marks = [[[SHAPE, m.alpha, m.beta, m.width, m.height, m.heading], [m.number]] for m in found]
    return in_picture(frame, marks, CAMERA_NAMES[frame.camera])


def barcode_value(_frame: Frame, found: list[Barcode]) -> list[Any]:
    """Value of `BarcodeReader/BarcodeDetected`, barcodes and QR codes.

    [[text, [[x, y], [x, y], [x, y], [x, y]]], ...], corners in pixels of the picture, from the upper left one as the
    code is read, clockwise.
    """
    return [[code.text, [list(corner) for corner in code.corners]] for code in found]


@dataclass(frozen=True)
class Detection:
    """An extractor that raises its event with each picture in which its detector finds something."""

    module: str  # NAOqi name
    event: str
    detector: str  # name in the vision process
    value: Callable[[Frame, Any], list[Any]]
    tell_end: bool  # see `Sight`
    fps: int  # pictures a second at the start
    resolution: int = QVGA
    camera: int | None = TOP  # at the start; None: the one that ALVideoDevice has active

    def watching(self, simulation: Simulation, memory: MemoryStore, vision: VisionProcess) -> Watching:
        """Looks for it in the cameras of a robot."""
        sight = Sight(memory, self.event, self.tell_end)

        def on_result(frame: Frame, found: list[Any]) -> None:
            if found:
                sight.show(self.value(frame, found))
            else:
                sight.nothing()

        return Watching(
            simulation.cameras,
            self.module,
            vision.detector(self.detector),
            on_result,
            on_stop=sight.nothing,
            camera=self.camera,
            resolution=self.resolution,
            fps=self.fps,
        )


DETECTIONS = (
    # It has no methods to choose a camera.
    Detection("ALRedBallDetection", "redBallDetected", "ball", ball_value, tell_end=False, fps=30, camera=None),
    Detection("ALLandMarkDetection", "LandmarkDetected", "landmarks", landmark_value, tell_end=True, fps=15),
    # In smaller pictures than VGA the stripes of a barcode cannot be told apart.
    Detection("ALBarcodeReader", "BarcodeReader/BarcodeDetected", "barcodes", barcode_value, False, 10, VGA),
)


@dataclass(frozen=True)
class Rare:
    """An extractor that few ask for, made when it is first called.

    Attributes:
        where: Its class; see `imported`. It is given simulation, memory and vision process, and files `with_files`; it
            has a `watching`, and ends it in `close()`.
    """

    where: str
    events: Tuple[str, ...]
    keys: Tuple[str, ...] = ()
    with_files: bool = False


RARE: Mapping[str, Rare] = {
    COLOR_BLOBS: Rare("naoqi.vision.color_blob_detection:ALColorBlobDetection", (COLOR_BLOB,)),
    DARKNESS: Rare("naoqi.vision.light_detection:ALDarknessDetection", (DARK,), (DARKNESS_VALUE,)),
    BACKLIGHTING: Rare("naoqi.vision.light_detection:ALBacklightingDetection", (BACKLIGHT,), (BACKLIGHT_VALUE,)),
    RECOGNITION: Rare("naoqi.vision.vision_recognition:ALVisionRecognition", (PICTURE,), with_files=True),
}


class VisionModules:
    """The modules that look through the cameras of one robot; their process starts with the first subscriber."""

    def __init__(self, simulation: Simulation, memory: MemoryStore, files: ClientFiles, process: VisionProcess) -> None:
        faces = face_detection.ALFaceDetection(simulation, memory, process, files)
        movement = movement_detection.ALMovementDetection(simulation, memory, process)
        self.people = faces.people
        self._learner = faces.learner
        self._watchings: list[Watching] = []
        self.modules: dict[str, Sequence[Any]] = {}

        def parts(module: str, own: list[Any], watching: Watching, *events_and_keys: Sequence[str]) -> list[Any]:
            work = (watching.start, watching.stop)
            extractor = Extractor(module, memory, *work, *events_and_keys, changed=watching.changed, by_events=True)
            return [*own, VisionExtractor(watching, simulation.cameras.tables), extractor]

        def add(module: str, own: list[Any], watching: Watching, *events_and_keys: Sequence[str]) -> None:
            self.modules[module] = parts(module, own, watching, *events_and_keys)
            self._watchings.append(watching)

        def seldom(module: str, rare: Rare) -> Later:
            def make() -> list[Any]:
                made = imported(rare.where)(simulation, memory, process, *([files] if rare.with_files else []))
                return parts(module, [made], made.watching, rare.events, rare.keys)

            parts_later = Later(make)
            for event in rare.events:
                memory.declare_event(event, module)
                memory.watch_subscribers(event, lambda *_: len(parts_later))  # which makes them, and they see who it is
            return parts_later

        for one in DETECTIONS:
            add(one.module, [], one.watching(simulation, memory, process), [one.event])
        add(face_detection.NAME, [faces], faces.watching, [face_detection.EVENT])
        events, keys = movement_detection.EVENTS, [movement_detection.INFO]
        add(movement_detection.NAME, [movement], movement.watching, events, keys)
        self.modules.update((module, seldom(module, rare)) for module, rare in RARE.items())

    def closing(self) -> list[Callable[[], None]]:
        """Steps after which nothing is looked at any more; blocking."""
        return [self._learner.close, *(watching.stop for watching in self._watchings)]
