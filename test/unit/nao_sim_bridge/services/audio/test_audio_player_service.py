"""ALAudioPlayer over the network, heard at the loudspeakers."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile

RATE = 48000


@pytest.fixture
def folder(robot):
    """The folder for recordings, with a tone of 440 Hz and 1 s."""
    folder = robot.server.files.folder
    folder.mkdir(parents=True, exist_ok=True)
    time = np.arange(RATE) / RATE
    soundfile.write(str(folder / "tone.wav"), 0.5 * np.sin(2.0 * np.pi * 440.0 * time), RATE)
    return folder


@pytest.fixture
def player(robot, folder):
    robot.ALAudioPlayer.unloadAllFiles()
    robot.ALAudioPlayer.setMasterVolume(1.0)
    robot.ALAudioPlayer.setPanorama(0.0)
    robot.ALAudioDevice.setOutputVolume(100)
    return robot.ALAudioPlayer


@pytest.fixture
def played(robot):
    """What the loudspeakers played from `begin` to `end`, in s from now back: (frames, 2)."""

    def of(begin, end):
        sound = robot.server.simulation.sound
        return robot.server.runner.call(lambda: sound.loudspeakers.played(begin, end)).samples

    return of


def loudness(samples):
    return np.sqrt(np.mean(np.asarray(samples, dtype=float) ** 2))


def frequency(samples):
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
    return np.argmax(spectrum) * RATE / len(samples)


def test_a_call_lasts_as_long_as_its_sound(robot, player, played):
    begun = robot.now.time
    future = robot.post("ALAudioPlayer", "playFile", "tone.wav")
    robot.handed_over("ALAudioPlayer")
    robot.advance(0.99)
    assert future.isRunning()
    robot.advance(0.05)
    assert robot.answer(future) is None
    heard = played(begun, begun + 1.03)
    assert frequency(heard[:RATE, 0]) == 440.0
    assert loudness(heard[2400:45600]) == pytest.approx(0.3536, rel=0.01)
    np.testing.assert_array_equal(heard[:, 0], heard[:, 1])
    assert not heard[RATE + 100 :].any()


@pytest.mark.parametrize("way", ["cancel", "stop", "stopAll"])
def test_stopping_a_call_is_silence_at_once(robot, player, played, way):
    begun = robot.now.time
    if way == "stop":
        call = player.pCall("playFile", "tone.wav")
        robot.handed_over("ALAudioPlayer")
        robot.advance(0.25)
        player.stop(call)
        robot.settled()
        assert player.isRunning(call) is False
    else:
        future = robot.post("ALAudioPlayer", "playFile", "tone.wav")
        robot.handed_over("ALAudioPlayer")
        robot.advance(0.25)
        if way == "cancel":
            future.cancel()
        else:
            player.stopAll()
        robot.settled()
        future.wait(int(1000 * robot.patience))
        assert not future.isRunning()
    robot.advance(0.5)
    assert loudness(played(begun, begun + 0.24)) > 0.3
    assert not played(begun + 0.27, begun + 0.75).any()
    assert player.getLoadedFilesIds() == []


def test_volume_and_pan_of_a_file(robot, player, played):
    begun = robot.now.time
    robot.finish("ALAudioPlayer", "playFile", "tone.wav", 0.5, -1.0, after=1.01)
    heard = played(begun + 0.1, begun + 0.9)
    assert loudness(heard[:, 0]) == pytest.approx(0.5 * 0.3536, rel=0.01)
    assert not heard[:, 1].any()


def test_a_file_from_a_position_and_in_a_loop(robot, player):
    robot.finish("ALAudioPlayer", "playFileFromPosition", "tone.wav", 0.75, after=0.26)
    robot.finish("ALAudioPlayer", "playFileFromPosition", "tone.wav", 0.75, 0.5, 0.0, after=0.26)
    future = robot.post("ALAudioPlayer", "playFileInLoop", "tone.wav")
    robot.handed_over("ALAudioPlayer")
    robot.advance(2.5)
    assert future.isRunning()
    player.stopAll()
    robot.answer(future)


def test_a_loaded_file_is_played_paused_moved_and_unloaded(robot, player):
    number = player.loadFile("tone.wav")
    assert player.getLoadedFilesIds() == [str(number)]
    assert player.getLoadedFilesNames() == ["tone.wav"]
    assert player.getFileLength(number) == 1.0
    future = robot.post("ALAudioPlayer", "play", number)
    robot.handed_over("ALAudioPlayer")
    robot.advance(0.25)
    assert player.getCurrentPosition(number) == pytest.approx(0.25, abs=1e-4)
    player.pause(number)
    robot.advance(1.0)
    assert player.getCurrentPosition(number) == pytest.approx(0.25, abs=1e-4)
    assert future.isRunning()
    again = robot.post("ALAudioPlayer", "play", number, 0.5, 0.0)
    robot.handed_over("ALAudioPlayer")
    assert player.getVolume(number) == 0.5
    player.goTo(number, 0.9)
    robot.advance(0.11)
    robot.answer(future)
    robot.answer(again)
    player.unloadFile(number)
    assert player.getLoadedFilesIds() == []
    with pytest.raises(RuntimeError, match=f"ALAudioPlayer::play no sound is loaded under the id {number}"):
        player.play(number)


def test_master_volume_and_panorama(robot, player, played):
    player.setMasterVolume(0.5)
    assert player.getMasterVolume() == 0.5
    player.setPanorama(1.0)
    begun = robot.now.time
    robot.finish("ALAudioPlayer", "playFile", "tone.wav", after=1.01)
    heard = played(begun + 0.1, begun + 0.9)
    assert loudness(heard[:, 1]) == pytest.approx(0.5 * 0.3536, rel=0.01)
    assert not heard[:, 0].any()


def test_another_pitch_and_back(robot, player, played):
    number = player.loadFile("tone.wav")
    player.setPitch(number, 1.5)
    begun = robot.now.time
    robot.finish("ALAudioPlayer", "play", number, after=1.01)
    player.disablePitch(number)
    robot.finish("ALAudioPlayer", "play", number, after=1.01)
    assert frequency(played(begun + 0.25, begun + 0.75)[:, 0]) == pytest.approx(660.0, abs=2.1)
    assert frequency(played(begun + 1.26, begun + 1.76)[:, 0]) == pytest.approx(440.0, abs=2.1)


@pytest.mark.parametrize("pan, left, right", [(-1, True, False), (0, True, True), (1, False, True)])
def test_a_tone(robot, player, played, pan, left, right):
    begun = robot.now.time
    robot.finish("ALAudioPlayer", "playSine", 1000, 50, pan, 0.5, after=0.51)
    heard = played(begun + 0.1, begun + 0.4)
    assert [bool(side.any()) for side in heard.T] == [left, right]
    assert loudness(heard[:, 1 if right else 0]) == pytest.approx(0.3536, rel=0.01)


def test_sound_sets(robot, player):
    assert "nao_library" in player.getInstalledSoundSetsList()
    assert player.isSoundSetInstalled("nao_library") and not player.isSoundSetInstalled("Nowhere")
    assert "bip" in player.getSoundSetFileNames("nao_library")
    assert player.isSoundSetFileInstalled("nao_library", "bip") is True
    assert player.isSoundSetFileInstalled("nao_library", "bop") is False
    player.loadSoundSet("nao_library")
    assert player.getLoadedSoundSetsList() == ["nao_library"] and player.isSoundSetLoaded("nao_library")
    for arguments in [
        ("bip",),
        ("nao_library", "bip"),
        ("nao_library", "bip", 0.0, 0.5, 0.0, False),
        ("bip", 0.05, 0.5, 0.0, False),
    ]:
        robot.finish("ALAudioPlayer", "playSoundSetFile", *arguments, after=0.2)
    future = robot.post("ALAudioPlayer", "playSoundSetFile", "bip", 0.0, 1.0, 0.0, True)
    robot.handed_over("ALAudioPlayer")
    robot.advance(1.0)
    assert future.isRunning()
    player.stopAll()
    robot.answer(future)
    player.unloadSoundSet("nao_library")
    assert not player.isSoundSetLoaded("nao_library")
    with pytest.raises(RuntimeError, match="no sound set 'nao_librar'; installed are nao_library"):
        player.loadSoundSet("nao_librar")


def test_a_stream(robot, player, folder, played):
    begun = robot.now.time
    future = robot.post("ALAudioPlayer", "playWebStream", f"file://{folder}/tone.wav", 0.5, 0.0)
    while future.isRunning() and robot.now.time < begun + 30.0:
        robot.advance(0.1)
    robot.answer(future)
    assert loudness(played(begun, robot.now.time)) > 0.0
    with pytest.raises(RuntimeError, match="ALAudioPlayer::playWebStream nothing can be fetched"):
        player.playWebStream("http://127.0.0.1:9/a.wav", 1.0, 0.0)


def test_a_reset_ends_what_plays(robot, player):
    future = robot.post("ALAudioPlayer", "playFile", "tone.wav")
    robot.handed_over("ALAudioPlayer")
    robot.advance(0.25)
    robot.NaoSimulation.reset()
    robot.settled()
    robot.answer(future)
    assert player.getLoadedFilesIds() == []


@pytest.mark.parametrize(
    "method, arguments, message",
    [
        ("playFile", ("missing.wav",), "no file 'missing.wav'"),
        ("playFile", ("/etc/passwd",), "is not inside .*; give a relative name"),
        ("playFile", ("tone.wav", 1.5, 0.0), "volume is 1.5, allowed is 0 to 1"),
        ("playFile", ("tone.wav", 1.0, 2.0), "pan is 2.0, allowed is -1 to 1"),
        ("playFileFromPosition", ("tone.wav", 1.5), "position is 1.5, allowed is 0 to 1"),
        ("playFileFromPosition", ("tone.wav", -1.0), "position is -1.0"),
        ("loadFile", ("",), "is not inside"),
        ("goTo", (99, 0.0), "no sound is loaded under the id 99; ids in use: none"),
        ("pause", (99,), "no sound is loaded"),
        ("setVolume", (99, 0.5), "no sound is loaded"),
        ("setMasterVolume", (-0.1,), "volume is -0.1"),
        ("setPanorama", (1.1,), "pan is 1.1"),
        ("playSine", (0, 50, 0, 1.0), "frequence is 0"),
        ("playSoundSetFile", ("nowhere", "bip"), "no sound set 'nowhere'; installed are nao_library"),
    ],
)
def test_what_is_refused_names_what_is_allowed(player, method, arguments, message):
    with pytest.raises(RuntimeError, match=f"ALAudioPlayer::{method} .*{message}"):
        player.call(method, *arguments)
