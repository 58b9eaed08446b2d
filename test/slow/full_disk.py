"""What is recorded, filmed, learnt and kept on a disk that is full; `test_full_disk.py` runs it on one of 8 MB."""

from __future__ import annotations

import csv
import io
import json
import logging
import os
import re
import shutil
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import av
import numpy as np
import pytest
import rospy
import soundfile
import yaml
from camera_topics import TOP, Topics, numbered_image
from goal_functions import behavior, led, motion, vision
from module_goals import ModuleGoals
from PIL import Image
from services import action_client
from simulator import Simulator

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "nao_library_modules" / "examples"))
from example_parts import walk_record
from nao_library_actions.msg import (
    NaoBehaviorGoal,
    NaoLedAction,
    NaoLedGoal,
    NaoMotionGoal,
    NaoVisionGoal,
)
from nao_library_modules.behaviors.server import NaoBehavior
from nao_library_modules.core.files import Kept, WholeFile, write_whole
from nao_library_modules.driver.camera import camera_calibration
from nao_library_modules.driver.camera.camera_calibration import ideal
from nao_library_modules.motion.motion_server import NaoMotion
from nao_library_modules.process_modules.control import do, seq, top_level
from nao_library_modules.process_modules.trace import save_picture, trace_of
from nao_library_modules.ros.own_stack import OwnMaster
from nao_library_modules.vision import NaoVision
from nao_sim_bridge.testing import wait_until
from nao_sim_bridge.vision.face_memory import FaceMemory

DISK = Path(os.environ["SMALL_DISK"])
FULL = r"cannot be written: No space left on device, 0\.0 MB free in /"
GIVEN = ("all.wav", "house.bnf")
BEHAVIOR = "help: Waits a moment, and nothing else.\ndo:\n- wait: 1.0\n"
LIMIT = 60.0
NODE = Path(__file__).resolve().parents[2] / "nao_library_modules" / "nodes" / "nao_lights"
GRAMMAR = "#BNF+EM V2.1;\n!grammar house;\n!start <s>;\n<s>: yes | no;\n"


def frames(path):
    with av.open(str(path)) as video:
        assert sum(1 for _ in video.decode(video=0)) > 0


OPENS = {
    ".wav": soundfile.read,
    ".ogg": soundfile.read,
    ".mp4": frames,
    ".avi": frames,
    ".png": lambda path: Image.open(path).load(),
    ".jpg": lambda path: Image.open(path).load(),
    ".npz": FaceMemory.load,
    ".json": lambda path: json.loads(path.read_text()),
    ".csv": lambda path: list(csv.DictReader(path.open())),
    ".yaml": lambda path: yaml.safe_load(path.read_text()),
    ".lcf": lambda path: json.loads(path.read_text()),
    ".bnf": Path.read_text,
    ".bin": lambda path: np.fromfile(path, np.uint8).reshape(-1, 120, 160),
}


