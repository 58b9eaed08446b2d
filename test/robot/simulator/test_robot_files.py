"""The robot's own file system: what one module writes by a path of the robot is what all others have by that path."""

from __future__ import annotations

import os

import cv2
import pytest
from sounds import RATE, loudness, played, tone, write

from nao_library_modules.cli.commands.files_commands import Entry, files_of
from nao_library_modules.cli.direct_robot import DirectRobot
from nao_library_modules.cli.output import CommandFailed

RANDOM = "/usr/share/naoqi/wav/random.wav"
FRONT = [0, 0, 1, 0]
BEHAVIOR = "behaviors: {mine/wait: {do: [{wait: 0.1}]}}"


@pytest.fixture
def here(robot):
    """Path on this computer of a file in the folder of the robot."""
    return lambda name: robot.server.files.folder / name


def test_the_sounds_of_a_robot_are_there_under_all_names_of_their_folder(robot):
    robot.ALAudioDevice.setOutputVolume(100)
    player = robot.ALAudioPlayer
    number = player.loadFile(RANDOM)
    assert player.getFileLength(number) == pytest.approx(8.0)
    began = robot.now.time
    playing = robot.post("ALAudioPlayer", "play", number)
    robot.handed_over("ALAudioPlayer")
    robot.advance(5.0)
    assert player.getCurrentPosition(number) == pytest.approx(5.0, abs=0.1)
    assert loudness(played(robot, began, robot.now.time)) > 0.05
    player.stopAll()
    robot.answer(playing)
    for name in ("begin_reco", "end_reco", "bip_gentle", "0"):
        for folder in ("/usr/share/naoqi/wav", "/opt/aldebaran/share/naoqi/wav"):
            assert 0.05 < player.getFileLength(player.loadFile(f"{folder}/{name}.wav")) < 1.0
    with pytest.raises(RuntimeError, match="no file '/usr/share/naoqi/wav/rando.wav' .*did you mean 'random.wav'"):
        player.loadFile("/usr/share/naoqi/wav/rando.wav")


def test_a_recording_is_played_by_any_path_that_leads_to_it(robot, here):
    recorder, player = robot.ALAudioRecorder, robot.ALAudioPlayer
    recorder.startMicrophonesRecording("/home/nao/recordings/x.wav", "wav", 16000, FRONT)
    robot.advance(0.5)
    recorder.stopMicrophonesRecording()
    assert here("recordings/x.wav").is_file()
    for path in ("~/recordings/x.wav", "/data/home/nao/recordings/x.wav", "recordings/x.wav"):
        assert player.getFileLength(player.loadFile(path)) == pytest.approx(0.5, abs=0.05)
    robot.finish("ALTextToSpeech", "sayToFile", "hello", "/tmp/hello.wav", after=0.1)
    assert player.getFileLength(player.loadFile("/tmp/hello.wav")) > 0.2
    assert here(".robot/tmp/hello.wav").is_file() and not here("tmp").exists()


def test_pictures_and_films_are_answered_by_the_paths_of_the_robot(robot, here, eventually):
    photos, films, device = robot.ALPhotoCapture, robot.ALVideoRecorder, robot.ALVideoDevice
    photos.setResolution(0)
    taken = robot.finish("ALPhotoCapture", "takePictures", 2, "/home/nao/recordings/cameras/", "image", after=0.5)
    assert taken == [[f"/home/nao/recordings/cameras/image_{number}.jpg" for number in (0, 1)]]
    assert cv2.imread(str(here("recordings/cameras/image_1.jpg"))).shape == (120, 160, 3)
    assert robot.finish("ALPhotoCapture", "takePicture", "~", "one", after=0.2) == ["/home/nao/one.jpg"]
    with pytest.raises(RuntimeError, match="file '/home/nao/one.jpg' exists already"):
        photos.takePicture("/home/nao", "one", False)
    films.setResolution(0)
    films.startRecording("/tmp", "walk")
    robot.advance(0.2)
    assert films.stopRecording() == [3, "/tmp/walk.avi"]
    handle = device.subscribeCamera("raw", 0, 0, 11, 30)
    device.recordVideo(handle, "/tmp/raw", 1, 1)
    robot.advance(0.2)
    eventually(lambda: here(".robot/tmp/raw").exists() and here(".robot/tmp/raw").stat().st_size == 160 * 120 * 3)
    device.unsubscribe(handle)


def test_grammars_preferences_and_behaviors_are_found_by_the_paths_of_the_robot(robot, here):
    asr, behaviors = robot.ALSpeechRecognition, robot.ALBehaviorManager
    here("house.bnf").write_text("#BNF+EM V2.1;\n!grammar house;\n!start <s>;\n<s>: yes | no;\n")
    asr.compile("~/house.bnf", "/tmp/house.lcf", "English")
    asr.pause(True)
    asr.addContext("/tmp/house.lcf", "house")
    here("mine").mkdir()
    here("mine/wait.yaml").write_text(BEHAVIOR)
    behaviors.installBehavior("/home/nao/mine/wait.yaml")
    assert behaviors.isBehaviorInstalled("mine/wait")


