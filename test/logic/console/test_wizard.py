"""The wizard's file, its keys, presses and repetitions, messages of its page, and the head by the camera picture."""

from __future__ import annotations

import json
import math
import threading
from dataclasses import dataclass, field
from functools import partial
from types import SimpleNamespace

import pytest
from click.testing import CliRunner

from nao_library_modules.cli.app import nao
from nao_library_modules.console.access.connections import LATE, console_time
from nao_library_modules.console.pages.wizard_page import WizardParts
from nao_library_modules.console.robots.robot_goals import Press, Presses
from nao_library_modules.console.wizard.desk import PageRights, WizardDesk, WizardSession, read_message
from nao_library_modules.console.wizard.head_pointer import CameraLens, HeadPointer, dragged, head_limits, looked_at
from nao_library_modules.console.wizard.layout import (
    BUTTON_WORDS,
    BadKey,
    EditConflict,
    PressRefused,
    filled_text,
    hex_colour,
    key_of,
    layout_message,
    names_in,
    read_layout,
    text_colour,
)
from nao_library_modules.console.wizard.layout_file import CurrentLayout, LayoutFile, doubts
from nao_library_modules.core.describe import offline_servers
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.files import config_file
from nao_library_modules.core.nao_facts import load_head
from nao_library_modules.studies.commands import ConsoleFileError, NotThere, Stopped
from nao_library_modules.studies.robot_events import EventStream
from nao_library_msgs.srv import DescribeFunctionsRequest

SHIPPED = config_file("console/console.yaml")
TEXT = """\
# said first
names: {participant: "", place: lab}
groups:
  - group: Words
    color: blue
    buttons:
      - {label: Hello, key: "1", say: "Hello {participant}"}
      - {label: Once, key: O, once: true, say: Welcome}
      - {label: Again, repeat: 0.001, say: Hm}
      - {label: All off, key: X, stop: true}
      - {label: Plan, perform: {type: saying, text: "At {place}"}}
      - {label: Other, robot: nao2, say: Hi}
"""


@dataclass
class FakeRun:
    id: str = "goal"
    state: str = "active"
    text: str = ""
    listeners: list = field(default_factory=list)

    def on_end(self, listener):
        self.listeners.append(listener)

    def end(self, state, text=""):
        self.state, self.text = state, text
        for listener in self.listeners:
            listener(self)


class FakeRobot:
    def __init__(self, namespace="/"):
        self.namespace = namespace
        self.events = EventStream(namespace, lambda: 1.0)
        self.sent, self.runs, self.walks = [], [], []
        self.stops = 0
        self.came = threading.Semaphore(0)

    def send(self, command, by="", label="", stops=None, patience=0.0):
        if stops not in (None, self.stops):
            raise Stopped(f"stopped before {label}")
        return self._sent(command)

    def send_goal(self, goal, by="", label="", stops=None, patience=0.0):
        if stops not in (None, self.stops):
            raise Stopped(f"stopped before {label}")
        return self._sent(goal)

    def _sent(self, what):
        self.sent.append(what)
        self.runs.append(FakeRun())
        self.came.release()
        return self.runs[-1]

    def stop(self, by=""):
        self.stops += 1
        self.events.add("stopped", "all")

    def walk(self, *velocity):
        self.walks.append(velocity[:3])


@pytest.fixture
def layout():
    return read_layout(TEXT)


@pytest.fixture
def desk(layout):
    desk = WizardDesk(Presses())
    desk.take_names(layout, "/")
    return desk


@pytest.fixture
def robot():
    return FakeRobot()


def press(desk, robot, layout, label, page="page", **more):
    group, button = next(pair for pair in layout.buttons() if pair[1].label == label)
    by_eva = Press(label, "eva", "/wizard", robot.namespace, group.title, streams=(robot.events,))
    return desk.press(robot, group, button, by_eva, page, **more)


def state(desk, layout, label):
    button = next(button for _, button in layout.buttons() if button.label == label)
    return desk.states(layout, lambda _: "/", "eva").get(button.id, "")


def problems(text):
    with pytest.raises(ConsoleFileError) as caught:
        read_layout(text)
    return [(problem.line, str(problem)) for problem in caught.value.problems]


# --- the file ---------------------------------------------------------------------------------------------------------


