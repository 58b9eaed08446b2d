"""What is printed."""

import json

import pytest
import rospy

from nao_library_actions.msg import NaoAudioInFeedback, NaoBehaviorFeedback, NaoLedFeedback
from nao_library_modules.command_line.output import plain, say_json, say_result, table, words
from nao_library_modules.command_line.progress import Progress
from nao_library_msgs.msg import LedFunction


def test_messages_become_plain_values_with_times_in_seconds():
    value = plain(LedFunction(function="on", lights=["a"], time=rospy.Duration(1.5)))
    assert (value["function"], value["lights"], value["time"]) == ("on", ["a"], 1.5)
    json.dumps(value)


def test_numbers_that_json_does_not_have_are_null(capsys):
    say_json({"a": [float("inf"), float("nan"), 1.0]}, compact=True)
    assert capsys.readouterr().out == '{"a": [null, null, 1.0]}\n'


@pytest.mark.parametrize(
    "value, text",
    [(True, "true"), (0.1234567, "0.123457"), ([1, 2.0], "1, 2"), ({"a": 1, "b": ""}, "a 1"), (None, "")],
)
def test_values_are_told_in_a_line(value, text):
    assert words(value) == text


def test_columns_stand_beneath_each_other():
    assert table([("a", "1"), ("bbb", "2")], indent=" ") == [" a    1", " bbb  2"]


def test_one_answer_stands_alone_and_several_with_their_functions(capsys):
    say_result({"results": [{"function": "f", "values": ["1", "2"]}], "memList": ["1", "2"]})
    assert capsys.readouterr().out == "1\n2\n"
    say_result({"results": [{"function": "f", "values": ["1"]}, {"function": "g", "values": ["2"]}]})
    assert capsys.readouterr().out == "f: 1\ng: 2\n"


def test_a_function_that_failed_and_was_skipped_is_told(capsys):
    say_result({"results": [{"function": "f", "values": [], "error": "no"}]})
    assert capsys.readouterr().err == "f: no\n"


def test_fields_of_a_result_stand_beside_each_other(capsys):
    say_result({"results": [], "name": ["HeadYaw", "HeadPitch"], "position": [0.5, 0.25]})
    assert capsys.readouterr().out == "HeadYaw    0.5\nHeadPitch  0.25\n"


def test_progress_is_a_line_a_function_where_there_is_no_terminal(capsys):
    with Progress(shown=True) as progress:
        progress.feedback(NaoLedFeedback(index=0, function="on", count=2))
        progress.feedback(NaoLedFeedback(index=0, function="on", count=2))
        progress.feedback(NaoLedFeedback(index=1, function="off", count=2))
        progress.feedback(NaoAudioInFeedback(index=1, function="off", count=2, status="listening"))
    assert capsys.readouterr().err == "1/2 on\n2/2 off\n"


def test_progress_of_a_behavior_is_a_line_a_step(capsys):
    with Progress(shown=True) as progress:
        step = {"index": 0, "function": "runBehavior", "count": 1, "path": "2.1", "what": "nao_audio_out.say"}
        progress.feedback(NaoBehaviorFeedback(state="began", **step))
        progress.feedback(NaoBehaviorFeedback(state="failed", text="no voice", **step))
    assert capsys.readouterr().err == "2.1 nao_audio_out.say began\n2.1 nao_audio_out.say failed no voice\n"


def test_progress_can_be_silent(capsys):
    with Progress(shown=False) as progress:
        progress.feedback(NaoLedFeedback(index=0, function="on", count=2))
        progress.note("stopping")
    assert capsys.readouterr().err == ""
