#!/usr/bin/env python3
"""Draws all animations of a NAO into one picture: the robot from the front at the height of each.

Coloured lines are the ways of its left (blue) and right (red) hand. Needs no ROS master and no physics, but OpenCV
(the extra `[vision]`). Without an argument the picture is docs/images/animations.png.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

import cv2
import numpy as np

from nao_sim_bridge.model.kinematics import link_transforms
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.speech.animations import load_animations
from nao_sim_bridge.speech.gesture import Animation
from nao_sim_bridge.speech.gesture_families import names

PICTURE = Path(__file__).resolve().parents[2] / "docs" / "images" / "animations.png"
COLUMNS, CELL, TITLE = 28, (62, 72), 14
# Columns that the title of a folder needs.
WIDTH = 3
# Height of a line of cells with title and captions.
LINE = CELL[1] + TITLE + 9
# Pixels a metre; where the torso is in its cell; how much of what is nearer is drawn lower.
SCALE, CENTRE, NEARER = 105.0, (31, 40), 0.3
# The picture is drawn so much larger and made smaller in the end: thin lines stay smooth.
LARGER = 2
STEP = 0.06
HAND = np.array([0.05775, 0.0, -0.01231, 1.0])
LIMBS = (
    ("LShoulderPitch", "LElbowYaw", "LWristYaw", "LHand"),
    ("RShoulderPitch", "RElbowYaw", "RWristYaw", "RHand"),
    ("LHipPitch", "LKneePitch", "LAnklePitch"),
    ("RHipPitch", "RKneePitch", "RAnklePitch"),
    ("LShoulderPitch", "RShoulderPitch", "RHipPitch", "LHipPitch", "LShoulderPitch"),
)
SHORT = {"Center_": "", "Neutral_": "", "Left_": "L ", "Right_": "R ", "_": " "}
INK, PALE, LEFT_WAY, RIGHT_WAY = (60, 60, 60), (110, 110, 110), (225, 135, 60), (70, 70, 225)


def poses_of(animation: Animation) -> list[dict[str, np.ndarray]]:
    """Frames of the links every `STEP` s of an animation, (4, 4) by name, in the torso; hands have theirs."""
    model, home = load_model(), np.array(posture(load_model(), "Sit" if "/Sit/" in animation.name else "Stand"))
    found = []
    index = model.joint_index
    curves = {index[j]: animation.curve(j, home[index[j]], home[index[j]], 1.0) for j in animation.joints}
    for time in np.arange(0.0, animation.length, STEP):
        angles = home.copy()
        for i, curve in curves.items():
            angles[i] = curve.value(time)
        links = link_transforms(model, angles)
        pose = {name: links[name] for limb in LIMBS for name in limb if not name.endswith("Hand")}
        for side in "LR":
            hand = links[f"{side}WristYaw"].copy()
            hand[:3, 3] = (hand @ HAND)[:3]
            pose[f"{side}Hand"] = hand
        pose["Head"] = links["HeadPitch"]
        found.append(pose)
    return found


def height_of(poses: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """The moment at which the hands, or else the head, are farthest from where they began."""
    first = poses[0]

    def distance(pose: dict[str, np.ndarray]) -> float:
        hands = sum(float(np.linalg.norm(pose[h][:3, 3] - first[h][:3, 3])) for h in ("LHand", "RHand"))
        return hands + 0.05 * float(np.linalg.norm(pose["Head"][:3, 0] - first["Head"][:3, 0]))

    return max(poses, key=distance)


class Sheet:
    """The picture while it is drawn; places in pixels of its final size."""

    def __init__(self, size: tuple[int, int]) -> None:
        self._size = size
        self._image = np.full((size[1] * LARGER, size[0] * LARGER, 3), 255, np.uint8)

    def robot(self, corner: tuple[int, int], animation: Animation) -> None:
        poses = poses_of(animation)
        for hand, color in (("LHand", LEFT_WAY), ("RHand", RIGHT_WAY)):
            self._line(corner, [pose[hand][:3, 3] for pose in poses], color, 1)
        shown = height_of(poses)
        for limb in LIMBS:
            self._line(corner, [shown[name][:3, 3] for name in limb], INK, 2)
        for hand, color in (("LHand", LEFT_WAY), ("RHand", RIGHT_WAY)):
            self._disc(corner, shown[hand][:3, 3], 2, color)
        head = (shown["Head"] @ (0.0, 0.0, 0.05, 1.0))[:3]
        self._disc(corner, head, 6, INK)
        self._disc(corner, (shown["Head"] @ (0.055, 0.0, 0.05, 1.0))[:3], 3, (235, 235, 235))

    def text(self, place: tuple[int, int], words: str, size: float, color: tuple[int, int, int]) -> None:
        at = (place[0] * LARGER, place[1] * LARGER)
        cv2.putText(self._image, words, at, cv2.FONT_HERSHEY_SIMPLEX, size * LARGER, color, 1, cv2.LINE_AA)

    def save(self, path: Path) -> None:
        image = cv2.resize(self._image, self._size, interpolation=cv2.INTER_AREA)
        gray = (image // 17) * 17  # few colours make a small file
        cv2.imwrite(str(path), gray, [cv2.IMWRITE_PNG_COMPRESSION, 9])

    def _pixel(self, corner: tuple[int, int], place: np.ndarray) -> tuple[int, int]:
        x, y, z = place
        right = corner[0] + CENTRE[0] + SCALE * y
        down = corner[1] + CENTRE[1] - SCALE * (z - NEARER * x)
        return round(right * LARGER), round(down * LARGER)

    def _line(self, corner: tuple[int, int], places: list[np.ndarray], color: tuple[int, int, int], width: int) -> None:
        points = np.array([self._pixel(corner, place) for place in places])
        cv2.polylines(self._image, [points], False, color, width, cv2.LINE_AA)

    def _disc(self, corner: tuple[int, int], place: np.ndarray, radius: int, color: tuple[int, int, int]) -> None:
        cv2.circle(self._image, self._pixel(corner, place), radius * LARGER, color, -1, cv2.LINE_AA)


@dataclass(frozen=True)
class Section:
    """The animations of a folder: where their title and the first of them stand, in cells and lines of cells."""

    folder: str
    names: list[str]
    line: int
    column: int

    def corner(self, number: int) -> tuple[int, int]:
        """Upper left corner of an animation's cell, pixels; below the title that each line of cells has room for."""
        lines, column = divmod(self.column + number, COLUMNS)
        return column * CELL[0], (self.line + lines) * LINE + TITLE


