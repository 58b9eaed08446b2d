"""Recognises the phrases of a grammar in one utterance, with pocketsphinx. Runs in the recogniser's process."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Callable, Iterable, Sequence, Tuple

import numpy as np
import pocketsphinx

from nao_sim_bridge.base.memory_file import memory_file
from nao_sim_bridge.hearing.evidence import Evidence, Piece, evidence
from nao_sim_bridge.hearing.grammars.grammar import OTHER_SPEECH, Grammar
from nao_sim_bridge.hearing.listening import Hypothesis
from nao_sim_bridge.hearing.network import OTHER, Arc, Network, build, spoken_word
from nao_sim_bridge.hearing.noise_reduction import FRAME, noise_spectrum, reduce_noise
from nao_sim_bridge.hearing.pronunciation import Pronouncer
from nao_sim_bridge.hearing.settings import RecognitionSettings
from nao_sim_bridge.hearing.speech_edges import speech_edges
from nao_sim_bridge.hearing.speech_likeness import likeness
from nao_sim_bridge.hearing.voice_activity import Utterance

PHONES = (
    "AA AE AH AO AW AY B CH D DH EH ER EY F G HH IH IY JH K L M N NG OW OY P R S SH T TH UH UW V W Y Z ZH"
).split()
# Number of a further pronunciation of a token.
FURTHER = re.compile(r"\((\d+)\)$")
PHRASES, SOUNDS = "phrases", "sounds"
# Further hypotheses are looked for in this many ways at most.
MOST_SEARCHES = 12
# Frames a second, in which places of words are counted.
FRAME_RATE = 100.0
# The decoder's scores are logarithms divided by this.
SCORE_UNIT = 1.0 / 1024.0
# How marks of silence and of noises begin, in the place of words.
NO_WORD = ("<", "[", "+")


@dataclass(frozen=True)
class Way:
    """One way through the network: what was said, other speech as well, and the score of the whole utterance.

    Its pieces are those from the first to the last word of its phrases, with the silence between them.
    """

    tokens: Tuple[str, ...]
    score: float
    pieces: Tuple[Piece, ...]


@dataclass(frozen=True)
class Heard:
    """What an utterance may be other than a phrase.

    It has the times of its origin, with the silence before it, of its first sound and of its last one, s.
    """

    everyday: Sequence[Piece]
    sounds: Sequence[Piece]
    origin: float
    onset: float
    end: float


class EverydaySpeech:
    """Writes down any English speech as well as it can, with a large dictionary: what phrases are measured against."""

    def __init__(self) -> None:
        pocketsphinx.set_loglevel("FATAL")
        # One fast search is enough: the sense of what is said does not matter here.
        self._engine = pocketsphinx.Decoder(
            pocketsphinx.Config(
                lm=pocketsphinx.get_model_path("en-us/en-us.lm.bin"),
                dict=pocketsphinx.get_model_path("en-us/cmudict-en-us.dict"),
                cmn="batch",
                fwdflat=False,
                bestpath=False,
                loglevel="FATAL",
            )
        )

    def heard(self, sound: bytes) -> list[Piece]:
        """The words of an utterance of int16 samples, 16 kHz, and the silence between them."""
        engine = self._engine
        heard = search(engine, sound)
        return pieces(engine, lambda word: (engine.lookup_word(word) or "").split()) if heard else []


def search(engine: pocketsphinx.Decoder, sound: bytes) -> bool:
    """Have a decoder search an utterance of int16 samples, 16 kHz; whether it found something."""
    engine.start_utt()
    engine.process_raw(sound, False, True)
    engine.end_utt()
    return engine.hyp() is not None


def pieces(engine: pocketsphinx.Decoder, phones_of: Callable[[str], Sequence[str]]) -> list[Piece]:
    """What the last search of a decoder found, which was something.

    `phones_of` gives the phones of a word, named with the number of its pronunciation; it is called for words only.
    """
    found = []
    for s in engine.seg():
        phones = () if s.word.startswith(NO_WORD) else tuple(phones_of(s.word))
        found.append(Piece(FURTHER.sub("", s.word), phones, s.start_frame, s.end_frame, log_score(s.ascore)))
    return [piece for piece in found if piece.frames > 0]


def log_score(likelihood: float) -> float:
    """Logarithm of a likelihood as the decoder tells it."""
    return math.log(max(likelihood, 1e-300)) / SCORE_UNIT


class Decoder:
    """Recognises phrases of one set of grammars; with none, nothing is ever recognised.

    Raises:
        NoPronunciation: A word cannot be said.
        BadValue: The grammars are too large.
    """

    def __init__(
        self,
        grammars: Iterable[Grammar],
        pronouncer: Pronouncer,
        settings: RecognitionSettings,
        everyday: EverydaySpeech,
    ) -> None:
        self._settings = settings
        self._everyday = everyday
        self._network: Network = build(grammars, pronouncer.phones, PHONES)
        if self._network.tokens:  # an empty network cannot be searched
            self._engine = self._new_engine()
            self._spots = any(map(_is_other, self._network.tokens))

    def _new_engine(self) -> pocketsphinx.Decoder:
        pocketsphinx.set_loglevel("FATAL")
        with memory_file(_dictionary(self._network).encode()) as dictionary:
            # A search of the lattice would find ways that end in the middle of a phrase.
            config = pocketsphinx.Config(lm=None, dict=dictionary, cmn="batch", bestpath=False, loglevel="FATAL")
            engine = pocketsphinx.Decoder(config)
        engine.add_allphone_file(SOUNDS, None)
        return engine

    def recognise(self, utterance: Utterance, most: int = 1) -> list[Hypothesis]:
        """The phrases that may have been said, best first."""
        if not self._network.tokens:
            return []
        speech = self._cleaned(utterance)
        if not self._is_like_speech(speech):
            return []
        sound = self._leveled(speech)
        heard = Heard(
            self._everyday.heard(sound),
            pieces(self._engine, lambda sound: [sound]) if self._run(SOUNDS, sound) else [],
            utterance.origin,
            *speech_edges(utterance),
        )
        found = self._whole(sound, heard, most)
        if self._spots:
            found += self._inside(sound, heard, most)
        best: dict[Tuple[str, str], Hypothesis] = {}
        for hypothesis in sorted(found, key=lambda h: -h.confidence):
            best.setdefault((hypothesis.phrase, hypothesis.grammar), hypothesis)
        return list(best.values())[:most]

    def _whole(self, sound: bytes, heard: Heard, most: int) -> list[Hypothesis]:
        """Phrases that are all of the utterance."""
        arcs = [arc for arc in self._network.arcs if not _is_other(arc.token)]
        settings, surest, found = self._settings.confidence, 1.0, []
        for way in self._ways(sound, arcs, most):
            confidence = self._evidence(way, heard, inside=False).confidence(settings)
            # What is less likely as a whole is no surer, however it is written.
            surest = min(surest, confidence)
            found += self._hypothesis(way, surest, settings.least, heard.onset, heard.end)
        return found

    def _inside(self, sound: bytes, heard: Heard, most: int) -> list[Hypothesis]:
        """Phrases with other speech around; how likely they are as a whole depends on that as well."""
        settings, found = self._settings.spotting, []
        # Other speech that is like a phrase may hide one that was said.
        for way in self._ways(sound, self._network.arcs, max(most, self._settings.other_speech.tries)):
            confidence = self._evidence(way, heard, inside=True).confidence(settings)
            onset, end = _span(way, heard)
            found += self._hypothesis(way, confidence, settings.least, onset, end)
        return found

    def _cleaned(self, utterance: Utterance) -> np.ndarray:
        """The utterance with less noise."""
        reduction = self._settings.noise_reduction
        if len(utterance.background) < FRAME:
            return utterance.samples
        noise = noise_spectrum(utterance.background)
        return reduce_noise(utterance.samples, noise, reduction.least_gain, reduction.smoothing)

    def _is_like_speech(self, speech: np.ndarray) -> bool:
        wanted, found = self._settings.speech_likeness, likeness(speech)
        voiced = found.voice >= wanted.least_voice
        return voiced and found.tone <= wanted.most_tone and found.change >= wanted.least_change

    def _leveled(self, speech: np.ndarray) -> bytes:
        """Speech at the level that the acoustic model is used to, as the decoder takes it."""
        gain = self._settings.gain
        wanted = 10.0 ** (gain.level_db / 20.0) / max(_loud_level(speech), 1e-9)
        factor = min(wanted, 10.0 ** (gain.most_db / 20.0), 0.99 / max(float(np.max(np.abs(speech))), 1e-9))
        return np.round(speech * factor * 32767.0).astype("<i2").tobytes()

    def _set_arcs(self, arcs: Sequence[Arc]) -> None:
        # Chances count once for each word that is said; equal ones would only punish large vocabularies.
        unlikely = self._settings.other_speech.weight
        table = [
            (a.start, a.end, 1.0)
            if a.token is None
            else (a.start, a.end, unlikely if _is_other(a.token) else 1.0, a.token)
            for a in arcs
        ]
        network = self._network
        self._engine.add_fsg(PHRASES, self._engine.create_fsg(PHRASES, network.start, network.end, table))

    def _search(self, sound: bytes, arcs: Sequence[Arc]) -> Way | None:
        """The best way along some of the arcs; None when there is none."""
        if all(arc.token is None for arc in arcs):  # that cannot be searched
            return None
        self._set_arcs(arcs)
        if not self._run(PHRASES, sound):
            return None
        found = pieces(self._engine, self._phones)
        words = [i for i, piece in enumerate(found) if piece.word in self._network.tokens]
        said = [i for i in words if not _is_other(found[i].word)]
        if not said:
            return None
        tokens = tuple(found[i].word for i in words)
        return Way(tokens, log_score(self._engine.hyp().best_score), tuple(found[said[0] : said[-1] + 1]))

    def _phones(self, name: str) -> Sequence[str]:
        """Of a token as the decoder names it."""
        further = FURTHER.search(name)
        token = self._network.tokens.get(FURTHER.sub("", name))
        return token.phones[int(further.group(1)) - 1 if further else 0].split() if token else ()

    def _ways(self, sound: bytes, arcs: Sequence[Arc], most: int) -> list[Way]:
        """Ways along some of the arcs, best first: each further one leaves out something said in a better one."""
        path = self._search(sound, arcs)
        found: dict[Tuple[str, ...], Way] = {}
        searches = 0
        while path is not None:
            found.setdefault(path.tokens, path)
            if len(found) >= most or searches >= MOST_SEARCHES:
                break
            ways = []
            for token in [t for t in dict.fromkeys(path.tokens) if self._begins(t)][: MOST_SEARCHES - searches]:
                searches += 1
                left = [arc for arc in arcs if arc.token != token]
                other = self._search(sound, left)
                if other is not None:
                    ways.append((other.score, left, other))
            if not ways:
                break
            _, arcs, path = max(ways, key=lambda way: way[0])
        first, *others = list(found.values()) or [None]
        return [first, *sorted(others, key=lambda way: -way.score)] if first is not None else []

    def _begins(self, token: str) -> bool:
        """Whether words begin with this: without it, the rest of them cannot be said."""
        return bool(self._network.tokens[token].heard) and not _is_other(token)

    def _run(self, kind: str, sound: bytes) -> bool:
        self._engine.activate_search(kind)
        return search(self._engine, sound)

    def _evidence(self, way: Way, heard: Heard, inside: bool) -> Evidence:
        spoken = [spoken_word(piece.word) for piece in way.pieces if piece.phones]
        return evidence(way.pieces, spoken, heard.everyday, heard.sounds, inside)

    def _hypothesis(self, way: Way, confidence: float, least: float, onset: float, end: float) -> list[Hypothesis]:
        """The phrase of a way; none when it is not sure enough."""
        said = [self._network.tokens[token] for token in way.tokens]
        grammar = next((token.grammar for token in said if token.grammar), "")
        if not grammar or confidence < least:
            return []
        return [Hypothesis(_phrase(token.heard for token in said), confidence, grammar, onset, end)]


def _span(way: Way, heard: Heard) -> Tuple[float, float]:
    """Times at which the phrases of a way begin and end, s."""
    begin = heard.origin + way.pieces[0].start / FRAME_RATE
    end = heard.origin + (way.pieces[-1].end + 1) / FRAME_RATE
    return max(begin, heard.onset), min(end, heard.end)


def _phrase(parts: Iterable[str]) -> str:
    """Parts of a result as one text; the sounds of other speech are written once for all that follow each other."""
    told: list[str] = []
    for part in parts:
        if part and not (part == OTHER_SPEECH and told and told[-1] == part):
            told.append(part)
    return " ".join(told)


def _is_other(token: str | None) -> bool:
    return token is not None and token.startswith(OTHER)


def _dictionary(network: Network) -> str:
    lines = []
    for name, token in network.tokens.items():
        for number, phones in enumerate(token.phones, start=1):
            lines.append(f"{name} {phones}" if number == 1 else f"{name}({number}) {phones}")
    return "\n".join(lines) + "\n"


def _loud_level(speech: np.ndarray) -> float:
    """RMS of the loud parts of a sound."""
    power = np.convolve(speech**2, np.full(320, 1.0 / 320.0), "same")
    loud = power > 1e-3 * power.max()
    return float(np.sqrt(np.mean(speech[loud] ** 2))) if loud.any() else 0.0
