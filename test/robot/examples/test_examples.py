"""The examples do what they show: programs without ROS, new modules and functions, goals, and what they say."""

from __future__ import annotations

import re
import wave

import av
import genpy
import pytest
import rosbag
from goal_functions import led as f
from PIL import Image
from sensor_msgs.msg import Image as RosImage
from simulator import Simulator

from nao_library_actions.msg import NaoLedGoal
from nao_sim_bridge.core.simulation import Scene

BRAIN0, BRAIN1 = "Head/Led/Front/Right/1", "Head/Led/Front/Right/0"


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


def test_a_robot_that_is_watched_is_drawn_and_so_is_its_record(program, run, robot, tmp_path):
    record, first, second = (tmp_path / name for name in ("walk.json", "first.png", "second.png"))
    program("plot_walk", "--watch", "0.2", "--record", record, "--output", first)
    assert not robot.now.stiffnesses[0]  # watching moves nothing
    assert run("plot_walk", "--from", record, "--output", second)[0] == 0
    assert first.read_bytes() == second.read_bytes()


def test_what_the_robot_has_recorded_is_fetched_and_the_log_tells_where_it_is(program, robot, tmp_path, caplog):
    caplog.set_level("INFO", "nao_sim.files")
    fetched = tmp_path / "mine.wav"
    program("record_and_fetch", "--seconds", "0.2", fetched)
    with wave.open(str(fetched)) as sound:
        assert sound.getframerate() == 16000 and sound.getnframes() > 0
    path, here = "/tmp/record_and_fetch.wav", robot.server.files.folder / ".robot/tmp/record_and_fetch.wav"
    assert here.read_bytes() == fetched.read_bytes()
    assert f"{path} is {here} on this computer; `nao files get {path}` fetches it" in caplog.text


def test_the_pictures_of_a_bag_become_a_film_in_which_each_stands_at_its_time(run, tmp_path):
    bag, film, topic = tmp_path / "walk.bag", tmp_path / "walk.mp4", "/nao_robot/camera/top/image_raw"
    with rosbag.Bag(str(bag), "w") as file:
        for stamp in (5.0, 5.1, 5.6):
            picture = RosImage(height=48, width=64, encoding="bgr8", step=192, data=bytes(64 * 48 * 3))
            picture.header.stamp = genpy.Time.from_sec(stamp)
            file.write(topic, picture, genpy.Time(9))
    assert run("bag_film", bag, film) == (0, f"written: {film}, 3 pictures in 1.1 s\n")
    with av.open(str(film)) as container:
        assert [frame.time for frame in container.decode(video=0)] == pytest.approx([0.0, 0.1, 0.6], abs=1e-3)
    status, output = run("bag_film", bag, tmp_path / "other.mp4", "--topic", "/odom")
    assert status == 1 and "no pictures of the topic /odom" in output and not (tmp_path / "other.mp4").exists()


def test_without_a_robot_they_say_so(run):
    for name in ("record_and_fetch", "naoqi_walk", "naoqi_picture", "look_at_the_lab", "place_things", "plot_walk"):
        status, output = run(name, "--port", "1")
        assert status == 1 and "NAOqi at 127.0.0.1:1" in output


@pytest.mark.parametrize(
    "name, arguments",
    [
        ("look_at_the_lab", ["--output"]),
        ("place_things", ["--output"]),
        ("plot_walk", ["--output"]),
        ("plot_walk", ["--record"]),
        ("plot_sound", ["any.wav", "--output"]),
        ("naoqi_picture", []),
        ("bag_film", ["any.bag"]),
    ],
)
def test_no_file_is_replaced_unasked(run, tmp_path, name, arguments):
    kept = tmp_path / "kept"
    kept.write_text("mine", encoding="utf-8")
    status, output = run(name, *arguments, kept)
    assert status == 1 and f"{kept} is there already: another name, or --overwrite" in output
    assert kept.read_text(encoding="utf-8") == "mine"


def test_a_demonstration_leaves_alone_what_an_earlier_one_left(run, tmp_path):
    (tmp_path / "table.md").touch()
    status, output = run("demo", "--output", tmp_path)
    assert status == 1 and f"{tmp_path} is not empty: another folder, or --overwrite" in output


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
    text = lights.refused(f("blink", times=[0.5, 0.0], **blink))
    assert text == "function 1 (blink): field times: 0.0 is not allowed: 0.01..60 s"
