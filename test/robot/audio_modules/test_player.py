"""ALAudioPlayer, heard at the loudspeakers: files, sounds that are loaded, tones, sound sets, streams."""

from __future__ import annotations

import io
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
import pytest
import soundfile
from sounds import RATE, frequency, loudness, played, tone, until, write

from nao_sim_bridge.paths import data_root, sounds_directory
from nao_sim_bridge.services.audio import sound_files, web_stream
from nao_sim_bridge.services.audio.tones import sine

FULL = 0.5 / np.sqrt(2.0)
EDGE = 0.02
"""Time around a change in which its ramp may be heard, s."""
SETS = "soundsets"
SHIPPED = ["alarm", "applause", "bip", "chime", "click", "dance_100", "dance_120", "double_bip", "failure", "success"]


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


def test_a_call_lasts_as_long_as_its_sound(robot, begin):
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


@pytest.mark.parametrize(
    "master, panorama, method, arguments, seconds, left, right",
    [
        (1.0, 0.0, "playFile", ("tone.wav", 0.5, -1.0), 1.0, 0.5, 0.0),
        (0.5, 1.0, "playFile", ("tone.wav",), 1.0, 0.0, 0.5),
        (0.5, -1.0, "playFile", ("tone.wav", 0.5, 1.0), 1.0, 0.25, 0.25),
        (1.0, 0.0, "playFileFromPosition", ("tone.wav", 0.75), 0.25, 1.0, 1.0),
        (1.0, 0.0, "playFileFromPosition", ("tone.wav", 0.75, 0.5, 1.0), 0.25, 0.0, 0.5),
        (1.0, 0.0, "playSine", (1000, 50, -1, 0.5), 0.5, 1.0, 0.0),
        (1.0, 0.0, "playSine", (1000, 50, 0, 0.5), 0.5, 1.0, 1.0),
        (1.0, 0.0, "playSine", (1000, 25, 1, 0.5), 0.5, 0.0, 0.5),
    ],
)
def test_volumes_multiply_pans_add_up_and_calls_have_their_length(
    robot, player, begin, master, panorama, method, arguments, seconds, left, right
):
    player.setMasterVolume(master)
    player.setPanorama(panorama)
    assert player.getMasterVolume() == master
    begun, future = robot.now.time, begin(method, *arguments)
    robot.advance(seconds + 0.01)
    robot.answer(future)
    heard = played(robot, begun + EDGE, begun + seconds - EDGE)
    assert [loudness(side) for side in heard.T] == pytest.approx([left * FULL, right * FULL], rel=0.02, abs=1e-6)


def test_a_loaded_sound_is_played_paused_moved_and_unloaded(robot, player, begin):
    number = player.loadFile("tone.wav")
    assert player.getLoadedFilesIds() == [str(number)] and player.getLoadedFilesNames() == ["tone.wav"]
    assert player.getFileLength(number) == 1.0 and player.loadFile("tone.wav") == number + 1
    begun, future = robot.now.time, begin("play", number)
    robot.advance(0.25)
    assert player.getCurrentPosition(number) == pytest.approx(0.25, abs=1e-4)
    player.pause(number)
    robot.advance(1.0)
    assert player.getCurrentPosition(number) == pytest.approx(0.25, abs=1e-4) and future.isRunning()
    assert not played(robot, begun + 0.25 + EDGE).any()
    again = begin("play", number, 0.5, 0.0)
    assert player.getVolume(number) == 0.5
    player.goTo(number, 0.9)
    robot.advance(0.11)
    robot.answer(future)
    robot.answer(again)
    player.goTo(number, 0.8)
    assert player.getCurrentPosition(number) == pytest.approx(0.8)
    player.setVolume(number, 1.0)
    assert until(robot, begin("play", number)) == pytest.approx(0.2, abs=0.06)
    assert player.getCurrentPosition(number) == 0.0
    playing, begun = begin("play", number), robot.now.time
    robot.advance(0.1)
    player.unloadFile(number)
    robot.answer(playing)
    robot.advance(0.2)
    assert not played(robot, begun + 0.1 + EDGE).any()
    with pytest.raises(RuntimeError, match=f"play no sound is loaded under the id {number}; ids in use: {number + 1}"):
        player.play(number)


