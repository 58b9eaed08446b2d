"""The examples do what they show: programs without ROS, new modules and functions, goals, and what they say."""

from __future__ import annotations

import math
import re
from types import SimpleNamespace

import pytest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Point, PoseStamped
from PIL import Image
from simulator import Simulator

from nao_library_actions.msg import NaoLedGoal, NaoMotionGoal
from nao_library_modules.driver.footsteps import read_steps, step_target
from nao_library_modules.driver.footsteps_walk import FootstepWalk
from nao_library_modules.driver.path_follower_path import WalkPath
from nao_library_modules.driver.planar_frames import read_path, read_place
from nao_library_modules.places import ORIGIN
from nao_library_msgs.msg import LedFunction, SeenObject
from nao_sim_bridge.sim.simulation import Scene

BRAIN0, BRAIN1 = "Head/Led/Front/Right/1", "Head/Led/Front/Right/0"
ARM = ["ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw", "Hand"]


def f(function, **fields):
    return LedFunction(function=function, **fields)


# Programs without ROS


@pytest.fixture
def program(run, robot):
    """Runs a program on the simulated robot, whose time runs as fast as it can."""

    def program(name, *arguments, at=robot):
        at.server.runner.resume()
        status, output = run(name, "--port", at.port, *arguments)
        at.server.runner.pause()
        assert status == 0, output
        return output

    return program


def test_a_robot_walks_its_bow_and_rests(program, robot):
    output = program("naoqi_walk", "--length", "0.1")
    assert float(re.search(r"walked (\S+) m", output).group(1)) == pytest.approx(0.112, abs=0.03)
    robot.advance(0.2)
    x, y, z = robot.now.torso.position
    assert (x, y) == pytest.approx((0.1, 0.05), abs=0.06) and z == pytest.approx(0.228, abs=0.02)
    assert max(robot.now.stiffnesses) == 0.0


def test_the_lab_is_told_drawn_and_seen(program, tmp_path):
    lab = Simulator(tmp_path / "lab", scene=Scene(world="lab", posture="Stand"), speed=float("inf"))
    try:
        output = program("look_at_the_lab", "--output", tmp_path / "room.png", at=lab)
        seen = program("naoqi_picture", "--size", "320x240", tmp_path / "seen.png", at=lab)
        assert lab.ALVideoDevice.getSubscribers() == []
    finally:
        lab.close()
    assert "ball: x 0.30 m, y -0.55 m, z 0.05 m, 0.63 m from the robot" in output
    assert len(output.splitlines()) == 6 and re.search(r"320x240 pixels, taken at \d+\.\d{3} s", seen)
    for name, size in (("room.png", (960, 600)), ("seen.png", (320, 240))):
        with Image.open(tmp_path / name) as picture:
            assert picture.size == size and all(high - low > 60 for low, high in picture.getextrema())


def test_things_are_placed_moved_drawn_and_cleared_up(program, robot, tmp_path):
    output = program("place_things", "--output", tmp_path / "things.png")
    assert "red_ball: x 0.50 m, y -0.12 m, z 0.03 m" in output and "clara: x 1.50 m, y -0.40 m, z 0.00 m" in output
    assert robot.now.placed == ()
    with Image.open(tmp_path / "things.png") as picture:
        assert picture.size == (960, 600)


def test_a_robot_that_is_watched_is_drawn_and_so_is_its_record(program, run, robot, tmp_path):
    record, first, second = (tmp_path / name for name in ("walk.json", "first.png", "second.png"))
    program("plot_walk", "--watch", "0.2", "--record", record, "--output", first)
    assert not robot.now.stiffnesses[0]  # watching moves nothing
    assert run("plot_walk", "--from", record, "--output", second)[0] == 0
    assert first.read_bytes() == second.read_bytes()


def test_without_a_robot_they_say_so(run):
    for name in ("naoqi_walk", "naoqi_picture", "look_at_the_lab", "place_things", "plot_walk"):
        status, output = run(name, "--port", "1")
        assert status == 1 and "NAOqi at 127.0.0.1:1" in output


# Modules and functions of one's own


def test_a_new_module_plays_chains_of_its_functions_and_of_memory_functions(example, goals_to, robot):
    system = goals_to(example("add_a_module").NaoSystem, NaoLedGoal)
    version = robot.ALSystem.systemVersion()
    rename = f("setRobotName", str_param="Ada")
    assert "function 2 (setRobotName): field str_param: 'no name' is not allowed" in system.refused(
        rename, f("setRobotName", str_param="no name")
    )
    result = system.succeed(f("robotName"), rename, f("robotName"), f("systemVersion"), f("ping"))
    assert result.memList == ["nao", "Ada", version, "True"]


