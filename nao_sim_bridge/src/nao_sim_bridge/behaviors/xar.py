"""Reads behaviours of Choregraphe's projects: the boxes of a behavior.xar that say what they do without a script.

Read are timelines (joint curves, with the boxes on their layers), diagrams of boxes, and the boxes for texts (Text
Edit, Localized Text), for speech (Say, Say Text, Animated Say), for postures and for waiting. What else has a script
of its own is refused: the simulated robot does not run the Python programs of others.

Boxes begin as their links say. A diagram ends when all that it has begun has ended.
"""

from __future__ import annotations

import logging
import math
from pathlib import Path
from typing import Iterator
from xml.etree.ElementTree import Element

from nao_sim_bridge.base.config import TooLarge, read_bounded
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.xml_values import parse_xml
from nao_sim_bridge.behaviors.steps import GoToPosture, InTurn, Joints, JointWay, Say, Step, Together, Wait
from nao_sim_bridge.control.joints.bezier import PLAIN, Handle, Interpolation, KeyPoint, PackedKeyPoints
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import load_postures

# Boxes in each other and branches behind each other, together. Boxes, elements, keys and characters of texts count
# each time they are read: a box to which several ways lead is read on each of them.
DEEPEST, MOST_BOXES, MOST_ELEMENTS, MOST_KEYS, MOST_CHARACTERS = 50, 2000, 2_000_000, 50_000, 1_000_000
# Frames a second; and the longest way to a key, handle or wait, s.
DEFAULT_FPS, LOWEST_FPS, HIGHEST_FPS, LONGEST = 25.0, 1.0, 100.0, 3600.0
# Largest value of a key or handle, deg or shares: above all limits of joints.
WIDEST = 10_000.0
# Units of curves: deg of joints, shares of hands.
DEGREES = "0"
KINDS = {"linear": Interpolation.LINEAR, "constant": Interpolation.CONSTANT, "bezier": Interpolation.BEZIER}
# Type of an input that takes a text.
TEXT_INPUT = "3"
# A behaviour that speaks does so as the text says; words that name a service in the scripts of Choregraphe's own boxes.
SPEECH, ANIMATED_SPEECH, POSTURE = "ALTextToSpeech", "ALAnimatedSpeech", "ALRobotPosture"
TEXT_PARAMETER = "Text"
POSTURE_PARAMETER, SPEED_PARAMETER, WAIT_PARAMETERS = "Posture name", "Speed (%)", ("Timeout (s)", "Timeout")
# Boxes that prepare the robot for others, which is not up to a behaviour here.
LEFT_OUT = ("setLanguage", "setStiffnesses", "stiffnessInterpolation")
log = logging.getLogger("nao_sim.behaviors")


def read_xar(path: Path) -> Step:
    """What a behavior.xar does.

    Raises:
        ConfigError: It cannot be read, or has a box that cannot be played.
    """
    try:
        content = read_bounded(path, load_sizes().xml.file_bytes)
    except (OSError, TooLarge) as error:
        raise ConfigError(path.name, f"cannot be read: {error}") from error
    return xar_step(content, path.name)


def xar_step(content: bytes, where: str) -> Step:
    """What the content of a behavior.xar does, as `read_xar`."""
    root = parse_xml(content, where)
    for element in root.iter():
        element.tag = element.tag.rsplit("}", 1)[-1]  # the namespace has had the names of several owners
    if root.tag != "ChoregrapheProject" or root.find("Box") is None:
        raise ConfigError(where, "is no behaviour of Choregraphe: there is no ChoregrapheProject with a Box")
    return _Xar(where).box(root.find("Box"), "", 0)