def test_the_shipped_file_can_be_read_and_has_a_button_of_each_kind():
    shipped = read_layout(SHIPPED.read_text(encoding="utf-8"))
    kinds = {next(iter(button.action.to_yaml())) for _, button in shipped.buttons()}
    assert kinds >= {"say", "run", "call", "chain", "posture", "walk_to", "perform"}
    assert shipped.templates and "participant" in shipped.names


def test_a_button_has_what_its_line_and_its_group_say(layout):
    _, hello = next(layout.buttons())
    assert (hello.label, hello.key, hello.color, hello.line) == ("Hello", "1", "#0000ff", 7)
    assert hello.names == ("participant",)


@pytest.mark.parametrize(
    "line, told",
    [
        ("{label: A, sai: hi}", "did you mean 'say'"),
        ("{label: A}", "one of say, run, call"),
        ("{label: A, say: hi, run: nod}", "exclude each other"),
        ("{label: A, say: hi, perform: {type: standing}}", "exclude each other"),
        ("{label: A, say: hi, key: w}", "walks"),
        ("{label: A, say: hi, key: Escape}", "always stops"),
        ("{label: A, say: hi, key: '1'}", "each key once"),
        ("{label: A, say: hi, color: gren}", "did you mean 'green'"),
        ("{label: A, say: 'hi {you}'}", "{you} is not among the names"),
        ("{label: A, say: hi, once: true, repeat: 3}", "exclude each other"),
        ("{label: A, say: hi, repeat: -1}", "-1 is not allowed"),
        ("{label: A, say: hi, once: 1}", "neither true nor false"),
        ("{label: Hello, say: hi}", "each label once"),
        ("{label: A, call: NaoLights.setColor, with: {light: [x]}}", "did you mean 'lights'"),
        ("{label: A, perform: 3}", "a designator is wanted"),
        ("just a text", "a mapping"),
    ],
)
def test_a_mistake_is_told_with_its_line_and_what_would_be_right(line, told):
    assert any(at == 8 and told in text for at, text in problems(TEXT.replace("{label: Once, key: O, once: true, "
               "say: Welcome}", line)))  # fmt: skip


@pytest.mark.parametrize(
    "text",
    [
        "[1, 2]",
        "groups: 3",
        "groups: [{group: A, buttons: {}}]",
        "speed: 2",
        "names: [a]",
        "templates: [{participant}]",
        "titel: A",
        "groups: [{buttons: []}]",
        "a: [",
        "a: 1\na: 2",
    ],
)
def test_what_is_no_layout_is_refused(text):
    assert problems(text)


def test_all_mistakes_are_told_in_the_order_of_the_file():
    lines = [line for line, _ in problems(TEXT.replace("blue", "bleu").replace("key: X", "key: q"))]
    assert lines == sorted(lines) and len(lines) >= 2


def test_an_empty_file_is_a_page_without_buttons():
    assert list(read_layout("").buttons()) == []


def test_saving_keeps_the_text_with_its_comments(tmp_path):
    file = LayoutFile(tmp_path / "console.yaml", SHIPPED)
    file.save(TEXT, file.text().revision)
    assert (tmp_path / "console.yaml").read_text() == TEXT


def test_a_file_that_somebody_else_has_changed_is_not_written_over(tmp_path):
    path = tmp_path / "console.yaml"
    path.write_text(TEXT)
    file = LayoutFile(path, SHIPPED)
    revision = file.text().revision
    path.write_text("title: of somebody else\n")
    with pytest.raises(EditConflict):
        file.save(TEXT, revision)
    assert path.read_text() == "title: of somebody else\n"
    file.save(TEXT, None)
    assert path.read_text() == TEXT


def test_a_wrong_text_is_not_saved(tmp_path):
    file = LayoutFile(tmp_path / "console.yaml", SHIPPED)
    with pytest.raises(ConsoleFileError):
        file.save("groups: 3", None)
    assert not (tmp_path / "console.yaml").exists()


def test_pages_keep_the_former_buttons_while_the_file_is_wrong(tmp_path):
    path = tmp_path / "console.yaml"
    path.write_text(TEXT)
    current = CurrentLayout(LayoutFile(path, SHIPPED))
    changes = []
    current.subscribe(lambda: changes.append(current.layout.revision))
    path.write_text("groups: wrong")
    current.look()
    current.look()
    assert len(changes) == 1 and current.problems and len(list(current.layout.buttons())) == 6


