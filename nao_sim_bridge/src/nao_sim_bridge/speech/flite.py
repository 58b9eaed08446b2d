"""The flite library: English voices. Used in the speech process only, where a crash of the library harms nobody."""

from __future__ import annotations

import ctypes
import unicodedata
from ctypes import POINTER, c_char_p, c_float, c_int, c_short, c_void_p
from typing import Any

LIBRARY = "libflite.so.1"
# Voice -> library and the function in it that makes the voice.
VOICES = {
    name: (f"libflite_cmu_us_{name}.so.1", f"register_cmu_us_{name}") for name in ("slt", "rms", "awb", "kal", "kal16")
}
FIRST_PHONE = b"R:SylStructure.daughter1.daughter1.R:Segment.p.end"
LAST_PHONE = b"R:SylStructure.daughtern.daughtern.R:Segment.end"
# Signs that flite does not know, and what it knows instead. The rest loses its accents, or becomes a blank.
SIGNS = {"’": "'", "‘": "'", "“": '"', "”": '"', "–": "-", "—": "-", "…": ".", "€": " euros ", "£": " pounds "}
SIGNS.update({"°": " degrees ", "ß": "ss", "æ": "ae", "œ": "oe", "ø": "o", "ł": "l", "đ": "d", "×": " times "})


class _Wave(ctypes.Structure):
    _fields_ = [
        ("type", c_char_p),
        ("sample_rate", c_int),
        ("num_samples", c_int),
        ("num_channels", c_int),
        ("samples", POINTER(c_short)),
    ]


class _Voice(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("features", c_void_p)]


class Flite:
    """All voices of flite that are installed, each loaded when it is first wanted."""

    def __init__(self) -> None:
        self._library = ctypes.CDLL(LIBRARY, mode=ctypes.RTLD_GLOBAL)
        for name, (result, arguments) in {
            "flite_init": (c_int, []),
            "flite_synth_text": (c_void_p, [c_char_p, POINTER(_Voice)]),
            "delete_utterance": (None, [c_void_p]),
            "utt_wave": (POINTER(_Wave), [c_void_p]),
            "utt_relation": (c_void_p, [c_void_p, c_char_p]),
            "relation_head": (c_void_p, [c_void_p]),
            "item_next": (c_void_p, [c_void_p]),
            "item_as": (c_void_p, [c_void_p, c_char_p]),
            "item_parent": (c_void_p, [c_void_p]),
            "ffeature_string": (c_char_p, [c_void_p, c_char_p]),
            "ffeature_float": (c_float, [c_void_p, c_char_p]),
            "feat_set_float": (None, [c_void_p, c_char_p, c_float]),
        }.items():
            function = getattr(self._library, name)
            function.restype, function.argtypes = result, arguments
        self._library.flite_init()
        self._voices: dict[str, Any] = {}

    def voices(self) -> list[str]:
        """Names of the voices that are installed."""
        return [name for name in VOICES if _can_load(VOICES[name][0])]

    def prepare(self, voice: str) -> None:
        """Load a voice."""
        self._voice(voice)

    def synthesise(self, voice: str, text: str, speed: float) -> tuple[int, bytes, list[tuple[int, int, float, float]]]:
        """Make speech; see `worker`."""
        spelled, origins = _plain(text)
        loaded = self._voice(voice)
        self._library.feat_set_float(loaded.contents.features, b"duration_stretch", 1.0 / speed)
        utterance = self._library.flite_synth_text(spelled.encode("ascii"), loaded)
        if not utterance:
            raise ValueError(f"flite makes no sound of {text!r}")
        try:
            wave = self._library.utt_wave(utterance).contents
            sound = ctypes.string_at(wave.samples, 2 * wave.num_samples * wave.num_channels)
            return wave.sample_rate, sound, self._words(utterance, text, spelled, origins)
        finally:
            self._library.delete_utterance(utterance)

    def _voice(self, name: str) -> Any:
        if name not in self._voices:
            library, function = VOICES[name]
            register = getattr(ctypes.CDLL(library), function)
            register.restype, register.argtypes = POINTER(_Voice), [c_char_p]
            self._voices[name] = register(None)
        return self._voices[name]

    def _words(
        self, utterance: int, text: str, spelled: str, origins: list[int]
    ) -> list[tuple[int, int, float, float]]:
        """Place and time of each word as it is written; "42" is one, though it is spoken in two."""
        flite = self._library
        words: list[tuple[int, int, float, float]] = []
        item = flite.relation_head(flite.utt_relation(utterance, b"Word"))
        token, place = None, 0
        while item:
            start, end = flite.ffeature_float(item, FIRST_PHONE), flite.ffeature_float(item, LAST_PHONE)
            written = flite.item_parent(flite.item_as(item, b"Token"))
            if words and written == token:
                words[-1] = (*words[-1][:3], end)
            else:
                name = flite.ffeature_string(item, b"R:Token.parent.name").decode("ascii", "replace")
                found = spelled.find(name, place)
                if found >= 0 and any(c.isalnum() for c in name):
                    place = found + len(name)
                    first, last = origins[found], origins[place - 1]
                    words.append((first, last + 1 - first, start, end))
                token = written
            item = flite.item_next(item)
        return words


def _plain(text: str) -> tuple[str, list[int]]:
    """A text in ASCII, and for each of its characters the place in `text` that it comes from."""
    spelled, origins = [], []
    for place, sign in enumerate(text):
        plain = SIGNS.get(sign) or SIGNS.get(sign.lower()) or unicodedata.normalize("NFKD", sign)
        plain = "".join(c for c in plain if " " <= c < "\x7f") or ("" if unicodedata.combining(sign) else " ")
        spelled.append(plain)
        origins.extend([place] * len(plain))
    return "".join(spelled), origins


def _can_load(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
