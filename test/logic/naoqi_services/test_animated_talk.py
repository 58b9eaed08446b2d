"""What instructions in a text have begun, and how it ends."""

from __future__ import annotations

import pytest

from nao_sim_bridge.base.tasks import Task, TaskIds
from nao_sim_bridge.naoqi.speech.animated_talk import until_over


@pytest.fixture
def sound():
    ids = TaskIds()
    ids.ask = Task.kill
    return ids.make("sound")


@pytest.mark.parametrize("stage", range(3))
def test_a_sound_is_stopped_however_far_its_call_has_come(sound, stage):
    read, begin = Task("read", 0), Task("begin", 0)
    steps = [lambda: read.finish(begin), lambda: begin.finish(sound)]
    whole = until_over(read)
    for step in steps[:stage]:
        step()
    assert not whole.finished and whole.kill()
    for step in steps[stage:]:
        step()
    assert sound.killed


def test_a_sound_is_over_when_it_has_ended_or_failed(sound):
    read = Task("read", 0)
    whole = until_over(read)
    read.finish(sound)
    assert not whole.finished
    sound.finish(error=ValueError("no file"))
    assert whole.finished and str(whole.error) == "no file"
