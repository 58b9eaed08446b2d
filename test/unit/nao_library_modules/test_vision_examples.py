"""The examples that see do what they show, on servers of stand-ins."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from types import SimpleNamespace

import pytest
from geometry_msgs.msg import Point

from nao_library_msgs.msg import SeenObject

EXAMPLES = Path(__file__).parents[3] / "nao_library_modules" / "examples"


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def find_ball():
    return load("find_ball")


@pytest.mark.parametrize("place", [(1.5, 0.0), (0.6, 0.3), (-0.5, -0.4), (0.23, 0.0)])
def test_the_way_ends_before_the_ball_and_looks_at_it(find_ball, place):
    x, y, turn = find_ball.way_to(*place)
    assert turn == pytest.approx(math.atan2(place[1], place[0]))
    length = math.hypot(x, y)
    assert length <= find_ball.LONGEST
    left = math.dist((x, y), place)
    assert left == pytest.approx(max(math.hypot(*place) - find_ball.LONGEST, find_ball.STOP))


def test_the_way_never_goes_back(find_ball):
    assert find_ball.way_to(0.1, 0.0) == (0.0, 0.0, 0.0)


class World:
    """A robot on the plane that sees a ball within a metre and 120 degrees to each side, and slips on its ways."""

    def __init__(self, find_ball, ball, slip=0.85):
        self.module = find_ball
        self.ball = ball
        self.slip = slip
        self.at = (0.0, 0.0, 0.0)
        self.looks, self.ways = [], []
        self.finder = find_ball.Finder.__new__(find_ball.Finder)
        self.finder._radius = 0.03
        self.finder._vision, self.finder._motion = "vision", "motion"
        self.finder._play = self.play

    def seen(self):
        dx, dy = self.ball[0] - self.at[0], self.ball[1] - self.at[1]
        c, s = math.cos(self.at[2]), math.sin(self.at[2])
        return dx * c + dy * s, dy * c - dx * s

    def play(self, client, goal):
        (function,) = goal.functions
        if client == "motion":
            if function.function == "moveTo":
                self.ways.append(tuple(function.values))
                x, y, turn = (self.slip * value for value in function.values)
                ahead = self.at[2]
                self.at = (
                    self.at[0] + x * math.cos(ahead) - y * math.sin(ahead),
                    self.at[1] + x * math.sin(ahead) + y * math.cos(ahead),
                    ahead + turn,
                )
            return None
        assert (function.function, function.str_param, function.size) == ("lookFor", "ball", 0.03)
        self.looks.append(function.camera)
        x, y = self.seen()
        far = math.hypot(x, y) > (0.75 if function.camera == "bottom" else 3.0)
        near = function.camera == "top" and math.hypot(x, y) < 0.3
        if far or near or abs(math.atan2(y, x)) > math.radians(115):
            return SimpleNamespace(objects=[])
        return SimpleNamespace(objects=[SeenObject(camera=function.camera, position=Point(x, y, 0.03))])


@pytest.mark.parametrize("place", [(1.2, 0.3), (0.25, 0.0), (-0.8, 0.3), (-1.5, -0.5), (2.5, 0.0)])
def test_the_ball_is_in_front_of_the_feet_in_the_end(find_ball, place):
    world = World(find_ball, place)
    ball = world.finder.find()
    assert ball is not None and ball.camera == "bottom"
    assert math.hypot(*world.seen()) <= find_ball.NEAR
    assert (ball.position.x, ball.position.y) == pytest.approx(world.seen())


def test_a_ball_that_is_nowhere_is_given_up_after_one_turn_around(find_ball):
    world = World(find_ball, (9.0, 0.0))
    assert world.finder.find() is None
    assert world.ways == [(0.0, 0.0, find_ball.TURN)] * 3


class Guest:
    """A host whose robot sees one person, or nobody."""

    def __init__(self, name=None, learns=True):
        self._name = name
        self._learns = learns
        self.learnt, self.said = [], []

    def face(self, timeout):
        return None if self._name is None else SeenObject(kind="face", name=self._name)

    def learn(self, name):
        self.learnt.append(name)
        return self._learns

    def say(self, text):
        self.said.append(text)


@pytest.mark.parametrize(
    ("guest", "name", "greeted", "learnt", "said"),
    [
        (Guest("Anna"), "", True, [], "Hello, Anna!"),
        (Guest("Anna"), "Ben", True, [], "Hello, Anna!"),
        (Guest(""), "Ben", True, ["Ben"], "Nice to meet you, Ben!"),
        (Guest("", learns=False), "Ben", False, ["Ben"], "I cannot see you well enough."),
        (Guest(""), "", False, [], "Hello! I do not know you yet."),
        (Guest(), "Ben", False, [], "Is anybody there?"),
    ],
)
def test_people_are_greeted_by_the_names_they_have(guest, name, greeted, learnt, said):
    assert load("greet_face").greet(guest, name, 20.0) is greeted
    assert (guest.learnt, guest.said) == (learnt, [said])


def test_both_cameras_are_recorded_and_completed(monkeypatch):
    example = load("record_while_walking")
    monkeypatch.setattr(example.rospy, "get_name", lambda: "/record_while_walking_1")
    begun, ended = example.start("walk").functions, example.stop().functions
    assert [(f.camera, f.str_param) for f in begun] == [("top", "walk_top.mp4"), ("bottom", "walk_bottom.mp4")]
    assert {f.id for f in begun} == {f.id for f in ended} and len({f.id for f in begun}) == 2
    assert [f.str_param for f in example.start("").functions] == ["", ""]