@pytest.mark.parametrize("module, method, arguments, told", [
    ("ALAudioPlayer", "loadFile", ["/etc/passwd"], "not inside the robot's places /home/nao, /tmp, /usr/share/naoqi"),
    ("ALTextToSpeech", "sayToFile", ["hello", "/usr/share/naoqi/wav/x.wav"], "only read; write to /home/nao or /tmp"),
    ("ALAudioRecorder", "startMicrophonesRecording", ["/home/nao/../x.wav", "wav", 16000, FRONT], "is not inside"),
    ("ALPhotoCapture", "takePicture", ["/usr/share/naoqi", "x"], "is only read"),
    ("ALVideoRecorder", "startRecording", ["/", "x"], "is not inside"),
    ("ALBehaviorManager", "installBehavior", ["/usr/share/x.xar"], "is not inside"),
    ("ALFrameManager", "newBehaviorFromFile", ["/data/home/x.xar", "x"], "is not inside"),
    ("ALSpeechRecognition", "loadVocabulary", ["/tmp/../etc/words"], "is not inside"),
    ("NaoSimulation", "listFiles", ["/etc"], "is not inside"),
    ("NaoSimulation", "readFile", ["~/../x", 0], "is not inside"),
    ("NaoSimulation", "readFile", ["none.wav", 0], "no file 'none.wav'"),
    ("NaoSimulation", "readFile", ["/usr/share/naoqi/wav/random.wav", -1], "offset is -1"),
    ("NaoSimulation", "beginFile", ["/root/x"], "is not inside"),
])  # fmt: skip
def test_what_is_none_of_the_robots_files_is_refused(robot, module, method, arguments, told):
    with pytest.raises(RuntimeError, match=told):
        getattr(robot, module).call(method, *arguments)


def test_who_runs_the_simulator_has_the_files_in_pieces(robot, here):
    files = robot.NaoSimulation
    write(robot, "tone.wav", tone(440.0, 20.0))  # more than a piece
    content = b""
    while piece := bytes(files.readFile("/home/nao/tone.wav", len(content))):
        content += piece
    assert content == here("tone.wav").read_bytes() and len(content) > 1 << 20
    number = files.beginFile("~/sounds/copy.wav")
    assert files.writeFile(number, content[:100], False) == "/home/nao/sounds/copy.wav"
    assert files.listFiles("~/sounds") == {}
    files.factoryReset()
    files.writeFile(number, content[100:], True)
    assert files.listFiles("/home/nao/sounds") == {"copy.wav": len(content)}
    assert here("sounds/copy.wav").read_bytes() == content
    here(os.fsdecode(b"sounds/\xe9.wav")).touch()
    assert files.listFiles("~/sounds") == {"copy.wav": len(content), "\\xe9.wav": 0}
    with pytest.raises(RuntimeError, match=f"number is {number}, allowed is that of a file that is begun"):
        files.writeFile(number, b"more", True)
    files.writeFile(files.beginFile("/usr/share/naoqi/wav/own.wav"), content[: 44 + RATE], True)
    assert "own.wav" in files.listFiles("/opt/aldebaran/share/naoqi/wav") and robot.ALAudioPlayer.loadFile(
        "/usr/share/naoqi/wav/own.wav"
    )


def test_the_command_line_has_the_files_of_a_simulated_robot(robot, here, tmp_path):
    (tmp_path / "empty").touch()
    (tmp_path / "large").write_bytes(bytes(range(256)) * 5000)
    with DirectRobot(robot.address) as link:
        files = files_of(link, "127.0.0.1", None, False)
        for name, remote, path in (("large", "~/day/", "/home/nao/day/large"), ("empty", "/tmp", "/tmp/empty")):
            assert files.place(remote, name) == (path, False)
            files.put(tmp_path / name, path)
            assert files.place(remote, name) == (path, True)
            files.get(path, tmp_path / "back")
            assert (tmp_path / "back").read_bytes() == (tmp_path / name).read_bytes()
        assert here("day/large").is_file() and files.place("day/other", "large") == ("/home/nao/day/other", False)
        assert files.listed("~") == [Entry("day", 0, True)] and files.listed("/tmp") == [Entry("empty", 0, False)]
        with pytest.raises(CommandFailed, match="/home/nao/day is a folder on the robot"):
            files.place("/home/nao/", "day")
        assert files.place("/etc/passwd", "large") == ("/etc/passwd", False)
        with pytest.raises(CommandFailed, match="is not inside the robot's places /home/nao"):
            files.put(tmp_path / "empty", "/etc/passwd")
        with pytest.raises(CommandFailed, match="no file 'missing'"):
            files.get("missing", tmp_path / "back")
