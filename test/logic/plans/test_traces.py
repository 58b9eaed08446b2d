"""Traces that are drawn and compared, projected plans, chains of joints, numbers, and the plan's side of ROS."""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path

import actionlib
import numpy as np
import pytest
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from fake_goals import FakeActionClient, FakeGoal
from plan_tools import Beside, fails

import nao_library_modules.process_modules as p
from nao_library_actions.msg import NaoLedAction
from nao_library_modules.process_modules.designators.objects_and_locations import head_angles
from nao_library_modules.process_modules.designators.rules import load_settings
from nao_library_modules.process_modules.failures import ActionlibActionTimedOut
from nao_library_modules.process_modules.plan_action_client import PlanActionClient
from nao_library_modules.process_modules.projection import compare
from nao_library_modules.process_modules.robot_link import Chain
from nao_library_modules.process_modules.trace import COLORS, draw_trace, draw_trace_file
from nao_library_modules.ros.goal_client import GoalTracker
from naoqi.errors import NaoError

URDF = (Path(__file__).parents[3] / "nao_sim_bridge/urdf/nao_h25.urdf").read_text(encoding="utf-8")


@pytest.fixture
def trace():
    roots = []
    branch = p.do(p.par, p.do(int, "2", name="two"), p.do(p.fail, "no", name="bad"))
    plan = lambda: p.seq(p.do(int, "1", name="count"), branch)  # noqa: E731
    fails(p.PlanFailure, "no", plan, name="plan", observers=[roots.append])
    return p.trace_of(roots[0])


def test_a_trace_is_drawn_with_a_bar_for_each_state_also_by_the_command(trace, tmp_path):
    colors = set(draw_trace(trace).getdata())
    assert COLORS["failed"] in colors and COLORS["succeeded"] in colors
    file, picture = tmp_path / "trace.json", tmp_path / "trace.png"
    file.write_text(trace.to_json())
    assert draw_trace_file([str(file), str(picture)]) == 0 and picture.read_bytes()[:4] == b"\x89PNG"


def test_a_task_that_gave_a_message_is_drawn_in_one_line():
    roots = []
    p.top_level(lambda: p.seq(p.do(NaoLedAction, name="made")), observers=[roots.append])
    trace = p.trace_of(roots[0])
    assert "\n" in repr(NaoLedAction()) and "\n" not in trace.named("made")[0].result
    draw_trace(trace)


def test_what_came_out_otherwise_is_told_with_its_path(trace):
    assert compare(trace, trace).alike
    good = [replace(each, state="succeeded", failure="") if each.name == "bad" else each for each in trace.records]
    extra = replace(trace.records[-1], number=99, name="two")
    compared = compare(trace, p.Trace((*good, extra)))
    assert not compared.alike and compared.before == trace.records[0].ended
    assert [str(each) for each in compared.differences] == [
        "plan/seq/par/par/bad: failed (SimplePlanFailure) -> succeeded",
        "plan/seq/par/par/two[2]: not there -> failed (SimplePlanFailure)",
    ]


@pytest.mark.parametrize("side, sign", [("l", 1.0), ("r", -1.0)])
def test_the_hand_is_where_the_tables_say_with_all_joints_at_zero(side, sign):
    arm = Chain(URDF, "torso", f"{side}_gripper")
    names = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw")
    assert arm.joints == tuple(f"{side.upper()}{name}" for name in names)
    assert arm.tip([0.0] * 5)[:3, 3] == pytest.approx((0.2187, sign * 0.113, 0.08769), abs=2e-4)


@pytest.mark.parametrize("point", [(1.0, 0.0, 0.2), (0.5, 0.4, -0.2), (2.0, -1.0, 0.6), (0.3, 0.1, 0.0)])
def test_the_camera_looks_at_the_point(point):
    camera = [load_settings().camera[key] for key in ("forward", "up", "neck", "tilt")]
    frame = Chain(URDF, "torso", "CameraTop_frame").tip(head_angles(*point, camera))
    ray = np.array(point) - frame[:3, 3]
    assert frame[:3, 0] @ ray / np.linalg.norm(ray) > np.cos(1e-3)


def test_numbers_that_are_wrong_are_told(tmp_path):
    file = tmp_path / "numbers.yaml"
    file.write_text("gripper: {open: 1.0}\nhands: 3")
    with pytest.raises(NaoError, match="numbers.yaml: .*unknown 'hands': did you mean 'head'.; missing gripper_t"):
        load_settings(file)


@pytest.mark.parametrize("late", [False, True])
def test_a_goal_that_takes_too_long_is_cancelled_when_the_server_knows_it_or_has_ended_before(late, monkeypatch):
    def on_sent(goal):
        if late:
            threading.Timer(0.1, goal.tell, [GoalStatus.ACTIVE]).start()
            return
        goal.tell(GoalStatus.ACTIVE)
        goal.just_before_the_cancel(lambda: goal.end(GoalStatus.SUCCEEDED))

    client, ends = FakeActionClient(on_sent), []
    monkeypatch.setattr(actionlib, "ActionClient", lambda *_: client)
    plan = lambda: PlanActionClient("NaoLights", NaoLedAction).call(None, timeout=0.01, on_end=ends.append)  # noqa: E731
    if late:
        fails(ActionlibActionTimedOut, "the goal of NaoLights took longer than 0.01 s", plan)
        assert (client.goals[0].cancelled, ends[0].status) == ([CommState.ACTIVE], GoalStatus.PREEMPTED)
    else:
        assert p.top_level(plan) == ends[0] and ends[0].succeeded and client.goals[0].cancelled == []


def test_a_plan_waits_for_a_server_until_it_is_there_and_not_for_ever(monkeypatch):
    there = threading.Event()
    client = FakeActionClient(lambda goal: None)
    client.wait_for_server = there.wait
    monkeypatch.setattr(actionlib, "ActionClient", lambda *_: client)
    late = PlanActionClient("joint_trajectory", NaoLedAction)
    fails(ActionlibActionTimedOut, "joint_trajectory after 0.01 s", lambda: late.wait_for_server(0.01))
    waiting = Beside(late.wait_for_server)
    there.set()
    waiting.ended()


def test_a_goal_of_which_the_server_never_tells_is_cancelled_all_the_same():
    watch = GoalTracker()
    goal = FakeGoal(watch.look)
    assert watch.cancel(goal.handle, limit=0.01) and goal.cancelled == [CommState.WAITING_FOR_GOAL_ACK]
