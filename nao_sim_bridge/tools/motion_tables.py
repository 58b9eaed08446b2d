"""Key points of the motions that come with the library, but for the dance; see `choreography.py`.

Those of arms and head begin and end in the posture Stand, those of the whole body in StandInit.
"""

from __future__ import annotations

from choreography import Keys, Table

STAND_HEAD = -0.17
STAND_ARM = {"ShoulderPitch": 1.4426, "ShoulderRoll": 0.2245, "ElbowYaw": -1.2023, "ElbowRoll": -0.4173, "Hand": 0.3}
INIT_ARM = {
    "ShoulderPitch": 1.4,
    "ShoulderRoll": 0.3,
    "ElbowYaw": -1.39,
    "ElbowRoll": -1.01,
    "WristYaw": 0.0,
    "Hand": 0.25,
}
"""Of the left arm; the right one mirrors it."""
MIRRORED = ("ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw")
HEIGHT = 0.3204
"""m, of the torso in StandInit."""
UPRIGHT = 0.1
"""rad, pitch of the torso in StandInit."""


def arms(
    times: list[float], base: dict[str, float], left: dict[str, list[float]], right: dict[str, list[float]]
) -> Table:
    """Channels of both arms, which begin and end as in `base`.

    Args:
        times: Of the key points between beginning and end, then that of the end, s.
        base: Angles of a left arm at beginning and end.
        left: Joint without its side -> angles of a left arm at these times.
        right: The same for the right arm, also as angles of a left arm: they are mirrored.
    """
    table: dict[str, Keys] = {}
    for side, values in (("L", left), ("R", right)):
        for joint, angles in values.items():
            sign = -1.0 if side == "R" and joint in MIRRORED else 1.0
            keys = [base[joint], *angles, base[joint]]
            table[f"{side}{joint}"] = [(time, sign * angle) for time, angle in zip([0.0, *times], keys)]
    return table


def through(text: str) -> Keys:
    """Key points from a text: "0 0.1, 1.5 0.3" is 0.1 at 0 s and 0.3 at 1.5 s."""
    return [(float(time), float(value)) for time, value in (pair.split() for pair in text.split(","))]


def wave() -> Table:
    """The right arm is raised and waves three times; the head looks up and a little aside."""
    times = [0.9, 1.25, 1.6, 1.95, 2.3, 2.65, 3.0, 4.0]
    right = {
        "ShoulderPitch": [-1.0] * 7,
        "ShoulderRoll": [0.35, 0.45, 0.3, 0.45, 0.3, 0.45, 0.35],
        "ElbowYaw": [-1.2] * 7,
        "ElbowRoll": [-0.9, -0.35, -1.25, -0.35, -1.25, -0.35, -0.9],
        "Hand": [1.0] * 7,
    }
    return {
        **arms(times, STAND_ARM, {}, right),
        "RWristYaw": [(0.0, 0.1), (0.9, -0.3), (3.0, -0.3), (4.0, 0.1)],
        "HeadPitch": [(0.0, STAND_HEAD), (0.9, -0.3), (3.0, -0.3), (4.0, STAND_HEAD)],
        "HeadYaw": [(0.0, 0.0), (0.9, -0.15), (3.0, -0.15), (4.0, 0.0)],
    }


def bow_small() -> Table:
    """A bow of 25 degrees."""
    return _bow(0.45, 0.7, 0.008)


def bow_deep() -> Table:
    """A bow of 45 degrees, one hand before the chest."""
    return _bow(0.8, 1.2, 0.012)


def _bow(depth: float, hold: float, ahead: float) -> Table:
    down, up, end = 1.6, 1.6 + hold, 3.4 + hold
    left = {
        "ShoulderPitch": [1.0, 1.0],
        "ShoulderRoll": [-0.1, -0.1],
        "ElbowYaw": [-0.75, -0.75],
        "ElbowRoll": [-1.35, -1.35],
        "Hand": [0.6, 0.6],
    }
    right = {"ShoulderPitch": [1.75, 1.75], "ShoulderRoll": [0.35, 0.35], "ElbowRoll": [-0.5, -0.5]}
    return {
        **arms([down, up, end], INIT_ARM, left, right),
        "pitch": [(0.0, UPRIGHT), (down, depth), (up, depth), (end, UPRIGHT)],
        "com_x": [(0.0, 0.0), (down, ahead), (up, ahead), (end, 0.0)],
        "height": [(0.0, HEIGHT), (down, 0.31), (up, 0.31), (end, HEIGHT)],
        "HeadPitch": [(0.0, 0.0), (down, 0.35), (up, 0.35), (end, 0.0)],
    }


def point_to_self() -> Table:
    """The right hand goes to the chest."""
    times = [0.8, 2.0, 2.8]
    right = {
        "ShoulderPitch": [0.75, 0.75],
        "ShoulderRoll": [-0.2, -0.2],
        "ElbowYaw": [-0.55, -0.55],
        "ElbowRoll": [-1.45, -1.45],
        "Hand": [0.7, 0.7],
    }
    return {
        **arms(times, STAND_ARM, {}, right),
        "HeadPitch": [(0.0, STAND_HEAD), (0.8, 0.0), (2.0, 0.0), (2.8, STAND_HEAD)],
    }


