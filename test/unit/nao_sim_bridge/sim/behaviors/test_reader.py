"""Behaviours in files: what they become, and what is refused with the place named."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from nao_sim_bridge.sim.behaviors.installed import shipped_behaviors
from nao_sim_bridge.sim.behaviors.reader import behaviors_of, read_behaviors
from nao_sim_bridge.sim.behaviors.steps import (
    GoToPosture,
    Joints,
    Lights,
    Repeat,
    Say,
    Together,
    Wait,
    joints_of,
    length_of,
)
from nao_sim_bridge.sim.errors import ConfigError


def steps(*entries):
    return behaviors_of({"behaviors": {"test": {"do": list(entries)}}}, "file")["test"].step.steps


def test_every_kind_of_step_is_read():
    posture, lights, said, waited, both, again = steps(
        {"posture": "Stand", "speed": 0.5},
        {"lights": "FaceLeds", "color": "#ff8000", "duration": 0.5},
        {"say": "Hello", "animated": True},
        {"wait": 1.5},
        {"together": [{"wait": 1.0}, [{"wait": 1.0}, {"wait": 2.0}]]},
        {"repeat": 0, "do": [{"wait": 1.0}]},
    )
    assert posture == GoToPosture("Stand", 0.5)
    assert lights == Lights("FaceLeds", (1.0, 128 / 255, 0.0), 0.5)
    assert said == Say("Hello", True)
    assert waited == Wait(1.5)
    assert isinstance(both, Together)
    assert length_of(both) == 3.0
    assert isinstance(again, Repeat)
    assert again.times is None


def test_times_of_frames_add_up_and_those_of_joints_count_from_the_begin():
    frames, joints = steps(
        {"frames": [{"time": 0.5, "angles": {"HeadYaw": 0.1}}, {"time": 0.5, "angles": {"HeadPitch": 0.2}}]},
        {"joints": {"HeadYaw": {"times": [0.5, 1.0], "angles": [0.1, 0.2]}}},
    )
    assert isinstance(frames, Joints)
    assert frames.ways["HeadPitch"].points[0].time == 1.0
    assert frames.length == joints.length == 1.0
    assert joints_of(frames) == {"HeadYaw", "HeadPitch"}


@pytest.mark.parametrize(
    "entry, told",
    [
        ({"posture": "Handstand"}, "allowed is Stand"),
        ({"lights": "FaceLeds", "color": "pink"}, "#rrggbb"),
        ({"lights": "FaceLeds"}, "color or an intensity"),
        ({"lights": "Nose", "intensity": 1.0}, "no LED"),
        ({"frames": [{"time": 0.5, "angles": {"HeadYaw": 9.0}}]}, "HeadYaw: is 9"),
        ({"frames": [{"time": 0.5, "angles": {"Tail": 0.0}}]}, "no joint"),
        ({"joints": {"HeadYaw": {"times": [0.5, 0.5], "angles": [0.1, 0.2]}}}, "do not rise"),
        ({"wait": -1.0}, "allowed is 0"),
        ({"wait": float("nan")}, "not a number"),
        ({"say": True}, "not a text"),
        ({"repeat": 0, "do": [{"lights": "FaceLeds", "color": "red"}]}, "takes no time"),
        ({"dance": "tango"}, "has not one of"),
        ({"wait": 1.0, "until": 2.0}, "unknown key 'until'"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(entry, told):
    with pytest.raises(ConfigError, match=told) as error:
        steps({"wait": 0.1}, entry)
    assert error.value.where.startswith("file: test: do[1]")


def test_what_nests_without_end_is_refused():
    entry = {"wait": 1.0}
    for _ in range(40):
        entry = {"together": [entry]}
    with pytest.raises(ConfigError, match="nests deeper"):
        steps(entry)


def test_a_file_with_aliases_is_refused(tmp_path):
    path = tmp_path / "many.yaml"
    path.write_text("behaviors: {a: {do: &x [{wait: 1}]}, b: {do: *x}}\n")
    with pytest.raises(ConfigError, match="aliases"):
        read_behaviors(path)


def test_a_name_that_leads_somewhere_else_is_refused():
    with pytest.raises(ConfigError, match="no name"):
        behaviors_of({"behaviors": {"../x": {"do": [{"wait": 1.0}]}}}, "file")


def test_all_files_that_come_with_the_simulator_are_sound():
    shipped = shipped_behaviors()
    assert len(shipped) >= 18
    assert all(behavior.help for behavior in shipped.values())
    assert {b.nature for b in shipped.values()} == {"solitary", "interactive", "no nature"}


def test_the_example_of_the_documentation_is_sound(tmp_path):
    text = (Path(__file__).parents[5] / "docs" / "robot_behaviors.md").read_text(encoding="utf-8")
    path = tmp_path / "example.yaml"
    path.write_text(re.search(r"```yaml\n(.*?)```", text, re.DOTALL).group(1))
    (behavior,) = read_behaviors(path).values()
    assert behavior.nature == "interactive"
    assert length_of(behavior.step) > 3.0
