"""The examples do what they show."""

from __future__ import annotations

import importlib.util
import threading
from pathlib import Path
from types import SimpleNamespace

import fake_motion
import pytest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoLedGoal, NaoMotionGoal
from nao_library_msgs.msg import LedFunction

EXAMPLES = Path(__file__).parents[3] / "nao_library_modules" / "examples"
LIMIT = 5.0


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class FakeSystem:
    name = "nao"

    def robotName(self):
        return self.name

    def setRobotName(self, name):
        self.name = name
        return True

    def systemVersion(self):
        return "2.8.5"


@pytest.fixture
def system(robot, edge):
    robot.add("ALSystem", FakeSystem())
    return load("add_a_module").NaoSystem("10.0.0.7", 9559, robot=robot, edge=edge)


@pytest.fixture
def blinking(robot, edge):
    return load("add_a_function").BlinkingLights("10.0.0.7", 9559, robot=robot, edge=edge)


def test_the_new_module_plays_chains_of_its_functions_and_of_memory_functions(system):
    server = system.server.play(
        NaoLedGoal(
            [
                LedFunction(function="robotName"),
                LedFunction(function="setRobotName", str_param="Ada"),
                LedFunction(function="robotName"),
                LedFunction(function="systemVersion"),
                LedFunction(function="getData", str_param="Name"),
            ]
        )
    )
    assert server.end == "succeeded"
    assert server.result.memList == ["nao", "Ada", "2.8.5", "nao"]


def test_the_new_module_checks_before_it_acts(system):
    server = system.server.play(
        NaoLedGoal([LedFunction(function="setRobotName", str_param=name) for name in ("Ada", "no name")])
    )
    assert server.end == "aborted"
    assert server.text.startswith("function 2 (setRobotName): field str_param: 'no name' is not allowed")
    assert system.robot.proxy("ALSystem").calls == []


def test_the_new_function_blinks_and_leaves_the_lights_as_they_were(blinking, robot, edge):
    before = dict(robot.leds.values)
    server = blinking.server.play(NaoLedGoal([LedFunction(function="blink", lights=["BrainLeds"], times=[0.01, 0.02])]))
    assert server.end == "succeeded"
    assert server.result.memList == ["2"]
    assert edge.clock.waits == [0.01, 0.01, 0.02, 0.02]
    assert [call for call in robot.proxy("ALLeds").calls if call[0] in ("on", "off")] == [
        ("on", "BrainLeds"),
        ("off", "BrainLeds"),
    ] * 2
    assert robot.leds.values == before


def test_the_new_function_is_preempted_between_flashes(blinking, robot, edge):
    before = dict(robot.leds.values)
    goal = NaoLedGoal([LedFunction(function="blink", lights=["BrainLeds"], times=[60.0])])
    thread = blinking.server.play_in_background(goal)
    assert edge.clock.waiting.wait(LIMIT)
    blinking.server.preempt()
    thread.join(LIMIT)
    assert blinking.server.end == "preempted"
    assert robot.leds.values == before


def test_the_new_function_is_checked(blinking):
    server = blinking.server.play(NaoLedGoal([LedFunction(function="blink", lights=["BrainLeds"])]))
    assert server.text == "function 1 (blink): field times: [] is not allowed: lengths of the flashes in s, above 0"


def test_the_client_shows_lights_and_intensities_and_its_goals_are_played(lights, capsys):
    client = load("lights_client")
    titles_and_goals = client.goals()
    assert len(titles_and_goals) == 3
    for _, goal in titles_and_goals[:2]:
        result = lights.server.play(goal).result
        assert lights.server.end == "succeeded"
    rows = client.table(result).splitlines()
    assert rows[0].split() == ["LeftFaceLed1", "1.00"]
    assert len(rows) == 4


def test_the_client_goes_on_after_a_goal_without_result_and_says_so(monkeypatch, capsys):
    client = load("lights_client")
    answers = iter([False, True, True])
    canceled = threading.Event()

    class FakeClient:
        def __init__(self, name, action):
            assert name == "NaoLights"

        def wait_for_server(self, timeout):
            return True

        def send_goal(self, goal):
            self.goal = goal

        def wait_for_result(self, timeout):
            return next(answers)

        def cancel_goal(self):
            canceled.set()

        def get_state(self):
            return GoalStatus.SUCCEEDED

        def get_goal_status_text(self):
            return ""

        def get_result(self):
            return SimpleNamespace(lights=["Brain0"], intensities=[0.5])

    monkeypatch.setattr(client, "SimpleActionClient", FakeClient)
    monkeypatch.setattr(client.rospy, "init_node", lambda *args, **options: None)
    assert client.main() == 1
    assert canceled.is_set()
    output = capsys.readouterr().out
    assert "one light at half intensity: no result within 20 s" in output
    assert "both eyes green: succeeded\n    Brain0  0.50" in output


ARM = ["ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw", "Hand"]


