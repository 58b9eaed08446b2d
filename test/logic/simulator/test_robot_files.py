"""Paths of the robot and of this computer: each leads to the other, and none leads out."""

from __future__ import annotations

import pytest

from nao_sim_bridge.base.config import robot_files_directory
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles, NoSuchFile, OutsideRecordDir, UnusableName, load_places
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.server.files_control import FilesControl

RANDOM = "/usr/share/naoqi/wav/random.wav"


@pytest.fixture
def files(tmp_path):
    return ClientFiles(tmp_path / "records", [tmp_path / "shipped"])


@pytest.mark.parametrize("name, inside, answered", [
    ("a.wav", "a.wav", "/home/nao/a.wav"),
    ("day/../a.wav", "a.wav", "/home/nao/a.wav"),
    ("~/a.wav", "a.wav", "/home/nao/a.wav"),
    ("~nao/day/a.wav", "day/a.wav", "/home/nao/day/a.wav"),
    ("~other/a.wav", "~other/a.wav", "/home/nao/~other/a.wav"),
    ("/home/nao/recordings/cameras/a.jpg", "recordings/cameras/a.jpg", "/home/nao/recordings/cameras/a.jpg"),
    ("//home/nao//a.wav", "a.wav", "/home/nao/a.wav"),
    ("/data/home/nao/a.wav", "a.wav", "/home/nao/a.wav"),
    ("/var/persistent/home/nao/a.wav", "a.wav", "/home/nao/a.wav"),
    ("/tmp/a.wav", ".robot/tmp/a.wav", "/tmp/a.wav"),
    ("/tmp/../home/nao/a.wav", "a.wav", "/home/nao/a.wav"),
    ("../../tmp/a.wav", ".robot/tmp/a.wav", "/tmp/a.wav"),
])  # fmt: skip
def test_a_path_of_the_robot_is_one_in_the_folder_and_back(files, name, inside, answered):
    path = files.to_write(name)
    assert path == files.folder / inside and path.parent.is_dir()
    path.write_bytes(b"new")
    assert files.to_read(name) == path and files.to_read(answered) == path
    assert files.to_robot(path) == answered


@pytest.mark.parametrize("folder", ["/usr/share/naoqi", "/opt/aldebaran/share/naoqi", "/opt/naoqi/data"])
def test_what_the_robot_has_of_its_own_is_read_and_not_written_by_its_modules(files, folder):
    name = f"{folder}/wav/random.wav"
    path = files.to_read(name)
    assert path == robot_files_directory() / RANDOM[1:] and files.to_robot(path) == RANDOM
    with pytest.raises(UnusableName, match="/usr/share/naoqi is only read; write to /home/nao or /tmp"):
        files.to_write(name)
    with pytest.raises(NoSuchFile, match="in /usr/share/naoqi: did you mean 'random.wav'"):
        files.to_read(f"{folder}/wav/rando.wav")
    own = files.to_keep(name)  # of who runs the simulator
    own.write_bytes(b"mine")
    assert files.to_read(name) == own and files.to_robot(own) == RANDOM
    with pytest.raises(UnusableName, match="only read"):
        files.to_write(str(own.relative_to(files.folder)))


@pytest.mark.parametrize("name", [
    "/etc/passwd", "/", "/home", "/tmp/..", "/home/nao/../naomi/a", "/tmpx/a", "/usr/share/a",
    "/usr/share/naoqi/../a", "~/../a", "../../../../../../etc/passwd", "/tmp/../etc/passwd",
    "/home/nao\0/a", "/root/~/a",
])  # fmt: skip
def test_other_paths_are_refused_with_the_robots_places(files, name):
    for way in (files.to_write, files.to_keep, files.to_read):
        with pytest.raises(OutsideRecordDir, match="places /home/nao, /tmp, /usr/share/naoqi, which are kept in "):
            way(name)
    assert not files.folder.exists()


@pytest.mark.parametrize("name", ["/home/nao", "~nao/", ".", "day/..", "/data/home/nao", "/tmp/../usr/share/naoqi"])
def test_a_place_itself_is_no_file(files, name):
    for way in (files.to_write, files.to_keep, files.to_read):
        with pytest.raises(UnusableName, match=f"^'{name}' is a folder, not a file$"):
            way(name)
    assert not files.folder.exists()


