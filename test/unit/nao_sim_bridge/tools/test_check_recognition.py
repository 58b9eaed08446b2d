"""The tool that measures recognition: its options, its bounds, and some of its parts, made small."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest

from nao_sim_bridge.sim.hearing.listening import Hypothesis

TOOLS = Path(__file__).resolve().parents[4] / "nao_sim_bridge" / "tools"
NAMES = ("check_recognition", "recognition_bench")
ALL_PARTS = {"words": 3, "second": 6, "others": 12, "spotting": 5, "quiet": 30, "sudden": 10}
# Made alike: one of them is run for all.
RUN = ("words", "spotting", "quiet")


@pytest.fixture(scope="module")
def tool():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(TOOLS))
        yield importlib.import_module(NAMES[0])
    for name in NAMES:
        sys.modules.pop(name, None)


@pytest.fixture(scope="module")
def bench(tool):
    made = tool.Bench()
    yield made
    made.close()


def test_help_tells_each_part(tool, capsys):
    with pytest.raises(SystemExit) as ended:
        tool.main(["--help"])
    assert ended.value.code == 0
    shown = capsys.readouterr().out
    assert all(f"  {part} " in shown for part in ALL_PARTS) and "--quick" in shown


def test_an_unknown_part_is_refused(tool, capsys):
    with pytest.raises(SystemExit):
        tool.main(["word"])
    assert "no part 'word'; there are words, second" in capsys.readouterr().err


@pytest.mark.parametrize("part", RUN)
def test_each_part_gives_its_lines(tool, bench, part):
    effort = tool.Effort(("slt",), every=40, quiet_s=1.0, bursts=1)
    lines = list(getattr(tool.Check(bench, False, effort), part)())
    assert len(lines) == ALL_PARTS[part], [line.what for line in lines]
    assert all(line.what in str(line) for line in lines)


class FakeBench:
    """Takes three of four other words for one of the vocabulary, one of them with a confidence that counts."""

    phrases = {"vocabulary": ["yes"], "other_words": ["a", "b", "c", "d"], "other_sentences": ["e"]}
    confidences = {"a": 0.1, "b": 0.39, "c": 0.4}

    def __init__(self, tool):
        self._heard = tool.Heard
        self.said = []

    def listen_for(self, phrases):
        assert phrases == ["yes"]

    def say(self, phrase, voice, noise, seed):
        self.said.append((phrase, noise))
        found = [Hypothesis("yes", self.confidences[phrase], "bench")] if phrase in self.confidences else []
        return self._heard(phrase, found)


def test_other_words_are_told_with_any_confidence_and_only_those_that_count_have_a_bound(tool, capsys):
    bench = FakeBench(tool)
    lines = {line.what: line for line in tool.Check(bench, True, tool.Effort(("slt",))).others()}
    assert len(lines) == ALL_PARTS["others"] and len(bench.said) == len(set(bench.said))
    found, sure = lines["other words, clean: any"], lines["other words, clean: from 0.4"]
    assert (found.total, found.bound, found.kept) == (0.75, "", True)
    assert (sure.total, sure.bound, sure.kept) == (0.25, "at most 10", False)
    assert lines["other sentences, pink: from 0.4"].kept
    assert "slt, clean: b -> yes 0.39" in capsys.readouterr().out


@pytest.mark.parametrize("share, kept", [(0.96, True), (0.94, False)])
def test_a_figure_that_misses_its_bound_is_marked(tool, share, kept):
    line = tool._line("words", [share, share], least=0.95)
    assert line.kept is kept
    assert ("MISSED" in str(line)) is not kept


def test_sudden_noises_are_all_different_and_the_same_each_time(tool):
    one, again = (sys.modules["recognition_bench"].sudden(2) for _ in range(2))
    assert len(one) == 5
    assert all(np.array_equal(one[kind], again[kind]) for kind in one)
    assert len({sound[:60000].tobytes() for sound in one.values()}) == 5