def test_a_new_function_blinks_is_checked_and_leaves_the_lights_as_they_were(example, goals_to, robot):
    lights = goals_to(example("add_a_function").BlinkingLights, NaoLedGoal)
    robot.ALLeds.setIntensity("Brain0", 0.25)
    blink = {"lights": ["Brain0", "Brain1"]}
    goal = lights.send(f("blink", times=[0.5, 1.0], **blink))
    shown = []
    for _ in range(14):
        robot.advance(0.2)
        shown.append(robot.led(BRAIN0))
    goal.finish()
    assert goal.state == "succeeded" and goal.result.memList == ["2"] and {0.0, 1.0} <= set(shown)
    changes = [b for a, b in zip([None, *shown], shown) if a != b]
    assert changes[:4] == [1.0, 0.0, 1.0, 0.0] and (robot.led(BRAIN0), robot.led(BRAIN1)) == (0.25, 1.0)
    goal = lights.send(f("blink", times=[60.0], **blink))
    robot.advance(1.0)
    assert goal.cancel().state == "preempted" and robot.led(BRAIN0) == 0.25
    text = lights.refused(f("blink", **blink))
    assert text == "function 1 (blink): field times: [] is not allowed: lengths of the flashes in s, above 0"


# Goals


def test_the_client_of_the_lights_shows_what_its_goals_did(example, lights):
    client = example("lights_client")
    titled = client.goals()
    assert len(titled) == 3
    for _, goal in titled:
        result = lights.succeed(*goal.functions)
    rows = client.table(lights.succeed(*titled[1][1].functions)).splitlines()
    assert rows[0].split() == ["LeftFaceLed1", "1.00"] and len(rows) == 16 and result is not None


@pytest.fixture
def motion(goals_to, tmp_path, robot):
    from nao_library_modules.motion import NaoMotion

    robot.advance(0.3)
    return goals_to(NaoMotion, NaoMotionGoal, motion_dir=tmp_path)


def test_the_motion_client_moves_every_joint_but_the_roll_of_the_shoulder(example):
    pose = example("motion_client").further(["RShoulderPitch", "RShoulderRoll", "RElbowYaw"], [0.25, -0.2, 0.75])
    assert pose == [0.75, -0.2, 1]


def test_nodding_standing_and_waving_are_one_goal(example, motion, robot):
    chain = example("nod_stand_wave").chain()
    assert [function.function for function in chain][0] == "angleInterpolation" and len(chain) == 5
    motion.succeed(*chain)
    assert robot.ALRobotPosture.getPostureFamily() == "Standing" and robot.now.torso.position[2] > 0.28


def test_standing_walking_and_waving_are_one_goal(example, motion, robot):
    result = motion.succeed(*example("stand_walk_wave").chain())
    assert robot.now.torso.position[0] == pytest.approx(0.3, abs=0.05) and robot.now.torso.position[2] > 0.28
    assert [float(value) for value in result.memList[-3:]] == pytest.approx([0.3, 0.0, 0.0], abs=0.05)


def test_what_is_taught_to_one_arm_is_repeated_by_both(example, motion, robot):
    motion.succeed(*example("teach_by_hand").chain("hello", ["LArm"], 0.5))
    assert motion.module.store.load("hello").joints == tuple(f"L{joint}" for joint in ARM)
    left, right = (robot.ALMotion.getAngles(f"{side}Arm", True) for side in "LR")
    assert right[0] == pytest.approx(left[0], abs=0.1) and right[1] == pytest.approx(-left[1], abs=0.1)


def test_ways_are_what_the_path_follower_and_the_footsteps_take(example):
    place, frame = read_place("target_pose", example("walk_to").goal(0.5, 0.2, 90.0, "base_footprint").target_pose)
    assert (place, frame) == (pytest.approx((0.5, 0.2, math.pi / 2)), "base_footprint")
    walk_path = example("walk_path")
    for shape, length in (("square", 4.0), ("curve", 1.13)):
        places, frame = read_path(walk_path.goal(getattr(walk_path, shape)(1.0)).path)
        path = WalkPath(places)
        assert frame == "base_footprint" and path.waypoints[0].distance_to(ORIGIN) == 0.0
        assert path.length == pytest.approx(length, abs=0.02)
    steps = read_steps(example("footsteps").steps())
    made = FootstepWalk(None, None).prepared(steps)
    assert [step_target(step) for step in made] == [step_target(step) for step in steps]
    assert sum(step.place.yaw for step in steps) == pytest.approx(0.6)


