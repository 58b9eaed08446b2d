"""Recognises the phrases of a grammar in one utterance, with pocketsphinx. Runs in the recogniser's process."""

from __future__ import annotations

import math
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Iterable, Sequence, Tuple

import numpy as np
import pocketsphinx

from nao_sim_bridge.sim.hearing.grammar import OTHER_SPEECH, Grammar
from nao_sim_bridge.sim.hearing.listening import Hypothesis
from nao_sim_bridge.sim.hearing.network import OTHER, Arc, Network, build
from nao_sim_bridge.sim.hearing.noise_reduction import FRAME, noise_spectrum, reduce_noise
from nao_sim_bridge.sim.hearing.pronunciation import Pronouncer
from nao_sim_bridge.sim.hearing.settings import RecognitionSettings
from nao_sim_bridge.sim.hearing.speech_likeness import likeness
from nao_sim_bridge.sim.hearing.voice_activity import Utterance

PHONES = (
    "AA AE AH AO AW AY B CH D DH EH ER EY F G HH IH IY JH K L M N NG OW OY P R S SH T TH UH UW V W Y Z ZH"
).split()
# The decoder's scores are logarithms divided by this.
SCORE_UNIT = 1.0 / 1024.0
# Mark of a further pronunciation of a token.
FURTHER = re.compile(r"\(\d+\)$")
# Power to which the decoder raises the chances of words.
LANGUAGE_WEIGHT = 6.5
PHRASES, SOUNDS = "phrases", "sounds"
# Further hypotheses are looked for in this many ways at most.
MOST_SEARCHES = 12


@dataclass(frozen=True)
class Way:
    """One way through the network: the tokens said, its score and the frames of speech in it."""

    tokens: Tuple[str, ...]
    score: float
    frames: int


