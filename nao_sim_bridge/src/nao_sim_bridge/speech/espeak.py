"""The espeak-ng library: voices in many languages. Used in the speech process only."""

from __future__ import annotations

import ctypes
import re
from ctypes import POINTER, c_char_p, c_int, c_short, c_size_t, c_uint, c_void_p

LIBRARY = "libespeak-ng.so.1"
# Numbers of espeak-ng's interface.
SYNCHRONOUS, NO_EXIT = 2, 0x8000
RATE = 1
UTF8, END_PAUSE = 1, 0x1000
END_OF_LIST, WORD, END_OF_CLAUSE = 0, 1, 5
CHARACTER = 1
# Words a minute at normal speed.
WORDS_PER_MINUTE = 175
# From here on scripts write no blanks between words: what espeak-ng calls a word is taken as it is.
FIRST_WITHOUT_BLANKS = "\u2e80"


class _Id(ctypes.Union):
    _fields_ = [("number", c_int), ("name", c_char_p), ("string", ctypes.c_char * 8)]


class _Event(ctypes.Structure):
    _fields_ = [
        ("type", c_int),
        ("unique_identifier", c_uint),
        ("text_position", c_int),
        ("length", c_int),
        ("audio_position", c_int),
        ("sample", c_int),
        ("user_data", c_void_p),
        ("id", _Id),
    ]


_Callback = ctypes.CFUNCTYPE(c_int, POINTER(c_short), c_int, POINTER(_Event))


class Espeak:
    """All voices of espeak-ng."""

    def __init__(self) -> None:
        self._library = ctypes.CDLL(LIBRARY)
        self._library.espeak_Initialize.argtypes = [c_int, c_int, c_char_p, c_int]
        self._library.espeak_SetVoiceByName.argtypes = [c_char_p]
        arguments = [c_char_p, c_size_t, c_uint, c_int, c_uint, c_uint, c_void_p, c_void_p]
        self._library.espeak_Synth.argtypes = arguments
        self._rate = self._library.espeak_Initialize(SYNCHRONOUS, 0, None, NO_EXIT)
        if self._rate <= 0:
            raise OSError("espeak-ng finds none of its data files")
        self._sound: list[bytes] = []
        self._events: list[tuple[int, int, int, float]] = []
        self._callback = _Callback(self._receive)  # kept: the library keeps only its address
        self._library.espeak_SetSynthCallback(self._callback)

    def voices(self) -> None:
        """All are there, in one file each: none is listed."""

    def prepare(self, voice: str) -> None:
        """Nothing: voices are small."""

    def synthesise(self, voice: str, text: str, speed: float) -> tuple[int, bytes, list[tuple[int, int, float, float]]]:
        """Make speech; see `worker`."""
        if self._library.espeak_SetVoiceByName(voice.encode("utf-8")) != 0:
            raise ValueError(f"espeak-ng has no voice {voice!r}")
        self._library.espeak_SetParameter(RATE, round(WORDS_PER_MINUTE * speed), 0)
        self._sound, self._events = [], []
        content = text.encode("utf-8") + b"\0"
        self._library.espeak_Synth(content, len(content), 0, CHARACTER, 0, UTF8 | END_PAUSE, None, None)
        return self._rate, b"".join(self._sound), _words(text, self._events)

    def _receive(self, samples: ctypes.Array, count: int, events: ctypes.Array) -> int:
        if samples and count > 0:
            self._sound.append(ctypes.string_at(samples, 2 * count))
        number = 0
        while events[number].type != END_OF_LIST:
            event = events[number]
            self._events.append((event.type, event.text_position - 1, event.length, event.sample / self._rate))
            number += 1
        return 0


def _words(text: str, events: list[tuple[int, int, int, float]]) -> list[tuple[int, int, float, float]]:
    """Place and time of each word as it is written; a number is one, though espeak-ng tells several."""
    words: list[tuple[int, int, float, float]] = []
    open_word = False
    for kind, place, length, time in events:
        if kind not in (WORD, END_OF_CLAUSE):
            continue
        if open_word:
            words[-1] = (*words[-1][:3], time)
            open_word = False
        if kind == WORD and length > 0 and 0 <= place < len(text):
            first, count = _as_written(text, place, length)
            if not (words and words[-1][:2] == (first, count)):
                words.append((first, count, time, time))
            open_word = True
    return words


def _as_written(text: str, place: int, length: int) -> tuple[int, int]:
    """First character and length of the written word that a place in the text belongs to."""
    if text[place] >= FIRST_WITHOUT_BLANKS:
        return place, length
    for word in re.finditer(r"\S+", text):
        if place < word.end():  # a blank belongs to the word behind it
            return word.start(), word.end() - word.start()
    return place, length