class Bench:
    """A robot, its modules, and everything of them that writes files."""

    def __init__(self):
        self.robot = robot = Simulator(DISK / "records", speed=float("inf"), sound_file="all.wav")
        robot.ALMotion.setStiffnesses("Body", 1.0)
        self.topics = Topics()
        self.vision = ModuleGoals(
            NaoVision, NaoVisionGoal, robot, topics=self.topics, record_dir=str(DISK / "ros" / "pictures")
        )
        self.motion = ModuleGoals(NaoMotion, NaoMotionGoal, robot, motion_dir=str(DISK / "ros" / "motions"))
        self.behaviors = ModuleGoals(NaoBehavior, NaoBehaviorGoal, robot, behavior_dir=str(DISK / "ros" / "behaviors"))
        self._number = 0
        robot.server.simulation.after_tick.append(self._look)
        robot.ALPhotoCapture.setResolution(0)
        robot.ALVideoRecorder.setResolution(0)
        self.handle = robot.ALVideoDevice.subscribeCamera("looker", 0, 0, 0, 10)
        self.records = robot.server.files.folder
        (self.records / "house.bnf").write_text(GRAMMAR)
        thing = {"name": "card", "face": "anna", "position": [1.0, 0.0, 0.55], "mass": 0.0, "heading": 3.14159}
        robot.NaoSimulation.placeObject(json.dumps(thing))
        robot.advance(1.0)

    def close(self):
        for module in (self.vision, self.motion, self.behaviors):
            module.close()
        self.robot.close()

    def _look(self, snapshot):
        if round(snapshot.time * 1000) % 100 < 8:
            self._number += 1
            image = numbered_image(self._number % 256, snapshot.time)
            image.data = np.random.default_rng(self._number).bytes(len(image.data))
            self.topics.send(TOP, image)

    def growing(self):
        """Name -> how it begins and how it ends: everything that records for a while."""
        robot, device = self.robot, self.robot.ALVideoDevice
        return {
            "sound of all microphones": (
                lambda: robot.ALAudioRecorder.startMicrophonesRecording("all4.wav", "wav", 48000, [1, 1, 1, 1]),
                robot.ALAudioRecorder.stopMicrophonesRecording,
            ),
            "sound as ogg": (
                lambda: robot.ALAudioDevice.startMicrophonesRecording("front.ogg"),
                robot.ALAudioDevice.stopMicrophonesRecording,
            ),
            "video of the robot": (
                lambda: robot.ALVideoRecorder.startRecording("", "robot"),
                robot.ALVideoRecorder.stopRecording,
            ),
            "raw video": (
                lambda: device.recordVideo(self.handle, "raw.bin", 1000, 1),
                lambda: device.stopVideo(self.handle),
            ),
            "film": (
                lambda: robot.NaoSimulation.startFilm("film.mp4", "front", 160, 160, 20.0),
                robot.NaoSimulation.stopFilm,
            ),
            **{
                f"{kind} of a camera": (
                    lambda kind=kind: self.vision.succeed(
                        vision("startRecording", id=kind, str_param=f"walk.{kind}", overwrite=True)
                    ),
                    lambda kind=kind: self.videos_end(kind),
                )
                for kind in ("mp4", "avi")
            },
        }

    def videos_end(self, ident):
        (video,) = self.vision.succeed(vision("stopRecording", id=ident)).recordings
        if video.error:
            raise RuntimeError(video.error)

    def whole(self):
        """Name -> what writes a file as a whole, or raises an error."""
        robot = self.robot

        def learn():
            robot.ALFaceDetection.forgetPerson("Anna")
            robot.finish("ALFaceDetection", "learnFace", "Anna", after=0.6)

        return {
            "photo": lambda: robot.finish("ALPhotoCapture", "takePicture", "", "photo", after=0.2),
            "speech": lambda: robot.ALTextToSpeech.sayToFile("hello you", "hello.wav"),
            "face": learn,
            "grammar": lambda: robot.ALSpeechRecognition.compile("house.bnf", "house.lcf", "English"),
            "picture": lambda: self.vision.succeed(vision("takePicture", str_param="eyes.png", overwrite=True)),
            "motion": lambda: self.motion.succeed(
                motion("recordMotion", str_param="turn", names=["Body"], duration=2.0, rate=50.0, overwrite=True)
            ),
            "behaviour": lambda: self.behaviors.succeed(
                behavior("storeBehavior", "eyes", text=BEHAVIOR, overwrite=True)
            ),
            "calibration": lambda: camera_calibration.write(
                DISK / "ros" / "camera_info" / "top.yaml", ideal(320, 240, 1.06, 0.83)
            ),
            "table": write_table,
            "walk": write_walk,
            **{f"trace as {kind}": lambda kind=kind: write_trace(kind) for kind in ("json", "png")},
            **{f"what {name} keeps": lambda name=name: keep(name) for name in ("NaoTactile", "nao_memory")},
        }


def write_table():
    """As studies write theirs, line by line."""
    with io.TextIOWrapper(WholeFile(DISK / "ros" / "study.csv"), "utf-8", newline="") as file:
        lines = csv.DictWriter(file, ("trial", "reaction_s"))
        lines.writeheader()
        for number in range(100):
            lines.writerow({"trial": number, "reaction_s": 0.5})
            file.flush()


def write_walk():
    foot = (0.0, 0.05, 0.0)
    sample = walk_record.Sample(foot, foot, (0.0, 0.0), (2.5, 2.5), ((0.0, 0.0), (0.0, 0.0)))
    walk_record.save([sample] * 100, DISK / "ros" / "walk.json")


def write_trace(kind):
    """As plans write theirs."""
    roots = []
    top_level(do(seq, do(int), do(float)), observers=[lambda task: roots or roots.append(task)])
    trace, path = trace_of(roots[0]), DISK / "ros" / f"trace.{kind}"
    write_whole(path, trace.to_json()) if kind == "json" else save_picture(trace, path)


class Said(logging.Handler):
    """What a logger says."""

    def __init__(self, name):
        super().__init__()
        self.texts = []
        logging.getLogger(name).addHandler(self)

    def emit(self, record):
        self.texts.append(record.getMessage())


def keep(name):
    """What a node keeps beyond its death; that it cannot is no error of its goals, and told in the log."""
    said = Said("nao_library_modules.core.files")
    Kept(DISK / "ros" / "kept" / f"{name}.json", "run").save([{"sensors": ["head"], "behavior": "hello"}] * 10)
    logging.getLogger("nao_library_modules.core.files").removeHandler(said)
    if said.texts:
        raise RuntimeError(said.texts[0])


def files():
    """Every file on the disk that is no log."""
    return {path for path in DISK.rglob("*") if path.is_file() and path.name != "filler" and path.suffix != ".log"}


