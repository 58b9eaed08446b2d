"""What clients can heap on each moment of simulated time is bounded, and so are threads that call their modules."""

import threading

import pytest
from store_walk import Walk, shrink

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes

SIZES = load_sizes()


@pytest.mark.parametrize("module", ["ALLeds", "ALAnimatedSpeech", "ALAudioDevice", "ALMemory", "ALTracker"])
def test_what_a_module_keeps_of_ever_new_texts_comes_to_an_end(robot, module, monkeypatch):
    shrink(monkeypatch)  # all modules are in the level slow
    assert [(str(way), way.wrong) for way in Walk(robot).module(module) if way.wrong] == []


def test_pushes_that_last_are_bounded_and_those_that_are_over_make_room(robot):
    for _ in range(SIZES.lists.pushes):
        robot.server.push([0.0, 0.0, 0.0], 0.1, "torso")
    with pytest.raises(BadValue, match="101 pushes.* allowed is 100 pushes at most"):
        robot.server.push([0.0, 0.0, 0.0], 0.1, "torso")
    robot.advance(0.2)
    robot.server.push([0.0, 0.0, 0.0], 0.1, "torso")


def test_sounds_that_play_at_once_are_bounded(robot):
    playing = [robot.post("ALAudioDevice", "playSine", 440, 1, 0, 1.0) for _ in range(SIZES.loaded_sounds.at_once)]
    with pytest.raises(RuntimeError, match="number of sounds that play is 65, allowed is 64 at most"):
        robot.ALAudioDevice.playSine(440, 1, 0, 1.0)
    robot.advance(1.2)
    assert not any(robot.answer(future) for future in playing)


def test_modules_that_are_called_have_few_threads_and_those_that_are_not_there_keep_none(robot):
    for number in range(2 * SIZES.clients.called_modules):
        robot.ALMemory.subscribeToEvent("Test/Call", f"Nobody{number}", "onEvent")
    before = threading.active_count()
    robot.ALMemory.raiseEvent("Test/Call", 1)
    assert threading.active_count() <= before + SIZES.clients.called_modules
    for thread in threading.enumerate():
        if thread.name.startswith("calls of Nobody"):
            thread.join(robot.patience)
            assert not thread.is_alive()
