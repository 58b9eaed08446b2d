"""How a voice sounds: NAOqi's parameters of ALTextToSpeech; and what is spoken instead of what is written."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Mapping, Tuple

from nao_sim_bridge.base.errors import BadValue

SPEED, DEFAULT_SPEED = "speed", "defaultVoiceSpeed"
# Name -> (lowest, highest, default). Of PITCH_SHIFT and DOUBLE_VOICE 0 is allowed too: switched off.
RANGES: Mapping[str, Tuple[float, float, float]] = {
    # NAOqi's documentation begins at 1; robots speak lower as well, and programs have them do so.
    "pitchShift": (0.5, 4.0, 1.0),
    "doubleVoice": (1.0, 4.0, 0.0),
    "doubleVoiceLevel": (0.0, 4.0, 0.0),
    "doubleVoiceTimeShift": (0.0, 0.5, 0.0),
    SPEED: (50.0, 400.0, 100.0),
    DEFAULT_SPEED: (50.0, 400.0, 100.0),
    "volume": (0.0, 100.0, 80.0),
    "pitch": (50.0, 200.0, 100.0),
}
SWITCHED_OFF_BY_ZERO = ("pitchShift", "doubleVoice")


@dataclass(frozen=True)
class Prosody:
    """How a text is spoken: factors of the voice's own speed and of all frequencies, 0.5 to 4, and of the amplitude."""

    speed: float = 1.0
    pitch: float = 1.0
    gain: float = 1.0


@dataclass(frozen=True)
class DoubleVoice:
    """A second voice that speaks along, `delay` s later.

    Its pitch is the factor of its frequencies to those of the engine's voice, 0 for no second voice; its level is its
    amplitude as part of the first one's.
    """

    pitch: float = 0.0
    level: float = 0.0
    delay: float = 0.0

    @property
    def sounds(self) -> bool:
        """Whether it can be heard."""
        return self.pitch > 0.0 and self.level > 0.0


def checked(name: str, value: float) -> float:
    """A value that a parameter may have.

    Raises:
        BadValue: There is no such parameter, or the value is out of its range; the text has what is allowed.
    """
    known(name)
    low, high, _ = RANGES[name]
    if name in SWITCHED_OFF_BY_ZERO and value == 0.0:
        return 0.0
    if not low <= value <= high:
        off = "0 (off) or " if name in SWITCHED_OFF_BY_ZERO else ""
        raise BadValue(name, value, f"{off}{low:g} to {high:g}")
    return float(value)


def known(name: str) -> str:
    """`name` if there is such a parameter.

    Raises:
        BadValue: There is not.
    """
    if name not in RANGES:
        raise BadValue("parameter", name, f"one of {', '.join(RANGES)}", RANGES)
    return name


def defaults() -> dict[str, float]:
    """Values of all parameters at the start."""
    return {name: default for name, (_, _, default) in RANGES.items()}


def prosody_of(values: Mapping[str, float]) -> Prosody:
    pitch = (values["pitchShift"] or 1.0) * values["pitch"] / 100.0
    gain = values["volume"] / RANGES["volume"][2]
    return limited(Prosody(values[SPEED] / 100.0, pitch, gain))


def double_voice_of(values: Mapping[str, float]) -> DoubleVoice:
    return DoubleVoice(values["doubleVoice"], values["doubleVoiceLevel"], values["doubleVoiceTimeShift"])


def limited(prosody: Prosody) -> Prosody:
    """A prosody that engines and effects can do: tags and parameters together may ask for more."""
    return replace(prosody, speed=min(max(prosody.speed, 0.5), 4.0), pitch=min(max(prosody.pitch, 0.5), 4.0))


@dataclass(frozen=True)
class Pronunciations:
    """Replacements (word as written, as spoken) of whole words, whatever their capitals; no word twice."""

    entries: Tuple[Tuple[str, str], ...] = ()

    def with_entry(self, word: str, spoken: str) -> Pronunciations:
        """These and one more, which replaces an older one of the same word."""
        return Pronunciations((*self.without(word).entries, (word, spoken)))

    def without(self, word: str) -> Pronunciations:
        return Pronunciations(tuple(entry for entry in self.entries if entry[0].lower() != word.lower()))

    def knows(self, word: str) -> bool:
        return any(entry[0].lower() == word.lower() for entry in self.entries)

    def spoken(self, text: str) -> tuple[str, list[tuple[int, int]]]:
        """The text as it is spoken, and for each of its characters the part (first, end) of `text` it comes from."""
        unchanged = [(place, place + 1) for place in range(len(text))]
        if not self.entries:
            return text, unchanged
        by_word = {word.lower(): spoken for word, spoken in self.entries}
        longest_first = sorted(by_word, key=len, reverse=True)
        pattern = re.compile(rf"(?<!\w)(?:{'|'.join(map(re.escape, longest_first))})(?!\w)", re.IGNORECASE)
        result: list[str] = []
        origins: list[tuple[int, int]] = []
        place = 0
        for found in pattern.finditer(text):
            spoken = by_word[found.group().lower()]
            result += [text[place : found.start()], spoken]
            origins += unchanged[place : found.start()] + [found.span()] * len(spoken)
            place = found.end()
        return "".join([*result, text[place:]]), origins + unchanged[place:]
