#!/usr/bin/env python3
"""Measures how well the simulated robot recognises words, and prints each figure beside its bound. Needs no ROS master.

Voices say phrases with the level of a person 1 m away, in the noise of a quiet room and in noise 20 dB below the
speech; all phrases of a vocabulary are listened for at once. It takes a few minutes of processor time. The exit status
is 1 when a figure misses its bound. Parts can be chosen by name:

  words      a vocabulary of 30 words and phrases: each is recognised, and nothing else
  second     another vocabulary, which nothing was tuned with (no bound)
  others     words and sentences that are not in the vocabulary: most are not recognised
  spotting   word spotting: phrases alone, inside of sentences, and sentences without any (bound on the last only)
  quiet      a minute each of noise, tones, clicks and silence: nothing is recognised
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass
from typing import Callable, Iterator, Sequence

from recognition_bench import VOICES, Bench, Heard, not_speech

NOISES = ("clean", "white", "pink")
LEAST_RIGHT = {"clean": 0.95, "white": 0.80, "pink": 0.80}
MOST_FALSE = 0.5
QUIET_S = 60.0


@dataclass(frozen=True)
class Line:
    """A line of the table.

    Attributes:
        what: What was measured.
        figures: One for each voice, 0..1.
        total: Over all voices, 0..1.
        bound: What `total` must reach, in words.
        kept: Whether it does.
    """

    what: str
    figures: Sequence[float]
    total: float
    bound: str = ""
    kept: bool = True

    def __str__(self) -> str:
        figures = "".join(f"{100.0 * figure:8.1f}" for figure in self.figures)
        return f"{self.what:34}{figures:{8 * len(VOICES)}}{100.0 * self.total:8.1f}  {self.bound}{self.missed}"

    @property
    def missed(self) -> str:
        """A mark at the end of a line that misses its bound."""
        return "" if self.kept else "  MISSED"


class Check:
    """The parts of the table.

    Args:
        bench: Who speaks and hears.
        verbose: Tell each phrase that is not as it should be.
    """

    def __init__(self, bench: Bench, verbose: bool) -> None:
        self._bench = bench
        self._verbose = verbose

    def words(self, name: str = "vocabulary", bounded: bool = True) -> Iterator[Line]:
        """Phrases of a vocabulary."""
        phrases = self._bench.phrases[name]
        self._bench.listen_for(phrases)
        for noise in NOISES:
            shares = self._shares(phrases, noise, lambda heard: heard.is_right(heard.said), True)
            yield _line(f"{name}, {noise}", shares, least=LEAST_RIGHT[noise] if bounded else 0.0)

    def second(self) -> Iterator[Line]:
        """Phrases of the other vocabulary."""
        return self.words("second", bounded=False)

    def others(self) -> Iterator[Line]:
        """What is not in the vocabulary: share that is recognised all the same."""
        self._bench.listen_for(self._bench.phrases["vocabulary"])
        for kind in ("other_words", "other_sentences"):
            for noise in NOISES:
                shares = self._shares(self._bench.phrases[kind], noise, lambda heard: bool(heard.found), False)
                label = f"{kind.replace('_', ' ')}, {noise}: false"
                yield _line(label, shares, most=MOST_FALSE)

    def spotting(self) -> Iterator[Line]:
        """Word spotting."""
        phrases = self._bench.phrases["vocabulary"]
        self._bench.listen_for(phrases, spotting=True)
        alone = self._shares(phrases, "clean", lambda h: h.is_right(f"<...> {h.said} <...>"), True)
        yield _line("spotting, alone", alone)
        for around in self._bench.phrases["around"]:
            wanted = {around.format(phrase): f"<...> {phrase} <...>" for phrase in phrases}
            shares = self._shares(list(wanted), "clean", lambda h, w=wanted: h.is_right(w[h.said]), True)
            yield _line(f"spotting, {around.format('...')}"[:33], shares)
        for kind in ("other_words", "other_sentences"):
            shares = self._shares(self._bench.phrases[kind], "clean", lambda heard: bool(heard.found), False)
            label = f"spotting, {kind.replace('_', ' ')}: false"
            yield _line(label, shares, most=MOST_FALSE)

    def quiet(self) -> Iterator[Line]:
        """What is no speech at all: number of phrases recognised, in hundredths."""
        for spotting in (False, True):
            self._bench.listen_for(self._bench.phrases["vocabulary"], spotting)
            for name, sound in not_speech(QUIET_S).items():
                found = [h.phrase for event in self._bench.hear(sound) for h in event.hypotheses[:1]]
                if self._verbose and found:
                    print(f"    {name}: {', '.join(found)}")
                label = f"{'spotting, ' if spotting else ''}{name}: false"
                yield Line(label, (), len(found) / 100.0, "0", not found)

    def _shares(self, phrases: Sequence[str], noise: str, counts: Callable[[Heard], bool], should: bool) -> list[float]:
        """Share of the phrases that count, for each voice."""
        shares = []
        for voice in VOICES:
            heard = [self._bench.say(phrase, voice, noise, seed) for seed, phrase in enumerate(phrases)]
            for one in heard if self._verbose else ():
                if counts(one) != should:
                    found = ", ".join(f"{h.phrase} {h.confidence:.2f}" for h in one.found) or "nothing"
                    print(f"    {voice}, {noise}: {one.said} -> {found}")
            shares.append(sum(map(counts, heard)) / len(heard))
        return shares


def _line(what: str, shares: Sequence[float], least: float = 0.0, most: float = 1.0) -> Line:
    total = sum(shares) / len(shares)
    bound = f"at least {100.0 * least:.0f}" if least else f"at most {100.0 * most:.0f}" if most < 1.0 else ""
    return Line(what, shares, total, bound, least <= total <= most)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and print; 1 when a figure misses its bound."""
    names = ("words", "second", "others", "spotting", "quiet")
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help="parts to measure; all of them by default")
    parser.add_argument("-v", "--verbose", action="store_true", help="tell each phrase that is not as it should be")
    options = parser.parse_args(arguments)
    unknown = [part for part in options.parts if part not in names]
    if unknown:
        parser.error(f"no part {unknown[0]!r}; there are {', '.join(names)}")
    bench = Bench()
    try:
        check = Check(bench, options.verbose)
        print(f"{'percent':34}{''.join(f'{voice:>8}' for voice in VOICES)}{'all':>8}  bound")
        began, kept = time.process_time(), True
        for part in options.parts or names:
            for line in getattr(check, part)():
                print(line, flush=True)
                kept = kept and line.kept
        spent = time.process_time() - began
        print(f"{bench.seconds:.0f} s of sound took {spent:.0f} s of processor time: 1/{bench.seconds / spent:.0f}")
    finally:
        bench.close()
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
