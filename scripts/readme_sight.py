"""What the simulated robot sees in the gallery, with what it recognises drawn into its picture."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Iterator

import qi
from PIL import Image, ImageDraw, ImageFont

from nao_sim_bridge.core.simulation import Scene
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.simulator_server import SimulatorServer

TOP, VGA, RGB, RATE = 0, 2, 11, 15
NAME = "readme"
COLOR = (255, 210, 0)
LIMIT = 60.0
# Until everything in view has been recognised several times, s of simulated time.
LOOKING = 2.0


def draw_sight(path: Path) -> None:
    """Take a picture with the top camera and mark faces, landmarks and codes as NAOqi's events tell them."""
    server = SimulatorServer(ServerOptions(Scene(world="gallery", posture="Stand"), port=0, speed=math.inf))
    server.start()
    session = qi.Session()
    try:
        session.connect(f"tcp://127.0.0.1:{server.broker.port}")
        session.service("ALMotion").wakeUp()
        memory = session.service("ALMemory")
        extractors = [session.service(f"AL{name}") for name in ("FaceDetection", "LandMarkDetection", "BarcodeReader")]
        for extractor in extractors:
            extractor.setResolution(VGA)
            extractor.subscribe(NAME)
        server.runner.advance(LOOKING).result(LIMIT)
        video = session.service("ALVideoDevice")
        handle = video.subscribeCamera(NAME, TOP, VGA, RGB, RATE)
        width, height, _, _, _, _, pixels = video.getImageRemote(handle)[:7]
        marks = [*_by_angles(video, memory, width, height), *_codes(memory)]
        for extractor in extractors:
            extractor.unsubscribe(NAME)
    finally:
        session.close()
        server.stop()
    picture = Image.frombytes("RGB", (width, height), bytes(pixels))
    pen, font = ImageDraw.Draw(picture), ImageFont.load_default(18)
    for text, (left, top, right, bottom) in marks:
        pen.rectangle([left, top, right, bottom], outline=COLOR, width=3)
        pen.text(
            ((left + right) / 2.0, bottom + 4), text, COLOR, font, anchor="ma", stroke_width=2, stroke_fill=(0, 0, 0)
        )
    picture.quantize(112, dither=Image.Dither.NONE).save(path, optimize=True)  # a third of the size


def _by_angles(video: Any, memory: Any, width: int, height: int) -> Iterator[tuple[str, tuple[float, ...]]]:
    """Faces and landmarks: the events tell angles of the camera."""
    shapes = [("face", shape) for (_, *shape), _ in _told(memory, "FaceDetected")]
    shapes += [(f"landmark {number}", shape[:4]) for (_, *shape), (number,) in _told(memory, "LandmarkDetected")]
    for text, (alpha, beta, across, down) in shapes:
        x, y = video.getImagePositionFromAngularPosition(TOP, [alpha, beta])
        w, h = video.getImageSizeFromAngularSize(TOP, [across, down])
        yield text, ((x - w / 2) * width, (y - h / 2) * height, (x + w / 2) * width, (y + h / 2) * height)


def _told(memory: Any, event: str) -> list[Any]:
    """What an event says of each thing; that of faces has one entry more at the end."""
    value = memory.getData(event)
    found = value[1] if value else []
    return found[:-1] if event == "FaceDetected" else found


def _codes(memory: Any) -> Iterator[tuple[str, tuple[float, ...]]]:
    for text, corners in memory.getData("BarcodeReader/BarcodeDetected") or []:
        xs, ys = zip(*corners)
        yield text, (min(xs), min(ys), max(xs), max(ys))
