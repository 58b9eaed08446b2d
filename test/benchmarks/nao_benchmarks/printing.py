"""What a program that times something prints, for `timings` to read."""

from __future__ import annotations

import json
from typing import Callable, Mapping, Sequence

from .errors import BenchmarkError


def print_times(measure: Callable[[], Mapping[str, Sequence[float]]]) -> int:
    """Measure, and print the times as JSON, or why they do not count; the exit status of the program.

    Args:
        measure: Gives the lists `ours` and `reference`, s each; raises BenchmarkError when they would say nothing.
    """
    try:
        print(json.dumps(measure()))
    except BenchmarkError as error:
        print(error)
        return 1
    return 0
