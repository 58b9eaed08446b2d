"""ALAudioPlayer, heard at the loudspeakers: files, sounds that are loaded, tones, sound sets, streams."""

from __future__ import annotations

import io
import threading
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
import pytest
import soundfile
from sounds import RATE, frequency, loudness, played, tone, until, write

from nao_sim_bridge.naoqi.sound.sound_files import SoundFiles
from nao_sim_bridge.naoqi.sound.web_stream import WebStreams

FULL = 0.5 / np.sqrt(2.0)
EDGE = 0.02
"""Time around a change in which its ramp may be heard, s."""


@pytest.fixture
def player(robot, tone_file):
    return robot.ALAudioPlayer


@pytest.fixture
def begin(robot, player):
    """Calls a method that plays; its future when the sound has begun."""

    def call(method, *arguments):
        future = robot.post("ALAudioPlayer", method, *arguments)
        robot.handed_over("ALAudioPlayer")
        return future

    return call


def test_a_call_lasts_as_long_as_its_sound_and_a_loop_until_it_is_stopped(robot, player, begin):
    for method, what in (("playFileInLoop", "tone.wav"), ("playInLoop", player.loadFile("tone.wav"))):
        future = begin(method, what)
        robot.advance(2.3)
        assert future.isRunning() and loudness(played(robot, robot.now.time - 0.5)) == pytest.approx(FULL, rel=0.01)
        player.stopAll()
        robot.answer(future)
    robot.advance(0.1)
    begun, future = robot.now.time, begin("playFile", "tone.wav")
    robot.advance(0.99)
    assert future.isRunning()
    robot.advance(0.05)
    assert robot.answer(future) is None
    heard = played(robot, begun)
    assert frequency(heard[:RATE, 0]) == 440.0
    assert loudness(heard[2400:45600]) == pytest.approx(FULL, rel=0.01)
    np.testing.assert_array_equal(heard[:, 0], heard[:, 1])
    assert not heard[RATE + 100 :].any()


@pytest.mark.parametrize("way", ["cancel", "stop", "stopAll", "reset"])
def test_stopping_a_call_is_silence_at_once_and_forgets_its_file(robot, player, begin, way):
    begun = robot.now.time
    if way == "stop":
        call = player.pCall("playFile", "tone.wav")
        robot.handed_over("ALAudioPlayer")
    else:
        future = begin("playFile", "tone.wav")
    robot.advance(0.25)
    if way == "stop":
        player.stop(call)
        robot.settled()
        assert player.isRunning(call) is False
    else:
        {"cancel": future.cancel, "stopAll": player.stopAll, "reset": robot.NaoSimulation.reset}[way]()
        robot.settled()
        future.wait(int(1000 * robot.patience))
        assert not future.isRunning()
    robot.advance(0.5)
    assert loudness(played(robot, begun, begun + 0.24)) > 0.3
    assert not played(robot, begun + 0.27).any() and player.getLoadedFilesIds() == []


def test_another_pitch_changes_what_plays_at_its_place_and_keeps_a_paused_sound_silent(robot, player, begin):
    number = player.loadFile(write(robot, "long.wav", tone(440.0, 2.0)).name)
    begun, future = robot.now.time, begin("play", number)
    robot.advance(0.5)
    player.setPitch(number, 1.5)
    assert player.getCurrentPosition(number) == pytest.approx(0.5)
    robot.advance(0.5)
    player.pause(number)
    player.disablePitch(number)
    robot.advance(0.5)
    assert not played(robot, begun + 1.0 + EDGE).any()
    begin("play", number)
    assert until(robot, future) == pytest.approx(1.0, abs=0.06)
    heard = [frequency(played(robot, begun + at, begun + at + 0.4)[:, 0]) for at in (0.05, 0.55, 1.6)]
    assert heard == pytest.approx([440.0, 660.0, 440.0], abs=2.6)


