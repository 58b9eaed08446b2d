"""Speech as the robot's microphone would hear it, and what the recogniser makes of it. For check_recognition.py."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Iterable, Sequence

import numpy as np

from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.hearing.grammars.grammar import vocabulary
from nao_sim_bridge.hearing.listening import Hypothesis, Listening, Recognised
from nao_sim_bridge.hearing.voice_activity import RATE, SpeechChange
from nao_sim_bridge.hearing.worker import Ear
from nao_sim_bridge.speech.engines import Engines, Utterance

PHRASES = Path(__file__).with_name("recognition_phrases.json")
VOICES = {
    "slt": ("flite", "slt"),
    "rms": ("flite", "rms"),
    "awb": ("flite", "awb"),
    "kal": ("flite", "kal16"),
    "espeak": ("espeak-ng", "en-us"),
}
# Level of a person 1 m away and of a quiet room, dB below full scale of a microphone (65 and 30 dB SPL; 104 is full).
SPEECH_DB = -39.0
ROOM_DB = -74.0
SNR_DB = 20.0
BEFORE_S, AFTER_S = 1.2, 1.0
BLOCK = 2720


@dataclass(frozen=True)
class Heard:
    """What came of one phrase: what was recognised, in order; mostly one or none."""

    said: str
    found: Sequence[Hypothesis]

    def is_right(self, wanted: str) -> bool:
        """Whether this was recognised and nothing else."""
        return [h.phrase for h in self.found] == [wanted]


class Bench:
    """A recogniser that listens for phrases, and voices that speak to it."""

    def __init__(self) -> None:
        self.phrases = json.loads(PHRASES.read_text(encoding="utf-8"))
        self._ear = Ear()
        self._engines = Engines()
        self._said: dict[tuple[str, str], np.ndarray] = {}
        self.seconds = 0.0

    def listen_for(self, phrases: Iterable[str], spotting: bool = False) -> None:
        """Phrases to recognise from now on."""
        self._ear.listen(Listening((vocabulary("bench", phrases, spotting),)))

    def talk(self, texts: Iterable[str], voice: str, seconds: float, pause: float = 0.7) -> np.ndarray:
        """(n,) samples of somebody who says one thing after the other, in the noise of a room; times in s."""
        frames = round(seconds * RATE)
        sound = np.zeros(round(BEFORE_S * RATE))
        for text in texts:
            if len(sound) >= frames:
                break
            sound = np.concatenate([sound, self._voice(text, voice), np.zeros(round(pause * RATE))])
        return sound[:frames] + coloured("white", len(sound[:frames]), 7, ROOM_DB)

    def say(self, text: str, voice: str, noise: str, seed: int) -> Heard:
        """What is recognised of a text in the noise of a room and, unless "clean", in noise 20 dB below the voice."""
        speech = self._voice(text, voice)
        before, after = round(BEFORE_S * RATE), round(AFTER_S * RATE)
        sound = np.pad(speech, (before, after))
        sound = sound + coloured("white", len(sound), seed, ROOM_DB)
        if noise != "clean":
            sound = sound + coloured(noise, len(sound), seed + 1, SPEECH_DB - SNR_DB)
        return Heard(text, [h for event in self.hear(sound) for h in event.hypotheses[:1]])

    def hear(self, sound: np.ndarray) -> list[Recognised]:
        """What is recognised in (n,) samples of 16 kHz, from a start without any background."""
        self._ear.finish(None)
        samples = np.round(np.clip(sound, -1.0, 1.0) * 32767.0).astype(np.int16)
        found: list[SpeechChange | Recognised] = []
        for start in range(0, len(samples) - BLOCK + 1, BLOCK):
            found += self._ear.hear((start / RATE, samples[start : start + BLOCK]))
        self.seconds += len(samples) / RATE
        return [event for event in found if isinstance(event, Recognised)]

    def close(self) -> None:
        """End the voices."""
        self._engines.close()

    def _voice(self, text: str, voice: str) -> np.ndarray:
        if (text, voice) not in self._said:
            engine, name = VOICES[voice]
            speech = self._engines.synthesise(Utterance(engine, name, text))
            samples = Sound(np.asarray(speech.samples), speech.rate).at_rate(RATE).mono().samples[:, 0]
            self._said[text, voice] = at_level(samples, SPEECH_DB)
        return self._said[text, voice]


def at_level(samples: np.ndarray, level_db: float) -> np.ndarray:
    """Samples whose loud parts have a level, dB below full scale."""
    power = np.convolve(samples**2, np.full(320, 1.0 / 320.0), "same")
    loud = power > 1e-3 * power.max()
    return samples * (10.0 ** (level_db / 20.0) / np.sqrt(np.mean(samples[loud] ** 2)))


def coloured(kind: str, frames: int, seed: int, level_db: float) -> np.ndarray:
    """White or pink noise of a level, dB below full scale."""
    wave = _coloured(kind, 1 << (frames - 1).bit_length(), seed % 8)
    return wave[:frames] * 10.0 ** (level_db / 20.0)


@lru_cache(maxsize=64)
def _coloured(kind: str, frames: int, seed: int) -> np.ndarray:
    spectrum = np.fft.rfft(np.random.default_rng(seed).standard_normal(frames))
    spectrum /= np.maximum(np.arange(len(spectrum)), 1) ** {"white": 0.0, "pink": 0.5}[kind]
    wave = np.fft.irfft(spectrum, frames)
    return wave / np.sqrt(np.mean(wave**2))


def not_speech(seconds: float) -> dict[str, np.ndarray]:
    """Sounds that go on and are no speech, by name: (n,) samples of 16 kHz, in the noise of a room."""
    frames = round(seconds * RATE)
    times = np.arange(frames) / RATE
    sounds = {"silence": np.zeros(frames)}
    for kind in ("white", "pink"):
        for level in (SPEECH_DB, SPEECH_DB - SNR_DB):
            sounds[f"{kind} noise {level:.0f} dB"] = coloured(kind, frames, 3, level)
        sounds[f"{kind} bursts"] = coloured(kind, frames, 4, SPEECH_DB) * (times % 2.3 < 0.6)
    gate = times % 1.7 < 0.8
    for frequency in (200.0, 440.0, 1000.0, 3000.0):
        tone = 10.0 ** (SPEECH_DB / 20.0) * np.sqrt(2.0) * np.sin(2.0 * np.pi * frequency * times)
        sounds[f"tones {frequency:.0f} Hz"] = tone * gate
    sounds["steady tone"] = 10.0 ** (SPEECH_DB / 20.0) * np.sqrt(2.0) * np.sin(2.0 * np.pi * 330.0 * times)
    sweep = np.sin(2.0 * np.pi * (300.0 + 600.0 * (times % 1.5)) * (times % 1.5))
    sounds["sweeps"] = 10.0 ** (SPEECH_DB / 20.0) * np.sqrt(2.0) * sweep * (times % 2.5 < 1.5)
    harmonics = sum(np.sin(2.0 * np.pi * 150.0 * k * times) / k for k in range(1, 9))
    sounds["harmonics"] = 10.0 ** (SPEECH_DB / 20.0) * harmonics * (times % 1.9 < 0.7)
    clicks = np.zeros(frames)
    clicks[:: round(0.53 * RATE)] = 0.5
    sounds["clicks"] = np.convolve(clicks, np.exp(-np.arange(160) / 20.0), "same")
    room = coloured("white", frames, 5, ROOM_DB)
    return {name: sound + room for name, sound in sounds.items()}


def sudden(number: int) -> dict[str, np.ndarray]:
    """Sudden noises, by kind: so many of each, all different, 0.2 to 2 s long, 1.5 s apart, in the noise of a room.

    Returns:
        (n,) samples of 16 kHz.
    """
    made = {}
    for number_of_kind, kind in enumerate(("white", "pink", "brown", "speech-shaped", "slams")):
        parts = [np.zeros(2 * RATE)]
        for seed in range(number):
            parts += [_burst(kind, np.random.default_rng([seed, number_of_kind])), np.zeros(round(1.5 * RATE))]
        sound = np.concatenate(parts)
        made[kind] = sound + coloured("white", len(sound), 6, ROOM_DB)
    return made


def _burst(kind: str, random: np.random.Generator) -> np.ndarray:
    frames = round(random.uniform(0.2, 2.0) * RATE)
    noise = random.standard_normal(frames)
    spectrum, frequencies = np.fft.rfft(noise), np.fft.rfftfreq(frames, 1.0 / RATE)
    if kind == "speech-shaped":  # level to 500 Hz, then 9 dB an octave down, in the rhythm of syllables
        spectrum *= np.minimum(1.0, (500.0 / np.maximum(frequencies, 1.0)) ** 1.5) * (frequencies > 100.0)
    else:
        power = {"white": 0.0, "pink": 0.5, "brown": 1.0, "slams": 0.7}[kind]
        spectrum /= np.maximum(frequencies, 20.0) ** power
    wave = np.fft.irfft(spectrum, frames)
    times = np.arange(frames) / RATE
    if kind == "speech-shaped":
        wave *= 1.0 + 0.9 * np.sin(2.0 * np.pi * random.uniform(3.0, 6.0) * times)
    if kind == "slams":  # a bang that dies away, and rattles
        wave *= np.exp(-times / random.uniform(0.03, 0.15)) + 0.3 * np.exp(-np.abs(times - 0.15) / 0.02)
    return wave * 10.0 ** ((SPEECH_DB + random.uniform(-10.0, 10.0)) / 20.0) / np.sqrt(np.mean(wave**2))
