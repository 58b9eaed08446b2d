"""Makes the sound of a sentence with the effects of its voice, and says when each word and each mark comes in it."""

from __future__ import annotations

import threading
from collections import OrderedDict
from dataclasses import dataclass, replace
from typing import Any, Iterable, Tuple, Union

import numpy as np

from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.sound.pitch import shifted
from nao_sim_bridge.speech.engines import Engines, Speech, Utterance, Word, silence
from nao_sim_bridge.speech.parameters import DoubleVoice, Pronunciations, Prosody
from nao_sim_bridge.speech.sentences import Sentence
from nao_sim_bridge.speech.tags import Bookmark, Cue, Pause, Spoken
from nao_sim_bridge.speech.voices import Voice

# Sounds of repeated texts are kept, up to this length in all, s: 0.2 MB each second, and 12 ms to make it anew.
CACHE_SECONDS = 30.0
# Of the engine's pause before speech, which would be a late answer, and at joints this much is left, s.
JOINT = 0.03
# What is louder is no pause: share of the loudest, and of full scale.
SOUND, LEAST_SOUND = 0.02, 1e-4
# Shortest sound of a sentence: marks need a moment to stand at, s.
SHORTEST = 0.01
# Loudness of all voices while they speak, and the highest peak, as parts of full scale. The peak leaves room for the
# volume of 100 %, which is 2 dB more than that of the start.
LOUDNESS = 0.16
HIGHEST_PEAK = 0.8
# What is less than this part of the loudest is no speech, in blocks of so many s.
SPEAKING = 0.1
BLOCK = 0.02
# Length of the pieces that the pitch is changed in, s: four periods of a low voice.
PITCH_WINDOW = 0.04


@dataclass(frozen=True)
class Style:
    """How everything of one text is spoken: its prosody where no tag says otherwise, its volume 0 to 1."""

    voice: Voice
    prosody: Prosody = Prosody()
    double: DoubleVoice = DoubleVoice()
    pronunciations: Pronunciations = Pronunciations()
    volume: float = 1.0


@dataclass(frozen=True)
class SpokenWord:
    """A word begins: as it is written, without punctuation; its position in its sentence counts from 0."""

    text: str
    position: int


Mark = Union[SpokenWord, Bookmark, Cue]


@dataclass(frozen=True, eq=False)
class Clip:
    """A sentence as sound, one channel, with its marks: (s from its beginning, what comes there), in rising order."""

    text: str
    sound: Sound
    marks: Tuple[Tuple[float, Mark], ...]

    def span(self) -> Tuple[float, float] | None:
        """Where its first and last sound are, s from its beginning: pauses around it are left out. None: silence."""
        samples = np.abs(self.sound.samples).max(axis=1)
        loud = np.flatnonzero(samples > max(SOUND * samples.max(initial=0.0), LEAST_SOUND))
        return (float(loud[0]) / RATE, float(loud[-1] + 1) / RATE) if len(loud) else None


class ClipMaker:
    """Makes clips. Any thread may ask."""

    def __init__(self, engine: Engines) -> None:
        self._engine = engine
        self._lock = threading.Lock()
        self._kept: OrderedDict[Any, Speech] = OrderedDict()

    def make(self, sentence: Sentence, style: Style) -> Clip:
        """The sound of a sentence; blocks until it is there.

        Raises:
            SpeechError: It cannot be said.
        """
        clip = _Assembly()
        runs = _runs(sentence)
        for number, run in enumerate(runs):
            if isinstance(run, Pause):
                clip.add_silence(run.seconds)
                continue
            speech = self._speech(run, style)
            goes_on = number + 1 < len(runs) and not isinstance(runs[number + 1], Pause)
            clip.add_speech(speech, run, goes_on)
        return clip.finished(sentence.text)

    def _speech(self, run: _Run, style: Style) -> Speech:
        """The sound of a run at RATE, its words placed in the text as it is written."""
        spoken, origins = style.pronunciations.spoken(run.text)
        if not any(sign.isalnum() for sign in spoken):
            return Speech(silence(0.0, RATE), RATE, ())
        utterance = Utterance(style.voice.engine, style.voice.engine_voice, spoken, run.prosody.speed)
        key = (utterance, run.prosody.pitch, style.double)
        with self._lock:
            speech = self._kept.get(key)
            if speech is not None:
                self._kept.move_to_end(key)
        if speech is None:
            speech = self._with_effects(self._engine.synthesise(utterance), run.prosody.pitch, style.double)
            self._keep(key, speech)
        return Speech(speech.samples * np.float32(run.prosody.gain), RATE, _as_written(speech.words, origins))

    def _with_effects(self, speech: Speech, pitch: float, double: DoubleVoice) -> Speech:
        rate = speech.rate
        plain = levelled(speech.samples, rate)
        samples = higher(plain, pitch, rate)
        if double.sounds:
            samples = doubled(samples, higher(plain, double.pitch, rate), double, rate)
        resampled = Sound(samples[:, None], rate).at_rate(RATE).samples[:, 0]
        return Speech(resampled, RATE, speech.words)

    def _keep(self, key: Any, speech: Speech) -> None:
        with self._lock:
            self._kept[key] = speech
            while sum(kept.duration for kept in self._kept.values()) > CACHE_SECONDS and len(self._kept) > 1:
                self._kept.popitem(last=False)


