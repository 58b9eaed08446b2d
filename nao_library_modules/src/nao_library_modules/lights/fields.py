"""What the fields of a LedFunction mean to the functions of lights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import List

from ..base.colours import ALLOWED, named_colours, parse_colour
from ..base.limits import limit
from ..functions.describe_choices import LIGHTS
from ..functions.fields import Annotated, flag, free, moments, number, numbers, text

COLOURS = limit("colours")


def _require_colours(name: str, words: Sequence[str]) -> None:
    for word in words:
        if word.strip() or len(words) > 1:
            parse_colour(word, name)


_LIGHTS = free(
    "lights and groups by the robot's names or in plain words: Eyes, LeftEar, Chest",
    allowed="lights and groups of the robot, at least one",
    asked=LIGHTS,
)
_COLOUR = free(
    "a colour by name, '#RRGGBB' or '0xRRGGBB'; empty: i_values has it",
    allowed=ALLOWED,
    choices=tuple(named_colours()),
    check=lambda name, text: _require_colours(name, [text]),
)
_SHARES = numbers((0.0, 1.0), "", allowed="each within 0..1")

Lights = Annotated[List[str], _LIGHTS]
ColouredLights = Annotated[List[str], _LIGHTS.but(allowed="lights and groups with red, green and blue LEDs")]
Members = Annotated[List[str], _LIGHTS.but(help="lights and groups that make the group")]
Intensities = Annotated[List[float], _SHARES.but(help="intensities: one for all lights, or one a light")]
Colours = Annotated[List[float], _SHARES.but(help="red, green, blue: for all lights, or three a light")]
ColourSteps = Annotated[List[float], _SHARES.but(help="red, green, blue of each moment")]
OneColour = Annotated[List[float], _SHARES.but(help="red, green, blue")]
ColourText = Annotated[str, _COLOUR]
ColourTexts = Annotated[
    str,
    _COLOUR.but(
        help="colours separated by commas, one a moment; empty: i_values has them",
        check=lambda name, text: _require_colours(name, text.split(",")),
    ),
]
FadeTime = Annotated[float, number("duration", "length of the fade", zero="")]
AnimationTime = Annotated[float, number("duration", "length of the animation")]
TurnTime = Annotated[float, number("duration", "time of one turn")]
Moments = Annotated[List[float], moments("duration", "when each colour is reached, from the start", COLOURS)]
Angle = Annotated[int, number((0, 360), "direction: 0 up, 90 front, 180 down, 270 back", "deg")]
LeaveOn = Annotated[bool, flag("whether the LEDs stay lit at the end")]
Revert = Annotated[bool, flag("whether all that changed gets its former values back after `time`")]
NewGroup = Annotated[str, text("the name of the new group", "name of the new group")]
Group = Annotated[str, free("name of a light or group", allowed="a light or group of the robot", asked=LIGHTS)]
