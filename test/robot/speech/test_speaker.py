"""The mouth: one text after the other, events at their simulated times, silence at once."""

from __future__ import annotations

import logging
import threading

import numpy as np
import pytest

from nao_sim_bridge.speech.clips import Style
from nao_sim_bridge.speech.engines import SpeechError
from nao_sim_bridge.speech.sentences import sentences
from nao_sim_bridge.speech.speaker import Speaker
from nao_sim_bridge.speech.studio import Studio
from nao_sim_bridge.speech.tags import Cue, Gate
from nao_sim_bridge.speech.voices import Voice, load_voices

NAO = Style(load_voices().voices["naoenu"])
MISSING = Style(Voice("x", "English", "festival", "x"))


class Mouth:
    """A speaker in a simulation whose time passes as long as somebody speaks."""

    def __init__(self, simulation, engines):
        self.simulation = simulation
        self.studio = Studio(engines)
        self.speaker = Speaker(simulation, self.studio)
        self.events = []
        self.speaker.listeners.append(lambda event: self.events.append((simulation.time, event)))
        self._released = threading.Event()
        simulation.shared.wake = self._released.set

    def say(self, text, style=NAO):
        return self.speaker.say(self.studio.read(text, style), style)

    def tick(self):
        """One tick, for which time waits as a fast run does."""
        while any(hold() for hold in self.simulation.holds):
            self._released.wait(0.1)
            self._released.clear()
        self.simulation.tick()

    def run(self, seconds):
        for _ in range(round(seconds / self.simulation.settings.tick_s)):
            self.tick()

    def until(self, task, limit=60.0):
        end = self.simulation.time + limit
        while not task.finished:
            assert self.simulation.time < end
            self.tick()
        return self.simulation.time

    def kinds(self):
        return [event.kind for _, event in self.events]

    def values(self, kind):
        return [event.value for _, event in self.events if event.kind == kind]

    def times(self, kind):
        return [time for time, event in self.events if event.kind == kind]

    def played(self, since, until):
        return self.simulation.sound.loudspeakers.played(since, until).samples[:, 0]


@pytest.fixture
def mouth(bench, engines):
    return Mouth(bench(posture="Sit", stiffness=0.0).simulation, engines)


def test_a_text_ends_with_its_sound_and_words_are_told_when_they_sound(mouth, caplog):
    caplog.set_level(logging.INFO, logger="nao_sim.speech")
    task = mouth.say(r"One \mrk=4\ two. Three.")
    ended = mouth.until(task)
    assert mouth.kinds() == ["enqueued", "started", "sentence", "word", "bookmark", "word", "sentence", "word", "done"]
    assert {event.task_id for _, event in mouth.events} == {task.task_id}
    begins, clips = mouth.times("sentence"), mouth.values("sentence")
    assert ended - begins[0] == pytest.approx(sum(clip.sound.duration for clip in clips), abs=0.02)
    expected = [begin + time for begin, clip in zip(begins, clips) for time, _ in clip.marks]
    assert [t for t, event in mouth.events if event.kind in ("word", "bookmark")] == pytest.approx(expected, abs=0.015)
    assert [word.position for word in mouth.values("word")] == [0, 1, 0] and mouth.values("bookmark") == [4]
    sound = clips[0].sound.samples[:-2000, 0]
    assert np.corrcoef(mouth.played(begins[0], ended)[: len(sound)], sound)[0, 1] > 0.99
    assert "says: One two." in caplog.text


def test_what_cannot_be_said_is_an_error_and_the_next_text_is_said(mouth, caplog):
    broken, fine = mouth.say("One.", MISSING), mouth.say("Two.")
    mouth.until(fine)
    assert isinstance(broken.error, SpeechError) and "festival" in str(broken.error)
    assert "thrown" in mouth.kinds() and mouth.kinds()[-1] == "done" and "cannot speak" in caplog.text


def test_at_a_gate_the_voice_waits(mouth):
    opened, reached = mouth.simulation.task_ids.make("gate"), []

    def wait():
        reached.append(mouth.simulation.time)
        return opened

    read = mouth.studio.tags.read
    items = sentences([*read("One"), Gate(wait), *read("two."), Cue(lambda: reached.append("cue"))])
    task = mouth.speaker.say(items, NAO)
    mouth.run(2.0)
    assert len(reached) == 1 and not task.finished
    opened.finish()
    mouth.until(task)
    assert reached[1] == "cue"


def test_a_long_text_begins_at_once_and_is_made_a_little_ahead_only(bench, counting):
    mouth = Mouth(bench(posture="Sit", stiffness=0.0).simulation, counting)
    task = mouth.say(" ".join(f"This is sentence number {number}." for number in range(100)))
    mouth.run(0.1)
    assert mouth.times("started")
    mouth.run(4.0)
    said = mouth.kinds().count("sentence")
    assert 2 <= said <= 4 and said < counting.asked <= said + 2
    task.kill()
