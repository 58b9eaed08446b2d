"""Blocks of README.md and docs/*.md run as they are printed, or are refused as their page says."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
from functools import partial
from pathlib import Path

import pytest
import rosgraph
import rospy
import yaml
from amount import part_of
from launch_lines import launch_lines, missing, without_launch_lines
from programs import Program, at_port, shell
from samples import PAGES, ROOT, samples

from nao_library_modules.console.wizard.layout import read_layout
from nao_sim_bridge.testing import wait_until
from nao_sim_bridge.world.reader import load_world

LIMIT, END_LIMIT = 240.0, 60.0
"""s of wall time for a program, and for its end after Ctrl-C."""
SPEEDS = {"python": 2.0, "shell": 4.0}
"""Times real time: most of it waits for speech, lights and legs. A program's limits are in simulated time, too."""
WITHOUT_ROS = ("docs/library.md", "docs/environments.md")
ALL = [sample for page in PAGES if page not in WITHOUT_ROS for sample in samples(page)]
"""Pages of the library need wheels that the stack does not, and run without ROS: test_library.py."""
REFUSED = re.compile(r"^Traceback|^success: False", re.MULTILINE)
"""In an output: `rosservice` ends with status 0 also when a service has said no."""
SOUND = ROOT / "nao_sim_bridge" / "src" / "nao_sim_bridge" / "sounds" / "nao_library" / "chime.ogg"
"""A file of music that the reader has."""
ONE_IN = 3
"""One in so many blocks runs in the short form."""
HERE = [sample for sample in ALL if not {"no", "part of", "run by"} & set(sample.marks)]
NUMBER = re.compile(r"-?\d+(\.\d+)?")


class Folder:
    """Where the blocks of a page run: the root of this project, as it were, and the home of whoever reads.

    Args:
        root: An empty folder.
        robot: Of the running stack.
    """

    def __init__(self, root: Path, robot) -> None:
        self.root, self.robot = root, robot
        ros_home = Path(os.environ["ROS_HOME"])
        for there in ROOT.iterdir():
            if there.is_dir() and not there.name.startswith(".") or there.suffix == ".md":
                (root / there.name).symlink_to(there)
        shutil.copy(SOUND, root / "music.ogg")
        (root / ".ros").symlink_to(ros_home)
        for name in ("recordings", "behaviors", "motions"):  # where test_stack.launch has them, and where users do
            (ros_home / f"test_{name}").mkdir(exist_ok=True)
            if not (ros_home / f"nao_{name}").exists():
                (ros_home / f"nao_{name}").symlink_to(ros_home / f"test_{name}")

    def put(self, place: str, text: str) -> Path:
        """Write a file of the reader's; returns its path."""
        path = self.root / re.sub("^~/", "", place)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def start(self, *words: str, **variables: str) -> Program:
        """Start a program of a page."""
        if "rostest " in words[-1]:  # it starts a robot of its own, not on the port of the running one
            variables["NAO_PORT"] = "0"
        return Program(words, self.root, {**os.environ, "HOME": str(self.root), **variables})

    def typed(self, command: str) -> list[str]:
        """What runs a command of a page for the robot of the running stack; another simulator takes a free port."""
        return shell(at_port(command, self.robot.port).replace("-m nao_sim_bridge", "-m nao_sim_bridge --port 0"))

    def program(self, text: str) -> list[str]:
        """What runs a Python program of a page for the robot of the running stack."""
        return [sys.executable, str(self.put("program.py", at_port(text, self.robot.port)))]


@pytest.fixture
def folder(sample, stack, tmp_path):
    """With the files that the page tells of; robot and world are as they began."""
    stack.robot.reset()
    made = Folder(tmp_path, stack.robot)
    files = [made.put(other.marks["file"], other.text) for other in samples(sample.page) if "file" in other.marks]
    with stack.robot.at_speed(SPEEDS.get(sample.kind, 1.0)):
        yield made
    for file in files:
        file.unlink()
    calibrations = Path(os.environ["ROS_HOME"]) / "camera_info"
    if calibrations.exists():  # the cameras have read them
        shutil.rmtree(calibrations)
        stack.broken = True


@pytest.mark.parametrize("sample", part_of(HERE, ONE_IN), ids=lambda sample: sample.name)
def test_a_block_does_what_its_page_says(sample, folder):
    {"python": runs_python, "shell": runs_shell, "yaml": runs_data, "json": runs_data}[sample.kind](sample, folder)


