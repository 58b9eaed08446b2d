"""The examples for programs without ROS, run as users run them, against a simulated robot."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.runner import FASTEST
from nao_sim_bridge.sim.simulation import Scene

PACKAGE = Path(__file__).parents[3] / "nao_library_modules"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(PACKAGE / "src")}
PATIENCE = 120.0


def run(name, *options):
    command = [sys.executable, str(PACKAGE / "examples" / f"{name}.py"), *options]
    return subprocess.run(command, env=ENVIRONMENT, timeout=PATIENCE, capture_output=True, text=True)


@pytest.fixture
def server():
    made = SimulatorServer(ServerOptions(port=0, speed=FASTEST))
    made.start()
    yield made
    made.stop()


def test_a_robot_walks_its_bow_and_rests(server):
    done = run("naoqi_walk", "--port", str(server.broker.port), "--length", "0.1")
    assert done.returncode == 0, done.stdout + done.stderr
    assert float(re.search(r"walked (\S+) m", done.stdout).group(1)) == pytest.approx(0.112, abs=0.03)
    x, y, z = server.runner.snapshot.torso.position
    assert (x, y) == pytest.approx((0.1, 0.05), abs=0.06)
    assert z == pytest.approx(0.228, abs=0.02)
    assert max(server.runner.snapshot.stiffnesses) == 0.0


def test_the_things_of_the_lab_are_told_and_drawn(tmp_path):
    lab = SimulatorServer(ServerOptions(Scene(world="lab"), port=0, paused=True))
    lab.start()
    try:
        done = run("look_at_the_lab", "--port", str(lab.broker.port), "--output", str(tmp_path / "room.png"))
    finally:
        lab.stop()
    assert done.returncode == 0, done.stdout + done.stderr
    assert "ball: x 0.30 m, y -0.55 m, z 0.05 m, 0.63 m from the robot" in done.stdout
    assert len(done.stdout.splitlines()) == 6
    with Image.open(tmp_path / "room.png") as picture:
        assert picture.size == (960, 600)


def test_what_the_robot_sees_is_saved(tmp_path):
    lab = SimulatorServer(ServerOptions(Scene(world="lab", posture="Stand"), port=0))
    lab.start()
    try:
        done = run("naoqi_picture", "--port", str(lab.broker.port), "--size", "320x240", str(tmp_path / "seen.png"))
        handles = lab.broker.service("ALVideoDevice").getSubscribers()
    finally:
        lab.stop()
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.search(r"320x240 pixels, taken at \d+\.\d{3} s", done.stdout)
    assert handles == []
    with Image.open(tmp_path / "seen.png") as picture:
        assert picture.size == (320, 240)
        assert all(high - low > 60 for low, high in picture.getextrema())


def test_things_are_placed_moved_drawn_and_cleared_up(server, tmp_path):
    done = run("place_things", "--port", str(server.broker.port), "--output", str(tmp_path / "things.png"))
    assert done.returncode == 0, done.stdout + done.stderr
    assert "red_ball: x 0.50 m, y -0.12 m, z 0.03 m" in done.stdout
    assert "clara: x 1.50 m, y -0.40 m, z 0.00 m" in done.stdout
    assert server.runner.snapshot.placed == ()
    with Image.open(tmp_path / "things.png") as picture:
        assert picture.size == (960, 600)


def test_a_robot_that_is_watched_is_drawn_and_so_is_its_record(server, tmp_path):
    record, first, second = (tmp_path / name for name in ("walk.json", "first.png", "second.png"))
    watched = ["--port", str(server.broker.port), "--watch", "0.2", "--record", str(record), "--output", str(first)]
    done = run("plot_walk", *watched)
    assert done.returncode == 0, done.stdout + done.stderr
    assert not server.runner.snapshot.stiffnesses[0]  # watching moves nothing
    again = run("plot_walk", "--from", str(record), "--output", str(second))
    assert again.returncode == 0, again.stdout + again.stderr
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize("name", ["naoqi_walk", "naoqi_picture", "look_at_the_lab", "place_things", "plot_walk"])
def test_without_a_robot_it_says_so(name):
    done = run(name, "--port", "1")
    assert done.returncode == 1
    assert "NAOqi at 127.0.0.1:1" in done.stdout
    assert "Traceback" not in done.stderr