@pytest.fixture
def motion(robot, edge, make_call, monkeypatch, tmp_path):
    """The motion module on a stand-in with all joints of the arms."""
    from nao_library_modules.motion import NaoMotion

    for side in "LR":
        joints = [f"{side}{joint}" for joint in ARM]
        monkeypatch.setitem(fake_motion.CHAINS, f"{side}Arm", joints)
        for joint in joints:
            monkeypatch.setitem(fake_motion.LIMITS, joint, [-2.0, 2.0, 8.0, 1.0])
    body = [joint for chain, joints in fake_motion.CHAINS.items() if chain != "Body" for joint in joints]
    monkeypatch.setitem(fake_motion.CHAINS, "Body", body)
    robot.motion = fake_motion.FakeMotion(make_call)
    robot.add("ALMotion", robot.motion)
    robot.add("ALRobotPosture", fake_motion.FakePostures())
    return NaoMotion("10.0.0.7", 9559, robot=robot, edge=edge, motion_dir=tmp_path)


def test_the_motion_client_moves_every_joint_but_the_roll_of_the_shoulder():
    pose = load("motion_client").further(["RShoulderPitch", "RShoulderRoll", "RElbowYaw"], [0.25, -0.2, 0.75])
    assert pose == [0.75, -0.2, 1]


def test_nodding_standing_and_waving_are_one_goal(motion, robot):
    robot.motion.stiffnesses.update(HeadYaw=0.0, HeadPitch=0.0)
    server = motion.server.play(NaoMotionGoal(load("nod_stand_wave").chain()))
    assert server.end == "succeeded", server.text
    paths = [(call[1], call[2]) for call in robot.proxy("ALMotion").calls if call[0] == "angleInterpolation"]
    nod, _, wave = paths
    assert nod == (["HeadPitch"], [[0.3, -0.2, 0.3, 0.0]])
    assert wave == (["RElbowRoll", "RWristYaw"], [[0.4, 1.2, 0.4, 1.2], [-0.3, 0.3, -0.3, 0.0]])
    assert robot.motion.stiffnesses["HeadPitch"] == 1.0
    assert motion.robot.proxy("ALRobotPosture").calls.count(("goToPosture", "Stand", 0.6)) == 1


def test_standing_walking_and_waving_are_one_goal(motion, robot):
    robot.motion.stiffnesses.update(LHipRoll=0.0)
    server = motion.server.play(NaoMotionGoal(load("stand_walk_wave").chain()))
    assert server.end == "succeeded", server.text
    assert ("moveTo", 0.3, 0.0, 0.0, [["MaxStepX", 0.05]]) in robot.proxy("ALMotion").calls
    assert [float(value) for value in server.result.memList] == pytest.approx([0.3, 0.0, 0.0] * 2)


def test_what_is_taught_to_one_arm_is_repeated_by_both(motion, robot):
    robot.motion.angles.update(LShoulderRoll=0.5, LShoulderPitch=1.0)
    server = motion.server.play(NaoMotionGoal(load("teach_by_hand").chain("hello", ["LArm"], 0.1)))
    assert server.end == "succeeded", server.text
    assert motion.store.load("hello").joints == tuple(f"L{joint}" for joint in ARM)
    assert (robot.motion.angles["RShoulderRoll"], robot.motion.angles["RShoulderPitch"]) == (-0.5, 1.0)
    assert set(robot.motion.stiffnesses.values()) == {1.0}


class FakeMotionClient:
    """A client of a server that is not there, or that aborts."""

    there = True

    def __init__(self, name, action):
        assert name == "NaoMotion"

    def wait_for_server(self, timeout):
        return self.there

    def send_goal(self, goal, feedback_cb=None):
        self.goal = goal

    def wait_for_result(self, timeout):
        return True

    def cancel_goal(self):
        pass

    def send_goal_and_wait(self, goal, timeout):
        return GoalStatus.ABORTED

    def get_state(self):
        return GoalStatus.ABORTED

    def get_goal_status_text(self):
        return "function 1: the robot is gone"

    def get_result(self):
        return None


@pytest.mark.parametrize("there, told", [(False, "there is no server NaoMotion"), (True, "the robot is gone")])
@pytest.mark.parametrize("name", ["motion_client", "nod_stand_wave", "stand_walk_wave", "teach_by_hand", "get_up"])
def test_what_goes_wrong_is_told_in_a_line_and_in_the_exit_status(monkeypatch, capsys, name, there, told):
    example = load(name)
    monkeypatch.setattr(FakeMotionClient, "there", there)
    monkeypatch.setattr(example, "SimpleActionClient", FakeMotionClient)
    monkeypatch.setattr(example.rospy, "init_node", lambda *args, **options: None)
    monkeypatch.setattr(example.rospy, "sleep", lambda duration: None)
    monkeypatch.setattr(example.rospy, "myargv", lambda: ["teach_by_hand.py", "hello"])
    service = SimpleNamespace(wait_for_service=lambda limit: None)
    monkeypatch.setattr(example.rospy, "ServiceProxy", lambda name, kind: service)
    assert example.main() == 1
    assert told in capsys.readouterr().out