def every_file_opens():
    found = files()
    for path in found:
        OPENS[path.suffix](path)
    return len(found)


def error_of(action):
    try:
        action()
    except (RuntimeError, AssertionError) as error:
        return str(error)
    return ""


def fill():
    """Leave no byte."""
    with (DISK / "filler").open("ab", buffering=0) as file:
        for size in (1 << 20, 1 << 12, 1):
            try:
                while True:
                    file.write(bytes(size))
            except OSError:
                continue


def record(growing, meanwhile):
    """Record everything for a while; name -> error, empty if there was none."""
    for begin, _ in growing.values():
        begin()
    meanwhile()
    return {name: error_of(end) for name, (_, end) in growing.items()}


def works(bench, growing, whole):
    """Write every file, without an error; which there are then."""
    errors = record(growing, lambda: bench.robot.advance(1.0))
    errors.update((name, error_of(make)) for name, make in whole.items())
    assert not any(errors.values()), errors
    return {path: (path.stat().st_ino, path.read_bytes()) for path in files() if path.name not in GIVEN}


def fails(bench, growing, whole):
    """Write every file while the disk fills up and is full; name -> error."""

    def run_full():
        bench.robot.advance(0.5)
        fill()
        bench.robot.advance(4.0)

    errors = record(growing, run_full)
    fill()
    return {**errors, **{name: error_of(make) for name, make in whole.items()}}


def test_files_on_a_full_disk():
    with closing(Bench()) as bench:
        growing, whole = bench.growing(), bench.whole()
        old = works(bench, growing, whole)
        print(f"before: {every_file_opens()} files, {shutil.disk_usage(DISK).free / 1e6:.1f} MB free")
        errors = fails(bench, growing, whole)
        for name, error in errors.items():
            print(f"full: {name}: {error.replace(str(DISK), 'DISK')}")
        assert all(re.search(FULL, error) for error in errors.values())
        assert {path: (path.stat().st_ino, path.read_bytes()) for path in old} == old
        print(f"full: {len(errors)} errors, {every_file_opens()} files that open, {len(old)} former ones as they were")
        bench.robot.NaoSimulation.reset()
        for path in (DISK / "filler", *DISK.rglob("*.part1.*")):
            path.unlink()
        new = works(bench, growing, whole)
        assert all(new[path][0] != inode for path, (inode, _) in old.items())
        ended = bench.robot.now.time
    sound = soundfile.info(str(DISK / "records" / "all.wav")).duration
    assert sound == pytest.approx(ended, abs=0.1)
    print(f"with room: {every_file_opens()} files that open; {sound:.1f} s of sound in {ended:.1f} s")


class Node:
    """NaoLights, and a ROS master; their logs are on the disk, and so is that of this process."""

    def __init__(self, robot_port):
        self._robot_port = robot_port
        self.log = DISK / "ros" / "NaoLights.log"
        os.environ["ROS_LOG_DIR"] = str(DISK / "ros")
        self._master = OwnMaster(Path(os.devnull))
        os.environ["ROS_MASTER_URI"] = self._master.uri
        rospy.init_node("full_disk", disable_signals=True)
        self.start()
        self._client = action_client("NaoLights", NaoLedAction)

    def start(self):
        arguments = ["--pport", str(self._robot_port), f"__log:={self.log}"]
        self.process = subprocess.Popen([sys.executable, str(NODE), *arguments], stderr=subprocess.DEVNULL)

    def end(self):
        self.process.kill()
        self.process.wait(LIMIT)
        wait_until(
            lambda: not self._client.wait_for_server(rospy.Duration.from_sec(0.01)), LIMIT, "the end of the node"
        )

    def works(self):
        assert self._client.wait_for_server(rospy.Duration.from_sec(LIMIT))
        self._client.send_goal(NaoLedGoal([led("setIntensity", lights=["FaceLeds"], i_values=[0.5])]))
        assert self._client.wait_for_result(rospy.Duration.from_sec(LIMIT)), "the goal does not end"
        assert self._client.get_state() == 3, self._client.get_goal_status_text()
        assert self.process.poll() is None
        return self.log.stat().st_size

    def close(self):
        rospy.signal_shutdown("it is over")
        self.process.kill()
        self.process.wait(LIMIT)
        self._master.stop()


def test_a_node_whose_log_is_on_the_full_disk():
    with closing(Simulator(DISK / "records")) as robot, closing(Node(robot.port)) as node:
        node.works()
        fill()
        node.works()
        for _ in range(3):  # of which the first may still find room in the last page of the log
            node.end()
            node.start()
            full = node.works()
        (DISK / "filler").unlink()
        node.end()
        node.start()
        with_room = node.works()
    assert full % os.sysconf("SC_PAGE_SIZE") == 0 and with_room > full
    print(f"a node whose log has no room works, also when it is started anew; log {full} B, with room {with_room} B")
