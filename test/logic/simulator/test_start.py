"""How the simulator is started, which files clients may use, and what its ROS services tell and are documented as."""

from __future__ import annotations

import math
import os
import re
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import pytest
import rospy
from std_srvs.srv import SetBool, SetBoolRequest

from nao_library_msgs.srv import TakePictureRequest
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import (
    ClientFiles,
    NoSuchFile,
    OutsideRecordDir,
    UnusableName,
    unused,
    world_of_client,
)
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.simulation import Scene
from nao_sim_bridge.ros.robot import RosRobot
from nao_sim_bridge.ros.services import success_of, success_service
from nao_sim_bridge.server.cli import parse, server_options
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.world.places import MOST_ROBOTS

LAUNCH = Path(__file__).parents[3] / "launch" / "launch"


def options(*arguments):
    return server_options(parse("nao_sim", arguments))


def test_the_launch_file_starts_the_nodes_of_as_many_robots_as_there_can_be():
    (include,) = (
        each
        for each in ElementTree.parse(LAUNCH / "nao_sim.launch").iter("include")
        if "nao_robots" in each.get("file")
    )
    (text,) = re.fullmatch(r"\$\(eval 1 < int\(arg\('robots'\)\) <= (\d+)\)", include.get("if")).groups()
    assert int(text) == MOST_ROBOTS


def test_the_defaults_are_a_robot_on_the_loopback_in_real_time():
    default = options()
    assert default == ServerOptions(Scene("empty", "V6", "Crouch", 0), "127.0.0.1", 9559, 1.0, False, False)
    assert default.record_dir == Path("~/.ros/nao_recordings") and default.renderer == "auto"
    assert (default.sound_file, default.sound_card, default.robots, default.places) == ("", False, 1, ())
    assert not default.allow_private_streams


def test_every_option_reaches_the_server():
    network, scene = "--port 0 --listen 0.0.0.0", "--world my.yaml --seed 7 --robot V5 --posture Stand"
    trouble = "--friction 0.4 --payload 0.5 --sensor-noise 1 --sensor-delay 0.03 --charger"
    chosen = options(*f"{network} {scene} {trouble} --speed 2.5 --gui --paused --record-dir my/files".split())
    far_from_ideal = dict(friction=0.4, payload=0.5, sensor_noise=1.0, sensor_delay=0.03)
    expected = Scene("my.yaml", "V5", "Stand", 7, charger=True, **far_from_ideal)
    assert chosen == ServerOptions(expected, "0.0.0.0", 0, 2.5, True, True, Path("my/files"))
    chosen = options("--sound-file", "all.wav", "--sound-card", "--renderer", "builtin", "--allow-private-streams")
    assert (chosen.sound_file, chosen.sound_card, chosen.renderer) == ("all.wav", True, "builtin")
    assert chosen.allow_private_streams
    chosen = options("--robots", "3", "--places=-1,0,0; 1,0,180; 0,1,-90")
    assert chosen.robots == 3 and [place.x for place in chosen.places] == [-1.0, 1.0, 0.0]
    assert options("--places", "").places == () and options("--friction", "world").scene == options().scene
    assert {options("--speed", text).speed for text in ("max", "0", "0.0", "inf")} == {math.inf}


@pytest.mark.parametrize("arguments, message", [
    ("--speed -1", "'-1' is not a speed: a number above 0, or max"),
    ("--port 65536", "'65536' is not a port: 0 to 65535"),
    ("--robot V3", "invalid choice: 'V3' (choose from"),
    ("--friction ice", "'ice' is not an amount: a number of 0 or more"),
    ("--sensor-delay nan", "'nan' is not an amount"),
    ("--robots 0", "'0' is not a number of robots: 1 to 8"),
    ("--places here", "is 'here'"),
    ("--wrold empty", "unrecognized arguments: --wrold"),
])  # fmt: skip
def test_wrong_arguments_end_the_program_with_what_is_allowed(capsys, arguments, message):
    with pytest.raises(SystemExit) as ended:
        options(*arguments.split())
    assert ended.value.code == 2 and message in capsys.readouterr().err


