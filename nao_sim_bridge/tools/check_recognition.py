#!/usr/bin/env python3
"""Measures how well the simulated robot recognises words, and prints each figure beside its bound. Needs no ROS master.

Voices say phrases with the level of a person 1 m away, in the noise of a quiet room and in noise 20 dB below the
speech; all phrases of a vocabulary are listened for at once. It takes half an hour of processor time. The exit status
is 1 when a figure misses its bound. Parts can be chosen by name:

  words      a vocabulary of 30 words and phrases: each is recognised, and nothing else
  second     two other vocabularies, which nothing was tuned with
  others     words and sentences that are not in the vocabulary: how many are taken for one of it at all ("any"), and
             how many with a confidence of 0.4 or more ("from 0.4"); only the latter have a bound
  spotting   word spotting: phrases alone and inside of sentences, words and sentences without any, a minute of these
  quiet      a minute each of noise, tones, clicks and silence: nothing is recognised
  sudden     noises that begin suddenly, 20 of each kind: none is recognised
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, replace
from typing import Callable, Iterator, Mapping, Sequence

import numpy as np
from command_line import parse, parts_parser
from recognition_bench import VOICES, Bench, Heard, not_speech, sudden

NOISES = ("clean", "white", "pink")
LEAST_RIGHT = {"clean": 0.95, "white": 0.80, "pink": 0.80}
SURE = 0.4
MOST_FALSE = 0.1
LEAST_SPOTTED = 0.8
MOST_IN_A_MINUTE = 1
QUICK_VOICES = ("slt", "rms")


@dataclass(frozen=True)
class Effort:
    """How much is measured: one of `every` phrases, `quiet_s` s of each noise, so many bursts of each kind."""

    voices: Sequence[str] = tuple(VOICES)
    every: int = 1
    quiet_s: float = 60.0
    bursts: int = 20


QUICK = Effort(QUICK_VOICES, every=6, quiet_s=8.0, bursts=4)


@dataclass(frozen=True)
class Line:
    """A line of the table: figures of each voice and of all, 0..1, and in words the bound that the total must keep."""

    what: str
    figures: Sequence[float]
    total: float
    bound: str = ""
    kept: bool = True

    def __str__(self) -> str:
        figures = "".join(f"{100.0 * figure:8.1f}" for figure in self.figures)
        missed = "" if self.kept else "  MISSED"
        return f"{self.what:34}{figures:{8 * len(VOICES)}}{100.0 * self.total:8.1f}  {self.bound}{missed}"


class Check:
    """The parts of the table; `verbose` tells each phrase that is not as it should be."""

    def __init__(self, bench: Bench, verbose: bool, effort: Effort) -> None:
        self._bench = bench
        self._effort = effort
        self._verbose = verbose

    def words(self, name: str = "vocabulary") -> Iterator[Line]:
        """Phrases of a vocabulary."""
        phrases = self._bench.phrases[name]
        self._bench.listen_for(phrases)
        for noise in NOISES:
            shares = self._shares(phrases, noise, lambda heard: heard.is_right(heard.said), True)
            yield _line(f"{name}, {noise}", shares, least=LEAST_RIGHT[noise])

    def second(self) -> Iterator[Line]:
        """Phrases of the other vocabularies."""
        yield from self.words("second")
        yield from self.words("third")

    def others(self) -> Iterator[Line]:
        """What is not in the vocabulary: share that is recognised all the same, with any confidence and with `SURE`."""
        self._bench.listen_for(self._bench.phrases["vocabulary"])
        for kind in ("other_words", "other_sentences"):
            for noise in NOISES:
                heard = self._heard(self._bench.phrases[kind], noise, _is_found, False)
                label = f"{kind.replace('_', ' ')}, {noise}:"
                yield _line(f"{label} any", _shares(heard, _is_found))
                yield _line(f"{label} from {SURE:g}", _shares(heard, _is_sure), most=MOST_FALSE)

    def spotting(self) -> Iterator[Line]:
        """Word spotting."""
        phrases, around = self._bench.phrases["vocabulary"], self._bench.phrases["around"]
        self._bench.listen_for(phrases, spotting=True)
        alone = self._shares(phrases, "clean", lambda h: h.is_right(f"<...> {h.said} <...>"), True)
        yield _line("spotting, alone", alone)
        wanted = {around[i % len(around)].format(phrase): f"<...> {phrase} <...>" for i, phrase in enumerate(phrases)}
        shares = self._shares(list(wanted), "clean", lambda h: h.is_right(wanted[h.said]), True)
        yield _line("spotting, inside of sentences", shares, least=LEAST_SPOTTED)
        for kind in ("other_words", "other_sentences"):
            shares = self._shares(self._bench.phrases[kind], "clean", _is_found, False)
            label = f"spotting, {kind.replace('_', ' ')}: false"
            yield _line(label, shares, most=MOST_FALSE)
        for voice in self._effort.voices:
            talk = self._bench.talk(self._bench.phrases["other_sentences"], voice, self._effort.quiet_s)
            yield self._nothing(f"spotting, a minute of {voice}", talk, MOST_IN_A_MINUTE)

    def quiet(self) -> Iterator[Line]:
        """What is no speech at all and goes on: number of phrases recognised."""
        return self._no_speech(not_speech(self._effort.quiet_s))

    def sudden(self) -> Iterator[Line]:
        """What is no speech at all and begins suddenly: number of phrases recognised."""
        return self._no_speech({f"sudden, {kind}": sound for kind, sound in sudden(self._effort.bursts).items()})

    def _no_speech(self, sounds: Mapping[str, np.ndarray]) -> Iterator[Line]:
        for spotting in (False, True):
            self._bench.listen_for(self._bench.phrases["vocabulary"], spotting)
            for name, sound in sounds.items():
                yield self._nothing(f"{'spotting, ' if spotting else ''}{name}", sound)

    def _nothing(self, name: str, sound: np.ndarray, most: int = 0) -> Line:
        """How many phrases are recognised where there is none; in hundredths, as the table has percents."""
        found = [h.phrase for event in self._bench.hear(sound) for h in event.hypotheses[:1]]
        if self._verbose and found:
            print(f"    {name}: {', '.join(found)}")
        return Line(f"{name}: number", (), len(found) / 100.0, f"at most {most}" if most else "0", len(found) <= most)

    def _shares(self, phrases: Sequence[str], noise: str, counts: Callable[[Heard], bool], should: bool) -> list[float]:
        """Share of the phrases that count, for each voice."""
        return _shares(self._heard(phrases, noise, counts, should), counts)

    def _heard(
        self, phrases: Sequence[str], noise: str, counts: Callable[[Heard], bool], should: bool
    ) -> list[list[Heard]]:
        """What came of the phrases, for each voice; those that count and should not, or the other way, are told."""
        said = list(enumerate(phrases))[:: self._effort.every]
        result = []
        for voice in self._effort.voices:
            result.append([self._bench.say(phrase, voice, noise, seed) for seed, phrase in said])
            for one in result[-1] if self._verbose else ():
                if counts(one) != should:
                    found = ", ".join(f"{h.phrase} {h.confidence:.2f}" for h in one.found) or "nothing"
                    print(f"    {voice}, {noise}: {one.said} -> {found}")
        return result


def _shares(heard: Sequence[Sequence[Heard]], counts: Callable[[Heard], bool]) -> list[float]:
    return [sum(map(counts, ones)) / len(ones) for ones in heard]


def _is_found(heard: Heard) -> bool:
    """Whether a phrase was recognised with any confidence."""
    return bool(heard.found)


def _is_sure(heard: Heard) -> bool:
    """Whether a phrase was recognised with a confidence that counts for something."""
    return any(found.confidence >= SURE for found in heard.found)


def _line(what: str, shares: Sequence[float], least: float = 0.0, most: float = 1.0) -> Line:
    total = sum(shares) / len(shares)
    bound = f"at least {100.0 * least:.0f}" if least else f"at most {100.0 * most:.0f}" if most < 1.0 else ""
    return Line(what, shares, total, bound, least <= total <= most)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and print; 1 when a figure misses its bound."""
    names = ("words", "second", "others", "spotting", "quiet", "sudden")
    parser = parts_parser(__doc__ or "", names)
    parser.add_argument("-v", "--verbose", action="store_true", help="tell each phrase that is not as it should be")
    parser.add_argument("--quick", action="store_true", help="few voices, phrases and noises, no bounds")
    options = parse(parser, names, arguments)
    bench = Bench()
    try:
        effort = QUICK if options.quick else Effort()
        check = Check(bench, options.verbose, effort)
        print(f"{'percent':34}{''.join(f'{voice:>8}' for voice in effort.voices):{8 * len(VOICES)}}{'all':>8}  bound")
        began, kept = time.process_time(), True
        for part in options.parts:
            for line in getattr(check, part)():
                if options.quick:  # too few of each for a verdict
                    line = replace(line, bound="", kept=True)
                print(line, flush=True)
                kept = kept and line.kept
        spent = time.process_time() - began
        print(f"{bench.seconds:.0f} s of sound took {spent:.0f} s of processor time: 1/{bench.seconds / spent:.0f}")
    finally:
        bench.close()
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
