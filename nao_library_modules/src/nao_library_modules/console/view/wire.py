"""Frames of the live view on the wire: binary for what comes often, JSON for what seldom changes. Pure.

A binary frame begins with a byte that says what it is, little-endian throughout:

    pose      01  flags u8  count u16  f32 x 3 place (m)  f32 x 4 turn (x, y, z, w)  f64 stamp (s)  f32 x count joints
    lights    02  0         count u16  u8 x 3 x count: red, green, blue
    samples   03  0         count u16  count x (u32 index of the trace, f32 value, f64 stamp)
    picture   04  kind u8   0 u16      u32 0  f64 stamp  the picture as it came: kind 0 JPEG, 1 PNG

Joints and lights are in the order of the last `layout`, a text frame; so are traces in that of the last `traces`.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Iterable, Sequence
from typing import Any, Tuple

POSE_FRAME, LIGHTS_FRAME, SAMPLES_FRAME, PICTURE_FRAME = 1, 2, 3, 4
PLACED = 1
"""Flag of a pose: it is known where the base is; else the robot stands on its feet at the origin."""
JPEG, PNG = 0, 1
HEAD = struct.Struct("<BBH")
BASE = struct.Struct("<7fd")
SAMPLE = struct.Struct("<Ifd")
SHOT = struct.Struct("<BBHId")
Base = Tuple[float, float, float, float, float, float, float]
"""Place in m and turn as a quaternion (x, y, z, w)."""
UNPLACED: Base = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
STAMP_AT = HEAD.size + 28
"""Where the stamp of a pose is: what is the same but for it shows the same."""


def pose_frame(stamp: float, base: Base | None, joints: Sequence[float]) -> bytes:
    """A pose; `base` is None where the robot's place is not known. Joints are in rad, or m."""
    head = HEAD.pack(POSE_FRAME, 0 if base is None else PLACED, len(joints))
    return head + BASE.pack(*(base or UNPLACED), stamp) + struct.pack(f"<{len(joints)}f", *joints)


def same_pose(first: bytes, second: bytes) -> bool:
    """Whether two frames show the same but for their stamps."""
    end = STAMP_AT + 8
    return first[:STAMP_AT] == second[:STAMP_AT] and first[end:] == second[end:]


def lights_frame(colours: Iterable[Sequence[float]]) -> bytes:
    """Colours, each red, green and blue in 0..1."""
    parts = bytes(min(max(round(255 * part), 0), 255) for colour in colours for part in colour)
    return HEAD.pack(LIGHTS_FRAME, 0, len(parts) // 3) + parts


def samples_frame(samples: Sequence[tuple[int, float, float]]) -> bytes:
    """Readings of traces: index of the trace, value, and ROS time in s."""
    return HEAD.pack(SAMPLES_FRAME, 0, len(samples)) + b"".join(SAMPLE.pack(*sample) for sample in samples)


def picture_frame(stamp: float, picture: bytes, png: bool = False) -> bytes:
    """A compressed picture as it came, and when it was taken, ROS time in s."""
    return SHOT.pack(PICTURE_FRAME, PNG if png else JPEG, 0, 0, stamp) + picture


def text_frame(kind: str, **values: Any) -> str:
    """Something that seldom changes: an object of JSON with a `kind`."""
    return json.dumps({"kind": kind, **values}, ensure_ascii=False)
