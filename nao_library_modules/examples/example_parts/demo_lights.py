"""What the demonstration asks of the lights, and how LEDs are to be then."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

EYE_ANGLES = tuple(range(0, 360, 45))
EYES = ("LeftFaceLeds", "RightFaceLeds")


@dataclass(frozen=True)
class Step:
    """One goal for the lights.

    Attributes:
        title: What is asked, for the table.
        functions: Fields of each function message of the chain.
        during: Device name -> intensity while the last function waits; nothing to check when empty.
        after: Device name -> intensity when the goal has ended.
        picture: View to take while the last function waits, or after the goal; no picture when empty.
        walking: Whether the robot walks to the table meanwhile.
    """

    title: str
    functions: Sequence[Mapping[str, object]]
    during: Mapping[str, float] = field(default_factory=dict)
    after: Mapping[str, float] = field(default_factory=dict)
    picture: str = ""
    walking: bool = False


def eye_devices(red: float, green: float, blue: float) -> dict[str, float]:
    """Intensity that every device of both eyes must have for a colour."""
    colors = {"Red": red, "Green": green, "Blue": blue}
    return {
        f"Face/Led/{color}/{side}/{angle}Deg": value
        for color, value in colors.items()
        for side in ("Left", "Right")
        for angle in EYE_ANGLES
    }


def steps() -> list[Step]:
    """The lights of the demonstration: the listings of the nao_library paper, then a chained light show."""
    white, green = eye_devices(1, 1, 1), eye_devices(0, 1, 0)
    chest = {f"ChestBoard/Led/{color}": value for color, value in (("Red", 0.0), ("Green", 0.0), ("Blue", 1.0))}
    return [
        Step(
            "head light Brain0 at half intensity",
            [{"function": "setIntensity", "lights": ["Brain0"], "i_values": [0.5]}],
            after={"Head/Led/Front/Right/1": 0.5},
        ),
        Step(
            "both eyes green for 2 s, then as before",
            [{"function": "setColor", "lights": EYES, "i_values": [0, 1, 0], "time": 2.0, "revert": True}],
            during=green,
            after=white,
        ),
        Step(
            "both eyes green",
            [{"function": "setColor", "lights": EYES, "i_values": [0, 1, 0]}],
            after=green,
            picture="front",
        ),
        Step(
            "show while it walks: rasta, random and turning eyes, ears, fades",
            [
                {"function": "rasta", "duration": 1.2},
                {"function": "randomEyes", "duration": 1.0},
                {"function": "rotateEyes", "str_param": "magenta", "rotation_time": 0.5, "duration": 1.0},
                {"function": "earLedsSetAngle", "angle": 90, "duration": 0.5, "leave_on": True},
                {
                    "function": "fadeListRGB",
                    "lights": ["FaceLeds"],
                    "str_param": "red,yellow,cyan",
                    "times": [0.4, 0.8, 1.2],
                },
                {"function": "fadeRGB", "lights": ["ChestLeds"], "i_values": [0, 0, 1], "duration": 0.5},
                {"function": "fade", "lights": ["BrainLeds"], "i_values": [0.2], "duration": 0.5},
                {"function": "setColor", "lights": ["FeetLeds"], "str_param": "blue"},
            ],
            after={**eye_devices(0, 1, 1), **chest, "Head/Led/Middle/Left/0": 0.2, "LFoot/Led/Blue": 1.0},
            picture="three_quarter",
            walking=True,
        ),
        Step(
            "everything off, then back to the default",
            [{"function": "off", "lights": ["AllLeds"], "time": 0.3}, {"function": "reset", "lights": ["AllLeds"]}],
            after={**white, "ChestBoard/Led/Blue": 0.0},
            picture="face",
        ),
    ]