@pytest.fixture
def files(tmp_path, monkeypatch):
    """Recordings with two files, and a folder that is shipped with two."""
    for name in ("records/day/one.wav", "shipped/chime.wav", "records/both.wav", "shipped/both.wav"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    monkeypatch.setenv("HOME", str(tmp_path))
    return ClientFiles("~/records", [tmp_path / "shipped"])


def test_files_are_read_from_the_recordings_or_from_what_is_shipped(files, tmp_path):
    assert files.folder == tmp_path / "records"
    for name, found in (
        ("day/one.wav", "records/day/one.wav"),
        ("chime.wav", "shipped/chime.wav"),
        ("both.wav", "records/both.wav"),
        ("/home/nao/day/one.wav", "records/day/one.wav"),
        ("/home//nao/day/../both.wav", "records/both.wav"),
    ):
        assert files.to_read(name).read_text() == found
    for name, told in (
        ("two.wav", "no file 'two.wav' in .*records"),
        ("day", "'day' is a folder, not a file"),
        ("new/a.wav", "no file 'new/a.wav'"),
    ):
        with pytest.raises(NoSuchFile, match=told):
            files.to_read(name)
    assert not (tmp_path / "records/new").exists()


def test_nothing_is_read_or_written_outside_or_by_a_name_that_no_file_can_have(files, tmp_path):
    outside = ["", "..", "../x.wav", "day/../../a.wav", "/etc/passwd", "/home/nao/../x", "/home/naomi/x"]
    (tmp_path / "records/out").symlink_to(tmp_path)
    for name in (*outside, "a\0b", "/root/a.wav", "out/a.wav"):
        for way in (files.to_write, files.to_keep, *([] if name == "out/a.wav" else [files.to_read])):
            with pytest.raises(OutsideRecordDir, match="is not inside .*records; give a relative name"):
                way(name)
    for name in ("n" * 300 + ".wav", "day/" + "é" * 200 + "/a.wav", "abc/" * 2000 + "a.wav"):
        for way in (files.to_read, files.to_write):
            with pytest.raises(UnusableName, match="too long a name") as refused:
                way(name)
            assert len(str(refused.value)) < 200


def test_only_files_of_the_recordings_are_written_to(files, tmp_path):
    for name in ("a.wav", "new/one/a.wav", "day/../a.wav", "..a.wav", "chime.wav", "/home/nao/new/b.wav"):
        path = files.to_write(name)
        assert path == (tmp_path / "records" / name.replace("/home/nao/", "")).resolve() and path.parent.is_dir()
    os.mkfifo(tmp_path / "records/pipe.wav")  # opened for writing it would block
    for name, told in (
        ("day", "'day' cannot be written: Is a directory"),
        ("both.wav/a.wav", "folder of 'both.wav/a.wav' cannot be made"),
        ("pipe.wav", "'pipe.wav' cannot be written: it is no file"),
    ):
        with pytest.raises(UnusableName, match=told):
            files.to_write(name)
    (tmp_path / "link").symlink_to(tmp_path / "shipped")
    linked = ClientFiles(tmp_path / "link")  # a folder that is a link itself
    assert linked.to_write("a.wav") == tmp_path / "shipped" / "a.wav"
    for name in ("free.wav", "free-2.wav", "free-3.wav"):
        unused(tmp_path / "free.wav").touch()
        assert (tmp_path / name).exists()


def test_a_picture_without_a_name_replaces_none(files):
    robot = SimpleNamespace(_server=SimpleNamespace(files=files, picture=lambda view, *size: view.encode()))
    take = lambda **fields: Path(RosRobot.on_picture(robot, TakePictureRequest(**fields)).path)  # noqa: E731
    assert [take(view=view).name for view in ("front", "back")] == ["picture.png", "picture-2.png"]
    assert (files.folder / "picture.png").read_bytes() == b"front"
    assert take(view="side", file="picture.png").read_bytes() == b"side"


def test_what_modules_have_made_can_be_forgotten_and_nothing_else(files, tmp_path):
    for name in ("made/a.wav", "day/two.wav", "both.wav"):
        files.to_write(name).touch()
    files.to_keep("made/film.mp4").touch()
    files.forget()
    left = {path.relative_to(files.folder).as_posix() for path in files.folder.rglob("*") if path.is_file()}
    assert left == {"day/one.wav", "both.wav", "made/film.mp4"}


def test_what_the_robot_remembers_is_again_what_it_was_at_the_start(files):
    remembered = files.folder / "remembered.json"
    remembered.write_bytes(b"old")
    for content in (b"new", b"newer"):
        files.to_change("remembered.json").write_bytes(content)
        files.to_change("made.json").write_bytes(content)
    files.to_change("brought.json").write_bytes(b"made")
    files.to_keep("brought.json").write_bytes(b"brought")
    files.forget()
    assert remembered.read_bytes() == b"old" and not (files.folder / "made.json").exists()
    assert (files.folder / "brought.json").read_bytes() == b"brought"
    remembered.write_bytes(b"of another robot since")
    files.forget()
    assert remembered.read_bytes() == b"of another robot since"


def ended(result=None, error=None):
    task = Task("glide", 1)
    task.finish(result, error)
    return task


def test_a_task_succeeds_with_the_one_it_leads_to_and_tells_errors_and_its_early_end():
    wrong = BadValue("mass", -1, "0 or more")

    def cannot_begin():
        raise wrong

    killed = Task("glide", 1)
    killed.kill()
    assert success_of(lambda: ended(ended()), "stopped") == (True, "")
    for begin in (lambda: ended(error=wrong), lambda: ended(ended(error=wrong)), cannot_begin):
        assert success_of(begin, "stopped") == (False, str(wrong))
    assert success_of(lambda: killed, "stopped") == (False, "stopped")


def test_the_answer_of_a_service_is_filled_by_name(monkeypatch):
    services, wrong = {}, BadValue("data", False, "true")
    monkeypatch.setattr(rospy, "Service", lambda name, kind, handler: services.update({name: (kind, handler)}))
    success_service("~go", SetBool, lambda request: ended(None, None if request.data else wrong), "stopped")
    offered, handle = services["~go"]
    assert offered is SetBool and handle(SetBoolRequest(True)) == {"success": True, "message": ""}
    assert handle(SetBoolRequest(False)) == {"success": False, "message": str(wrong)}


def test_a_client_has_worlds_by_name_from_its_folder_and_from_where_the_first_one_is(tmp_path):
    mine, first = tmp_path / "mine" / "a.yaml", tmp_path / "worlds" / "first.yaml"
    beside, elsewhere = first.with_name("second.yml"), tmp_path / "secret.yaml"
    for path in (mine, first, beside, elsewhere):
        path.parent.mkdir(exist_ok=True)
        path.touch()
    (mine.parent / "link.yaml").symlink_to(elsewhere)
    files = ClientFiles(mine.parent)
    for name, world in (
        ("", ""), ("lab", "lab"), (str(first), str(first)), ("a.yaml", str(mine)), (str(mine), str(mine)),
        ("/home/nao/a.yaml", str(mine)), ("~/a.yaml", str(mine)),
        ("second.yml", str(beside)), (str(beside), str(beside)),
    ):  # fmt: skip
        assert world_of_client(name, files, str(first)) == world
    for name in (str(elsewhere), "../secret.yaml", "link.yaml", "/etc/passwd.yaml", "a\0.yaml", "/a\0.yaml"):
        with pytest.raises(NoSuchFile, match="no world file .* in .*mine or .*worlds"):
            world_of_client(name, files, str(first))
    with pytest.raises(NoSuchFile):
        world_of_client(str(beside), files, "lab")
