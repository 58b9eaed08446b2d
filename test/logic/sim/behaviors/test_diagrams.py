"""Diagrams of Choregraphe: which boxes begin when, and how they end."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from choregraphe import (
    EVENT,
    FAILED,
    LOAD,
    NOD,
    SAYS,
    STOP,
    TOUCHED,
    box,
    curve,
    diagram,
    goes,
    link,
    memory,
    parameters,
    project,
    says,
    text_edit,
    timeline,
    to_end,
    waits,
)

from nao_sim_bridge.base.tasks import Task, TaskIds
from nao_sim_bridge.behaviors.player import BehaviorPlayer
from nao_sim_bridge.behaviors.steps import Behavior, BehaviorFailed
from nao_sim_bridge.behaviors.xar import xar_step
from nao_sim_bridge.model.model_reader import load_model

TICK, SPEAKS = 0.1, 0.5
"""Of the time here, and of any text, s."""


class Stage:
    """A limp robot that speaks; what was begun is in `told`, with the time at which it was."""

    def __init__(self):
        self.told, self.listeners, self.spoken = [], {}, "English"
        self.reaches, self.ends = True, []
        model = load_model()
        joints = SimpleNamespace(stiffnesses=np.zeros(len(model.joints)))
        robot = SimpleNamespace(leds=SimpleNamespace(values=()), model=model, joints=joints)
        self.simulation = SimpleNamespace(
            robot=robot, time=0.0, task_ids=TaskIds(), after_tick=[], after_reset=[], snapshot=None
        )
        self.player = BehaviorPlayer(self.simulation, None, None, self.say, self.go_to, self)

    def language(self):
        return self.spoken

    def set_language(self, name):
        self.spoken = name

    def listen(self, key, listener):
        self.listeners[key] = listener
        return lambda: self.listeners.pop(key)

    def say(self, text, animated):
        self.tell(text)
        return self.after(SPEAKS)

    def go_to(self, name, speed):
        self.tell(name)
        return self.after(SPEAKS, self.reaches)

    def tell(self, what):
        self.told.append((round(self.simulation.time, 3), what))

    def after(self, time, result=None):
        command, work = Task("command", 0), Task("work", 0)
        self.ends.append((self.simulation.time + time, work, result))
        command.finish(work)
        return command

    def play(self, boxes, *links, inputs="", seconds=0.0):
        """Begin with a project, and let some time pass."""
        step = xar_step(project(boxes, "".join(links), inputs), "file")
        task = self.player.start(Behavior("mine", step))
        self.advance(seconds)
        return task

    def advance(self, seconds):
        for _ in range(round(seconds / TICK)):
            self.simulation.time += TICK
            for end in [end for end in self.ends if end[0] <= self.simulation.time + 1e-9]:
                self.ends.remove(end)
                end[1].finish(end[2])
            for call in self.simulation.after_tick:
                call(self.simulation)

    @property
    def texts(self):
        return [what for _, what in self.told]


@pytest.fixture
def stage():
    return Stage()


def test_only_what_a_link_from_onstart_leads_to_begins(stage):
    boxes = says(1, "started") + says(2, "touched") + says(3, "stopped")
    stage.play(boxes, link(0, 1), link(0, 2, end=TOUCHED), link(0, 3, end=STOP), inputs=memory("Touched"), seconds=2.0)
    assert stage.told == [(0.0, "started")]


def test_an_event_of_almemory_begins_its_box_each_time_until_the_end(stage):
    boxes = says(1, "touched") + waits(2, 3.0)
    task = stage.play(
        boxes, link(0, 1, end=TOUCHED), link(0, 2), to_end(2), inputs=memory("FrontTactilTouched"), seconds=1.0
    )
    assert stage.told == []
    for _ in range(2):
        stage.listeners["FrontTactilTouched"](1.0)
        stage.advance(1.0)
    assert stage.told == [(1.0, "touched"), (2.0, "touched")]
    assert task.finished and not stage.listeners, "the end was reached, and nobody listens any more"


def test_an_unwired_diagram_does_nothing_and_that_is_told(stage, caplog):
    task = stage.play(says(1, "never") + box(2, "Nod", NOD))
    assert task.finished and stage.told == []
    assert "no link leads to 'Say never', 'Nod'" in caplog.text and "nothing in it is left to happen" in caplog.text


@pytest.mark.parametrize("reaches, then", [(True, "there"), (False, "lost")])
def test_success_and_failure_are_ways_of_their_own(stage, reaches, then):
    stage.reaches = reaches
    boxes = goes(1, "Crouch") + says(2, "there") + says(3, "lost")
    task = stage.play(boxes, link(0, 1), link(1, 2), link(1, 3, end=FAILED), to_end(2), to_end(3), seconds=2.0)
    assert stage.texts == ["Crouch", then] and task.finished and task.error is None


def test_a_failure_without_a_way_fails_the_behaviour(stage):
    stage.reaches = False
    task = stage.play(goes(1, "Crouch"), link(0, 1), to_end(1), seconds=2.0)
    assert isinstance(task.error, BehaviorFailed) and "posture Crouch" in str(task.error)


def test_the_end_of_a_diagram_stops_what_runs_in_it(stage, caplog):
    boxes = waits(1, 1.0) + waits(2, 5.0) + says(3, "never")
    task = stage.play(boxes, link(0, 1), link(0, 2), to_end(1), link(2, 3), seconds=1.1)
    assert task.finished and "left to happen" not in caplog.text
    stage.advance(6.0)
    assert stage.told == []


def test_a_link_to_onstop_stops_a_box(stage):
    boxes = waits(1, 1.0) + waits(2, 2.0) + says(3, "never")
    task = stage.play(boxes, link(0, 1), link(0, 2), link(1, 2, STOP), link(2, 3), seconds=3.0)
    assert task.finished and stage.told == []


def test_a_wait_that_is_stopped_goes_on_where_its_parameter_says_so(stage):
    boxes = waits(1, 1.0) + waits(2, 2.0, on_cancel=1) + says(3, "cancelled")
    stage.play(boxes, link(0, 1), link(0, 2), link(1, 2, STOP), link(2, 3), seconds=3.0)
    assert stage.told == [(1.0, "cancelled")]


def test_a_wait_that_begins_again_while_it_waits_begins_anew(stage):
    boxes = waits(1, 1.0) + waits(2, 1.5) + says(3, "once")
    stage.play(boxes, link(0, 1), link(0, 2), link(1, 2), link(2, 3), seconds=4.0)
    assert stage.told == [(2.5, "once")]


def test_boxes_may_go_round_until_something_ends_them(stage):
    boxes = waits(1, 1.0) + says(2, "again") + waits(3, 4.0)
    task = stage.play(boxes, link(0, 1), link(1, 2), link(2, 1), link(0, 3), to_end(3), seconds=5.0)
    assert stage.told == [(1.0, "again"), (2.5, "again")] and task.finished


def test_signals_that_go_round_in_no_time_fail_the_behaviour(stage):
    task = stage.play(text_edit(1, "a") + text_edit(2, "b"), link(0, 1), link(1, 2), link(2, 1))
    assert isinstance(task.error, BehaviorFailed) and "signals go round without end" in str(task.error)


def test_a_text_goes_to_the_box_that_says_it(stage):
    boxes = text_edit(1, "Good day") + box(2, "Say Text", "", SAYS, text_input=True)
    stage.play(boxes, link(0, 1), link(1, 2))
    assert stage.texts == ["Good day"]


def test_localized_text_is_that_of_the_language_of_the_robot(stage):
    texts = "<pluginContent><language>English</language><english>Hello</english><german>Hallo</german></pluginContent>"
    local = box(1, "Localized Text", texts, "self.onStopped(self.sentences[sDefaultLang])")
    speaks = box(3, "Set Language", parameters(Language="German"), "self.tts.setLanguage(lang)")
    boxes = local + box(2, "Say Text", "", SAYS, text_input=True) + speaks + waits(4, 1.0)
    stage.play(boxes, link(0, 1), link(1, 2), link(0, 4), link(4, 3), link(3, 1), seconds=2.0)
    assert stage.texts == ["Hello", "Hallo"]


def test_outputs_of_a_box_with_boxes_go_where_their_links_go(stage):
    inside = diagram(waits(1, 1.0) + waits(2, 5.0), link(0, 1) + link(0, 2) + to_end(1, FAILED) + to_end(2))
    boxes = box(1, "Inner", inside) + says(2, "on the way") + says(3, "over")
    task = stage.play(boxes, link(0, 1), link(1, 2, end=FAILED), link(1, 3), to_end(3), seconds=6.0)
    assert stage.told == [(1.0, "on the way"), (5.0, "over")] and task.finished


def test_onstop_of_a_box_with_boxes_stops_all_in_it(stage):
    inner = box(1, "Inner", diagram(waits(1, 2.0) + says(2, "never"), link(0, 1) + link(1, 2)))
    stage.play(inner + waits(2, 1.0), link(0, 1), link(0, 2), link(2, 1, STOP), seconds=4.0)
    assert stage.told == []


def test_an_event_input_is_heard_by_a_box_that_was_begun_and_by_no_other(stage):
    heard = f'<Input name="onNext" type="1" nature="1" id="{EVENT}"/>'
    inner = box(1, "Inner", diagram(says(1, "next"), link(0, 1, end=EVENT)), inputs=heard)
    boxes = inner + waits(2, 1.0) + waits(3, 2.0)
    stage.play(boxes, link(0, 2), link(0, 3), link(2, 1, EVENT), seconds=1.5)
    assert stage.told == [], "nothing has begun it"
    stage.told.clear()
    stage.play(boxes, link(0, 1), link(0, 2), link(2, 1, EVENT), seconds=1.5)
    assert stage.texts == ["next"]


def test_diagrams_of_a_timeline_begin_when_they_are_loaded_and_end_with_it(stage):
    first = says(1, "first") + waits(2, 5.0) + says(3, "never")
    frames = {
        1: first + link(0, 1, end=LOAD) + link(0, 2, end=LOAD) + link(2, 3),
        11: says(1, "second") + link(0, 1, end=LOAD),
    }
    moves = box(1, "Move", timeline(curve("HeadYaw", (20, 1.0)), diagrams=frames))
    task = stage.play(moves + says(2, "over"), link(0, 1), link(1, 2), to_end(2), seconds=7.0)
    assert stage.told == [(0.0, "first"), (1.0, "second"), (2.0, "over")] and task.finished


def test_a_timeline_ends_with_its_last_frame(stage):
    moves = box(1, "Move", timeline(curve("HeadYaw", (20, 1.0), (50, 2.0)), end=10))
    stage.play(moves + says(2, "over"), link(0, 1), link(1, 2), seconds=6.0)
    assert stage.told == [(1.0, "over")]


def test_an_empty_timeline_ends_at_once(stage):
    stage.play(box(1, "Later", timeline()) + says(2, "over"), link(0, 1), link(1, 2))
    assert stage.texts == ["over"]


def test_a_timeline_without_keys_ends_when_a_signal_ends_it(stage):
    frames = {1: waits(1, 2.0) + link(0, 1, end=LOAD) + to_end(1)}
    stage.play(box(1, "Show", timeline(diagrams=frames)) + says(2, "over"), link(0, 1), link(1, 2), seconds=3.0)
    assert stage.told == [(2.0, "over")]


def test_what_is_stopped_from_outside_begins_nothing_more(stage):
    task = stage.play(waits(1, 1.0) + says(2, "never"), link(0, 1), link(1, 2), seconds=0.5)
    task.kill()
    stage.advance(2.0)
    assert stage.told == []


def test_parameters_of_a_box_may_be_those_of_the_box_around_it(stage):
    speed = '<Parameter name="Speed (%)" inherits_from_parent="1" value="100"/>'
    speaks = box(2, "Say Text", speed, SAYS, text_input=True)
    inside = diagram(text_edit(1, "Hi") + speaks, link(0, 1) + link(1, 2) + to_end(2))
    stage.play(box(1, "Say", parameters(**{"Speed (%)": 80}) + inside), link(0, 1), to_end(1))
    assert stage.texts == ["\\rspd=80\\ Hi"]


def test_an_empty_script_ends_only_when_it_says_so(stage):
    ends = "class MyClass(GeneratedClass):\n    def onInput_onStart(self):\n        self.onStopped()\n        pass\n"
    silent = ends.replace("self.onStopped()", "#self.onStopped() #activate the output of the box")
    boxes = box(1, "Silent", "", silent) + says(2, "never") + box(3, "Ends", "", ends) + says(4, "then")
    stage.play(boxes, link(0, 1), link(1, 2), link(0, 3), link(3, 4))
    assert stage.texts == ["then"]
