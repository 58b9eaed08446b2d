"""How English words are pronounced: looked up in a dictionary, else read by rules, as phones of the acoustic model."""

from __future__ import annotations

import re
import subprocess
import unicodedata
from pathlib import Path
from typing import Sequence

from nao_sim_bridge.base.errors import SimulationError

TIMEOUT = 10.0
# Letters of a word; the decoder has no room for the phones of one that is much longer.
LONGEST_WORD = 64
# What espeak-ng writes for American English, longest first where one begins another; two phones where it needs them.
IPA_PHONES = {
    "tʃ": "CH", "dʒ": "JH", "eɪ": "EY", "aɪ": "AY", "ɔɪ": "OY", "aʊ": "AW", "oʊ": "OW", "əʊ": "OW", "oːɹ": "AO R",
    "iː": "IY", "uː": "UW", "ɑː": "AA", "ɔː": "AO", "ɜː": "ER", "oː": "AO", "əl": "AH L", "n̩": "AH N", "l̩": "AH L",
    "aː": "AA", "ɛː": "EH", "eː": "EY", "øː": "ER", "yː": "UW",
    "ɪ": "IH", "ɛ": "EH", "æ": "AE", "ʌ": "AH", "ʊ": "UH", "ə": "AH", "ɐ": "AH", "ᵻ": "IH", "i": "IY", "u": "UW",
    "ɑ": "AA", "ɔ": "AO", "ɒ": "AA", "ɚ": "ER", "ɝ": "ER", "a": "AA", "e": "EH", "o": "OW", "y": "UW", "ø": "ER",
    "œ": "ER",
    "p": "P", "b": "B", "t": "T", "d": "D", "k": "K", "ɡ": "G", "g": "G", "f": "F", "v": "V", "θ": "TH", "ð": "DH",
    "s": "S", "z": "Z", "ʃ": "SH", "ʒ": "ZH", "h": "HH", "m": "M", "n": "N", "ŋ": "NG", "l": "L", "ɫ": "L", "ɹ": "R",
    "r": "R", "w": "W", "j": "Y", "x": "K", "ç": "HH", "ɬ": "L", "ɾ": "T", "ʔ": "T", "ɲ": "N Y", "ʁ": "R", "ɣ": "G",
    "β": "B", "c": "K", "ʎ": "L Y",
}  # fmt: skip
LONGEST = max(map(len, IPA_PHONES))
# Stress, length, nasal and tie marks, and the marks that espeak-ng puts around a word of another language.
MARKS = re.compile("[ˈˌː\u0303\u0361_‿\\s]|\\([a-z-]+\\)")
LATIN = re.compile(r"LATIN .*LETTER")
ALTERNATIVE = re.compile(r"\(\d+\)$")


class NoPronunciation(SimulationError):
    """A word that cannot be said in English."""

    def __init__(self, word: str, problem: str) -> None:
        self.word = word
        super().__init__(f"no English pronunciation of the word {word!r}: {problem}")


class Pronouncer:
    """Finds pronunciations; each line of the dictionary has a word and its phones, further ones as "word(2)"."""

    def __init__(self, dictionary: Path) -> None:
        self._known = _read(dictionary)

    def phones(self, word: str) -> Sequence[str]:
        """Pronunciations of a word in lower case, each as phones with blanks between, the usual one first.

        Raises:
            NoPronunciation: None can be made.
        """
        if word not in self._known:
            self._known[word] = self._compounds(word) or [read_by_rules(word)]
        return self._known[word]

    def _compounds(self, word: str) -> list[str]:
        """A possessive or plural of a known word."""
        stem = word[:-2] if word.endswith("'s") else word[:-1] if word.endswith("'") else ""
        if stem not in self._known:
            return []
        return [f"{phones} {_s_after(phones)}" if word.endswith("s") else phones for phones in self._known[stem]]


def read_by_rules(word: str) -> str:
    """Phones of a word as espeak-ng would read it.

    Raises:
        NoPronunciation: It is not written in Latin letters, or espeak-ng is missing or does not know how.
    """
    if len(word) > LONGEST_WORD:
        raise NoPronunciation(f"{word[:20]}...", f"it is longer than {LONGEST_WORD} letters")
    strange = [letter for letter in word if letter != "'" and not LATIN.match(unicodedata.name(letter, ""))]
    if strange:
        raise NoPronunciation(word, f"{strange[0]!r} is no Latin letter")
    command = ["espeak-ng", "-q", "--ipa", "-v", "en-us", "--stdin"]
    try:
        done = subprocess.run(command, input=word.encode(), capture_output=True, timeout=TIMEOUT, check=True)
    except FileNotFoundError as error:
        raise NoPronunciation(word, "it is in no dictionary, and espeak-ng, which would read it, is missing") from error
    except (subprocess.SubprocessError, OSError) as error:
        raise NoPronunciation(word, f"espeak-ng failed: {error}") from error
    phones = phones_of_ipa(done.stdout.decode())
    if not phones:
        raise NoPronunciation(word, "espeak-ng makes no sound of it")
    return phones


def phones_of_ipa(ipa: str) -> str:
    """Phones of the acoustic model for a word in the phonetic alphabet; letters that mean no sound of it are left out.

    >>> phones_of_ipa("nˈaʊ")
    'N AW'
    """
    phones: list[str] = []
    text = ipa.strip()
    text = re.sub("[ˈˌ]|\\([a-z-]+\\)", "", text)
    at = 0
    while at < len(text):
        for length in range(LONGEST, 0, -1):
            piece = text[at : at + length]
            if len(piece) == length and piece in IPA_PHONES:
                phones += IPA_PHONES[piece].split()
                at += length
                break
        else:
            if not MARKS.match(text[at]):
                return ""
            at += 1
    return " ".join(phones)


def _s_after(phones: str) -> str:
    last = phones.split()[-1]
    if last in {"S", "Z", "SH", "ZH", "CH", "JH"}:
        return "IH Z"
    return "S" if last in {"P", "T", "K", "F", "TH"} else "Z"


def _read(path: Path) -> dict[str, list[str]]:
    known: dict[str, list[str]] = {}
    with path.open(encoding="utf-8") as lines:
        for line in lines:
            word, _, phones = line.strip().partition(" ")
            if phones and not line.startswith((";;;", "#")):
                known.setdefault(ALTERNATIVE.sub("", word), []).append(phones)
    return known
