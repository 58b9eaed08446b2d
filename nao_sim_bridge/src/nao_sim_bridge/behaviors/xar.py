"""Reads behaviours of Choregraphe's projects: the boxes of a behavior.xar that say what they do without a script.

Read are timelines (joint curves, with the diagrams on their layers), diagrams of boxes, and the boxes for texts (Text
Edit, Localized Text, Number Edit), for speech (Say, Say Text, Animated Say), for postures, for waiting and for the
language. What else has a script of its own is refused, as dialogues are: the simulated robot does not run the Python
programs of others. One error names all boxes that are refused.

Boxes begin and stop as their links say; see `diagram_run.py`.
"""

from __future__ import annotations

import logging
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Iterable, Mapping
from xml.etree.ElementTree import Element

from nao_sim_bridge.base.config import TooLarge, read_bounded
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.xml_values import parse_xml
from nao_sim_bridge.behaviors.scripts import Kind, kind_of, sends_stopped
from nao_sim_bridge.behaviors.steps import (
    Act,
    Box,
    Diagram,
    GoToPosture,
    Joints,
    JointWay,
    KeyFrame,
    Language,
    Link,
    Say,
    Step,
    Text,
    Timeline,
    Wait,
)
from nao_sim_bridge.control.joints.bezier import PLAIN, Handle, Interpolation, KeyPoint, PackedKeyPoints
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import load_postures

# Boxes in each other; boxes, keys and characters of texts of a file.
DEEPEST, MOST_BOXES, MOST_KEYS, MOST_CHARACTERS = 50, 2000, 50_000, 1_000_000
# Frames a second; and the longest way to a key, handle or wait, s.
DEFAULT_FPS, LOWEST_FPS, HIGHEST_FPS, LONGEST = 25.0, 1.0, 100.0, 3600.0
# Largest value of a key or handle, deg or shares: above all limits of joints.
WIDEST = 10_000.0
KINDS = {"linear": Interpolation.LINEAR, "constant": Interpolation.CONSTANT, "bezier": Interpolation.BEZIER}
# Owner of a link that begins or ends at the diagram itself.
DIAGRAM = "0"
# Natures of inputs and outputs; files that say none have them by their names.
ON_LOAD, ON_EVENT, ON_START, ON_STOP, MEMORY = "0", "1", "2", "3", "4"
ENDS = "1"
NATURES = {"onLoad": ON_LOAD, "onStart": ON_START, "onSet": ON_START, "onStop": ON_STOP, "onStopped": ENDS}
# Types of inputs that take a text.
ANYTHING, STRING = "0", "3"
FAILURES = ("failure", "onFailure", "onError")
TEXT_PLUGINS = ("textedit_plugin", "numberedit_plugin", "localizationbox_plugin")
OWN_SCRIPT, DIALOGUE = "a script of its own, which is not run", "a dialogue, which is not held"
# Names of parameters.
TEXT, SPEED, SHAPING, MODES = "Text", "Speed (%)", "Voice shaping (%)", ("Speaking movement mode", "Body language mode")
POSTURE_NAMES, LANGUAGE, ON_CANCEL = ("Name", "Posture name"), "Language", "Trigger timerOutput if cancelled"
WAITS = ("Timeout (s)", "Timeout", "Animation duration (s)")
GO_TO = re.compile(r"goToPosture\(\s*['\"](\w+)['\"]\s*,\s*([\d.]+)\s*\)")
log = logging.getLogger("nao_sim.behaviors")


