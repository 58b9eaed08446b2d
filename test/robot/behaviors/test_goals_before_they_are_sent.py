"""Servers check goals by the checks that come before a goal's first function: nothing moves, what runs goes on."""

from __future__ import annotations

import pytest
from goal_functions import behavior, led, motion
from plan_clients import client_of
from wrong_behaviors import LINE, WRONG, wrong_text

from nao_library_actions.msg import NaoBehaviorGoal, NaoLedGoal, NaoMotionGoal
from nao_library_modules.behaviors.server import NaoBehavior
from nao_library_modules.core.goal_checks import robot_facts
from nao_library_modules.core.nao_facts import CHAINS
from nao_library_modules.motion.motion_server import NaoMotion
from naoqi.errors import RobotError


@pytest.fixture
def to_motion(goals_to, tmp_path):
    return goals_to(NaoMotion, NaoMotionGoal, motion_dir=tmp_path)


def told(module, *goals):
    return [(each.goal, each.index, each.field) for each in module.check(*goals).problems]


def turn(angle, **fields):
    return motion("setAngles", names=["HeadYaw"], angles=[angle], **fields)


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_behaviour_is_refused_before_the_robot_moves(name, goals_to, lights, to_motion, robot, tmp_path):
    servers = {"NaoLights": client_of(lights, robot), "NaoMotion": client_of(to_motion, robot)}
    behaviors = goals_to(NaoBehavior, NaoBehaviorGoal, behavior_dir=tmp_path, clients=servers.get)
    before = robot.ALMotion.getAngles("Body", False)
    behaviors.module.store.save(name, wrong_text(name))
    file = behaviors.module.store.path(name)
    for what in ({"str_param": name}, {"text": wrong_text(name), "file": str(file)}):
        text = behaviors.refused(behavior("runBehavior", **what))
        assert text.startswith(f"function 1 (runBehavior): behavior {name}: {file}:{LINE}: {WRONG[name][1]}"), text
    assert robot.ALMotion.getAngles("Body", False) == pytest.approx(before, abs=0.01)
    assert not any(robot.ALMotion.getStiffnesses("Body"))


def test_the_first_goal_finds_the_robot_as_it_is_and_the_others_what_goals_before_make(to_motion, lights, robot):
    module = to_motion.module
    limp, too_far = NaoMotionGoal([turn(0.1)]), NaoMotionGoal([turn(0.1, stiffness=1.0), turn(3.0, stiffness=1.0)])
    assert told(module, limp, too_far, limp) == [(0, 0, "stiffness"), (1, 1, "angles")]
    record = NaoMotionGoal([motion("recordMotion", str_param="taken", names=["Head"], duration=1.0)])
    play = NaoMotionGoal([motion("playMotion", str_param="taken", stiffness=1.0)])
    assert told(module, record, play) == [] and len(told(module, play)) == 1
    group = led("createGroup", str_param="Mine", lights=["Brain0"])
    use = NaoLedGoal([led("on", lights=["Mine"])])
    assert told(lights.module, NaoLedGoal([group]), use) == [] and told(lights.module, use) == [(0, 0, "lights")]
    assert told(lights.module, NaoLedGoal()) == [(0, -1, "functions")]
    assert "Mine" not in robot.ALLeds.listGroups()


def test_a_goal_that_runs_or_is_preempted_goes_on_as_if_nobody_asked(to_motion, stiff_robot):
    goal = to_motion.send(motion("angleInterpolation", names=["HeadYaw"], angles=[1.0], times=[2.0]))
    stiff_robot.advance(0.5)
    began = stiff_robot.ALMotion.getAngles("HeadYaw", True)[0]
    legs = NaoMotionGoal([motion("setAngles", names=["LKneePitch"], angles=[0.5, 0.5]), motion("moveInit")])
    assert told(to_motion.module, legs) == [(0, 0, "angles")]
    plan = to_motion.module.body.plan
    assert list(plan.touched) == ["HeadYaw"] and goal.active and 0.0 < began < 1.0
    assert goal.finish().state == "succeeded"
    assert stiff_robot.ALMotion.getAngles("HeadYaw", True)[0] == pytest.approx(1.0, abs=0.02)
    to_motion.module.interrupt.trigger()
    assert told(to_motion.module, NaoMotionGoal([turn(3.0)])) == [(0, 0, "angles")]
    to_motion.module.interrupt.clear()


def test_what_is_known_without_a_robot_is_what_the_robot_tells(robot):
    def answer(module, method, arguments):
        try:
            told = getattr(getattr(robot, module), method)(*arguments)
        except RobotError:
            return None
        return [row[:3] for row in told] if method == "getLimits" else told

    for module, methods in robot_facts().items():
        if not module.startswith("_"):
            for method, rows in methods.items():
                for arguments, known in rows:
                    assert answer(module, method, arguments) == known, (module, method, arguments)
    names = {chain: answer("ALMotion", "getBodyNames", [chain]) for chain in CHAINS}
    known = {arguments[0]: joints for arguments, joints in robot_facts()["ALMotion"]["getBodyNames"]}
    assert {chain: joints for chain, joints in names.items() if joints is not None} == known
    assert [arguments[0] for arguments, _ in robot_facts()["ALLeds"]["listLED"]] == robot.ALLeds.listLEDs()
    assert [arguments[0] for arguments, _ in robot_facts()["ALLeds"]["listGroup"]] == robot.ALLeds.listGroups()