def test_playing_what_plays_begins_anew_and_a_paused_sound_can_be_stopped(robot, player, begin):
    number = player.loadFile("tone.wav")
    first = begin("play", number)
    robot.advance(0.5)
    second = begin("play", number)
    robot.answer(first)
    assert player.getCurrentPosition(number) == 0.0
    robot.advance(0.75)
    assert second.isRunning()
    player.pause(number)
    player.stopAll()
    robot.answer(second)
    assert player.getCurrentPosition(number) == 0.0
    with pytest.raises(RuntimeError, match=rf"the sound {number} \(tone.wav\) does not play"):
        player.pause(number)


def test_a_loop_goes_on_until_it_is_stopped(robot, player, begin):
    number = player.loadFile("tone.wav")
    for method, what in (("playFileInLoop", "tone.wav"), ("playInLoop", number)):
        begun, future = robot.now.time, begin(method, what)
        robot.advance(2.3)
        assert future.isRunning() and loudness(played(robot, begun + 1.5)) == pytest.approx(FULL, rel=0.01)
        player.stopAll()
        robot.answer(future)


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


def test_tones_swell_and_fade_within_milliseconds_and_do_not_drift(robot, begin):
    begun = robot.now.time
    until(robot, begin("playSine", 5000, 100, 0, 0.1))
    level = np.abs(played(robot, begun)[:4800, 0])
    assert level[:5].max() < 0.1 and level[-5:].max() < 0.1
    assert level[150:250].max() > 0.95 and level[-250:-150].max() > 0.95
    last = np.arange(60 * RATE - 4896, 60 * RATE - 96)
    np.testing.assert_allclose(
        sine(441, 100, 60.0).samples[last, 0], np.sin(2.0 * np.pi * 441 * last / RATE), atol=1e-3
    )


def test_what_is_refused_names_what_is_allowed(robot, refused, player, monkeypatch):
    folder = robot.server.files.folder
    (folder / "text.wav").write_text("this is no sound")
    (folder / "nothing.wav").write_bytes(b"")
    (folder / "folder.wav").mkdir(exist_ok=True)
    write(robot, "silent.wav", np.zeros((0, 1)))
    write(robot, "long.wav", tone(440.0, 3.0))
    monkeypatch.setattr(sound_files, "LONGEST", 2.0)
    rows = [
        ("playFile", ("missing.wav",), "ALAudioPlayer::playFile .*no file 'missing.wav'"),
        ("playFile", ("/etc/passwd",), "is not inside .*; give a relative name"),
        ("playFile", ("text.wav",), "'text.wav' cannot be read as sound .*; allowed are wav, ogg, flac and mp3"),
        ("playFile", ("nothing.wav",), "'nothing.wav' cannot be read as sound"),
        ("playFile", ("silent.wav",), "'silent.wav' cannot be played: .*holds no sound"),
        ("playFile", ("folder.wav",), "'folder.wav' is a folder, not a file"),
        ("playFile", ("long.wav",), "'long.wav' is 3 s long, allowed are 2 s"),
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
        ("playSine", (0, 50, 0, 1.0), "frequence is 0, allowed is 1 to 20000"),
        ("playSine", (20001, 50, 0, 1.0), "frequence is 20001"),
        ("playSine", (440, 101, 0, 1.0), "gain is 101, allowed is 0 to 100"),
        ("playSine", (440, -1, 0, 1.0), "gain is -1"),
        ("playSine", (440, 50, 2, 1.0), "pan is 2, allowed is -1"),
        ("playSine", (440, 50, 0, 0.0), "duration is 0.0, allowed is above 0 to 600"),
        ("playSine", (440, 50, 0, float("nan")), "duration is nan"),
        ("playSine", (440, 50, 0, 1e9), "duration is 1000000000.0"),
        ("playSoundSetFile", ("nowhere", "bip"), "no sound set 'nowhere'; installed are .*nao_library"),
        ("loadSoundSet", ("mine/..",), "no sound set 'mine/..'; installed are"),
        (
            "playWebStream",
            ("ftp://x/a.wav", 1.0, 0.0),
            "streamName is .*, allowed is an address of http, https or file",
        ),
        ("playWebStream", ("http://127.0.0.1:9/a.wav", 1.0, 0.0), "nothing can be fetched from .*refused"),
    ]
    begun = robot.now.time
    refused("ALAudioPlayer", rows)
    robot.advance(0.3)
    assert not played(robot, begun).any() and player.getLoadedFilesIds() == []