def test_each_corner_of_the_square_is_a_side_ahead_and_a_quarter_to_the_left(example):
    square = example("walk_square")
    place = (0.0, 0.0, 0.0)
    for corner in square.square(0.5):
        assert square.seen_from(place, corner) == pytest.approx((0.5, 0.0, math.pi / 2))
        place = corner
    assert place == (0.0, 0.0, 0.0)
    for start in ((0.0, 0.0, 0.0), (1.0, -2.0, 0.7), (-0.3, 0.2, -3.0)):
        target = (0.4, -0.1, 1.2)
        assert square.seen_from(start, square.in_odometry(start, target)) == pytest.approx(target)
    assert square.seen_from((0.0, 0.0, 3.0), (0.0, 0.0, -3.0))[2] == pytest.approx(2 * math.pi - 6.0)


# What clients print; the server is the test's


class Client:
    """A client of a server that is not there, or whose goal ends as the test says, with some feedback before."""

    there, state, feedback, answers = True, GoalStatus.SUCCEEDED, None, iter(())

    def __init__(self, name, action):
        type(self).name, type(self).cancelled = name, False

    def wait_for_server(self, *_):
        return self.there

    def send_goal(self, goal, feedback_cb=None, **_):
        if self.feedback is not None:
            feedback_cb(self.feedback)

    def wait_for_result(self, *_):
        return next(self.answers, True)

    def send_goal_and_wait(self, *_):
        return self.state

    def cancel_goal(self):
        type(self).cancelled = True

    def get_state(self):
        return self.state

    def get_goal_status_text(self):
        return "" if self.state == GoalStatus.SUCCEEDED else "the robot is gone"

    def get_result(self):
        return SimpleNamespace(lights=["Brain0"], intensities=[0.5]) if self.state == GoalStatus.SUCCEEDED else None


@pytest.fixture
def play(example, monkeypatch, capsys):
    """Plays an example against such a server; exit status, what it printed, the client."""

    def play(name, *arguments, **facts):
        loaded, client = example(name), type("Client", (Client,), facts)
        for attribute, value in {
            "init_node": lambda *_, **__: None, "sleep": lambda _: None, "on_shutdown": lambda _: None,
            "myargv": lambda: [name, *arguments],
            "ServiceProxy": lambda *_: SimpleNamespace(wait_for_service=facts.get("service", lambda _: None)),
        }.items():  # fmt: skip
            monkeypatch.setattr(loaded.rospy, attribute, value)
        if hasattr(loaded, "SimpleActionClient"):
            monkeypatch.setattr(loaded, "SimpleActionClient", client)
        return loaded.main(), capsys.readouterr().out, client

    return play


WALKS = {
    "walk_to": (["1.0", "-0.5"], "walk_target", "nao_path_follower", SimpleNamespace(base_position=PoseStamped()),
                "x  0.00 m"),
    "walk_path": (["curve"], "walk_path", "nao_path_follower", SimpleNamespace(index=7), "waypoint 7 of 40"),
    "footsteps": ([], "footsteps_execution", "nao_footsteps", SimpleNamespace(executed_footsteps=[None, None]),
                  "2 of 10 steps"),
}  # fmt: skip


@pytest.mark.parametrize("name", WALKS)
def test_progress_and_end_of_walks_are_shown(play, name):
    arguments, server, node, feedback, line = WALKS[name]
    status, output, client = play(name, *arguments, feedback=feedback)
    assert (status, client.name) == (0, server) and line in output and output.endswith("\nsucceeded\n")
    assert play(name, *arguments, state=GoalStatus.ABORTED)[:2] == (1, "\naborted the robot is gone\n")
    status, output, _ = play(name, *arguments, there=False)
    assert status == 1 and output.startswith(f"there is no {node}")


@pytest.mark.parametrize("name", ["motion_client", "nod_stand_wave", "stand_walk_wave", "teach_by_hand", "get_up"])
def test_what_goes_wrong_is_told_in_a_line_and_in_the_exit_status(play, name):
    status, output, _ = play(name, "hello", there=False)
    assert status == 1 and "there is no server NaoMotion" in output
    status, output, client = play(name, "hello", state=GoalStatus.ABORTED)
    assert status == 1 and "the robot is gone" in output and client.name == "NaoMotion"


def test_the_lights_go_on_after_a_goal_without_result_and_the_square_tells_what_is_missing(play, example):
    status, output, client = play("lights_client", answers=iter([False, True, True]))
    assert status == 1 and client.cancelled
    assert "one light at half intensity: no result within 20 s" in output
    assert "both eyes green: succeeded\n    Brain0  0.50" in output

    def refuse(limit):
        raise example("walk_square").rospy.ROSException("timeout exceeded while waiting for service /cmd_pose_srv")

    status, output, _ = play("walk_square", service=refuse)
    assert status == 1 and "the square ends here: timeout exceeded while waiting for service /cmd_pose_srv" in output


# Seeing


@pytest.fixture
def find_ball(example):
    return example("find_ball")