def read_xar(path: Path) -> Step:
    """What a behavior.xar does.

    Raises:
        ConfigError: It cannot be read, or has boxes that cannot be played.
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
    return _Xar(where).read(root.find("Box"))


class _Xar:
    """Reads one file; counts its boxes, and collects what is refused."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._boxes = self._keys = self._characters = 0
        self._refused: dict[str, list[str]] = {}  # names of boxes by the reason
        self._unlinked: list[str] = []

    def read(self, root: Element) -> Step:
        box = self._box(root, {}, {}, ())
        if self._refused:
            count = sum(map(len, self._refused.values()))
            each = "; ".join(f"{', '.join(names)}: {reason}" for reason, names in self._refused.items())
            raise ConfigError(self._file, f"{count} of its boxes cannot be played: {each}")
        if self._unlinked:
            names = ", ".join(self._unlinked)
            log.warning("%s: no link leads to %s: left out, with the onLoad of their scripts", self._file, names)
        if isinstance(box.step, (Diagram, Timeline)):
            return box.step
        return Diagram((box,), {"": (Link(Act.START, "", 0),)}, ("",))

    def _refuse(self, path: tuple[str, ...], reason: str) -> None:
        names = self._refused.setdefault(reason, [])
        name = repr("/".join(path[1:] or path))
        if name not in names:
            names.append(name)

    def _box(
        self,
        box: Element,
        links: Mapping[str, tuple[Link, ...]],
        inherited: Mapping[str, str],
        above: tuple[str, ...],
    ) -> Box:
        """A box.

        Args:
            links: Of its outputs, by their ids.
            inherited: Parameters of the box that it is in.
            above: Names of the boxes that it is in.
        """
        self._boxes += 1
        name = box.get("name", "?")[:60]
        if len(above) > DEEPEST or self._boxes > MOST_BOXES:
            raise ConfigError(self._file, f"box {name!r} is nested too deep, or the file has too many boxes")
        path, parameters = (*above, name), _parameters(box, inherited)
        script = _script(box)
        kind = kind_of(script)
        timeline = box.find("Timeline")
        if timeline is None or (kind is not Kind.NOTHING and not _holds_anything(timeline)):
            return self._leaf(box, name, path, parameters, script, kind, links)
        if kind is not Kind.NOTHING:
            self._refuse(path, OWN_SCRIPT)
        elif sends_stopped(script, "onInput_onStart") and timeline.find("BehaviorLayer") is not None:
            self._refuse(path, OWN_SCRIPT)  # which ends it at once
        ends = tuple(_ids(box, "Output", ENDS))
        stopped = ends if sends_stopped(script, "onInput_onStop") else ()
        step: Step
        if timeline.get("enable") == "1":
            step = self._timeline(box, timeline, ends, parameters, path)
        else:
            diagram = timeline.find("BehaviorLayer/BehaviorKeyframe/Diagram")
            step = self._diagram(box, diagram, ends, parameters, path)
        return Box(name, step, links, stopped=stopped, restarts=isinstance(step, Timeline))

    # --- diagrams -------------------------------------------------------------------------------------------------

    def _diagram(
        self,
        owner: Element,
        diagram: Element | None,
        ends: tuple[str, ...],
        parameters: Mapping[str, str],
        path: tuple[str, ...],
    ) -> Diagram:
        """The boxes that links lead to from an input of the diagram, or from ALMemory."""
        found: dict[str | None, Element] = {}
        for box in () if diagram is None else diagram.findall("Box"):
            found.setdefault(box.get("id"), box)
        links = [] if diagram is None else diagram.findall("Link")
        leads: dict[str | None, list[str | None]] = {}
        for link in links:
            leads.setdefault(link.get("outputowner"), []).append(link.get("inputowner"))
        begun: set[str | None] = set()
        new: list[str | None] = [DIAGRAM]
        while new:
            targets = set(leads.pop(new.pop(), ()))
            new += targets - begun
            begun |= targets
        boxes = {key: box for key, box in found.items() if key in begun}
        self._unlinked += [repr(box.get("name", "?")[:60]) for key, box in found.items() if key not in begun]
        places = {key: place for place, key in enumerate(boxes)}
        natures = {key: _natures(box, "Input") for key, box in boxes.items()}
        ways: dict[str | None, dict[str, list[Link]]] = {}
        for link in links:
            source, port, target, entry = (
                link.get(each) for each in ("outputowner", "indexofoutput", "inputowner", "indexofinput")
            )
            way = None
            if target == DIAGRAM:
                way = Link(Act.OUT, entry or "")
            elif target in boxes:
                act = {ON_STOP: Act.STOP, ON_LOAD: None, MEMORY: None}.get(natures[target].get(entry), Act.START)
                inner = boxes[target].find("Timeline") is not None
                if act is Act.START and inner and natures[target].get(entry) == ON_EVENT:
                    act = Act.PASS
                way = None if act is None else Link(act, entry or "", places[target])
            if way is not None:
                ports = ways.setdefault(source, {}).setdefault(port or "", [])
                if way not in ports:
                    ports.append(way)
        own = {port: tuple(each) for port, each in ways.get(DIAGRAM, {}).items()}
        of_owner = _natures(owner, "Input")
        loads = [port for port, nature in of_owner.items() if nature == ON_LOAD]
        events = {
            one.get("stm_value_name") or one.get("name", ""): own[one.get("id", "")]
            for one in owner.findall("Input")
            if of_owner.get(one.get("id")) == MEMORY and one.get("id") in own
        }
        made = [
            self._box(box, {k: tuple(v) for k, v in ways.get(key, {}).items()}, parameters, path)
            for key, box in boxes.items()
        ]
        return Diagram(
            tuple(made),
            {port: each for port, each in own.items() if of_owner.get(port) in (ON_START, ON_EVENT)},
            tuple(port for port, nature in of_owner.items() if nature == ON_START),
            tuple(each for port in loads for each in own.get(port, ())),
            events,
            ends,
        )

    # --- timelines ------------------------------------------------------------------------------------------------

    def _timeline(
        self,
        box: Element,
        timeline: Element,
        ends: tuple[str, ...],
        parameters: Mapping[str, str],
        path: tuple[str, ...],
    ) -> Timeline:
        fps = self._within(timeline.get("fps"), DEFAULT_FPS, LOWEST_FPS, HIGHEST_FPS, "frames a second")
        last = LONGEST * fps
        if self._within(timeline.get("start_frame"), 1.0, -last, last, "the first frame of a timeline") > 1.0:
            self._refuse(path, "its timeline does not begin with frame 1")
        ways = self._curves(timeline, fps, path)
        frames = []
        for layer, element in enumerate(timeline.findall("BehaviorLayer")):
            for key_frame in element.findall("BehaviorKeyframe"):
                index = self._within(key_frame.get("index"), 1.0, -last, last, "the frame of a diagram")
                diagram = self._diagram(box, key_frame.find("Diagram"), ends, parameters, path)
                frames.append(KeyFrame(max(0.0, (index - 1.0) / fps), layer, diagram))
        frames.sort(key=lambda frame: frame.begin)
        joints = Joints(ways) if ways else None
        end = self._within(timeline.get("end_frame"), -1.0, -last, last, "the last frame of a timeline")
        length = joints.length if joints is not None else None if frames else 0.0
        if end > 0.0:
            length = end / fps
        if end <= 0.0 and length is not None and frames and frames[-1].begin >= length:
            return Timeline(joints, tuple(frames), None, ends)  # what begins after the last key is played, too
        return Timeline(joints, tuple(frames), length, ends, concludes=length is not None)

    def _curves(self, timeline: Element, fps: float, path: tuple[str, ...]) -> dict[str, JointWay]:
        model, ways = load_model(), {}
        for curve in timeline.findall("ActuatorList/ActuatorCurve"):
            joint = curve.get("actuator", "")
            if curve.get("mute") == "1" or curve.find("Key") is None:
                continue
            if joint not in model.joint_index:
                self._refuse(path, f"a curve moves {joint!r}, which is no joint of a NAO")
                continue
            limits = model.joint(joint)
            keys = curve.findall("Key")
            # Whatever the unit of the curve says: angles are in deg, hands open by shares, and in deg in old files.
            of_hand = limits.is_hand and not any(_number(key.get("value"), 0.0) > 1.0 for key in keys)
            factor = 1.0 if of_hand else math.radians(1.0)
            points = [self._key(key, fps, factor, joint) for key in keys]
            points.sort(key=lambda point: point.time)
            kept = [p for p, after in zip(points, [*points[1:], None]) if after is None or after.time > p.time]
            beyond = [p.angle for p in kept if not limits.lower - 0.02 <= p.angle <= limits.upper + 0.02]
            if beyond:
                allowed = f"{limits.lower:.3f} to {limits.upper:.3f}"
                log.warning(
                    "%s: box %r moves %s to %.3f, its limits are %s: it goes as far as it can",
                    self._file, path[-1], joint, beyond[0], allowed,
                )  # fmt: skip
            kept = [replace(p, angle=min(max(p.angle, limits.lower), limits.upper)) for p in kept]
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

    # --- single boxes ---------------------------------------------------------------------------------------------

    def _leaf(
        self,
        box: Element,
        name: str,
        path: tuple[str, ...],
        parameters: Mapping[str, str],
        script: str,
        kind: Kind,
        links: Mapping[str, tuple[Link, ...]],
    ) -> Box:
        """A box without boxes."""
        failed = tuple(one.get("id", "") for one in box.findall("Output") if one.get("name") in FAILURES)
        done = tuple(one.get("id", "") for one in box.findall("Output") if one.get("id") not in failed)
        texts = self._texts(box)
        if box.find("dialogFile") is not None:
            self._refuse(path, DIALOGUE)
        elif texts is not None:
            return Box(name, Text(texts), links, done)
        elif box.get("plugin"):
            self._refuse(path, OWN_SCRIPT)
        elif kind is Kind.NOTHING:
            if sends_stopped(script, "onInput_onStart"):
                return Box(name, Text({"": ""}), links, done)
        elif kind in (Kind.SAY, Kind.ANIMATED_SAY) and (TEXT in parameters or _takes_text(box)):
            return Box(name, self._say(parameters, kind), links, done, failed, stopped=done)
        elif kind is Kind.POSTURE:
            return Box(name, self._posture(parameters, script, path), links, done, failed, stopped=failed)
        elif kind in (Kind.WAIT, Kind.DELAY):
            on_cancel = done if parameters.get(ON_CANCEL, "0") not in ("0", "") else ()
            step = self._wait(parameters, name, path)
            return Box(name, step, links, done, stopped=on_cancel, restarts=kind is Kind.WAIT)
        elif kind is Kind.LANGUAGE:
            return Box(name, Language(parameters.get(LANGUAGE, "")), links, done, failed)
        else:
            self._refuse(path, OWN_SCRIPT)
        return Box(name, None, links)

    def _texts(self, box: Element) -> dict[str, str] | None:
        """The texts that a box sends to the next one; None for boxes that send none."""
        content = box.find("pluginContent")
        plugin = box.get("plugin", TEXT_PLUGINS[0])
        if content is None or plugin not in TEXT_PLUGINS:
            return None
        if content.find("language") is not None or content.find("english") is not None:
            return {each.tag.capitalize(): self._short(each.text) for each in content if each.tag != "language"}
        text = next((each.text for name in ("text", "number") for each in content.iter(name)), None)
        return {"": self._short(text)}

    def _short(self, text: str | None) -> str:
        text = text or ""
        longest = load_sizes().speech.text_characters
        if len(text) > longest:
            raise ConfigError(self._file, f"has a text of {len(text)} characters, at most {longest} are allowed")
        self._characters += len(text)
        if self._characters > MOST_CHARACTERS:
            raise ConfigError(self._file, f"has texts of more than {MOST_CHARACTERS} characters")
        return " ".join(text.split())

    def _say(self, parameters: Mapping[str, str], kind: Kind) -> Step:
        tags = ""
        for parameter, tag in ((SPEED, "rspd"), (SHAPING, "vct")):
            percent = _number(parameters.get(parameter), 100.0)
            tags += "" if percent == 100.0 else f"\\{tag}={percent:.0f}\\ "
        text, animated = parameters.get(TEXT), kind is Kind.ANIMATED_SAY
        spoken = None if text is None else self._short(text)
        if animated:
            mode = next((parameters[each] for each in MODES if parameters.get(each)), None)
            if mode == "disabled" and spoken and parameters.get("Animation"):
                spoken = "^start({0}) {1} ^wait({0})".format(parameters["Animation"], spoken)
            tags = tags if mode is None else f"^mode({mode}) {tags}"
        if spoken is None:
            return Say(tags, animated, given=True)
        return Say(tags + spoken, animated) if spoken else Wait(0.0)

    def _posture(self, parameters: Mapping[str, str], script: str, path: tuple[str, ...]) -> Step | None:
        written = GO_TO.search(script)
        if written:
            wanted, share = written[1], _number(written[2], 0.8)
        else:
            wanted = next((parameters[each] for each in POSTURE_NAMES if each in parameters), "")
            share = _number(parameters.get(SPEED), 80.0) / 100.0
        known = load_postures().by_name
        if wanted not in known:
            self._refuse(path, f"it goes to posture {wanted[:60]!r}, there are {', '.join(known)}")
            return None
        return GoToPosture(wanted, min(max(share, 0.05), 1.0))

    def _wait(self, parameters: Mapping[str, str], name: str, path: tuple[str, ...]) -> Step | None:
        for parameter in WAITS:
            if parameter in parameters:
                return Wait(self._within(parameters[parameter], 0.0, 0.0, LONGEST, f"the time of box {name!r}"))
        self._refuse(path, f"it waits, and has none of the parameters {', '.join(WAITS)}")
        return None

    def _within(self, text: str | None, default: float, low: float, high: float, what: str) -> float:
        """A number of the file, `default` for what is none; outside of its bounds it is refused."""
        value = _number(text, default)
        if not low <= value <= high:
            raise ConfigError(self._file, f"{what} is {str(text)[:40]}, allowed is {low:g} to {high:g}")
        return value


