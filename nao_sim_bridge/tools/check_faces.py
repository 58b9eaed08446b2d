#!/usr/bin/env python3
"""Measures how well the robot finds and recognises faces, and prints each figure beside its bound.

Cards and people stand at chosen distances in the lab world and are drawn and developed as for the robot's cameras; the
detector gets the pictures and nothing else. The exit status is 1 when a figure misses its bound. Needs no ROS master.
Parts can be chosen by name:

  found    cards and people by distance and by how far they are turned away
  names    six people are learnt from a metre away; who is called what, from other distances and in other light
  lab      a camera that looks around in the lab: no face
"""

from __future__ import annotations

import math
import sys
import time
from typing import Mapping, Sequence

import numpy as np
from camera_stage import AHEAD, EYES, VGA, Stage, Viewpoint, thing
from command_line import parse
from measurement import StageChecks, stage_parser

from nao_sim_bridge.vision.face_memory import FaceMemory
from nao_sim_bridge.vision.faces import FaceDetector, FaceSettings, SeenFace
from nao_sim_bridge.world.painting.known_faces import load_faces
from nao_sim_bridge.world.world import WorldObject

DISTANCES = (0.5, 0.75, 1.0, 1.5, 2.0)
TURNS = (0.0, 0.13, 0.26)
PEOPLE = tuple(load_faces())
KNOWN, THRESHOLD = 6, 0.4
LIGHTS: Mapping[str, Mapping[int, int]] = {
    "as it is": {},
    "dark": {0: -60},
    "bright": {0: 60},
    "no white balance": {12: 0},
}
FOUND, NAMED = 0.95, 0.8
"""Shares of cards that have to be found and, unless it is too dark to see much, to be called by name; nobody may be
called by another's name."""


class Checks(StageChecks):
    def __init__(self, stage: Stage, count: int, frames: int) -> None:
        super().__init__(stage, count, frames, seed=1)
        self._detector = FaceDetector()
        self._times: list[float] = []

    def found(self) -> None:
        """Share of faces that are found, and that of one picture in which there is more than one."""
        for kind in ("face", "person"):
            for distance in DISTANCES:
                for turn in TURNS:
                    counts = [
                        len(self._look(kind, name, distance, side * turn))
                        for name in PEOPLE
                        for side in self._sides(turn)
                    ]
                    share, more = np.mean([count > 0 for count in counts]), sum(count > 1 for count in counts)
                    good = None if kind == "person" else share >= FOUND and not more
                    self._tell(f"{kind} at {distance} m, turned {turn} rad", f"found {share:.2f}, more {more}", good)
        print(f"{1000 * np.median(self._times):.1f} ms of a processor for a whole VGA picture")

    def names(self) -> None:
        """Right, wrong and no names."""
        for kind in ("face", "person"):
            memory = FaceMemory()
            for name in PEOPLE[:KNOWN]:
                views = [face.description for _ in range(5) for face in self._look(kind, name, 1.0, 0.0)[:1]]
                if views:
                    total = np.sum(views, axis=0)
                    memory.learn(name, total / np.linalg.norm(total))
            for light, parameters in LIGHTS.items():
                for distance in DISTANCES:
                    for turn in TURNS[:2]:
                        self._call(memory, kind, light, parameters, distance, turn)

    def lab(self) -> None:
        """No faces where there are none."""
        wrong = 0
        for number in range(self._frames):
            image = self._stage.picture(self._anywhere(), size=VGA, seed=number)
            wrong += len(self._detect(image))
        self._tell("the lab", f"{wrong} faces in {self._frames} pictures", wrong == 0)

    def _call(
        self, memory: FaceMemory, kind: str, light: str, parameters: Mapping[int, int], distance: float, turn: float
    ) -> None:
        right = wrong = unknown = strangers = 0
        for name in PEOPLE:
            for side in self._sides(turn):
                for face in self._look(kind, name, distance, side * turn, parameters)[:1]:
                    guess, score = memory.recognise(face.description)
                    guess = guess if score >= THRESHOLD else ""
                    right += guess == name
                    wrong += guess not in ("", name)
                    unknown += not guess and name in PEOPLE[:KNOWN]
                    strangers += not guess and name not in PEOPLE[:KNOWN]
        share = right / max(1, right + wrong + unknown)
        bounded = kind == "face" and not turn and light != "dark"
        good = share >= NAMED and not wrong if bounded else None
        text = f"right {right}, wrong {wrong}, not known {unknown}, strangers who stay so {strangers}"
        self._tell(f"{kind}, {light}, {distance} m, turned {turn} rad", text, good)

    def _look(
        self, kind: str, name: str, distance: float, turn: float, parameters: Mapping[int, int] | None = None
    ) -> list[SeenFace]:
        """What is found in a picture of somebody."""
        view = Viewpoint(EYES, AHEAD + self._random.uniform(-0.2, 0.2), self._random.uniform(-0.1, 0.1))
        shown, view = self._somebody(kind, name, distance, turn, view)
        return self._detect(self._stage.picture(view, [shown], VGA, self._seed(), parameters))

    def _somebody(
        self, kind: str, name: str, distance: float, turn: float, view: Viewpoint
    ) -> tuple[WorldObject, Viewpoint]:
        heading = AHEAD + math.pi + turn
        if kind == "face":
            return thing("shown", (EYES[0], EYES[1] + distance, EYES[2] + 0.02), face=name, heading=heading), view
        # Somebody as tall as a child; the camera looks up at the face.
        height = 1.0
        up = math.atan2(0.92 * height - EYES[2], distance)
        view = Viewpoint(EYES, view.heading, -up)
        ahead = distance * math.cos(up)
        return thing("shown", (EYES[0], EYES[1] + ahead, 0.0), person=name, height=height, heading=heading), view

    def _detect(self, image: np.ndarray) -> list[SeenFace]:
        began = time.process_time()
        found = self._detector.detect(image, self._stage.optics, FaceSettings(0.0, track=False))
        self._times.append(time.process_time() - began)
        return found

    def _sides(self, turn: float) -> Sequence[int]:
        return [1 if number % 2 else -1 for number in range(max(1, self._count // len(PEOPLE)))] if turn else [1, 1]


PARTS = ("found", "names", "lab")


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure."""
    chosen = parse(stage_parser(__doc__ or "", PARTS, count=16), PARTS, arguments, count=1, frames=1)
    with Stage("lab", chosen.engine) as stage:
        return Checks(stage, chosen.count, chosen.frames).measure(chosen.parts)


if __name__ == "__main__":
    sys.exit(main())
