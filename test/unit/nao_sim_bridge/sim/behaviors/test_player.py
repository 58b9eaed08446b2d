"""Behaviours that are played under physics: what they do, how they end, and what they leave behind."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.behaviors.installed import InstalledBehaviors, shipped_behaviors
from nao_sim_bridge.sim.behaviors.player import BehaviorPlayer
from nao_sim_bridge.sim.behaviors.reader import behaviors_of
from nao_sim_bridge.sim.behaviors.steps import joints_of
from nao_sim_bridge.sim.motion.posture_change import PostureChange
from nao_sim_bridge.sim.posture_moves import load_moves
from nao_sim_bridge.sim.posture_recognition import STANDING, recognise
from nao_sim_bridge.sim.speech.animations import load_animations
from nao_sim_bridge.sim.speech.animator import Animator
from nao_sim_bridge.sim.tasks import Task

LONGEST = 40.0
SPEAKS = 0.5
"""Time that any text takes here, s."""


class Stage:
    """A robot that stands, a player, and what was said."""

    def __init__(self, bench):
        self.bench, self.simulation, self.said = bench, bench.simulation, []
        self.animator = Animator(self.simulation)
        library = load_animations()
        self.installed = InstalledBehaviors(library)
        self.player = BehaviorPlayer(self.simulation, self.animator, library, self.speak, self.go_to)

    def speak(self, text, animated):
        self.said.append((self.simulation.time, text, animated))
        command, voice = Task("say", 0), self.simulation.task_ids.make("say")
        command.finish(voice)
        end = self.simulation.time + SPEAKS
        self.simulation.after_tick.append(lambda now: voice.finish() if now.time >= end else None)
        return command

    def go_to(self, name, speed):
        robot = self.simulation.robot
        return PostureChange(robot, lambda: self.simulation.snapshot, name, speed, 3, load_moves()).start()

    def play(self, *steps):
        return self.player.start(behaviors_of({"behaviors": {"test": {"do": list(steps)}}}, "file")["test"])

    def until_over(self, task):
        """Let time pass until a task has ended; how long that was, s."""
        begin = self.simulation.time
        while not task.finished and self.simulation.time < begin + LONGEST:
            self.bench.run(0.05)
        return self.simulation.time - begin


@pytest.fixture
def stage(bench):
    return Stage(bench())


@pytest.fixture
def limp_stage(bench):
    return Stage(bench(stiffness=0.0))


def nod(time=0.3, to=0.1):
    return {"frames": [{"time": time, "angles": {"HeadPitch": to}}]}


def test_steps_follow_each_other_and_branches_run_beside_each_other(stage):
    begin = stage.simulation.time
    task = stage.play({"together": [{"say": "one"}, [{"wait": 1.0}, {"say": "two"}]]}, {"say": "three"})
    assert stage.until_over(task) == pytest.approx(1.0 + 2 * SPEAKS, abs=0.06)
    assert [(round(t - begin, 1), text) for t, text, _ in stage.said] == [(0.0, "one"), (1.0, "two"), (1.5, "three")]


def test_joints_get_to_their_key_frames_in_time(stage):
    task = stage.play({"frames": [{"time": 0.5, "angles": {"HeadYaw": 0.5}}, nod()["frames"][0]]})
    stage.bench.run(0.5)
    assert stage.bench.joint("HeadYaw") == pytest.approx(0.5, abs=0.03)
    stage.until_over(task)
    stage.bench.run(0.2)
    assert stage.bench.joint("HeadPitch") == pytest.approx(0.1, abs=0.02)


def test_what_is_repeated_is_done_so_often(stage):
    stage.until_over(stage.play({"repeat": 3, "do": [{"say": "again"}]}))
    assert len(stage.said) == 3


def test_stopping_ends_everything_at_once_and_brings_gestures_back(stage):
    home = stage.bench.joint("RShoulderPitch", of="commands")
    gesture = {"gesture": "animations/Stand/Gestures/Hey_1"}
    task = stage.play({"together": [{"repeat": 0, "do": [nod(), nod(0.3, -0.1)]}, gesture, {"wait": 30.0}]})
    stage.bench.run(1.0)
    assert stage.bench.joint("RShoulderPitch", of="commands") != pytest.approx(home, abs=0.1)
    task.kill()
    assert task.finished
    assert task.killed
    pitch = stage.bench.joint("HeadPitch", of="commands")
    stage.bench.run(2.0)
    assert stage.bench.joint("HeadPitch", of="commands") == pitch
    assert stage.bench.joint("RShoulderPitch", of="commands") == pytest.approx(home, abs=1e-6)
    assert stage.simulation.robot.motion.tasks() == []


@pytest.mark.parametrize("stopped_after", [None, 0.3])
def test_lights_show_afterwards_what_they_showed_before(stage, stopped_after):
    before = stage.simulation.robot.leds.values
    task = stage.play({"lights": "FaceLeds", "color": "red", "duration": 0.5}, {"wait": 0.1})
    if stopped_after is None:
        stage.until_over(task)
    else:
        stage.bench.run(stopped_after)
        assert stage.simulation.robot.leds.values != before
        task.kill()
    assert stage.simulation.robot.leds.values == before


def test_lights_that_somebody_else_has_changed_stay_as_they_are(stage):
    leds = stage.simulation.robot.leds
    eye = stage.simulation.led_layout.devices_of("FaceLeds")[0]
    task = stage.play({"lights": "FaceLeds", "color": "green", "duration": 0.2}, {"wait": 1.0})
    stage.bench.run(0.5)
    leds.set({eye: 0.25})
    stage.until_over(task)
    assert leds.values[eye] == 0.25


def test_limp_joints_are_told_and_end_the_behaviour(limp_stage):
    task = limp_stage.play({"together": [{"wait": 5.0}, nod()]})
    assert task.finished
    assert "HeadPitch are limp, wakeUp" in str(task.error)


def test_a_posture_comes_before_what_follows(stage):
    task = stage.play({"posture": "Crouch", "speed": 1.0}, {"say": "down"})
    assert stage.until_over(task) > 1.0
    assert task.error is None
    assert recognise(stage.bench.model, stage.bench.now).posture == "Crouch"
    assert [text for _, text, _ in stage.said] == ["down"]


def test_somebody_who_kills_its_motion_ends_the_behaviour(stage):
    task = stage.play(nod(2.0), {"say": "never"})
    stage.bench.run(0.5)
    stage.simulation.robot.motion.kill_all()
    assert task.killed
    assert stage.said == []


def test_a_reset_ends_it(stage):
    task = stage.play({"wait": 30.0})
    stage.simulation.reset()
    assert task.finished


LEGS = {"LHipPitch", "LHipRoll"}


@pytest.mark.parametrize("name", [name for name, b in shipped_behaviors().items() if LEGS & joints_of(b.step)])
def test_those_that_move_legs_stay_on_their_feet_even_when_stopped_half_way(stage, name):
    behavior = stage.installed.resolve(name)
    whole = stage.player.start(behavior)
    stage.bench.run(2.3)
    whole.kill()
    stage.bench.run(0.7)
    assert recognise(stage.bench.model, stage.bench.now).family == STANDING