class Decoder:
    """Recognises phrases of one set of grammars.

    Args:
        grammars: What may be said; with none, nothing is ever recognised.
        pronouncer: Knows how words are said.
        settings: Noise reduction, gain, confidence.

    Raises:
        NoPronunciation: A word cannot be said.
        BadValue: The grammars are too large.
    """

    def __init__(self, grammars: Iterable[Grammar], pronouncer: Pronouncer, settings: RecognitionSettings) -> None:
        self._settings = settings
        self._network: Network = build(grammars, pronouncer.phones, PHONES)
        if self._network.tokens:  # an empty network cannot be searched
            self._engine = self._new_engine()
            self._set_arcs(self._network.arcs)

    def _new_engine(self) -> pocketsphinx.Decoder:
        pocketsphinx.set_loglevel("FATAL")
        with tempfile.TemporaryDirectory(prefix="nao_words_") as folder:
            dictionary = Path(folder) / "words.dict"
            dictionary.write_text(_dictionary(self._network), encoding="utf-8")
            # A search of the lattice would find ways that end in the middle of a phrase.
            config = pocketsphinx.Config(lm=None, dict=str(dictionary), cmn="batch", bestpath=False, loglevel="FATAL")
            engine = pocketsphinx.Decoder(config)
        engine.add_allphone_file(SOUNDS, None)
        return engine

    def recognise(self, utterance: Utterance, most: int = 1) -> list[Hypothesis]:
        """The phrases that may have been said, best first.

        Args:
            utterance: What was heard.
            most: How many at most.
        """
        if not self._network.tokens:
            return []
        speech = self._cleaned(utterance)
        if not self._is_like_speech(speech):
            return []
        sound = self._leveled(speech)
        best = self._search(sound)
        if best is None:
            return []
        sounds_score = self._sounds_score(sound)
        paths = [best, *self._others(sound, best, most - 1)]
        return self._hypotheses(paths, sounds_score)[:most]

    def _cleaned(self, utterance: Utterance) -> np.ndarray:
        """The utterance with less noise."""
        reduction = self._settings.noise_reduction
        if len(utterance.background) < FRAME:
            return utterance.samples
        noise = noise_spectrum(utterance.background)
        return reduce_noise(utterance.samples, noise, reduction.least_gain, reduction.smoothing)

    def _is_like_speech(self, speech: np.ndarray) -> bool:
        wanted, found = self._settings.speech_likeness, likeness(speech)
        return wanted.least_tone <= found.tone <= wanted.most_tone and found.change >= wanted.least_change

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
            (a.start, a.end, 1.0) if a.token is None else (a.start, a.end, _chance(a.token, unlikely), a.token)
            for a in arcs
        ]
        network = self._network
        self._engine.add_fsg(PHRASES, self._engine.create_fsg(PHRASES, network.start, network.end, table))

    def _search(self, sound: bytes) -> Way | None:
        """The best way through the network; None when there is none."""
        if not self._run(PHRASES, sound):
            return None
        said = [(FURTHER.sub("", s.word), s) for s in self._engine.seg()]
        said = [(token, segment) for token, segment in said if token in self._network.tokens]
        if not said:
            return None
        frames = said[-1][1].end_frame - said[0][1].start_frame + 1
        return Way(tuple(token for token, _ in said), self._score(), frames)

    def _others(self, sound: bytes, best: Way, most: int) -> list[Way]:
        """Further ways, best first: each leaves out one of the words of the best one."""
        found: dict[Tuple[str, ...], Way] = {}
        path = best
        arcs = list(self._network.arcs)
        searches = 0
        while most > len(found) and searches < MOST_SEARCHES:
            ways = []
            for token in dict.fromkeys(t for t in path.tokens if not t.startswith(OTHER)):
                searches += 1
                left = [arc for arc in arcs if arc.token != token]
                self._set_arcs(left)
                other = self._search(sound)
                if other is not None:
                    ways.append((other.score, left, other))
                if searches >= MOST_SEARCHES:
                    break
            if not ways:
                break
            _, arcs, path = max(ways, key=lambda way: way[0])
            found.setdefault(path.tokens, path)
        self._set_arcs(self._network.arcs)
        return sorted(found.values(), key=lambda p: -p.score)

    def _sounds_score(self, sound: bytes) -> float:
        """Score of the best sequence of sounds, of whatever language."""
        return self._score() if self._run(SOUNDS, sound) else 0.0

    def _run(self, search: str, sound: bytes) -> bool:
        engine = self._engine
        engine.activate_search(search)
        engine.start_utt()
        engine.process_raw(sound, False, True)
        engine.end_utt()
        return engine.hyp() is not None

    def _score(self) -> float:
        return math.log(max(self._engine.hyp().best_score, 1e-300)) / SCORE_UNIT

    def _hypotheses(self, paths: Iterable[Way], sounds_score: float) -> list[Hypothesis]:
        settings = self._settings.confidence
        listed: dict[Tuple[str, str], Hypothesis] = {}
        surest = 1.0
        charge = -math.log(self._settings.other_speech.weight) * LANGUAGE_WEIGHT
        for path in paths:
            # What other speech was charged says nothing about how well the words fit.
            score = path.score + charge * sum(token.startswith(OTHER) for token in path.tokens)
            evidence = (score - sounds_score) / (path.frames + settings.more_frames)
            confidence = 1.0 / (1.0 + math.exp(-settings.slope * (evidence - settings.middle)))
            said = [self._network.tokens[t] for t in path.tokens]
            phrase = _phrase([token.heard for token in said])
            grammar = next((token.grammar for token in said if token.grammar), "")
            if grammar and confidence >= settings.least:
                # A way that is less likely as a whole is no surer, however few sounds it has.
                surest = min(surest, confidence)
                listed.setdefault((phrase, grammar), Hypothesis(phrase, surest, grammar))
        return list(listed.values())


def _phrase(parts: Iterable[str]) -> str:
    """Parts of a result as one text; the sounds of other speech are written once for all that follow each other."""
    told: list[str] = []
    for part in parts:
        if part and not (part == OTHER_SPEECH and told and told[-1] == part):
            told.append(part)
    return " ".join(told)


def _chance(token: str, unlikely: float) -> float:
    return unlikely if token.startswith(OTHER) else 1.0


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
