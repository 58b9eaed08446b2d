"""What the loudspeakers play goes into a file, and to the sound card."""

from __future__ import annotations

import sys
import threading

import numpy as np
import pytest

from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.errors import BadValue, SimulationError
from nao_sim_bridge.sim.simulation import Simulation
from nao_sim_bridge.sim.sound.files import read_sound
from nao_sim_bridge.sim.sound.samples import RATE, sine
from nao_sim_bridge.sim.sound.wav_file import WavFile
from nao_sim_bridge.sound_outlets import CARD_DELAY, SoundCard, SoundCardError, SoundFile


@pytest.fixture
def simulation():
    made = Simulation()
    yield made
    made.close()


class Card:
    """A stand-in for the library of the sound card."""

    class PortAudioError(Exception):
        pass

    def __init__(self, there=True):
        self.there, self.written, self.dry, self.closed = there, [], False, False

    def OutputStream(self, rate, channels, dtype):
        if not self.there:
            raise self.PortAudioError("Error querying device -1")
        assert (rate, channels, dtype) == (RATE, 2, "int16")
        return self

    def start(self):
        pass

    def write(self, samples):
        self.written.append(samples)
        dry, self.dry = self.dry, False
        return dry

    def abort(self):
        self.closed = True

    def close(self):
        assert self.closed


@pytest.fixture
def card(monkeypatch):
    made = Card()
    monkeypatch.setitem(sys.modules, "sounddevice", made)
    return made


def test_the_file_has_silence_and_sound_at_their_times(simulation, tmp_path):
    file = SoundFile(simulation, tmp_path / "all.wav")
    simulation.run(0.5)
    simulation.sound.loudspeakers.play(sine(1000.0, 0.5, 0.5), "say")
    simulation.run(1.5)
    file.close()
    kept = read_sound(tmp_path / "all.wav")
    assert (kept.duration, kept.channels, kept.rate) == (2.0, 2, RATE)
    loud = np.flatnonzero(np.abs(kept.samples[:, 0]) > 1e-3)
    assert loud[0] == pytest.approx(0.5 * RATE, abs=2) and loud[-1] == pytest.approx(RATE, abs=2)
    assert np.array_equal(kept.samples[RATE // 2 : RATE], (sine(1000.0, 0.5, 0.5).pcm16() / 32768.0).repeat(2, axis=1))


def test_the_file_is_whole_while_it_is_written(simulation, tmp_path, patience, monkeypatch):
    written = threading.Event()
    write = WavFile.write

    def tell(file, samples):
        write(file, samples)
        written.set()

    monkeypatch.setattr(WavFile, "write", tell)
    file = SoundFile(simulation, tmp_path / "all.wav")
    simulation.run(0.6)
    assert written.wait(patience)
    assert read_sound(tmp_path / "all.wav").duration >= 0.5
    file.close()


def test_fast_time_waits_for_a_slow_disk(simulation, tmp_path):
    file = SoundFile(simulation, tmp_path / "all.wav")
    assert file.behind in simulation.holds and not file.behind()
    file.close()


def test_a_file_that_cannot_be_written_is_an_error(simulation, tmp_path):
    with pytest.raises(SimulationError, match="cannot be written"):
        SoundFile(simulation, tmp_path / "missing" / "all.wav")


def test_the_card_gets_what_is_played_after_a_short_silence(simulation, card):
    outlet = SoundCard(simulation)
    tone = sine(1000.0, 0.2, 0.5)
    simulation.sound.loudspeakers.play(tone, "say")
    simulation.run(0.3)
    outlet.close()
    sent = np.concatenate(card.written)
    start = round(CARD_DELAY * RATE)
    assert not sent[:start].any() and np.array_equal(sent[start : start + tone.frames, 1], tone.pcm16()[:, 0])
    assert card.closed


def test_a_card_that_ran_dry_gets_its_head_start_again(simulation, card):
    outlet = SoundCard(simulation)
    card.dry = True
    simulation.run(0.1)
    outlet.close()
    assert [len(samples) for samples in card.written].count(round(CARD_DELAY * RATE)) == 2


def test_no_card_and_no_library_are_clear_errors(simulation, monkeypatch):
    monkeypatch.setitem(sys.modules, "sounddevice", Card(there=False))
    with pytest.raises(SoundCardError, match="there is none .*device -1.*--sound-card"):
        SoundCard(simulation)
    monkeypatch.setitem(sys.modules, "sounddevice", None)
    with pytest.raises(SoundCardError, match="libportaudio2"):
        SoundCard(simulation)


def test_a_card_wants_real_time(tmp_path, card):
    server = SimulatorServer(ServerOptions(port=0, speed=2.0, sound_card=True, record_dir=tmp_path))
    with pytest.raises(BadValue, match="1 with a sound card"):
        server.start()
    server.simulation.close()


def test_the_file_stays_in_the_folder_for_recordings(tmp_path):
    server = SimulatorServer(ServerOptions(port=0, sound_file="../all.wav", record_dir=tmp_path / "records"))
    with pytest.raises(BadValue, match="inside"):
        server.start()
    server.simulation.close()
    assert not (tmp_path / "all.wav").exists()


def test_a_server_keeps_what_it_plays(tmp_path, patience):
    server = SimulatorServer(ServerOptions(port=0, paused=True, sound_file="today/all.wav", record_dir=tmp_path))
    server.start()
    try:
        server.runner.call(lambda: server.simulation.sound.loudspeakers.play(sine(500.0, 1.0), "say"))
        server.runner.advance(1.5).result(patience)
    finally:
        server.stop()
    kept = read_sound(tmp_path / "today" / "all.wav")
    assert kept.duration == 1.5 and kept.samples[:RATE].any() and not kept.samples[RATE:].any()