def test_a_file_that_was_cut_off_is_played_as_far_as_it_goes(robot, player):
    path = write(robot, "cut.wav", tone(440.0, 1.0))
    path.write_bytes(path.read_bytes()[: 44 + 48000])
    assert player.getFileLength(player.loadFile("cut.wav")) == 0.5


# --- sound sets -------------------------------------------------------------------------------------------------------


def test_sound_sets_are_listed_loaded_played_and_forgotten(robot, player, begin):
    write(robot, f"{SETS}/mine/beep.wav", tone(440.0, 0.1))
    (robot.server.files.folder / SETS / "mine/notes.txt").write_text("no sound")
    assert {"mine", "nao_library"} <= set(player.getInstalledSoundSetsList())
    assert player.isSoundSetInstalled("nao_library") and not player.isSoundSetInstalled("Nowhere")
    assert sorted(player.getSoundSetFileNames("nao_library")) == SHIPPED
    assert player.getSoundSetFileNames("mine") == ["beep"]
    there = [("mine", "beep"), ("mine", "beep.wav"), ("mine", "notes"), ("yours", "beep"), ("nao_library", "bop")]
    assert [player.isSoundSetFileInstalled(*each) for each in there] == [True, True, False, False, False]
    with pytest.raises(RuntimeError, match="no sound set is loaded; installed are"):
        robot.answer(begin("playSoundSetFile", "beep"))
    player.loadSoundSet("mine")
    player.loadSoundSet("mine")
    assert player.getLoadedSoundSetsList() == ["mine"] and player.isSoundSetLoaded("mine")
    begun = robot.now.time
    for arguments in [
        ("beep",),
        ("mine", "beep"),
        ("mine", "beep", 0.05, 0.5, 0.0, False),
        ("beep.wav", 0.05, 0.5, 1.0, False),
    ]:
        robot.finish("ALAudioPlayer", "playSoundSetFile", *arguments, after=0.2)
    heard = [played(robot, begun + 0.2 * n + 0.01, begun + 0.2 * n + 0.04) for n in range(4)]
    assert [loudness(h[:, 1]) / FULL for h in heard] == pytest.approx([1.0, 1.0, 0.5, 0.5], rel=0.05)
    assert not heard[3][:, 0].any()
    future = begin("playSoundSetFile", "beep", 0.0, 1.0, 0.0, True)
    robot.advance(1.0)
    assert future.isRunning()
    player.stopAll()
    robot.answer(future)
    with pytest.raises(RuntimeError, match="no sound 'bep'; there are mine/beep"):
        robot.answer(begin("playSoundSetFile", "bep"))
    player.unloadSoundSet("mine")
    assert not player.isSoundSetLoaded("mine")
    with pytest.raises(RuntimeError, match="'mine' is not loaded; loaded are none"):
        player.unloadSoundSet("mine")


def test_the_shipped_sounds_can_be_heard_are_small_and_those_of_the_tool(robot, player, monkeypatch):
    monkeypatch.syspath_prepend(str(data_root() / "tools"))
    import make_sounds

    assert sorted(make_sounds.SOUNDS) == SHIPPED
    for name in SHIPPED:
        shipped, rate = soundfile.read(str(sounds_directory() / make_sounds.SET / f"{name}.ogg"))
        assert 0.5 < np.abs(shipped).max() <= 1.0 and len(shipped) / rate < (25.0 if "dance" in name else 2.5)
        assert (rate, len(shipped)) == (make_sounds.RATE, len(make_sounds.made(name)))
    np.testing.assert_array_equal(make_sounds.made("chime"), make_sounds.made("chime"))
    assert sum(path.stat().st_size for path in sounds_directory().rglob("*.ogg")) < 250_000


