"""Behaviours that are played under physics: what they do, how they end, and what they leave behind."""

from __future__ import annotations

from unittest.mock import Mock

import pytest

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.installed import InstalledBehaviors, shipped_behaviors
from nao_sim_bridge.behaviors.player import BehaviorPlayer
from nao_sim_bridge.behaviors.reader import behaviors_of
from nao_sim_bridge.behaviors.steps import joints_of
from nao_sim_bridge.control.balance.posture_recognition import STANDING, recognise
from nao_sim_bridge.core.posture_change import PostureChange
from nao_sim_bridge.core.posture_moves import load_moves
from nao_sim_bridge.speech.animations import load_animations
from nao_sim_bridge.speech.animator import Animator
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait

LONGEST = 40.0
SPEAKS = 0.5
"""Time that any text takes here, s."""


class Stage:
    """A robot that stands, a player, and what was said."""

    def __init__(self, bench):
        self.bench, self.simulation, self.said = bench, bench.simulation, []
        library = load_animations()
        self.installed = InstalledBehaviors(library)
        animator = Animator(self.simulation)
        self.player = BehaviorPlayer(self.simulation, animator, library, self.speak, self.go_to, Mock())

    @property
    def leds(self):
        return self.simulation.robot.leds

    def speak(self, text, animated):
        self.said.append((self.simulation.time, text))
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

    def command(self, name):
        return self.bench.joint(name, of="commands")


@pytest.fixture
def stage(bench):
    return Stage(bench())


def nod(time=0.3, to=0.1):
    return {"frames": [{"time": time, "angles": {"HeadPitch": to}}]}


def test_steps_follow_each_other_branches_run_beside_each_other_and_repeats_are_done_so_often(stage):
    begin, again = stage.simulation.time, {"repeat": 2, "do": [{"say": "again"}]}
    task = stage.play({"together": [{"say": "one"}, [{"wait": 1.0}, {"say": "two"}]]}, {"say": "three"}, again)
    assert stage.until_over(task) == pytest.approx(1.0 + 4 * SPEAKS, abs=0.1)
    said = [(round(t - begin, 1), text) for t, text in stage.said]
    assert said == [(0.0, "one"), (1.0, "two"), (1.5, "three"), (2.0, "again"), (2.5, "again")]


def test_stopping_ends_everything_at_once_and_brings_gestures_and_lights_back(stage, bench):
    home, before = stage.command("RShoulderPitch"), stage.leds.values
    gesture, red = (
        {"gesture": "animations/Stand/Gestures/Hey_1"},
        {"lights": "FaceLeds", "color": "red", "duration": 0.5},
    )
    task = stage.play({"together": [{"repeat": 0, "do": [nod(), nod(0.3, -0.1)]}, gesture, red, {"wait": 30.0}]})
    stage.bench.run(1.0)
    assert stage.command("RShoulderPitch") != pytest.approx(home, abs=0.1) and stage.leds.values != before
    task.kill()
    assert task.finished and task.killed and stage.leds.values == before
    pitch = stage.command("HeadPitch")
    stage.bench.run(2.0)
    assert stage.command("HeadPitch") == pitch and stage.command("RShoulderPitch") == pytest.approx(home, abs=1e-6)
    assert stage.simulation.robot.motion.tasks() == []
    task = stage.play({"posture": "Crouch", "speed": 1.0}, {"say": "down"}, {"wait": 30.0})
    stage.bench.run(6.0)
    assert recognise(stage.bench.model, stage.bench.now).posture == "Crouch" and stage.said[0][1] == "down"
    stage.simulation.reset()
    assert task.finished


def test_limp_joints_stay_while_a_behaviour_takes_its_time(bench):
    limp = Stage(bench(stiffness=0.0))
    pitch, hey = limp.command("HeadPitch"), {"gesture": "animations/Stand/Gestures/Hey_1"}
    task = limp.play(nod(), hey)
    assert limp.until_over(task) == pytest.approx(0.3 + 2.5, abs=0.1) and task.error is None
    assert limp.command("HeadPitch") == pitch and limp.simulation.robot.motion.tasks() == []


def test_a_gesture_that_leans_is_stopped_half_way_and_the_robot_stands(stage):
    stage.bench.run(0.3)  # until its feet carry it
    hip = stage.command("LHipPitch")
    task = stage.play({"gesture": "animations/Stand/Gestures/BowShort_1"})
    stage.bench.run(1.2)
    assert stage.command("LHipPitch") < hip - 0.2
    task.kill()
    stage.bench.run(1.5)
    assert stage.command("LHipPitch") == pytest.approx(hip, abs=1e-6)
    assert recognise(stage.bench.model, stage.bench.now).posture == "Stand"


def test_a_walk_has_the_legs_when_a_gesture_that_leans_is_over_or_stopped(stage):
    robot = stage.simulation.robot
    moving = lambda: [task.name for task in robot.motion.tasks()]  # noqa: E731
    stage.bench.run(0.3)
    gesture = stage.play({"gesture": "animations/Stand/Gestures/BowShort_1"})
    stage.bench.run(0.8)
    walk = robot.locomotion.move_to([FootPose(0.1, 0.0, 0.0)], FeetGait())
    stage.bench.run(0.4)
    assert moving() == ["animation", "moveTo"] and robot.locomotion.velocity() == (0.0, 0.0, 0.0)
    gesture.kill()
    stage.bench.run(1.2)
    assert moving() == ["moveTo"] and robot.locomotion.velocity()[0] > 0.0
    stage.until_over(walk)
    assert walk.value is True and moving() == []


LEGS = {"LHipPitch", "LHipRoll"}


@pytest.mark.parametrize("name", [name for name, b in shipped_behaviors().items() if LEGS & joints_of(b.step)])
def test_those_that_move_legs_stay_on_their_feet_even_when_stopped_half_way(stage, name):
    whole = stage.player.start(stage.installed.resolve(name))
    stage.bench.run(2.3)
    whole.kill()
    stage.bench.run(0.7)
    assert recognise(stage.bench.model, stage.bench.now).family == STANDING
