"""The examples that walk to places, along paths and by footsteps."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from types import SimpleNamespace

import pytest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped

from nao_library_modules.driver.footsteps import read_steps, step_target
from nao_library_modules.driver.footsteps_walk import FootstepWalk
from nao_library_modules.driver.path_follower_path import WalkPath
from nao_library_modules.driver.planar_frames import read_path, read_place
from nao_library_modules.places import ORIGIN

EXAMPLES = Path(__file__).parents[3] / "nao_library_modules" / "examples"
SERVERS = {
    "walk_to": ("walk_target", "nao_path_follower"),
    "walk_path": ("walk_path", "nao_path_follower"),
    "footsteps": ("footsteps_execution", "nao_footsteps"),
}


def load(name):
    spec = importlib.util.spec_from_file_location(f"example_{name}", EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_target_is_what_the_path_follower_takes():
    place, frame = read_place("target_pose", load("walk_to").goal(0.5, 0.2, 90.0, "base_footprint").target_pose)
    assert place == pytest.approx((0.5, 0.2, math.pi / 2))
    assert frame == "base_footprint"


@pytest.mark.parametrize("shape, length", [("square", 4.0), ("curve", 1.13)])
def test_paths_begin_at_the_robot_and_are_as_long_as_they_should_be(shape, length):
    example = load("walk_path")
    places, frame = read_path(example.goal(getattr(example, shape)(1.0)).path)
    path = WalkPath(places)
    assert frame == "base_footprint"
    assert path.waypoints[0].distance_to(ORIGIN) == 0.0
    assert path.length == pytest.approx(length, abs=0.02)


def test_footsteps_can_be_made_as_they_are():
    steps = read_steps(load("footsteps").steps())
    made = FootstepWalk(None, None).prepared(steps)
    assert [step_target(step) for step in made] == [step_target(step) for step in steps]
    assert sum(step.place.yaw for step in steps) == pytest.approx(0.6)


class FakeClient:
    """A client of a server that is not there, or whose goal ends as the test says, with some feedback before."""

    there = True
    state = GoalStatus.SUCCEEDED
    feedback = None
    name = None

    def __init__(self, name, action):
        type(self).name = name

    def wait_for_server(self, timeout):
        return self.there

    def send_goal(self, goal, feedback_cb):
        if self.feedback is not None:
            feedback_cb(self.feedback)

    def wait_for_result(self):
        return True

    def cancel_goal(self):
        raise AssertionError("nobody ended the example")

    def get_state(self):
        return self.state

    def get_goal_status_text(self):
        return "" if self.state == GoalStatus.SUCCEEDED else "no progress for 10 s"


@pytest.fixture
def play(monkeypatch, capsys):
    """Plays an example; gives its exit status and what it printed."""

    def run(name, *arguments, **facts):
        example = load(name)
        client = type("Client", (FakeClient,), facts)
        monkeypatch.setattr(example, "SimpleActionClient", client)
        monkeypatch.setattr(example.rospy, "init_node", lambda *args, **options: None)
        monkeypatch.setattr(example.rospy, "sleep", lambda duration: None)
        monkeypatch.setattr(example.rospy, "on_shutdown", lambda action: None)
        monkeypatch.setattr(example.rospy, "myargv", lambda: [name, *arguments])
        status = example.main()
        assert client.name == SERVERS[name][0]
        return status, capsys.readouterr().out

    return run


FEEDBACK = {
    "walk_to": SimpleNamespace(base_position=PoseStamped()),
    "walk_path": SimpleNamespace(index=7),
    "footsteps": SimpleNamespace(executed_footsteps=[None, None]),
}
ARGUMENTS = {"walk_to": ["1.0", "-0.5"], "walk_path": ["curve"], "footsteps": []}
LINES = {"walk_to": "x  0.00 m", "walk_path": "waypoint 7 of 40", "footsteps": "2 of 10 steps"}


@pytest.mark.parametrize("name", SERVERS)
def test_progress_and_end_are_shown(play, name):
    status, output = play(name, *ARGUMENTS[name], feedback=FEEDBACK[name])
    assert status == 0
    assert LINES[name] in output
    assert output.endswith("\nsucceeded\n")


@pytest.mark.parametrize("name", SERVERS)
def test_what_goes_wrong_is_told_in_a_line_and_in_the_exit_status(play, name):
    status, output = play(name, *ARGUMENTS[name], state=GoalStatus.ABORTED)
    assert (status, output) == (1, "\naborted no progress for 10 s\n")
    status, output = play(name, *ARGUMENTS[name], there=False)
    assert status == 1
    assert output.startswith(f"there is no {SERVERS[name][1]}")