def test_a_file_that_is_wrong_from_the_start_is_a_page_without_buttons(tmp_path):
    path = tmp_path / "console.yaml"
    path.write_text("groups: wrong")
    current = CurrentLayout(LayoutFile(path, SHIPPED))
    assert current.problems and list(current.layout.buttons()) == []
    assert WizardDesk(Presses()).values(current.layout, "/") == {}


def test_the_mistakes_of_a_file_are_in_the_terminal_when_the_console_starts(tmp_path, capsys):
    path = tmp_path / "console.yaml"
    path.write_text("groups: wrong")
    WizardParts(SimpleNamespace(settings=SimpleNamespace(buttons=path), presses=Presses()))
    assert f"{path}: groups: a list is wanted" in capsys.readouterr().err


@pytest.mark.parametrize(
    "line, told",
    [
        ("{label: Go, key: Hyper+Q, say: Hi}", "key"),
        ("{label: Go, walk_to: [30, 0, 0]}", "Body: Go: function 2 (moveTo): field values: 30 is unusual"),
        ("{label: Go, call: NaoLights.onn}", "Body: Go: NaoLights has no function 'onn': did you mean 'on'"),
        ("{label: Go, posture: Stnd}", "did you mean 'Stand'"),
    ],
)
def test_a_file_is_checked_in_a_shell_and_nothing_is_started(tmp_path, line, told):
    path = tmp_path / "mine.yaml"
    path.write_text(f"groups:\n  - group: Body\n    buttons:\n      - {line}\n")
    answer = CliRunner().invoke(nao, ["console", "--check", str(path)])
    assert answer.exit_code == 1
    assert f"{path}:4: " in answer.output and told in answer.output


@pytest.mark.parametrize(
    "action, told",
    [
        ("walk_to: [30, 0, 0]", "field values: 30 is unusual: usual is -10..10 m"),
        ("call: nao_audio_out.say, with: {str_param: Hi, volume: 500}", "field volume: 500.0 is not allowed: 0..1"),
    ],
)
def test_the_check_of_the_page_knows_limits(action, told):
    describe = {each.name: partial(each.service.answer, DescribeFunctionsRequest()) for each in offline_servers()}
    robot = SimpleNamespace(namespace="/", describe=lambda server: describe[server]())
    text = f"groups: [{{group: Body, buttons: [{{label: Go, {action}}}]}}]"
    (problem,) = doubts(read_layout(text), robot, None)
    assert told in problem.text


def test_a_file_that_is_right_is_told_as_such(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("groups: [{group: Body, buttons: [{label: Go, walk_to: [30, 0, 0], unusual: true}]}]\n")
    answer = CliRunner().invoke(nao, ["console", "--check", str(path)])
    assert (answer.exit_code, answer.output) == (0, f"nothing wrong was found in {path}: 1 buttons\n")
    assert CliRunner().invoke(nao, ["console", "--check", str(tmp_path / "none.yaml")]).exit_code == 1


# --- keys, colours, texts ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text, key", [("h", "H"), ("H", "H"), ("shift + h", "Shift+H"), ("1", "1"), ("Shift+1", "Shift+1"), ("f2", "F2"),
                  ("+", "+")]
)  # fmt: skip
def test_a_key_has_one_form(text, key):
    assert key_of(text) == key


@pytest.mark.parametrize(
    "text", ["", "w", "E", "Shift+A", "ArrowUp", "up", "Esc", "Tab", " ", "F5", "Ctrl+H", "Shift++", "ab"]
)
def test_keys_that_are_taken_or_that_there_are_not_are_refused(text):
    with pytest.raises(BadKey):
        key_of(text)