def _holds_anything(timeline: Element) -> bool:
    return timeline.find(".//Box") is not None or timeline.find(".//Key") is not None


def _natures(box: Element, kind: str) -> dict[str | None, str]:
    """Natures of the inputs or outputs of a box by their ids."""
    ends = reversed(box.findall(kind))  # of two the first counts
    return {end.get("id"): end.get("nature") or NATURES.get(end.get("name", ""), ON_EVENT) for end in ends}


def _ids(box: Element, kind: str, nature: str) -> Iterable[str]:
    return [key or "" for key, one in _natures(box, kind).items() if one == nature]


def _takes_text(box: Element) -> bool:
    return any(one.get("type") in (ANYTHING, STRING) for one in box.findall("Input"))


def _parameters(box: Element, inherited: Mapping[str, str]) -> dict[str, str]:
    """Values of the parameters of a box, some from the box that it is in."""
    values = {}
    for one in box.findall("Parameter"):
        name, value = one.get("name", ""), one.get("value", "")
        values[name] = inherited.get(name, value) if one.get("inherits_from_parent") == "1" else value
    return values


def _script(box: Element) -> str:
    """The script of a box, empty when it does nothing."""
    content = box.find("script/content")
    return "" if content is None or content.text is None else content.text.strip()


def _number(text: str | None, default: float) -> float:
    try:
        value = float(text) if text is not None else default
    except ValueError:
        return default
    return value if math.isfinite(value) else default
