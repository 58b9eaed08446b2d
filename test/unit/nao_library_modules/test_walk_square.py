"""The arithmetic of the example that walks a square, and what it says when there is nobody to walk."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from types import SimpleNamespace

import pytest

EXAMPLE = Path(__file__).parents[3] / "nao_library_modules" / "examples" / "walk_square.py"


@pytest.fixture
def example():
    spec = importlib.util.spec_from_file_location("walk_square", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_each_corner_is_a_side_ahead_and_a_quarter_to_the_left(example):
    place = (0.0, 0.0, 0.0)
    for corner in example.square(0.5):
        assert example.seen_from(place, corner) == pytest.approx((0.5, 0.0, math.pi / 2))
        place = corner
    assert place == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (1.0, -2.0, 0.7), (-0.3, 0.2, -3.0)])
def test_targets_are_the_same_seen_from_the_start_and_in_the_odometry(example, start):
    target = (0.4, -0.1, 1.2)
    assert example.seen_from(start, example.in_odometry(start, target)) == pytest.approx(target)


def test_it_turns_the_short_way(example):
    assert example.seen_from((0.0, 0.0, 3.0), (0.0, 0.0, -3.0))[2] == pytest.approx(2 * math.pi - 6.0)


def test_what_goes_wrong_is_told_in_a_line_and_in_the_exit_status(example, monkeypatch, capsys):
    def refuse(limit):
        raise example.rospy.ROSException("timeout exceeded while waiting for service /cmd_pose_srv")

    monkeypatch.setattr(example.rospy, "init_node", lambda *args, **options: None)
    monkeypatch.setattr(example.rospy, "myargv", lambda: ["walk_square.py"])
    service = SimpleNamespace(wait_for_service=refuse)
    monkeypatch.setattr(example.rospy, "ServiceProxy", lambda name, kind: service)
    assert example.main() == 1
    assert "the square ends here: timeout exceeded while waiting for service /cmd_pose_srv" in capsys.readouterr().out