@pytest.mark.parametrize("sample", [s for s in ALL if "part of" in s.marks], ids=lambda sample: sample.name)
def test_a_block_stands_in_a_file_that_is_tested(sample):
    assert sample.text in (ROOT / sample.marks["part of"]).read_text(encoding="utf-8")


def runs_python(sample, folder):
    words = folder.program(sample.program)
    if "until" in sample.marks:
        goes_on([words], sample.marks["until"], folder, ROS_NAMESPACE="sample")
    else:
        ends(words, sample, folder)


def runs_shell(sample, folder):
    if "until" in sample.marks:
        lines = [folder.typed(line) for line in sample.text.splitlines()]
        goes_on(lines, sample.marks["until"], folder)
        return
    for line in launch_lines(sample.text):
        assert missing(line) == [], line
    for command, shown in sample.commands:
        others = without_launch_lines(command)
        if others:
            output = ends(folder.typed(f"set -e\n{others}"), sample, folder)
            assert shows(shown, output), f"$ {command}\n{output}"


def ends(words, sample, folder):
    """A program that has to end as the page says; returns what it printed."""
    ended = folder.start(*words).end(LIMIT)
    if "fails" in sample.marks:
        assert ended.status and sample.marks["fails"] in ended.output, str(ended)
    else:
        assert ended.status == 0, str(ended)
    assert not REFUSED.search(ended.output), str(ended)
    return ended.output


def goes_on(lines, wanted, folder, **variables):
    """Programs that do not end, each in a shell of its own, until this is in their output or among the topics."""
    programs = []

    def seen():
        topics = [topic for topic, _ in rospy.get_published_topics()]
        return "\n".join([*(program.output for program in programs), *topics])

    def there():
        assert not any(program.failed for program in programs), seen()
        return re.search(wanted, seen(), re.MULTILINE)

    try:
        for words in lines:
            programs.append(folder.start(*words, **variables))
            for topic in re.findall(r"rostopic echo (/\S+)", words[-1]):
                wait_until(partial(listened, topic), LIMIT, f"rostopic echo {topic}")
        wait_until(there, LIMIT, lambda: f"{wanted!r} in {seen()}")
        assert not REFUSED.search(seen()), seen()  # later it may tell of the Ctrl-C that ends it
    finally:
        for program in programs:
            program.interrupt()
        ended = [program.end(END_LIMIT) for program in programs]
    assert all(end.status is not None for end in ended), "\n".join(map(str, ended))


def listened(topic):
    """Whether a `rostopic echo` listens to a topic, or to the one that such a field belongs to."""
    subscribers = rosgraph.Master("/samples").getSystemState()[1]
    heard = [node for name, nodes in subscribers if f"{topic}/".startswith(f"{name}/") for node in nodes]
    return any(node.startswith("/rostopic_") for node in heard)


def shows(shown, output):
    """Whether an output has these lines, in this order; numbers may be others, and `...` stands for anything."""
    lines = iter(output.splitlines())
    patterns = [re.escape(NUMBER.sub("#", line.strip())).replace(r"\.\.\.", ".*") for line in shown]
    return all(any(re.fullmatch(pattern, NUMBER.sub("#", line.strip())) for line in lines) for pattern in patterns)


def runs_data(sample, folder):
    """A behaviour or protocol can be run, a world or buttons read, topics of the memory appear; others are used."""
    content = json.loads(sample.text) if sample.kind == "json" else sample.document
    file = folder.put("sample.yaml", yaml.safe_dump(content, sort_keys=False))
    if "do" in content:
        ends(["nao", "check", str(file)], sample, folder)
    elif "phases" in content:
        ends(["nao", "study", "check", str(file)], sample, folder)
    elif "groups" in content:
        assert read_layout(sample.text, file.name).groups
    elif "nao_memory" in content:
        ends(["rosparam", "load", str(file), "/sample"], sample, folder)
        node = ["rosrun", "nao_library_modules", "nao_memory", f"_pport:={folder.robot.port}"]
        goes_on([node], "^/sample/nao_memory/FrontTactilTouched$", folder, ROS_NAMESPACE="sample")
    elif "file" in sample.marks:
        used = Path(sample.marks["file"]).name
        others = "".join(block.text for block in samples(sample.page) if "file" not in block.marks)
        assert used in others or re.search(rf'"{Path(used).stem.rpartition("_")[2]}"', others), sample.name
    else:
        assert load_world(str(file)).name == file.stem
