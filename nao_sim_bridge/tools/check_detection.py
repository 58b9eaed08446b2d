#!/usr/bin/env python3
"""Measures how well the robot recognises things in its pictures, and prints each figure beside its bound.

Things stand at chosen distances in the lab world and are drawn and developed as for the robot's cameras; the detectors
get the pictures and nothing else. The exit status is 1 when a figure misses its bound. Needs no ROS master. Parts can
be chosen by name:

  ball       red balls of 3 and 5 cm radius on the floor, also with half of them behind the edge of the picture
  light      the same in dim and in bright light and with the camera's settings changed
  landmarks  landmarks of 9 cm, facing the camera and slanted, in any rotation
  red        boxes, cups and capsules as red as the ball: how often one is taken for it (no bound)
  codes      QR codes of 15 cm and barcodes of 20 cm (no bound)
  lab        a camera that looks around in the lab: no ball but its own, no mark, no code
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Mapping, Sequence

import cv2
import numpy as np
from camera_stage import AHEAD, EYES, QVGA, VGA, Stage, Viewpoint, thing
from command_line import parse
from measurement import StageChecks, stage_parser

from nao_sim_bridge.vision.ball import BallDetector
from nao_sim_bridge.vision.barcodes import BarcodeDetector
from nao_sim_bridge.vision.landmarks import LandmarkDetector
from nao_sim_bridge.world.cards import THICKNESS
from nao_sim_bridge.world.objects import BALL_RED
from nao_sim_bridge.world.painting.known_landmarks import load_landmarks

FREE = (-1.3, 0.6)
"""There is floor ahead between these X, m: further out are a wall and a chair."""
FRONT = THICKNESS / 2.0
BALL_DISTANCES = (0.3, 0.5, 0.75, 1.0, 1.5, 2.0)
BALL_RADII = (0.03, 0.05)
BEARING = 2.0
"""Most a bearing may be off, degrees."""
MARK_DISTANCES = (0.4, 0.7, 1.0, 1.25, 1.5)
MARK_TILTS = (0, 20, 40)
CODE_DISTANCES = (0.3, 0.5, 0.75, 1.0, 1.5, 2.0)
# Camera settings: name -> values by NAOqi's id.
LIGHTS: Mapping[str, Mapping[int, int]] = {
    "as it is": {},
    "dark (-60)": {0: -60},
    "bright (+60)": {0: 60},
    "short exposure": {11: 0, 17: 16},
    "long exposure": {11: 0, 17: 64},
    "high gain": {11: 0, 6: 100},
    "little contrast": {1: 20},
    "much contrast": {1: 48},
    "pale (40)": {2: 40},
    "gaudy (100)": {2: 100},
    "no white balance": {12: 0},
}
MOST_OF = 0.98
"""Share that has to be found within the bounds of distance."""


@dataclass
class Tally:
    """What came of many pictures of a kind: `wanted` of them, in `found` of them the thing was found.

    Attributes:
        wrong: Findings that were something else.
        bearings: By how much bearings were off, degrees.
        distances: By how much distances were off, as shares.
        times: Processor time of a picture, s.
    """

    wanted: int = 0
    found: int = 0
    wrong: int = 0
    bearings: list[float] = field(default_factory=list)
    distances: list[float] = field(default_factory=list)
    times: list[float] = field(default_factory=list)

    def text(self) -> str:
        parts = [f"found {self.found:3d} of {self.wanted:3d}", f"wrong {self.wrong}"]
        if self.bearings:
            parts.append(f"bearing off {np.mean(self.bearings):.2f} mean, {max(self.bearings):.2f} most, deg")
        if self.distances:
            mean, most = 100 * np.mean(self.distances), 100 * max(self.distances)
            parts.append(f"distance off {mean:.1f} mean, {most:.1f} most, %")
        parts.append(f"{1000 * np.mean(self.times):.1f} ms")
        return ", ".join(parts)


class Checks(StageChecks):
    """All measurements; `folder` gets pictures in which not everything is as it should be, unless it is None."""

    def __init__(self, stage: Stage, count: int, frames: int, seed: int, folder: Path | None = None) -> None:
        super().__init__(stage, count, frames, seed)
        self._folder = folder
        self._kept = 0
        self._ball, self._marks, self._codes = BallDetector(), LandmarkDetector(), BarcodeDetector()

    def ball(self) -> None:
        """Balls by radius and distance."""
        for radius in BALL_RADII:
            for distance in BALL_DISTANCES:
                tally = Tally()
                for _ in range(self._count):
                    self._one_ball(tally, radius, distance, {})
                self._judge(f"ball of {100 * radius:.0f} cm at {distance:.2f} m", tally)
            tally = Tally()
            for _ in range(self._count):
                self._one_ball(tally, radius, self._random.uniform(0.4, 1.5), {}, cut=True)
            self._judge(f"ball of {100 * radius:.0f} cm cut by the edge", tally)

    def light(self) -> None:
        """Balls and marks in other light."""
        for name, parameters in LIGHTS.items():
            tally, marks = Tally(), Tally()
            for _ in range(self._count):
                self._one_ball(tally, 0.03, self._random.uniform(0.3, 2.0), parameters)
                self._one_mark(marks, self._random.uniform(0.4, 1.5), self._random.uniform(0.0, 40.0), parameters)
            self._judge(f"ball, {name}", tally)
            self._judge(f"landmark, {name}", marks)

    def landmarks(self) -> None:
        """Marks by distance and tilt."""
        for distance in MARK_DISTANCES:
            for tilt in MARK_TILTS:
                tally = Tally()
                for _ in range(self._count):
                    self._one_mark(tally, distance, tilt, {})
                self._judge(f"landmark at {distance:.2f} m, tilt {tilt:2d} deg", tally)

    def red(self) -> None:
        """Red things that are no balls."""
        draw = self._random.uniform
        kinds = {
            "cubes": lambda: {"box": [float(draw(0.04, 0.12))] * 3},
            "boxes": lambda: {"box": draw(0.03, 0.15, 3).tolist()},
            "cups": lambda: {"cylinder": [float(draw(0.025, 0.05)), float(draw(0.04, 0.12))]},
            "capsules": lambda: {"capsule": [float(draw(0.02, 0.05)), float(draw(0.03, 0.1))]},
        }
        for name, shape in kinds.items():
            tally = Tally()
            for _ in range(self._count):
                distance, alpha, beta = draw(0.4, 2.0), draw(-0.3, 0.3), draw(-0.2, 0.2)
                view = self._view(distance, alpha, beta, draw(0.0, 0.3), lowest=0.1)
                place, rpy = view.at(distance, alpha, beta), draw(-0.6, 0.6, 3).tolist()
                red = thing("target", place, color=list(BALL_RED), rpy=rpy, **shape())
                image = self._stage.picture(view, [red], QVGA, self._seed(), gone=["ball"])
                found = self._timed(tally, self._ball, image)
                tally.wrong += bool(found)
                if found:
                    self._keep(image, f"{name} at {distance:.2f} m: {found}")
            self._judge(f"ball: {self._count} red {name}", tally, bounded=False)

    def codes(self) -> None:
        """Codes by kind and distance."""
        for size in (QVGA, VGA):
            for kind, content in (("qr", "nao_library"), ("barcode", "4006381333931")):
                for distance in CODE_DISTANCES:
                    tally = Tally()
                    for _ in range(self._count):
                        self._one_code(tally, kind, content, distance, size)
                    self._judge(f"{kind} at {distance:.2f} m, {size[0]}x{size[1]}", tally, bounded=False)

    def lab(self) -> None:
        """Nothing where there is nothing."""
        tallies = {name: Tally() for name in ("ball", "landmark", "code")}
        own = thing("ball", (0.30, -0.55, 0.05), ball=0.05)
        for number in range(self._frames):
            view = self._anywhere()
            image = self._stage.picture(view, size=VGA if number % 4 == 0 else QVGA, seed=number)
            alpha, beta = view.direction_of(own.position)
            for name, detector in zip(tallies, (self._ball, self._marks, self._codes)):
                tally = tallies[name]
                found = self._timed(tally, detector, image)
                if name == "ball":
                    found = [b for b in found if math.hypot(b.alpha - alpha, b.beta - beta) > math.radians(BEARING)]
                tally.wrong += len(found)
                if found:
                    self._keep(image, f"{name} in the lab: {found}")
        for name, tally in tallies.items():
            self._judge(f"{name}: false ones in {self._frames} pictures of the lab", tally)

    # --- one picture ----------------------------------------------------------------------------------------------

    def _one_ball(
        self, tally: Tally, radius: float, distance: float, parameters: Mapping[int, int], cut: bool = False
    ) -> None:
        """A ball on the floor, or in somebody's hand where it would be too near for that."""
        angle = math.asin(radius / distance)
        sideways, down = (0.5 * field - angle for field in self._stage.optics.fov)
        alpha, beta = self._random.uniform(-sideways, sideways), self._random.uniform(-down, down)
        if cut:  # its centre is at the edge or within: at least half of it is to be seen
            alpha = self._random.choice((-1, 1)) * (sideways + angle * self._random.uniform(0.2, 0.95))
        drop = EYES[2] - radius
        pitch = math.asin(min(0.95, drop / distance)) - beta if distance > drop else self._random.uniform(-0.2, 0.5)
        view = self._view(distance, alpha, beta, pitch)
        ball = thing("target", view.at(distance, alpha, beta), ball=radius)
        image = self._stage.picture(view, [ball], QVGA, self._seed(), parameters, gone=["ball"])
        found = self._timed(tally, self._ball, image)
        tally.wanted += 1
        near = [b for b in found if math.hypot(b.alpha - alpha, b.beta - beta) < math.radians(3 * BEARING)]
        tally.wrong += len(found) - len(near)
        if not near or len(found) > 1:
            self._keep(image, f"ball of {100 * radius:.0f} cm at {distance:.2f} m, {alpha:.2f} {beta:.2f}: {found}")
        if near:
            tally.found += 1
            off = math.hypot(near[0].alpha - alpha, near[0].beta - beta)
            tally.bearings.append(math.degrees(off))
            tally.distances.append(abs(near[0].distance(radius) / distance - 1.0))

    def _one_mark(self, tally: Tally, distance: float, tilt: float, parameters: Mapping[int, int]) -> None:
        number = int(self._random.choice(list(load_landmarks().marks)))
        alpha, beta = self._random.uniform(-0.35, 0.35), self._random.uniform(-0.25, 0.25)
        view = self._view(distance, alpha, beta, self._random.uniform(0.0, 0.2), lowest=0.1)
        place = view.at(distance, alpha, beta)
        facing = math.atan2(*(view.position - place)[1::-1])
        side, aside = self._random.choice((-1, 1)), self._random.random() < 0.5
        roll = self._random.uniform(-math.pi, math.pi)
        level = math.asin((view.position - place)[2] / distance)
        pitch, yaw = (-level, facing + side * math.radians(tilt)) if aside else (side * math.radians(tilt), facing)
        # What is printed on a card is on its front.
        behind = FRONT * np.array((math.cos(pitch) * math.cos(yaw), math.cos(pitch) * math.sin(yaw), -math.sin(pitch)))
        mark = thing("target", place - behind, landmark=number, rpy=[roll, pitch, yaw])
        image = self._stage.picture(view, [mark], QVGA, self._seed(), parameters)
        found = self._timed(tally, self._marks, image)
        tally.wanted += 1
        right = [m for m in found if m.number == number]
        tally.wrong += len(found) - len(right)
        if len(found) != 1 or not right:
            self._keep(image, f"mark {number} at {distance:.2f} m, tilt {tilt:.0f} deg: {found}")
        if right:
            tally.found += 1
            tally.bearings.append(math.degrees(math.hypot(right[0].alpha - alpha, right[0].beta - beta)))
            measured = load_landmarks().diameter / 2.0 / math.tan(right[0].size / 2.0)
            tally.distances.append(abs(measured / distance - 1.0))

    def _one_code(self, tally: Tally, kind: str, content: str, distance: float, size: tuple[int, int]) -> None:
        alpha, beta = self._random.uniform(-0.2, 0.2), self._random.uniform(-0.1, 0.1)
        view = Viewpoint(EYES, AHEAD, 0.1)
        tilt = self._random.uniform(-0.5, 0.5)
        code = thing("target", view.at(distance, alpha, beta), **{kind: content}, heading=AHEAD + math.pi + tilt)
        image = self._stage.picture(view, [code], size, self._seed())
        found = self._timed(tally, self._codes, image)
        tally.wanted += 1
        right = [c for c in found if c.text == content]
        tally.wrong += len(found) - len(right)
        if right:
            tally.found += 1
            x, y = np.mean(right[0].corners, axis=0) / size
            seen = self._stage.optics.angles(x, y)
            tally.bearings.append(math.degrees(math.hypot(seen[0] - alpha, seen[1] - beta)))

    def _view(self, distance: float, alpha: float, beta: float, pitch: float, lowest: float = -1.0) -> Viewpoint:
        """From `EYES`, turned so that what is in this direction is over the free floor, at `lowest` m or higher."""
        while True:
            view = Viewpoint(EYES, AHEAD + self._random.uniform(-0.7, 0.7), pitch)
            x, _, height = view.at(distance, alpha, beta)
            if FREE[0] < x < FREE[1] and height > lowest:
                return view
            pitch -= 0.02 if height <= lowest else 0.0

    # --- inside ---------------------------------------------------------------------------------------------------

    def _timed(self, tally: Tally, detector: object, image: np.ndarray) -> list:
        began = time.process_time()
        found = detector.detect(image, self._stage.optics, None)
        tally.times.append(time.process_time() - began)
        return found

    def _keep(self, image: np.ndarray, what: str) -> None:
        """Write a picture in which not everything was as it should be."""
        if self._folder is not None:
            self._kept += 1
            path = self._folder / f"{self._kept:03d}.png"
            cv2.imwrite(str(path), image)
            print(f"  {path.name}: {what}")

    def _judge(self, what: str, tally: Tally, bounded: bool = True) -> None:
        good = tally.wrong == 0 and tally.found >= MOST_OF * tally.wanted
        good = good and max(tally.bearings, default=0.0) <= BEARING
        self._tell(what, tally.text(), good if bounded else None)


PARTS = ("ball", "light", "landmarks", "red", "codes", "lab")


def options(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """The command line."""
    parser = stage_parser(__doc__ or "", PARTS, count=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--keep", type=Path, metavar="FOLDER", help="write pictures there that are not as they should be"
    )
    chosen = parse(parser, PARTS, arguments, count=1, frames=1)
    if chosen.keep is not None and not chosen.keep.is_dir():
        parser.error(f"--keep is {chosen.keep}, which is no folder")
    return chosen


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure."""
    chosen = options(arguments)
    with Stage("lab", chosen.engine) as stage:
        return Checks(stage, chosen.count, chosen.frames, chosen.seed, chosen.keep).measure(chosen.parts)


if __name__ == "__main__":
    sys.exit(main())