@dataclass
class _Run:
    """Text of one prosody, and the marks in it with their places."""

    text: str
    prosody: Prosody
    marks: list[tuple[int, Union[Bookmark, Cue]]]


def _runs(sentence: Sentence) -> list[Union[_Run, Pause]]:
    """What is spoken in one go: a mark alone does not part a text."""
    runs: list[Union[_Run, Pause]] = []
    for part in sentence.parts:
        last = runs[-1] if runs else None
        if isinstance(part, Pause):
            runs.append(part)
        elif isinstance(part, Spoken):
            if isinstance(last, _Run) and (last.prosody == part.prosody or not last.text):
                last.text, last.prosody = last.text + part.text, part.prosody
            else:
                runs.append(_Run(part.text, part.prosody, []))
        else:
            if not isinstance(last, _Run):
                last = _Run("", Prosody(), [])
                runs.append(last)
            last.marks.append((len(last.text), part))
    return runs


class _Assembly:
    """A clip while it is put together."""

    def __init__(self) -> None:
        self._samples: list[np.ndarray] = []
        self._marks: list[tuple[float, Mark]] = []
        self._frames = 0
        self._words = 0

    def add_silence(self, seconds: float) -> None:
        self._add(silence(seconds, RATE))

    def add_speech(self, speech: Speech, run: _Run, goes_on: bool) -> None:
        """Add speech without the engine's pause before it, and behind it where it goes on in another prosody."""
        begin, end = 0.0, speech.duration
        if speech.words:
            begin = max(speech.words[0].start - JOINT, 0.0)
        if speech.words and goes_on:
            end = min(speech.words[-1].end + JOINT, end)
        offset = self._frames / RATE - begin
        # A mark stands where the next word begins, behind the last one where that ends.
        close = speech.words[-1].end if speech.words else begin
        waiting = list(run.marks)
        for word in speech.words:
            while waiting and waiting[0][0] <= word.first:
                self._marks.append((word.start + offset, waiting.pop(0)[1]))
            text = run.text[word.first : word.first + word.length].strip("\"'«»“”‘’()[]{}.,;:!?…¡¿。、！？，-–— \n\t")
            if text:
                self._marks.append((word.start + offset, SpokenWord(text, self._words)))
                self._words += 1
        self._marks += [(close + offset, mark) for _, mark in waiting]
        self._add(speech.samples[round(begin * RATE) : round(end * RATE)])

    def finished(self, text: str) -> Clip:
        if self._frames < SHORTEST * RATE:
            self.add_silence(SHORTEST)
        samples = np.concatenate(self._samples)
        return Clip(text, Sound(samples[:, None], RATE), tuple(self._marks))

    def _add(self, samples: np.ndarray) -> None:
        self._samples.append(samples)
        self._frames += len(samples)


def _as_written(words: Iterable[Word], origins: list[tuple[int, int]]) -> Tuple[Word, ...]:
    """Words of the text as it is spoken, placed in the text as it is written; several may stand for one."""
    placed: list[Word] = []
    for word in words:
        first = origins[word.first][0]
        end = origins[min(word.first + word.length, len(origins)) - 1][1]
        before = placed[-1] if placed else None
        if before is not None and first < before.first + before.length:
            placed[-1] = replace(before, end=word.end)
        else:
            placed.append(Word(first, end - first, word.start, word.end))
    return tuple(placed)


def levelled(samples: np.ndarray, rate: int) -> np.ndarray:
    """(frames,) samples as loud as every voice is."""
    size = max(round(BLOCK * rate), 1)
    blocks = samples[: len(samples) // size * size].reshape(-1, size)
    if not len(blocks):
        return samples
    levels = np.sqrt(np.mean(np.square(blocks, dtype=np.float64), axis=1))
    speaking = levels[levels > SPEAKING * levels.max()]
    if not len(speaking):
        return samples
    gain = min(LOUDNESS / float(np.sqrt(np.mean(np.square(speaking)))), HIGHEST_PEAK / float(np.abs(samples).max()))
    return (samples * gain).astype(np.float32)


def higher(samples: np.ndarray, factor: float, rate: int) -> np.ndarray:
    """(frames,) samples with all frequencies times `factor`, as long as before."""
    if factor == 1.0 or not len(samples):
        return samples
    window = 4 * round(PITCH_WINDOW * rate / 4)
    return shifted(samples[:, None], factor, rate, window)[:, 0]


def doubled(samples: np.ndarray, second: np.ndarray, voice: DoubleVoice, rate: int) -> np.ndarray:
    """Samples of a voice and of its second one together, longer by the delay of the second.

    The level is that of the second against the first, so it leaves the loudness of both together as it is.
    """
    delay = round(voice.delay * rate)
    both = np.zeros(len(samples) + delay, dtype=np.float32)
    both[: len(samples)] = samples
    both[delay : delay + len(second)] += voice.level * second
    return both / np.float32(np.sqrt(1.0 + voice.level**2))