def layout() -> tuple[list[Section], int]:
    """All folders in lines of cells, short ones beside each other, and how many lines that makes."""
    sections: list[Section] = []
    line = column = 0
    for folder, each in groupby(sorted(names()), lambda name: name.rsplit("/", 1)[0]):
        members = list(each)
        if column and column + max(len(members), WIDTH) > COLUMNS:
            line, column = line + 1, 0
        sections.append(Section(folder, members, line, column))
        lines, end = divmod(column + len(members), COLUMNS)
        line, column = line + lines, max(end + 1, 0 if lines else column + WIDTH) if end else 0
    return sections, line + bool(column)


def draw(path: Path) -> None:
    library, (sections, lines) = load_animations(), layout()
    sheet = Sheet((COLUMNS * CELL[0], lines * LINE))
    for section in sections:
        x, y = section.corner(0)
        sheet.text((x + 3, y - 3), section.folder.split("/", 1)[1], 0.36, INK)
        for number, name in enumerate(section.names):
            x, y = section.corner(number)
            sheet.robot((x, y), library.get(name))
            label = name.rsplit("/", 1)[1]
            for long, short in SHORT.items():
                label = label.replace(long, short)
            sheet.text((x + 2, y + CELL[1] + 6), label, 0.25, PALE)
    sheet.save(path)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", nargs="?", type=Path, default=PICTURE, help="default: that of the documents")
    draw(parser.parse_args().picture)
