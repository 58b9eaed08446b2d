"""Robots that lack a module, and chains that are wrong."""

from __future__ import annotations

import pytest
from audio_out_goals import f, play, played, spoken
from fake_audio_out import NoModule


@pytest.mark.parametrize("module", ["ALTextToSpeech", "ALAudioPlayer", "ALAudioDevice"])
def test_a_robot_without_a_module_says_so_and_the_server_stays(audio, robot, module):
    robot.add(module, NoModule(module))
    function = {
        "ALTextToSpeech": f("say", "Hello"),
        "ALAudioPlayer": f("playFile", "ding.wav"),
        "ALAudioDevice": f("muteAudioOut", enable=True),
    }[module]
    server = play(audio, function)
    assert server.end == "aborted"
    assert f"has no module '{module}'" in server.text
    assert play(audio, f("getData", "Name")).end == "succeeded"


def test_a_robot_that_does_not_tell_its_volume_speaks_all_the_same(audio, robot):
    robot.add("ALAudioDevice", NoModule("ALAudioDevice"))
    server = play(audio, f("say", "Hello"))
    assert (server.end, server.result.volume) == ("succeeded", -1.0)


def test_nothing_sounds_when_a_later_function_is_wrong(audio, robot):
    server = play(audio, f("say", "Hello"), f("playFile", "ding.wav"), f("say", "  "))
    assert server.end == "aborted"
    assert server.text == "function 3 (say): field str_param: it is empty: the text to say"
    assert spoken(robot) == played(robot) == []


def test_many_goals_from_many_clients_leave_nothing_behind(audio, player):
    player.quick = False
    for _ in range(50):
        play(audio, f("playFile", "ding.wav", background=True))
        player.pending.pop().end()
    play(audio, f("getVolume"))
    assert audio._begun == audio._left == []