@pytest.mark.parametrize("place", [(1.5, 0.0), (0.6, 0.3), (-0.5, -0.4), (0.23, 0.0)])
def test_the_way_ends_before_the_ball_and_looks_at_it(find_ball, place):
    x, y, turn = find_ball.way_to(*place)
    assert turn == pytest.approx(math.atan2(place[1], place[0])) and math.hypot(x, y) <= find_ball.LONGEST
    left = max(math.hypot(*place) - find_ball.LONGEST, find_ball.STOP)
    assert math.dist((x, y), place) == pytest.approx(left)
    assert find_ball.way_to(0.1, 0.0) == (0.0, 0.0, 0.0), "it never goes back"


class Plane:
    """A robot on the plane that sees a ball within some metres and 115 degrees to each side, and slips on its ways."""

    slip = 0.85

    def __init__(self, ball):
        self.ball, self.at, self.ways = ball, (0.0, 0.0, 0.0), []

    def seen(self):
        dx, dy, turn = self.ball[0] - self.at[0], self.ball[1] - self.at[1], self.at[2]
        return dx * math.cos(turn) + dy * math.sin(turn), dy * math.cos(turn) - dx * math.sin(turn)

    def client(self, name, action):
        """A client of a server on this plane."""
        client = Client(name, action)
        client.send_goal_and_wait = lambda goal, limit: setattr(client, "result", self.play(*goal.functions))
        client.get_result = lambda: client.result
        return client

    def play(self, function):
        if function.function == "moveTo":
            self.ways.append(tuple(function.values))
            x, y, turn = (self.slip * value for value in function.values)
            c, s = math.cos(self.at[2]), math.sin(self.at[2])
            self.at = self.at[0] + x * c - y * s, self.at[1] + x * s + y * c, self.at[2] + turn
        if function.function != "lookFor":
            return None
        assert (function.str_param, function.size) == ("ball", 0.03)
        x, y = self.seen()
        far = math.hypot(x, y) > (0.75 if function.camera == "bottom" else 3.0)
        near = function.camera == "top" and math.hypot(x, y) < 0.3
        if far or near or abs(math.atan2(y, x)) > math.radians(115):
            return SimpleNamespace(objects=[])
        return SimpleNamespace(objects=[SeenObject(camera=function.camera, position=Point(x, y, 0.03))])


@pytest.mark.parametrize("place", [(1.2, 0.3), (0.25, 0.0), (-0.8, 0.3), (-1.5, -0.5), (2.5, 0.0), (9.0, 0.0)])
def test_the_ball_is_in_front_of_the_feet_in_the_end_or_given_up_after_one_turn_around(find_ball, monkeypatch, place):
    plane = Plane(place)
    monkeypatch.setattr(find_ball, "SimpleActionClient", plane.client)
    ball = find_ball.Finder(0.03).find()
    if place == (9.0, 0.0):
        assert ball is None and plane.ways == [(0.0, 0.0, find_ball.TURN)] * 3
        return
    assert ball.camera == "bottom" and math.hypot(*plane.seen()) <= find_ball.NEAR
    assert (ball.position.x, ball.position.y) == pytest.approx(plane.seen())


class Guest:
    """A host whose robot sees one person, or nobody."""

    def __init__(self, name=None, learns=True):
        self._name, self._learns = name, learns
        self.learnt, self.said = [], []

    def face(self, timeout):
        return None if self._name is None else SeenObject(kind="face", name=self._name, position=Point())

    def learn(self, name):
        self.learnt.append(name)
        return self._learns

    def say(self, text):
        self.said.append(text)


def test_people_are_greeted_by_the_names_they_have(example):
    greet = example("greet_face").greet
    for guest, name, greeted, learnt, said in (
        (Guest("Anna"), "", True, [], "Hello, Anna!"), (Guest("Anna"), "Ben", True, [], "Hello, Anna!"),
        (Guest(""), "Ben", True, ["Ben"], "Nice to meet you, Ben!"),
        (Guest("", learns=False), "Ben", False, ["Ben"], "I cannot see you well enough."),
        (Guest(""), "", False, [], "Hello! I do not know you yet."), (Guest(), "Ben", False, [], "Is anybody there?"),
    ):  # fmt: skip
        assert greet(guest, name, 20.0) is greeted
        assert (guest.learnt, guest.said) == (learnt, [said])


def test_both_cameras_are_recorded_and_completed(example, monkeypatch):
    record = example("record_while_walking")
    monkeypatch.setattr(record.rospy, "get_name", lambda: "/record_while_walking_1")
    begun, ended = record.start("walk").functions, record.stop().functions
    assert [(each.camera, each.str_param) for each in begun] == [("top", "walk_top.mp4"), ("bottom", "walk_bottom.mp4")]
    assert {each.id for each in begun} == {each.id for each in ended} and len({each.id for each in begun}) == 2
    assert [each.str_param for each in record.start("").functions] == ["", ""]