class _Xar:
    """Reads one file and counts its boxes."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._boxes = self._elements = self._keys = self._characters = 0

    def box(self, box: Element, text: str, depth: int) -> Step:
        """What a box does that gets `text` from the box before it and is in `depth` others."""
        self._count(box, depth)
        timeline = box.find("Timeline")
        if timeline is None or not _holds_anything(timeline):
            return self._leaf(box, text)
        steps: list[Step] = []
        fps = self._within(timeline.get("fps"), DEFAULT_FPS, LOWEST_FPS, HIGHEST_FPS, "frames a second")
        enabled = timeline.get("enable") == "1"
        if enabled:
            ways = self._curves(timeline, fps)
            if ways:
                steps.append(Joints(ways))
        for key_frame in timeline.findall("BehaviorLayer/BehaviorKeyframe"):
            diagram = key_frame.find("Diagram")
            if diagram is None or diagram.find("Box") is None:
                continue
            inside = self._diagram(diagram, depth)
            last = LONGEST * fps
            index = self._within(key_frame.get("index"), 1.0, -last, last, "the frame of a diagram")
            start = max(0.0, (index - 1.0) / fps) if enabled else 0.0
            steps.append(InTurn((Wait(start), inside)) if start else inside)
        return Together(tuple(steps)) if len(steps) != 1 else steps[0]

    def _count(self, box: Element, depth: int) -> None:
        self._boxes += 1
        self._elements += sum(1 for _ in box.iter())
        if depth > DEEPEST or self._boxes > MOST_BOXES or self._elements > MOST_ELEMENTS:
            name = box.get("name", "?")
            raise ConfigError(self._file, f"box {name!r} is nested too deep, or the file has too many boxes")

    # --- diagrams -------------------------------------------------------------------------------------------------

    def _diagram(self, diagram: Element, depth: int) -> Step:
        """Boxes in the order of their links, from the start of the diagram on."""
        boxes = {box.get("id"): box for box in diagram.findall("Box")}
        inputs, outputs = ({key: _names(box, kind) for key, box in boxes.items()} for kind in ("Input", "Output"))
        after: dict[str | None, dict[str | None, None]] = {}  # of each box those that it begins, in their order
        for link in diagram.findall("Link"):
            source, target = link.get("outputowner"), link.get("inputowner")
            entry = inputs.get(target, {}).get(link.get("indexofinput"), "")
            end = outputs.get(source, {}).get(link.get("indexofoutput"), "")
            # It begins a box when another one has done its work, and not when that has failed.
            if target in boxes and entry not in ("onStop", "onLoad") and "error" not in end.lower():
                after.setdefault(source, {})[target] = None
        # A project that was never wired begins with what nothing leads to.
        led_to = {target for targets in after.values() for target in targets}
        begun = after.get("0") or [key for key in boxes if key not in led_to]
        return _together([self._from(key, boxes, after, "", frozenset(), depth) for key in begun])

    def _from(
        self, key: str | None, boxes: dict, after: dict, text: str, before: frozenset[str | None], depth: int
    ) -> Step:
        """A box, and what comes after it."""
        steps: list[Step] = []
        while True:
            box = boxes[key]
            if key in before:
                raise ConfigError(self._file, f"box {box.get('name')!r} begins itself again: circles are not played")
            own = self._text_of(box)
            if own is None:
                steps.append(self.box(box, text, depth + 1))
            else:
                self._count(box, depth + 1)
            text, before = own or "", before | {key}
            following = list(after.get(key, ()))
            if len(following) != 1:
                break
            key = following[0]
        if following:
            steps.append(_together([self._from(one, boxes, after, text, before, depth + 1) for one in following]))
        return steps[0] if len(steps) == 1 else InTurn(tuple(steps))

    def _text_of(self, box: Element) -> str | None:
        """The text that a box sends to the next one; None for boxes that send none."""
        text = next((each.text for each in _plugin_texts(box) if each.text and each.text.strip()), None)
        return None if text is None else " ".join(self._short(text).split())

    def _short(self, text: str) -> str:
        longest = load_sizes().speech.text_characters
        if len(text) > longest:
            raise ConfigError(self._file, f"has a text of {len(text)} characters, at most {longest} are allowed")
        self._characters += len(text)
        if self._characters > MOST_CHARACTERS:
            raise ConfigError(self._file, f"has texts of more than {MOST_CHARACTERS} characters")
        return text

    # --- single boxes ---------------------------------------------------------------------------------------------

    def _leaf(self, box: Element, text: str) -> Step:
        """A box without boxes."""
        name, script = box.get("name", "?"), _script(box)
        parameters = {p.get("name"): p.get("value", "") for p in box.findall("Parameter")}
        takes_text = any(i.get("type") == TEXT_INPUT for i in box.findall("Input"))
        if (takes_text or TEXT_PARAMETER in parameters) and (SPEECH in script or ANIMATED_SPEECH in script):
            spoken = " ".join(self._short(parameters.get(TEXT_PARAMETER) or text).split())
            return Say(f"{_speed(parameters)}{spoken}", ANIMATED_SPEECH in script) if spoken else Wait(0.0)
        if POSTURE in script:
            return self._posture(name, parameters)
        for parameter in WAIT_PARAMETERS:
            if parameter in parameters and "wait" in name.lower():
                return Wait(self._within(parameters[parameter], 0.0, 0.0, LONGEST, f"the time of box {name!r}"))
        if any(word in script for word in LEFT_OUT):
            log.warning("%s: box %r is left out, the robot speaks and holds itself as it is told to", self._file, name)
            return Wait(0.0)
        if script:
            first = script.strip().splitlines()[0][:60]
            raise ConfigError(self._file, f"box {name!r} runs a script ({first!r}...), which is not played")
        return Wait(0.0)

    def _posture(self, name: str, parameters: dict) -> Step:
        wanted = parameters.get(POSTURE_PARAMETER) or name.rsplit(" ", 1)[-1]
        if wanted not in load_postures().by_name:
            known = ", ".join(load_postures().by_name)
            raise ConfigError(self._file, f"box {name!r} goes to posture {wanted!r}, there are {known}")
        share = _number(parameters.get(SPEED_PARAMETER), 80.0) / 100.0
        return GoToPosture(wanted, min(max(share, 0.05), 1.0))

    def _curves(self, timeline: Element, fps: float) -> dict[str, JointWay]:
        model, ways = load_model(), {}
        for curve in timeline.findall("ActuatorList/ActuatorCurve"):
            joint = curve.get("actuator", "")
            if curve.get("mute") == "1" or curve.find("Key") is None:
                continue
            if joint not in model.joint_index:
                raise ConfigError(self._file, f"a curve moves {joint!r}, which is no joint of a NAO")
            factor = math.radians(1.0) if curve.get("unit", DEGREES) == DEGREES else 1.0
            limits = model.joint(joint)
            points = [self._key(key, fps, factor, joint) for key in curve.findall("Key")]
            points.sort(key=lambda point: point.time)
            kept = [p for p, after in zip(points, [*points[1:], None]) if after is None or after.time > p.time]
            for point in kept:
                if not limits.lower - 0.02 <= point.angle <= limits.upper + 0.02:
                    raise ConfigError(self._file, f"{joint} goes to {point.angle:.3f}, beyond what it can")
            curved = any(p.before.kind or p.after.kind for p in kept if p.after.kind is not Interpolation.LINEAR)
            ways[joint] = JointWay(PackedKeyPoints(kept), curved)
        return ways

    def _key(self, key: Element, fps: float, factor: float, joint: str) -> KeyPoint:
        self._keys += 1
        if self._keys > MOST_KEYS:
            raise ConfigError(self._file, f"has more than {MOST_KEYS} keys")
        last = LONGEST * fps
        frame = self._within(key.get("frame"), math.nan, -last, last, f"the frame of a key of {joint}")
        value = self._within(key.get("value"), math.nan, -WIDEST, WIDEST, f"a key of {joint}")
        handles = {"left": PLAIN, "right": PLAIN}
        for tangent in key.findall("Tangent"):
            kind = KINDS.get(tangent.get("interpType", "linear").split("_")[0], Interpolation.LINEAR)
            what = f"the tangent of a key of {joint}"
            time = self._within(tangent.get("abscissaParam"), 0.0, -last, last, what) / fps
            angle = self._within(tangent.get("ordinateParam"), 0.0, -WIDEST, WIDEST, what) * factor
            handles[tangent.get("side", "left")] = Handle(kind, time, angle)
        # Frame 1 is the begin; a joint needs some time to get to a key there.
        return KeyPoint(max(frame, 1.0) / fps, value * factor, handles["left"], handles["right"])

    def _within(self, text: str | None, default: float, low: float, high: float, what: str) -> float:
        """A number of the file, `default` for what is none; outside of its bounds it is refused."""
        value = _number(text, default)
        if not low <= value <= high:
            raise ConfigError(self._file, f"{what} is {str(text)[:40]}, allowed is {low:g} to {high:g}")
        return value


def _speed(parameters: dict) -> str:
    """The tag for the speed at which a text is spoken."""
    percent = _number(parameters.get(SPEED_PARAMETER), 100.0)
    return "" if percent == 100.0 else f"\\rspd={percent:.0f}\\ "


def _holds_anything(timeline: Element) -> bool:
    return timeline.find("BehaviorLayer/BehaviorKeyframe/Diagram/Box") is not None or (
        timeline.get("enable") == "1" and timeline.find("ActuatorList/ActuatorCurve/Key") is not None
    )


def _names(box: Element, kind: str) -> dict[str | None, str]:
    """Names of the inputs or outputs of a box by their numbers."""
    return {end.get("id"): end.get("name", "") for end in reversed(box.findall(kind))}  # of two the first counts


def _plugin_texts(box: Element) -> Iterator[Element]:
    content = box.find("pluginContent")
    if content is not None:
        for name in ("text", "data", "sentence", "value"):
            yield from content.iter(name)


def _script(box: Element) -> str:
    """The script of a box, empty when it does nothing."""
    content = box.find("script/content")
    return "" if content is None or content.text is None else content.text.strip()


def _together(steps: list[Step]) -> Step:
    return steps[0] if len(steps) == 1 else Together(tuple(steps))


def _number(text: str | None, default: float) -> float:
    try:
        value = float(text) if text is not None else default
    except ValueError:
        return default
    return value if math.isfinite(value) else default