# --- streams ----------------------------------------------------------------------------------------------------------


class Site(BaseHTTPRequestHandler):
    """Sounds, things that are none, and a stream without an end."""

    leave = threading.Event()
    kinds = {"/a.ogg": "OGG", "/radio": "MP3", "/a.wav": "WAV"}

    def do_GET(self):
        self.send_response({"/inward": 302, "/missing": 404}.get(self.path, 200))
        if self.path == "/inward":
            self.send_header("Location", "file:///etc/passwd")
        self.end_headers()
        if self.path in self.kinds:
            file = io.BytesIO()
            soundfile.write(file, tone(440.0, 1.0, rate=24000), 24000, format=self.kinds[self.path])
            self.wfile.write(file.getvalue())
        try:
            while self.path == "/endless" and not self.leave.is_set():
                self.wfile.write(bytes(65536))
        except OSError:
            pass

    def log_message(self, *_):
        pass


@pytest.fixture
def site(monkeypatch):
    monkeypatch.setenv("no_proxy", "127.0.0.1")
    Site.leave.clear()
    server = ThreadingHTTPServer(("127.0.0.1", 0), Site)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    Site.leave.set()
    server.shutdown()
    server.server_close()


def test_streams_are_fetched_whatever_their_name_and_files_by_their_address(robot, player, begin, site, tmp_path):
    song = write(robot, "my song.wav", tone(440.0, 1.0))
    here = f"file://{song.parent}/my%20song.wav"
    for address in (f"{site}/a.ogg", f"{site}/a.wav", f"{site}/radio", here, "file:///home/nao/my%20song.wav"):
        sound = web_stream.fetch_sound(address, robot.server.files)
        assert sound.rate == RATE and sound.duration == pytest.approx(1.0, abs=0.1)
        assert frequency(sound.samples[12000:36000, 0]) == 440.0
    with pytest.raises(ValueError, match="is not inside .*; give a relative name"):
        web_stream.fetch_sound(f"file://{tmp_path}/outside.wav", robot.server.files)
    begun = robot.now.time
    until(robot, begin("playWebStream", f"{site}/a.wav", 0.5, 0.0))
    assert loudness(played(robot, robot.now.time - 0.7, robot.now.time - 0.2)) == pytest.approx(0.5 * FULL, rel=0.02)
    assert robot.now.time - begun >= 0.95


def test_what_is_no_stream_is_named_and_one_without_an_end_has_one(robot, site, monkeypatch):
    fetch, files = web_stream.fetch_sound, robot.server.files
    for path, words in [
        ("/missing", "nothing can be fetched from .*/missing: .*404"),
        ("/page.html", ".*/page.html' cannot be read as sound"),
        ("/inward", "nothing can be fetched from .*/inward"),
        ("/endless", "endless is larger than 32 MiB"),
    ]:
        with pytest.raises(RuntimeError, match=words):
            fetch(site + path, files)
    for address in ("", "a.wav", "http://", "http:///a.wav", "http://["):
        with pytest.raises(RuntimeError, match="streamName is .*, allowed is an address of http, https or file"):
            fetch(address, files)
    wanted = iter([True, True, False])
    with pytest.raises(RuntimeError, match="cannot be read as sound"):
        fetch(site + "/endless", files, lambda: next(wanted))
    assert next(wanted, None) is None
    monkeypatch.setattr(web_stream, "PATIENCE", 0.0)
    with pytest.raises(RuntimeError, match="endless has not ended after 0 s"):
        fetch(site + "/endless", files)


def test_a_stream_that_is_on_its_way_when_all_is_stopped_is_not_played(robot, player, begin, site):
    future, begun = begin("playWebStream", f"{site}/endless", 1.0, 0.0), robot.now.time
    player.stopAll()
    future.wait(int(1000 * robot.patience))
    assert not future.isRunning()
    robot.advance(0.5)
    assert not played(robot, begun).any() and player.getLoadedFilesIds() == []
