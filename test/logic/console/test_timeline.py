"""Behaviours on tracks: where boxes are, what edits make of the text, and what a run shows."""

from __future__ import annotations

import textwrap
from types import SimpleNamespace

import pytest

from nao_library_modules.behaviors import BehaviorStore
from nao_library_modules.behaviors.server_functions import FunctionTables
from nao_library_modules.console.timeline.document import BehaviorDocument, EditRefused
from nao_library_modules.console.timeline.tracks import BY_ORDER, BY_TIME, FIXED, RunView, tracks_of
from nao_library_modules.core.files import config_file

TEXT = """\
    help: A test.   # kept
    parameters:
      pause: {default: 0.5, help: between}
    do:
      - wait: 1.0
      - parallel:
          - NaoMotion.angleInterpolation: {names: [HeadYaw], angles: [0.1, 0.0], times: [1.0, 2.0], stiffness: 1.0}
          - [{wait: "${pause}"}, {NaoLights.fadeRGB: {lights: [FaceLeds], str_param: red, duration: 3.0, time: 1.0}}]
      - timeline:
          - {NaoLights.fade: {lights: [FaceLeds], i_values: [0.5], duration: 1.0}, at: 0.5, label: eyes}
          - {nao_audio_out.say: {str_param: Hi}, at: eyes.end + 0.5}
          - {NaoLights.fade: {lights: [FaceLeds], i_values: [0.0], duration: 1.0}, at: "${pause * 10}"}
          - {barrier: all}
      - repeat: 3
        do: [{wait: 2.0, label: pause}]
    """


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    return BehaviorStore(tmp_path_factory.mktemp("behaviors"), config_file("behaviors"))


@pytest.fixture(scope="module")
def tables():
    return FunctionTables()


@pytest.fixture
def document():
    return BehaviorDocument("mine", textwrap.dedent(TEXT))


@pytest.fixture
def boxes(document, store, tables):
    return {box.path: box for box in tracks_of(document, store.load, tables).boxes}


def test_steps_follow_each_other(boxes):
    assert (boxes["1"].begin, boxes["1"].end, boxes["2"].begin) == (0.0, 1.0, 1.0)


def test_a_parallel_is_over_when_its_longest_branch_is(boxes):
    assert boxes["2"].end == boxes["2.2"].end == pytest.approx(1.0 + 0.5 + 3.0 + 1.0)
    assert boxes["2.1"].end == 3.0


def test_branches_have_rows_of_their_own(boxes):
    assert boxes["2.1"].row + boxes["2.1"].rows <= boxes["2.2"].row
    assert boxes["2.2.1"].row == boxes["2.2.2"].row


def test_entries_of_a_timeline_begin_when_their_labels_say(boxes):
    begin = boxes["3"].begin
    assert boxes["3.1"].begin == begin + 0.5
    assert boxes["3.2"].begin == begin + 2.0
    assert boxes["3.3"].begin == begin + 5.0


def test_entries_of_one_server_share_a_row(boxes):
    assert boxes["3.1"].row == boxes["3.3"].row != boxes["3.2"].row


def test_a_barrier_spans_its_timeline(boxes):
    barrier = boxes["3.4"]
    assert barrier.begin == barrier.end == boxes["3"].end
    assert (barrier.row, barrier.rows) == (boxes["3"].row + 1, boxes["3"].rows - 1)


def test_a_repetition_takes_all_its_rounds(boxes):
    assert boxes["4"].end - boxes["4"].begin == 6.0
    assert boxes["4.1"].end - boxes["4.1"].begin == 2.0


def test_what_can_be_dragged_is_known(boxes):
    assert [boxes[path].moves for path in ("1", "3.1", "3.3", "4.1")] == [BY_ORDER, BY_TIME, FIXED, FIXED]
    assert [boxes[path].stretches for path in ("1", "2.1", "2.2.1", "3.2")] == [True, True, False, False]


def test_lengths_that_were_measured_count(document, store, tables):
    box = tracks_of(document, store.load, tables, measured={"3.2": 4.0}).box("3.2")
    assert (box.end - box.begin, box.sure) == (4.0, True)


def test_parameters_that_are_given_count(document, store, tables):
    tracks = tracks_of(document, store.load, tables, ["pause=2"])
    assert tracks.box("2.2.1").end == 3.0


def test_times_that_count_from_others_are_linked(document, store, tables):
    assert tracks_of(document, store.load, tables).links == (("3.1", "3.2"),)


def test_a_step_that_cannot_be_read_has_a_box_with_its_problem(store, tables):
    document = BehaviorDocument("mine", "help: h\ndo:\n  - wait: 1.0\n  - NaoLight.of: {}\n  - wiat: 2\n")
    boxes = {box.path: box for box in tracks_of(document, store.load, tables).boxes}
    assert "wait" in boxes["3"].problem and boxes["3"].kind == "unreadable"


@pytest.mark.parametrize("name", ["bow", "count_to_ten", "dance", "hello", "introduce_yourself", "tai_chi"])
def test_the_behaviours_that_come_along_have_all_their_steps_on_tracks(name, store, tables):
    document = BehaviorDocument(name, store.text(name), shipped=True)
    tracks = tracks_of(document, store.load, tables)
    assert tracks.length > 1.0
    assert not any(box.problem for box in tracks.boxes)
    assert all(0 <= box.row and box.row + box.rows <= tracks.rows for box in tracks.boxes)


