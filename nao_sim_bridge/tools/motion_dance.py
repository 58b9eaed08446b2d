"""Key points of the dance: 32 beats at 120 a minute, from StandInit to StandInit; see `choreography.py`."""

from __future__ import annotations

from choreography import Keys, Table
from motion_tables import HEIGHT, INIT_ARM, MIRRORED

BEAT = 0.5
"""s."""
BEATS = 32
DIP = 0.018
"""m, how deep knees bend on the beat."""
SWAY = 0.03
"""m, of the weight."""

UP, SIDE, LOW, CHEST, OUT = "up", "side", "low", "chest", "out"
ARM = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "Hand")
POSES = {
    UP: (-1.1, 0.35, -0.9, -0.25, 1.0),
    SIDE: (0.2, 1.1, -1.2, -0.3, 1.0),
    LOW: (1.5, 0.25, -1.3, -0.6, 0.2),
    CHEST: (0.7, 0.0, -0.6, -1.4, 0.2),
    OUT: (0.4, 0.75, -1.5, -1.2, 1.0),
}
"""Of a left arm; the right one mirrors it."""
FIGURES = (
    # Every two beats: left arm, right arm, weight to the left (1) or right (-1).
    (LOW, OUT, -1), (OUT, LOW, 1), (LOW, OUT, -1), (OUT, LOW, 1),
    (UP, LOW, 1), (LOW, UP, -1), (UP, LOW, 1), (LOW, UP, -1),
    (CHEST, CHEST, 1), (SIDE, SIDE, -1), (CHEST, CHEST, 1), (SIDE, SIDE, -1),
    (UP, SIDE, 1), (SIDE, UP, -1), (UP, UP, 1),
)  # fmt: skip


def dance() -> Table:
    """Sways and bends its knees to the beat; arms point up and out."""
    end = BEATS * BEAT
    return {
        **_arms(end),
        "com_y": _on_figures([side * SWAY for _, _, side in FIGURES], 0.0, end),
        "roll": _on_figures([-side * 0.09 for _, _, side in FIGURES], 0.0, end),
        "height": _bounce(end),
        "HeadYaw": _on_figures([side * 0.4 for _, _, side in FIGURES], 0.0, end),
        "HeadPitch": [
            (0.0, 0.0),
            *((beat * BEAT, 0.18 if beat % 2 else -0.08) for beat in range(1, BEATS - 1)),
            (end, 0.0),
        ],
    }


def _bounce(end: float) -> Keys:
    """Knees bend on each beat and straighten between two."""
    keys = [(0.0, HEIGHT)]
    for beat in range(2, BEATS - 1):
        keys += [(beat * BEAT, HEIGHT - DIP), ((beat + 0.5) * BEAT, HEIGHT - 0.004)]
    return [*keys, (end, HEIGHT)]


def _on_figures(values: list[float], rest: float, end: float) -> Keys:
    """A value that is reached on the first beat of its figure and held for half of the second."""
    keys = [(0.0, rest)]
    for place, value in enumerate(values, 1):
        keys += [(2 * place * BEAT, value), ((2 * place + 0.6) * BEAT, value)]
    return [*keys, (end, rest)]


def _arms(end: float) -> Table:
    table: dict[str, Keys] = {}
    for place, joint in enumerate(ARM):
        for side, which in (("L", 0), ("R", 1)):
            sign = -1.0 if side == "R" and joint in MIRRORED else 1.0
            values = [sign * POSES[figure[which]][place] for figure in FIGURES]
            table[f"{side}{joint}"] = _on_figures(values, sign * INIT_ARM[joint], end)
    return table
