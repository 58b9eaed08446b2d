"""The command line, and the program as a whole."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from nao_sim_bridge.cli import parse, server_options
from nao_sim_bridge.server import ServerOptions
from nao_sim_bridge.sim.simulation import Scene


def options(*arguments):
    return server_options(parse("nao_sim", arguments))


def test_the_defaults_are_a_robot_on_the_loopback_in_real_time():
    assert options() == ServerOptions(Scene("empty", "V6", "Crouch", 0), "127.0.0.1", 9559, 1.0, False, False)
    assert options().record_dir == Path("~/.ros/nao_recordings")


def test_every_option_reaches_the_server():
    network, scene = "--port 0 --listen 0.0.0.0", "--world my.yaml --seed 7 --robot V5 --posture Stand"
    trouble = "--friction 0.4 --payload 0.5 --sensor-noise 1 --sensor-delay 0.03 --charger"
    chosen = options(*f"{network} {scene} {trouble} --speed 2.5 --gui --paused --record-dir my/files".split())
    far_from_ideal = dict(friction=0.4, payload=0.5, sensor_noise=1.0, sensor_delay=0.03)
    expected = Scene("my.yaml", "V5", "Stand", 7, charger=True, **far_from_ideal)
    assert chosen == ServerOptions(expected, "0.0.0.0", 0, 2.5, True, True, Path("my/files"))


def test_what_is_played_can_go_to_a_file_and_to_the_sound_card():
    assert (options().sound_file, options().sound_card) == ("", False)
    chosen = options("--sound-file", "all.wav", "--sound-card")
    assert (chosen.sound_file, chosen.sound_card) == ("all.wav", True)


def test_there_can_be_several_robots_at_places():
    assert (options().robots, options().places) == (1, ())
    chosen = options("--robots", "3", "--places=-1,0,0; 1,0,180; 0,1,-90")
    assert chosen.robots == 3
    assert [place.x for place in chosen.places] == [-1.0, 1.0, 0.0]
    assert options("--places", "").places == ()


def test_what_draws_can_be_chosen():
    assert options().renderer == "auto"
    assert options("--renderer", "builtin").renderer == "builtin"


def test_the_friction_of_the_world_can_be_asked_for():
    assert options("--friction", "world").scene == options().scene


@pytest.mark.parametrize("text", ["max", "0", "0.0", "inf"])
def test_as_fast_as_possible_has_several_spellings(text):
    assert options("--speed", text).speed == math.inf


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["--speed", "-1"], "'-1' is not a speed: a number above 0, or max"),
        (["--speed", "fast"], "'fast' is not a speed"),
        (["--speed", "nan"], "'nan' is not a speed"),
        (["--port", "65536"], "'65536' is not a port: 0 to 65535"),
        (["--port", "-1"], "'-1' is not a port"),
        (["--port", "naoqi"], "'naoqi' is not a port"),
        (["--robot", "V3"], "invalid choice: 'V3' (choose from"),
        (["--posture", "Standing"], "invalid choice: 'Standing' (choose from"),
        (["--friction", "ice"], "'ice' is not an amount: a number of 0 or more"),
        (["--payload", "-1"], "'-1' is not an amount"),
        (["--sensor-noise", "inf"], "'inf' is not an amount"),
        (["--sensor-delay", "nan"], "'nan' is not an amount"),
        (["--robots", "0"], "'0' is not a number of robots: 1 to 8"),
        (["--robots", "2.5"], "'2.5' is not a number of robots"),
        (["--places", "here"], "is 'here'"),
        (["--renderer", "vulkan"], "invalid choice: 'vulkan' (choose from"),
        (["--seed", "x"], "invalid int value: 'x'"),
        (["--wrold", "empty"], "unrecognized arguments: --wrold"),
    ],
)
def test_wrong_arguments_end_the_program_with_what_is_allowed(capsys, arguments, message):
    with pytest.raises(SystemExit) as ended:
        options(*arguments)
    assert ended.value.code == 2
    assert message in capsys.readouterr().err


def test_help_names_every_option_and_its_default(capsys):
    with pytest.raises(SystemExit) as ended:
        parse("nao_sim", ["--help"])
    assert ended.value.code == 0
    text = capsys.readouterr().out
    scene = "world seed robot posture friction payload sensor-noise sensor-delay charger"
    for option in f"port listen speed gui {scene} record-dir paused verbose".split():
        assert f"--{option}" in text
    assert "(default: 9559)" in text and "empty" in text