def test_no_link_leads_out_of_any_place(files, tmp_path):
    secret = tmp_path / "secret"
    secret.write_text("secret")
    for inside, name in ((".", "/home/nao"), (".robot/tmp", "/tmp"), (".robot/usr/share/naoqi", "/usr/share/naoqi")):
        folder = files.folder / inside
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "file").symlink_to(secret)
        (folder / "folder").symlink_to(tmp_path)
        (folder / "loop").symlink_to(folder / "loop")
        for leaf in ("file", "folder/secret", "loop"):
            for way in (files.to_keep, files.to_read):
                with pytest.raises((OutsideRecordDir, NoSuchFile)):
                    way(f"{name}/{leaf}")
        assert not {"file", "folder/", "loop"} & set(files.listed(name))
        with pytest.raises((OutsideRecordDir, NoSuchFile)):
            files.listed(f"{name}/folder")
    with pytest.raises(OutsideRecordDir, match="none of the robot's files"):
        files.to_robot(secret)
    (files.folder / "to_tmp").symlink_to(files.folder / ".robot/tmp")
    assert files.to_robot(files.to_write("to_tmp/a.wav")) == "/tmp/a.wav"


def test_names_that_no_file_can_have_are_refused_shortly(tmp_path):
    files = ClientFiles(tmp_path / ("d" * 200))
    for name in ("/tmp/" + "n" * 300, "~/" + "abc/" * 990 + "a", "/usr/share/naoqi/" + "é" * 200):
        for way in (files.to_read, files.to_keep):
            with pytest.raises(UnusableName, match="too long a name"):
                way(name)


def test_folders_are_listed_without_what_is_not_for_users(files):
    assert files.listed("~") == {} == files.listed("/tmp")
    for name in ("b.wav", "a.wav", "recordings/cameras/x.jpg", "/tmp/t.wav"):
        files.to_write(name).write_bytes(b"four")
    (files.folder / f".nao_library-{'5a' * 16}.draft").touch()
    (files.folder / "thesis.draft").write_bytes(b"four")
    there = [("a.wav", 4), ("b.wav", 4), ("recordings/", 0), ("thesis.draft", 4)]
    assert list(files.listed("~").items()) == there
    assert files.listed("recordings") == {"cameras/": 0}
    assert files.listed("/home/nao/recordings/cameras/") == {"x.jpg": 4}
    assert files.listed("/tmp/") == {"t.wav": 4} and files.listed("/usr/share/naoqi") == {"wav/": 0}
    sounds = files.listed("/opt/aldebaran/share/naoqi/wav")
    assert {"random.wav", "begin_reco.wav", "end_reco.wav", "bip_gentle.wav", "0.wav"} <= set(sounds)
    with pytest.raises(NoSuchFile, match="no folder '~/nowhere'"):
        files.listed("~/nowhere")
    with pytest.raises(OutsideRecordDir):
        files.listed("/etc")


def test_what_was_made_in_any_place_can_be_forgotten(files):
    for name in ("/tmp/a.wav", "~/day/b.wav"):
        files.to_write(name).touch()
    files.forget()
    assert [path for path in files.folder.rglob("*") if path.is_file()] == []


def test_each_of_two_uploads_of_one_file_is_whole_and_nothing_else_removes_it(files):
    control = FilesControl(lambda: files)
    one, other = control.begin("~/a.wav"), control.begin("/home/nao/a.wav")
    for number, piece in ((one, b"one "), (other, b"other ")):
        assert control.write(number, piece, False) == "/home/nao/a.wav"
    ClientFiles(files.folder)  # of a second simulator
    assert files.listed("~") == {}
    files.to_write("a.wav").touch()  # by a module of the robot
    for number, content in ((one, b"one more"), (other, b"other more")):
        control.write(number, b"more", True)
        assert files.to_read("a.wav").read_bytes() == content
    files.forget()
    assert files.listed("~") == {"a.wav": 10}


def test_of_too_many_uploads_the_oldest_is_given_up(files):
    control = FilesControl(lambda: files)
    first, *others = [control.begin("a.wav") for _ in range(load_sizes().clients.uploads + 1)]
    with pytest.raises(BadValue, match=f"number is {first}, allowed is that of a file that is begun"):
        control.write(first, b"old", True)
    assert len([*files.folder.iterdir()]) == len(others)
    control.write(others[0], b"new", True)
    assert files.to_read("a.wav").read_bytes() == b"new"


def test_an_upload_that_is_given_up_leaves_no_draft_and_changes_nothing(files):
    files.to_write("a.wav").write_bytes(b"by a module")
    control = FilesControl(lambda: files)
    control.write(control.begin("a.wav"), b"half", False)
    control.close()
    assert [path.name for path in files.folder.iterdir()] == ["a.wav"]
    files.forget()
    assert not [*files.folder.iterdir()]


def test_no_place_is_in_another_but_in_the_home():
    home, *others = load_places()
    assert home.folder == "." and all(place.folder.startswith(".robot/") for place in others)
    names = [name for place in (home, *others) for name in (place.path, *place.other_names)]
    assert not [(one, two) for one in names for two in names if one != two and one.startswith(two + "/")]
