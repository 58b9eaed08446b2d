"""What programs print that time something."""

from __future__ import annotations

import json

from nao_benchmarks.errors import BenchmarkError
from nao_benchmarks.printing import print_times


def test_times_are_printed_as_json(capsys):
    times = {"ours": [0.25], "reference": [0.5]}
    assert print_times(lambda: times) == 0
    assert json.loads(capsys.readouterr().out) == times


def test_what_was_no_measurement_is_told_and_the_status_says_so(capsys):
    def fallen():
        raise BenchmarkError("a robot has fallen")

    assert print_times(fallen) == 1
    assert capsys.readouterr().out == "a robot has fallen\n"
