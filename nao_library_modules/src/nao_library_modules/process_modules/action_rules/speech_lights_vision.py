"""Rules for speech, lights and seeing."""

from __future__ import annotations

from numbers import Real
from typing import Any

from ..designators.designator import Designator, action
from ..designators.patterns import anything, described, number, one_of, text
from ..designators.rules import Command, command, rule
from .values import BOTH

SPEECH, LIGHTS, VISION = "speech", "lights", "vision"
WAIT = one_of(True, False).or_else(False)
"""Whether to wait for the end of a text, by the action; else it goes to the topic /speech, and that is all."""


@rule(BOTH, type=one_of("saying", "speaking"), text=text(), wait=WAIT)
def saying(desig: Designator, wait: bool) -> Command:
    return _saying(desig["text"], wait)


@rule(BOTH, type=one_of("lighting", "colouring"), color=text(), lights=anything().or_else(("FaceLeds",)))
def lighting(color: str, lights: Any) -> Command:
    return command(LIGHTS, "set_color", color=color, lights=(lights,) if isinstance(lights, str) else tuple(lights))


@rule(BOTH, type="detecting", object=described("object"), timeout=number(0.0, 3600.0, "s").or_else(2.0))
def detecting(object: Designator, timeout: float, desig: Designator) -> Command:  # noqa: A002  the key's name
    looked = {"camera": desig.get("camera", "")}
    if "name" in object:
        looked["name"] = object["name"]
    # A detector wants one length, as NaoVision has it; of what is known of a thing, `size` is the box around it.
    if isinstance(object.get("size"), Real):
        looked["size"] = float(object["size"])
    return command(VISION, "detect", type=object["type"], timeout=timeout, search=bool(desig.get("search")), **looked)


@rule(action, name=one_of("to say", "text to speech"), text=text(), wait=WAIT)
def to_say(desig: Designator, wait: bool) -> Command:
    return _saying(desig["text"], wait)


@rule(action, name=one_of("to say", "text to speech"), sentence=text(), wait=WAIT)
def to_say_a_sentence(sentence: str, wait: bool) -> Command:
    return _saying(sentence, wait)


def _saying(sentence: str, wait: bool) -> Command:
    return command(SPEECH, "say" if wait else "text_to_speech", text=sentence)