def changed_lines(document, before):
    """Pairs of lines that an edit has changed."""
    return [pair for pair in zip(before.splitlines(), document.text.splitlines()) if pair[0] != pair[1]]


def test_dragging_changes_the_time_and_keeps_what_it_counts_from(document):
    before = document.text
    document.shift("3.2", 0.25)
    ((_, line),) = changed_lines(document, before)
    assert "at: eyes.end + 0.75" in line
    document.shift("3.2", -5.0)
    assert "at: eyes.end}" in document.text


def test_a_time_that_is_calculated_is_not_dragged(document):
    with pytest.raises(EditRefused, match="calculated"):
        document.shift("3.3", 1.0)


def test_stretching_changes_the_field_that_says_how_long(document):
    document.stretch("1", 1.0, 1.5)
    document.stretch("2.1", 2.0, 3.0)
    document.stretch("2.2.2", 4.0, 6.0)
    assert "- wait: 1.5\n" in document.text
    assert "times: [1.5, 3.0]" in document.text
    assert "duration: 5.0, time: 1.0" in document.text


def test_what_takes_what_it_takes_is_not_stretched(document):
    with pytest.raises(EditRefused, match="takes what it takes"):
        document.stretch("3.2", 1.0, 2.0)


def test_the_way_back_and_forth(document):
    before = document.text
    document.delete("1")
    after = document.text
    document.undo()
    assert document.text == before and not document.changed
    document.redo()
    assert document.text == after and document.changed


def test_a_step_comes_behind_the_chosen_one_or_inside_of_it(document):
    assert document.insert({"wait": 9.0}, "1") == "2"
    assert document.step("2") == {"wait": 9.0}
    assert document.insert({"NaoLights.reset": {"lights": ["FaceLeds"]}}, "4", inside=True, begin=1.234) == "4.5"
    assert document.step("4.5")["at"] == 1.23


def test_a_wait_holds_no_steps(document):
    with pytest.raises(EditRefused, match="holds no others"):
        document.insert({"wait": 9.0}, "1", inside=True)


def test_a_step_that_leaves_a_timeline_has_no_time(document):
    document.move("3.1", "1")
    assert document.step("2") == {
        "NaoLights.fade": {"lights": ["FaceLeds"], "i_values": [0.5], "duration": 1.0},
        "label": "eyes",
    }


def test_a_step_that_comes_to_a_timeline_gets_one(document):
    document.move("1", "3", inside=True)
    assert document.step("2.5") == {"wait": 1.0, "at": 0.0}


def test_steps_change_places(document):
    assert document.reorder("1", 1) == "2"
    assert document.step("2") == {"wait": 1.0}
    assert document.reorder("2", -1) == "1"
    assert document.text == textwrap.dedent(TEXT)


def test_a_second_one_has_no_label(document):
    assert document.duplicate("4.1") == "4.2"
    assert document.step("4.2") == {"wait": 2.0}


def test_keys_come_and_go(document):
    document.set_key("1", "label", "first")
    assert document.step("1") == {"wait": 1.0, "label": "first"}
    document.set_key("1", "label", None)
    assert document.text == textwrap.dedent(TEXT)


def test_parameters_of_a_box_come_and_go():
    document = BehaviorDocument("mine", "help: h\ndo:\n  - behavior: bow\n")
    document.set_parameter("1", "depth", "small")
    assert document.step("1") == {"behavior": "bow", "parameters": {"depth": "small"}}


def test_a_broken_text_is_kept_with_its_problems(document):
    document.set_text("help: [")
    assert document.behavior is None and document.problems[0].line
    with pytest.raises(EditRefused):
        document.delete("1")


def told(path, state, time, what="wait", text="", behavior="mine"):
    return SimpleNamespace(path=path, state=state, time=time, what=what, text=text, behavior=behavior, label="")


def test_a_run_shows_what_began_and_ended():
    view = RunView()
    for each in [told("1", "began", 0.0), told("1", "ended", 1.0), told("4#2.1", "began", 3.0)]:
        view.told(each)
    assert view.states() == {"1": "ended", "4.1": "began"}
    assert [(line.path, line.depth) for line in view.tree()] == [("1", 0), ("4#2.1", 1)]
    assert view.measured() == {"1": 1.0}


def test_the_cursor_follows_the_step_that_began_last(document, store, tables):
    tracks = tracks_of(document, store.load, tables)
    view = RunView()
    for each in [told("1", "began", 0.0), told("1", "ended", 3.0), told("2", "began", 3.0), told("2.1", "began", 3.0)]:
        view.told(each)
    assert view.cursor(tracks, 3.5) == pytest.approx(1.5)
    assert view.cursor(tracks, 100.0) == tracks.box("2.1").end


def test_the_end_of_a_run_cuts_short_what_goes_on():
    view = RunView()
    view.told(told("1", "began", 0.0))
    view.end()
    assert view.states() == {"1": "preempted"}