def offer() -> Table:
    """Both arms open to the sides, palms up."""
    times = [0.9, 1.8, 2.7]
    both = {
        "ShoulderPitch": [0.85, 0.75],
        "ShoulderRoll": [0.45, 0.6],
        "ElbowYaw": [-1.6, -1.7],
        "ElbowRoll": [-0.9, -0.7],
        "Hand": [1.0, 1.0],
    }
    return {
        **arms(times, STAND_ARM, both, both),
        "LWristYaw": [(0.0, 0.1), (0.9, -1.3), (1.8, -1.5), (2.7, 0.1)],
        "RWristYaw": [(0.0, 0.1), (0.9, 1.3), (1.8, 1.5), (2.7, 0.1)],
        "HeadYaw": [(0.0, 0.0), (0.9, 0.25), (1.8, -0.25), (2.7, 0.0)],
        "HeadPitch": [(0.0, STAND_HEAD), (0.9, -0.25), (1.8, -0.25), (2.7, STAND_HEAD)],
    }


def look_around() -> Table:
    """The head goes slowly round, over the left shoulder and over the right one, up and down; weight goes with it."""
    times = [2.0, 3.4, 5.4, 7.6, 9.0]
    shade = {
        "ShoulderPitch": [1.4, 0.0, -0.5, -0.5],
        "ShoulderRoll": [0.3, 0.3, -0.15, -0.15],
        "ElbowYaw": [-1.39, -1.2, -0.7, -0.7],
        "ElbowRoll": [-1.01, -1.3, -1.5, -1.5],
        "Hand": [0.25, 0.6, 1.0, 1.0],
    }
    return {
        **arms(times, INIT_ARM, {}, shade),
        "HeadYaw": through("0.0 0.0, 1.0 0.9, 2.0 1.3, 2.8 0.9, 3.6 0.0, 4.6 -0.9, 6.0 -1.2, 7.4 0.4, 9.0 0.0"),
        "HeadPitch": through("0.0 0.0, 1.0 -0.3, 2.0 -0.05, 2.8 0.2, 3.6 0.1, 4.6 0.15, 6.0 -0.1, 7.4 -0.2, 9.0 0.0"),
        "com_y": [(0.0, 0.0), (1.6, 0.02), (3.6, 0.0), (5.6, -0.02), (7.4, 0.0), (9.0, 0.0)],
        "roll": [(0.0, 0.0), (1.6, -0.06), (3.6, 0.0), (5.6, 0.06), (7.4, 0.0), (9.0, 0.0)],
    }


def tai_chi() -> Table:
    """Weight goes from foot to foot, and each leg is lifted once, the robot standing on the other."""
    # s: rising, sinking, to the left, its leg lifted until, to the right, its leg lifted until, home, end.
    times = [2.5, 5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0, 22.5, 24.5, 26.5]
    rows = [  # ShoulderPitch, ShoulderRoll, ElbowYaw, ElbowRoll, WristYaw, Hand of a left arm
        (0.1, 0.1, -1.2, -0.3, -0.6, 0.8),
        (1.1, 0.2, -1.2, -0.9, -0.6, 0.5),
        (0.3, 0.1, -0.9, -1.2, -0.9, 0.8),
        (-0.2, 0.5, -0.9, -0.9, -0.6, 1.0),
        (-0.2, 0.6, -0.9, -0.6, -0.6, 1.0),
        (0.9, 0.1, -1.0, -1.2, -1.2, 0.8),
        (0.6, 0.9, -1.3, -0.5, -0.6, 0.8),
        (0.5, 1.0, -1.3, -0.4, -0.6, 0.8),
        (0.1, 0.1, -1.2, -0.3, -0.6, 0.8),
        (1.1, 0.2, -1.2, -0.9, -0.3, 0.5),
    ]
    rows_right = [*rows[:2], *rows[5:8], *rows[2:5], *rows[8:]]  # what the left arm does on the way to the other side
    lifted, ahead = 0.045, 0.02
    low, tall = HEIGHT - 0.03, HEIGHT - 0.012
    over, lean = 0.05, 0.1
    return {
        **arms(times, INIT_ARM, _columns(rows), _columns(rows_right)),
        "height": through(
            f"0 {HEIGHT}, 2.5 {HEIGHT}, 5 {low}, 7.5 {tall}, 12.5 {tall}, 15 {low}, "
            f"17.5 {tall}, 20 {tall}, 22.5 {HEIGHT}, 24.5 {low}, 26.5 {HEIGHT}"
        ),
        "com_y": through(f"0 0, 5 0, 8 {over}, 12.6 {over}, 17 {-over}, 20.2 {-over}, 22.8 0, 26.5 0"),
        "roll": through(f"0 0, 5 0, 8 {-lean}, 12.6 {-lean}, 17 {lean}, 20.2 {lean}, 22.8 0, 26.5 0"),
        "right_z": [(0.0, 0.0), (8.4, 0.0), (9.9, lifted), (11.0, lifted), (12.4, 0.0), (26.5, 0.0)],
        "right_x": [(0.0, 0.0), (8.4, 0.0), (9.9, ahead), (11.0, ahead), (12.4, 0.0), (26.5, 0.0)],
        "left_z": [(0.0, 0.0), (17.2, 0.0), (18.4, lifted), (19.0, lifted), (20.0, 0.0), (26.5, 0.0)],
        "left_x": [(0.0, 0.0), (17.2, 0.0), (18.4, ahead), (19.0, ahead), (20.0, 0.0), (26.5, 0.0)],
        "HeadYaw": through("0.0 0.0, 5.0 0.0, 8.0 0.5, 12.5 0.3, 15.0 0.0, 17.5 -0.5, 20.0 -0.3, 22.5 0.0, 26.5 0.0"),
        "HeadPitch": through(
            "0.0 0.0, 2.5 -0.1, 5.0 0.15, 10.0 -0.1, 15.0 0.1, 18.5 -0.1, 22.5 -0.1, 24.5 0.15, 26.5 0.0"
        ),
    }


def _columns(rows: list[tuple[float, ...]]) -> dict[str, list[float]]:
    return {joint: list(column) for joint, column in zip(INIT_ARM, zip(*rows))}