@pytest.mark.parametrize("colour", ["red", "yellow", "#1565c0", "black", "white", "#777777"])
def test_text_on_a_colour_can_be_read(colour):
    def luminance(text):
        parts = [int(text[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    background = hex_colour(colour)
    low, high = sorted((luminance(background), luminance(text_colour(background))))
    assert (high + 0.05) / (low + 0.05) >= 4.5


def test_an_unknown_colour_is_refused():
    with pytest.raises(BadGoal):
        hex_colour("gren")


def test_names_in_braces_are_found_and_filled():
    assert names_in({"a": ["{x} and {y}"], "b": "{x}", "c": 3}) == ("x", "y")
    assert filled_text("{x}, {z}", {"x": "Ada {z}", "z": "Bo"}) == "Ada {z}, Bo"


def test_the_page_gets_each_key_with_its_button(layout):
    message = json.loads(json.dumps(layout_message(layout)))
    labels = {button["id"]: button["label"] for group in message["layout"]["groups"] for button in group["buttons"]}
    assert labels[message["layout"]["keys"]["X"]] == "All off"
    assert message["walking"]["W"] == message["walking"]["ArrowUp"] == [1.0, 0.0, 0.0]


# --- presses ----------------------------------------------------------------------------------------------------------


def test_a_press_sends_the_text_with_the_name_and_is_logged(desk, robot, layout):
    desk.set_values("/", {"participant": "  Ada  L. "})
    press(desk, robot, layout, "Hello")
    assert robot.sent[0].chain == (("say", {"str_param": "Hello Ada L."}),)
    (event,) = robot.events.last()
    assert (event.kind, event.by, event.data["button"]) == ("pressed", "eva", "Hello")
    assert state(desk, layout, "Hello") == "runs"
    robot.runs[0].end("succeeded")
    assert state(desk, layout, "Hello") == ""


def test_a_press_with_an_empty_name_says_nothing(desk, robot, layout):
    with pytest.raises(PressRefused, match="participant"):
        press(desk, robot, layout, "Hello")
    assert not robot.sent


def test_names_are_of_one_robot(desk, layout):
    desk.set_values("/", {"participant": "Ada"})
    assert desk.values(layout, "/")["participant"] == "Ada"
    assert desk.values(layout, "/nao2/") == {"participant": "", "place": "lab"}


def test_a_button_for_once_is_pressed_once_until_it_is_armed(desk, robot, layout):
    press(desk, robot, layout, "Once")
    robot.runs[0].end("succeeded")
    assert state(desk, layout, "Once") == "used"
    with pytest.raises(PressRefused):
        press(desk, robot, layout, "Once", page="another page")
    desk.arm("/")
    press(desk, robot, layout, "Once")
    assert len(robot.sent) == 2


def test_a_button_for_once_that_could_not_be_sent_may_be_pressed_again(desk, robot, layout):
    robot.send = lambda *_, **__: (_ for _ in ()).throw(BadGoal("server", "x", "a server"))
    with pytest.raises(BadGoal):
        press(desk, robot, layout, "Once")
    assert state(desk, layout, "Once") == ""


def test_a_repetition_goes_on_until_it_is_pressed_again(desk, robot, layout):
    press(desk, robot, layout, "Again")
    for number in range(3):
        assert robot.came.acquire(timeout=60.0)
        assert state(desk, layout, "Again") == "repeats"
        robot.runs[number].end("succeeded")
    assert robot.came.acquire(timeout=60.0)
    press(desk, robot, layout, "Again")
    robot.runs[3].end("succeeded")
    assert state(desk, layout, "Again") == "" and len(robot.sent) == 4


@pytest.mark.parametrize("end", ["failure", "stop", "page"])
def test_a_repetition_ends_with_a_failure_a_stop_and_its_page(end, desk, robot, layout):
    press(desk, robot, layout, "Again")
    if end == "stop":
        robot.stop()
    elif end == "page":
        desk.leave("page")
    robot.runs[0].end("aborted" if end == "failure" else "succeeded")
    assert state(desk, layout, "Again") == ("aborted" if end == "failure" else "") and len(robot.sent) == 1


def ended_repetition(robot, layout, desk):
    """End the first run, and wait for the note that there are no more repetitions; its text."""
    told, notes = threading.Event(), []
    robot.events.subscribe(lambda event: event.kind == "failed" and (notes.append(event.text), told.set()))
    robot.runs[0].end("succeeded")
    assert told.wait(60.0)
    assert state(desk, layout, "Again") == "not sent" and len(robot.sent) == 1
    return notes[0]


def test_a_repetition_ends_when_its_user_may_not_move_the_robot_any_more(desk, robot, layout):
    press(desk, robot, layout, "Again", refusal=lambda: "bob holds the controls")
    assert "bob holds the controls" in ended_repetition(robot, layout, desk)


@pytest.mark.parametrize("label", ["Once", "Again", "Plan"])
def test_what_was_pressed_before_a_stop_is_not_sent_after_it(label, desk, robot, layout):
    pressed_at = robot.stops
    robot.stop()
    with pytest.raises(Stopped):
        press(desk, robot, layout, label, stops=pressed_at)
    assert not robot.sent and state(desk, layout, label) == ""


def test_a_repetition_is_not_sent_after_a_stop_that_nobody_has_told_of_yet(desk, robot, layout):
    press(desk, robot, layout, "Again")
    robot.stops += 1
    assert "no more repetitions" in ended_repetition(robot, layout, desk)


def test_a_designator_goes_to_the_plans(desk, robot, layout):
    press(desk, robot, layout, "Plan")
    assert robot.sent[0].server == "perform_designator"
    assert "At lab" in robot.sent[0].goal.designator


@pytest.mark.parametrize("end, word", [("aborted", "failed"), ("rejected", "refused"), ("preempted", "stopped"),
                                      ("recalled", "stopped before it began"), ("lost", "lost")])  # fmt: skip
def test_a_button_says_how_its_goal_has_failed_until_its_user_has_looked(end, word, desk, robot, layout):
    press(desk, robot, layout, "Once")
    robot.runs[0].end(end, "no voice")
    assert state(desk, layout, "Once") == end and BUTTON_WORDS[end] == word
    (failed,) = desk.presses.unseen("eva")
    assert (failed.press.label, failed.reason) == ("Once", "no voice")
    event = robot.events.last()[-1]
    assert (event.kind, event.data["button"], event.data["state"]) == ("failed", "Once", end)
    desk.presses.seen("eva")
    assert state(desk, layout, "Once") == "used"


def test_a_button_that_failed_and_runs_again_runs(desk, robot, layout):
    desk.set_values("/", {"participant": "Ada"})
    for _ in range(2):
        press(desk, robot, layout, "Hello")
    robot.runs[0].end("aborted")
    assert state(desk, layout, "Hello") == "runs"
    robot.runs[1].end("succeeded")
    assert state(desk, layout, "Hello") == "aborted"


def test_a_repetition_that_fails_says_that_it_is_over(desk, robot, layout):
    press(desk, robot, layout, "Again")
    robot.runs[0].end("lost", "it died")
    assert [each.reason for each in desk.presses.unseen("eva")] == ["it died; no more repetitions"]


def test_free_texts_are_filled_and_kept_each_once_the_newest_first(desk, robot):
    for text in ("One.", "At {place}", "One."):
        desk.say(robot, text, False, "eva")
    assert desk.history("/") == ["One.", "At {place}"]
    assert robot.sent[1].chain == (("say", {"str_param": "At lab"}),)
    with pytest.raises(PressRefused):
        desk.say(robot, "  ", False, "eva")


# --- messages of a page -----------------------------------------------------------------------------------------------


@pytest.fixture
def pages(desk, robot, layout):
    made = SimpleNamespace(refusal="", known=True, operator=True, points=[], other=FakeRobot("/nao2/"), closed=[])
    pointer = SimpleNamespace(point=lambda *a: made.points.append(a), close=lambda: made.closed.append(True))
    rights = PageRights("eva", lambda _: made.refusal, lambda: made.known, lambda: made.operator)
    found = {}

    def find(name):
        return found.setdefault(name, made.other)

    made.session = WizardSession("page", robot, desk, lambda: layout, rights, find, found.get, lambda _robot: pointer)
    made.take = lambda message: made.session.take(*read_message(json.dumps(message)))
    made.failed = lambda: [failed.reason for failed in desk.presses.unseen("eva")]
    return made


def test_a_velocity_is_passed_on_within_its_limits(pages, robot):
    assert pages.take({"walk": [2, 0, -0.5]}) == ""
    assert robot.walks == [(1.0, 0.0, -0.5)]


def test_a_page_that_leaves_stops_what_it_walked(pages, robot):
    pages.take({"walk": [1, 0, 0]})
    pages.session.leave()
    assert robot.walks[-1] == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("stop", ["of another page", "of this page"])
def test_a_walk_that_is_held_does_not_go_on_after_a_stop(stop, pages, robot):
    pages.take({"walk": [1, 0, 0]})
    if stop == "of another page":
        robot.stop()
    else:
        pages.take({"stop": True})
    robot.walks.clear()
    assert "let go" in pages.take({"walk": [1, 0, 0]}) and pages.session.must_let_go
    assert pages.take({"walk": [0, 0, 0]}) == "" and not robot.walks
    assert pages.take({"walk": [0.5, 0, 0]}) == "" and robot.walks == [(0.5, 0.0, 0.0)]


def test_a_stop_while_a_velocity_is_passed_on_ends_it(pages, robot):
    passed = robot.walk

    def stopped_before(*velocity):
        robot.walk = passed
        robot.stop()
        passed(*velocity)

    robot.walk = stopped_before
    pages.take({"walk": [1, 0, 0]})
    assert robot.walks == [(1.0, 0.0, 0.0), (0.0, 0.0, 0.0)]


def test_a_press_that_comes_late_is_not_sent_and_says_so(pages, desk, robot, layout):
    for age in (60.0, 0.0):
        pages.take({"press": "2", "revision": layout.revision, "at": console_time() - age})
    assert len(robot.sent) == 1 and "late" in pages.failed()[0]


def test_a_button_that_stops_is_not_refused_because_it_comes_late(pages, robot, layout):
    pages.take({"press": "4", "revision": layout.revision, "at": console_time() - 60.0})
    assert robot.stops == 1


def test_a_press_that_cannot_be_sent_says_so_on_its_button(pages, desk, robot, layout):
    robot.send = lambda *_, **__: (_ for _ in ()).throw(NotThere("the server nao_audio_out does not run"))
    assert pages.take({"press": "2", "revision": layout.revision, "via": "key"}) == ""
    assert pages.failed() == ["the server nao_audio_out does not run"]
    assert pages.session.states() == {"2": "not sent"}
    event = robot.events.last()[-1]
    assert (event.kind, event.data["button"], event.data["via"]) == ("failed", "Once", "key")


def test_a_button_of_another_robot_fails_on_the_page_where_it_was_pressed(pages, robot, layout):
    pages.take({"press": "6", "revision": layout.revision})
    pages.other.runs[0].end("aborted", "no voice")
    assert pages.failed() == ["no voice"] and pages.session.states() == {"6": "aborted"}
    for events in (robot.events, pages.other.events):
        assert [event.kind for event in events.last()] == ["pressed", "failed"]
        assert events.last()[-1].data["of"] == "/nao2/"


def test_a_robot_that_is_not_there_is_told_on_the_button_that_is_for_it(pages, layout):
    pages.session._find = lambda name: (_ for _ in ()).throw(NotThere(f"there is no robot {name!r}"))
    pages.take({"press": "6", "revision": layout.revision})
    assert pages.failed() == ["there is no robot 'nao2'"] and pages.session.states() == {"6": "not sent"}


def test_an_error_that_nobody_has_thought_of_is_told_as_well(pages, robot, layout):
    robot.send = lambda *_, **__: (_ for _ in ()).throw(OSError("no route"))
    with pytest.raises(OSError):
        pages.take({"press": "2", "revision": layout.revision})
    assert "no route" in pages.failed()[0]


def test_what_an_observer_tries_is_not_in_the_log(pages, robot, layout):
    pages.refusal, pages.operator = "observers look on", False
    pages.take({"press": "2", "revision": layout.revision})
    assert pages.failed() == ["observers look on"] and robot.events.last() == []


def test_a_press_that_has_waited_over_a_stop_is_refused(pages, robot, layout):
    arrived = pages.session.stops()
    robot.stop()
    kind, message = read_message(json.dumps({"press": "2", "revision": layout.revision}))
    pages.session.take(kind, message, arrived)
    assert "stopped" in pages.failed()[0] and not robot.sent


def test_after_the_page_has_left_nothing_is_done_but_a_stop(pages, robot, layout):
    pages.take({"head": {"kind": "click", "camera": "top", "x": 0, "y": 0}})
    pages.session.leave()
    for message in ({"walk": [1, 0, 0]}, {"press": "2", "revision": layout.revision},
                    {"head": {"kind": "click", "camera": "top", "x": 0, "y": 0}}):  # fmt: skip
        pages.take(message)
    assert not robot.walks and not robot.sent and len(pages.points) == 1
    pages.take({"press": "4", "revision": layout.revision})
    assert robot.stops == 1
    assert not pages.closed
    pages.session.close_pointer()
    assert pages.closed == [True]


def test_a_repetition_whose_page_leaves_while_it_begins_is_sent_once(pages, desk, robot, layout):
    allowed = pages.session._rights.refusal

    def leaving(namespace):
        pages.session.leave()
        return allowed(namespace)

    pages.session._rights = PageRights("eva", leaving, lambda: True, lambda: True)
    pages.take({"press": "3", "revision": layout.revision})
    assert "page is gone" in ended_repetition(robot, layout, desk)


def test_who_may_not_move_the_robot_does_not(pages, robot, layout):
    pages.refusal = "bob holds the controls"
    for message in ({"walk": [1, 0, 0]}, {"head": {"kind": "click", "camera": "top", "x": 0, "y": 0}}):
        assert pages.take(message) == "bob holds the controls"
    pages.take({"press": "2", "revision": layout.revision})
    assert pages.failed() == ["bob holds the controls"]
    assert not robot.walks and not robot.sent and not pages.points


def test_a_stop_button_works_without_the_controls(pages, robot, layout):
    pages.refusal = "bob holds the controls"
    assert pages.take({"press": "4", "revision": layout.revision}) == ""
    assert robot.stops == 1


def test_a_press_of_a_former_layout_is_refused(pages, robot):
    pages.take({"press": "2", "revision": "another", "label": "Hello", "group": "Words"})
    (failed,) = pages.session._desk.presses.unseen("eva")
    assert "changed" in failed.reason and failed.press.label == "Hello" and not robot.sent


def test_a_button_of_another_robot_goes_there_and_a_stop_too(pages, robot, layout):
    assert pages.take({"stop": True}) == "" and pages.other.stops == 0  # it is not known yet
    assert pages.take({"press": "6", "revision": layout.revision}) == ""
    assert len(pages.other.sent) == 1 and not robot.sent
    assert pages.take({"stop": True}) == "" and pages.other.stops == 1
    pages.known = False
    assert "logged out" in pages.take({"stop": True}) and pages.other.stops == 1


def test_who_looks_on_may_stop_and_do_nothing_else(pages, robot, layout):
    pages.refusal = "observers look on"
    assert pages.take({"press": "4", "revision": layout.revision}) == "" and robot.stops == 1
    pages.take({"press": "2", "revision": layout.revision})
    assert pages.failed() == ["observers look on"] and not robot.sent


def test_what_waited_in_a_network_that_was_cut_moves_nothing(pages, robot, layout):
    old = console_time() - 2 * LATE
    for message in ({"walk": [1, 0, 0]}, {"head": {"kind": "click", "camera": "top", "x": 0, "y": 0}}):
        assert "late" in pages.take({**message, "at": old})
    assert not robot.walks and not pages.points


def test_a_stop_and_the_end_of_a_walk_are_never_too_late(pages, robot, layout):
    old = console_time() - 2 * LATE
    pages.take({"walk": [1, 0, 0], "at": console_time()})
    assert pages.take({"walk": [0, 0, 0], "at": old}) == "" and robot.walks[-1] == (0.0, 0.0, 0.0)
    assert pages.take({"press": "4", "revision": layout.revision, "at": old}) == "" and robot.stops == 1


@pytest.mark.parametrize("stamp", [None, "now", True, math.nan])
def test_a_stamp_that_is_none_holds_nothing_up(stamp, pages, robot):
    assert pages.take({"walk": [1, 0, 0], "at": stamp}) == "" and robot.walks


def test_an_integer_that_no_float_holds_is_a_velocity_at_its_limit(pages, robot):
    assert pages.take({"walk": [10**400, -(10**400), 0]}) == ""
    assert robot.walks == [(1.0, -1.0, 0.0)]


@pytest.mark.parametrize("message", [{"walk": [1, 0]}, {"walk": ["a", 0, 0]}, {"walk": [True, 0, 0]}, {"walk": None},
                                     {"head": 3}, {"head": {"kind": "jump"}}, {"head": {"kind": "click"}}])  # fmt: skip
def test_values_that_make_no_sense_are_told_and_move_nothing(message, pages, robot):
    assert pages.take(message)
    assert not robot.walks and not pages.points


@pytest.mark.parametrize("text", ["", "[]", "{}", "{", '{"walk": [], "stop": true}', "[" * 4000, "x" * 5000])
def test_what_is_no_message_is_refused(text):
    with pytest.raises(ValueError):
        read_message(text)


# --- the head ---------------------------------------------------------------------------------------------------------


@pytest.fixture
def pointer(robot, monkeypatch):
    """Points on a robot; angles that it sends are in `sent`."""
    pointer = HeadPointer(robot)
    pointer.sent = []
    pointer._publisher = SimpleNamespace(publish=pointer.sent.append)
    monkeypatch.setattr(pointer, "_lens", lambda camera: LENS)
    monkeypatch.setattr(pointer, "_angles", lambda: (0.0, 0.0))
    return pointer


def test_a_head_that_is_pointed_before_a_stop_is_not_turned_after_it(pointer, robot, monkeypatch):
    monkeypatch.setattr(pointer, "_angles", lambda: robot.stop() or (0.0, 0.0))
    with pytest.raises(Stopped):
        pointer.point("click", "top", 0.7, 0.5, "eva", robot.stops)
    assert pointer.sent == []


def test_a_stop_ends_a_drag_of_the_head(pointer, robot):
    pointer.point("start", "top", 0.5, 0.5, "eva")
    pointer.point("drag", "top", 0.6, 0.5, "eva")
    robot.stop()
    with pytest.raises(Stopped):
        pointer.point("drag", "top", 0.7, 0.5, "eva")
    pointer.point("drag", "top", 0.8, 0.5, "eva")
    assert len(pointer.sent) == 1


WIDE, HIGH = math.radians(60.97), math.radians(47.64)
LENS = CameraLens(0.5 / math.tan(WIDE / 2), 0.5 / math.tan(HIGH / 2))


@pytest.mark.parametrize("camera, pitch", [("CameraTop", 0.1), ("CameraBottom", -0.3)])
def test_a_click_into_the_middle_leaves_the_head(camera, pitch):
    head = load_head()
    assert looked_at(head, head.cameras[camera], LENS, (0.5, 0.5), (0.4, pitch)) == pytest.approx((0.4, pitch))


def test_a_click_turns_the_head_there():
    head = load_head()
    yaw, pitch = looked_at(head, head.cameras["CameraTop"], LENS, (1.0, 0.5), (0.0, 0.0))
    assert yaw == pytest.approx(-WIDE / 2, abs=0.03) and abs(pitch) < 0.03
    yaw, pitch = looked_at(head, head.cameras["CameraTop"], LENS, (0.5, 1.0), (0.0, 0.0))
    assert pitch == pytest.approx(HIGH / 2, abs=0.03) and yaw == pytest.approx(0.0)


def test_what_is_dragged_stays_under_the_pointer():
    assert dragged(LENS, (0.0, 0.5), (0.5, 0.5), (0.0, 0.0)) == pytest.approx((WIDE / 2, 0.0))
    assert dragged(LENS, (0.5, 0.5), (0.5, 1.0), (0.0, 0.0)) == pytest.approx((0.0, -HIGH / 2))


def test_the_head_is_not_told_more_than_its_joints_can():
    (low, high), (up, down) = head_limits()
    assert dragged(LENS, (0.0, 0.0), (1.0, 1.0), (high - 0.1, up + 0.1)) == (high, up)
    assert (low, down) == (-2.08567, 0.514872)


def test_a_lens_is_read_from_pixels():
    lens = CameraLens.of(320, 240, (280.0, 0.0, 160.0, 0.0, 281.0, 120.0, 0.0, 0.0, 1.0))
    assert lens.slopes(1.0, 0.5) == pytest.approx((160.0 / 280.0, 0.0))
    with pytest.raises(ValueError):
        CameraLens.of(0, 0, (0.0,) * 9)