def test_what_is_refused_names_what_is_allowed(robot, refused, player, monkeypatch):
    folder = robot.server.files.folder
    (folder / "text.wav").write_text("this is no sound")
    write(robot, "silent.wav", np.zeros((0, 1)))
    write(robot, "long.wav", tone(440.0, 3.0))
    reader = robot.server.sound_reader
    sizes = replace(reader.sizes.sound, client_s=2.0)
    monkeypatch.setattr(reader, "sizes", replace(reader.sizes, sound=sizes))
    rows = [
        ("playFile", ("missing.wav",), "ALAudioPlayer::playFile .*no file 'missing.wav'"),
        ("playFile", ("/etc/passwd",), "is not inside .*; give a relative name"),
        (
            "playFile",
            ("text.wav",),
            "'text.wav' cannot be read: it begins with b'this', which is none of WAV .*, FLAC, Ogg .* and MP3",
        ),
        ("playFile", ("silent.wav",), "'silent.wav' holds no sound"),
        ("playFile", ("long.wav",), "'long.wav' is 3 s long, at most 2 s are allowed"),
        ("playFile", ("tone.wav", 1.0, 2.0), "pan is 2.0, allowed is -1 to 1"),
        ("playFileFromPosition", ("tone.wav", 1.5), "position is 1.5, allowed is 0 to 1"),
        ("goTo", (99, 0.0), "no sound is loaded under the id 99; ids in use: none"),
        ("setMasterVolume", ("loud",), "volume is 'loud', allowed is a number"),
        ("setPanorama", (1.1,), "pan is 1.1"),
        ("playSine", (0, 50, 0, 1.0), "frequence is 0, allowed is 1 to 20000"),
        ("playSine", (440, 101, 0, 1.0), "gain is 101, allowed is 0 to 100"),
        ("playSine", (440, 50, 2, 1.0), "pan is 2, allowed is -1"),
        ("playSine", (440, 50, 0, 0.0), "duration is 0.0, allowed is above 0 to 600"),
        ("playSoundSetFile", ("beep",), "no sound set is loaded; installed are"),
        ("unloadSoundSet", ("mine",), "'mine' is not loaded; loaded are none"),
        ("playSoundSetFile", ("nowhere", "bip"), "no sound set 'nowhere'; installed are .*nao_library"),
        ("playWebStream", ("ftp://x/a.wav", 1.0, 0.0), "streamName is .*, allowed is an address of http, https or f"),
        ("playWebStream", ("http://127.0.0.1:9/a.wav", 1.0, 0.0), "nothing can be fetched from .*refused"),
    ]
    begun = robot.now.time
    refused("ALAudioPlayer", rows)
    robot.advance(0.3)
    assert not played(robot, begun).any() and player.getLoadedFilesIds() == []


class Site(BaseHTTPRequestHandler):
    """A tone, and things that are none."""

    def do_GET(self):
        self.send_response(404 if self.path == "/missing" else 200)
        self.end_headers()
        if self.path == "/radio":
            file = io.BytesIO()
            soundfile.write(file, tone(440.0, 1.0, rate=24000), 24000, format="OGG")
            self.wfile.write(file.getvalue())

    def log_message(self, *_):
        pass


@pytest.fixture
def site():
    server = ThreadingHTTPServer(("127.0.0.1", 0), Site)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()


def test_streams_are_fetched_whatever_their_name_and_files_by_their_address(robot, player, begin, site):
    streams = WebStreams(SoundFiles(robot.server.files, robot.server.sound_reader), allow_private=True)
    song = write(robot, "my song.wav", tone(440.0, 1.0))
    for address in (f"{site}/radio", f"file://{song.parent}/my%20song.wav", "file:///home/nao/my%20song.wav"):
        sound = streams.fetch(address)
        assert sound.rate == RATE and sound.duration == pytest.approx(1.0, abs=0.1)
        assert frequency(sound.samples[12000:36000, 0]) == 440.0
    for address, words in (
        ("file:///root/outside.wav", "is not inside .*; give a relative name"),
        (f"{site}/missing", "nothing can be fetched from .*/missing: .*404"),
        (f"{site}/page.html", ".*/page.html' cannot be read"),
    ):
        with pytest.raises((RuntimeError, ValueError), match=words):
            streams.fetch(address)
    begun = robot.now.time
    until(robot, begin("playWebStream", f"{site}/radio", 0.5, 0.0))
    assert loudness(played(robot, robot.now.time - 0.7, robot.now.time - 0.2)) == pytest.approx(0.5 * FULL, rel=0.02)
    assert robot.now.time - begun >= 0.95


def test_what_is_loaded_has_a_budget_and_the_refusal_names_what_is_there_and_what_makes_room(
    robot, player, monkeypatch
):
    reader = robot.server.sound_reader
    monkeypatch.setattr(
        reader, "sizes", replace(reader.sizes, loaded_sounds=replace(reader.sizes.loaded_sounds, bytes=500_000))
    )
    write(robot, "long.wav", tone(440.0, 2.0))
    player.loadFile("tone.wav")
    words = (
        r"no room for 'long.wav' \(0.4 MB\): 0.5 MB are allowed for all sounds, 1 are loaded or play "
        r"\('tone.wav' 0.2 MB\); unloadFile, unloadAllFiles, unloadSoundSet and stopAll make room"
    )
    for method in ("loadFile", "playFile"):
        with pytest.raises(RuntimeError, match=words):
            getattr(player, method)("long.wav")
    with pytest.raises(RuntimeError, match="no room for 'sound set nao_library'"):
        player.loadSoundSet("nao_library")
    player.unloadAllFiles()
    number = player.loadFile("long.wav")
    with pytest.raises(RuntimeError, match="no room for 'long.wav'"):
        player.setPitch(number, 1.5)  # kept beside the sound as it was
    assert player.getLoadedFilesIds() == [str(number)]
