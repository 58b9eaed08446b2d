"""Recordings end where they were stopped, also when time passes on while their last part is worked out."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
import soundfile

from nao_sim_bridge.record_dir import ClientFiles, UnusableName
from nao_sim_bridge.services.audio.microphone_formats import MicrophoneFormat
from nao_sim_bridge.services.audio.recorder import FilesInUse, Recorder, RecordingOrder, kind_of
from nao_sim_bridge.sim.errors import BadValue, SimulationStopped


class World:
    """A simulation whose time a test sets, and ears that deliver up to it; also the runner, which acts at once."""

    def __init__(self, bench):
        self._bench = bench
        self.sound = SimpleNamespace(time=0.0, ears=self)
        self.stopped = False
        self.delivered = 0.0

    def execute(self, command, name):
        if self.stopped:
            raise SimulationStopped("the simulation has stopped")
        return self._bench.execute(command, name)

    def listen(self, _name, callback, _wants, _channel, exact):
        assert exact
        self._callback = callback
        return self

    def deliver(self, until):
        count = round((until - self.delivered) * 48000)
        samples = np.full((count, 4), round(1000 * until), dtype=np.int16)
        self._callback(SimpleNamespace(time=self.delivered, samples=samples, rate=48000))
        self.delivered = until

    def close(self):
        """As ears do: what is left up to now, which is later than the moment at which somebody asked for the end."""
        if not self.stopped:
            self.deliver(self.sound.time + 0.05)


@pytest.fixture
def world(bench):
    return World(bench)


@pytest.fixture
def recorder(world, tmp_path):
    return Recorder(world, world, ClientFiles(tmp_path), FilesInUse())


ORDER = RecordingOrder("a.wav", "wav", MicrophoneFormat())


def test_nothing_after_the_stop_is_in_the_file(world, recorder, tmp_path, patience):
    recorder.start(ORDER)
    world.deliver(0.17)
    world.sound.time = 0.25
    recorder.stop().result(patience)
    samples, _ = soundfile.read(str(tmp_path / "a.wav"), dtype="int16")
    assert len(samples) == 12000
    assert set(samples[:8160, 0]) == {170} and set(samples[8160:, 0]) == {300}


def test_what_there_is_is_kept_when_the_simulation_has_stopped(world, recorder, tmp_path):
    recorder.start(ORDER)
    world.deliver(0.17)
    world.stopped = True
    recorder.close()
    assert soundfile.info(str(tmp_path / "a.wav")).frames == 8160


def test_a_stop_without_a_recording_is_no_harm(recorder, patience):
    assert recorder.stop().result(patience) is None


def test_a_file_that_fails_to_open_can_be_tried_again(world, recorder, tmp_path, patience):
    (tmp_path / "a.wav").mkdir()
    for _ in range(2):
        with pytest.raises(UnusableName, match="'a.wav' cannot be written: Is a directory"):
            recorder.start(ORDER)
    (tmp_path / "a.wav").rmdir()
    recorder.start(ORDER)
    recorder.stop().result(patience)


@pytest.mark.parametrize("name, kind", [("a.wav", "wav"), ("day/A.WAV", "wav"), ("a.b.ogg", "ogg")])
def test_the_ending_tells_the_kind(name, kind):
    assert kind_of(name) == kind


@pytest.mark.parametrize("name", ["a.mp3", "wav", ".wav", ""])
def test_other_endings_are_refused(name):
    with pytest.raises(BadValue, match="a name that ends in .wav or .ogg"):
        kind_of(name)
