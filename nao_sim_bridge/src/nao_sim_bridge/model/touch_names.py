"""The touch sensors of a NAO: their names, what NAOqi calls their events, and the parts of the body that have them."""

from __future__ import annotations

from typing import Mapping, Tuple

from nao_sim_bridge.base.errors import UnknownName

CHEST_BUTTON = "ChestBoard/Button"
HEAD = ("Head/Touch/Front", "Head/Touch/Middle", "Head/Touch/Rear")
HANDS: Mapping[str, Tuple[str, ...]] = {
    side: tuple(f"{side}/Touch/{place}" for place in ("Back", "Left", "Right")) for side in ("LHand", "RHand")
}
BUMPERS: Mapping[str, Tuple[str, ...]] = {
    side: tuple(f"{side}/Bumper/{half}" for half in ("Left", "Right")) for side in ("LFoot", "RFoot")
}
SENSORS = (*HEAD, *HANDS["LHand"], *HANDS["RHand"], *BUMPERS["LFoot"], *BUMPERS["RFoot"])
"""In ALTouch's order, which leaves out the button of the chest."""
EVENTS: Mapping[str, Tuple[str, ...]] = {
    "FrontTactilTouched": (HEAD[0],),
    "MiddleTactilTouched": (HEAD[1],),
    "RearTactilTouched": (HEAD[2],),
    **{
        f"Hand{word}{sensor.rsplit('/', 1)[1]}Touched": (sensor,)
        for word, side in (("Right", "RHand"), ("Left", "LHand"))
        for sensor in HANDS[side]
    },
    # The outer half first: it is what a hand touches that is asked for the event.
    "RightBumperPressed": BUMPERS["RFoot"][::-1],
    "LeftBumperPressed": BUMPERS["LFoot"],
    "ChestButtonPressed": (CHEST_BUTTON,),
}
"""The sensors of each event: it tells whether any of them is touched."""


def sensor_of(name: str) -> str:
    """The sensor that a name of a sensor or of an event means.

    Raises:
        UnknownName: It is neither.
    """
    if name in SENSORS or name == CHEST_BUTTON:
        return name
    if name not in EVENTS:
        raise UnknownName("touch sensor", name, (*SENSORS, CHEST_BUTTON, *EVENTS))
    return EVENTS[name][0]
