"""What a program that times something prints, for `timings` to read."""

from __future__ import annotations

import argparse
import json
from typing import Any, Callable, Mapping, Sequence

from .errors import BenchmarkError


def print_times(
    measure: Callable[..., Mapping[str, Sequence[float]]],
    document: str | None,
    rounds: int,
    *options: tuple[str, dict[str, Any]],
) -> int:
    """Measure what the command line asks for, and print the times as JSON, or why they do not count.

    Args:
        measure: Gives the lists `ours` and `reference`, s each; raises BenchmarkError when they would say nothing. Gets
            `rounds` and the options by name.
        document: What `--help` tells.
        rounds: How often it measures, unless told otherwise.
        options: Name and keywords of further arguments of the parser.

    Returns:
        The exit status of the program.
    """
    parser = argparse.ArgumentParser(description=document)
    parser.add_argument("--rounds", type=int, default=rounds, help="how often to measure")
    for name, keywords in options:
        parser.add_argument(name, **keywords)
    try:
        print(json.dumps(measure(**vars(parser.parse_args()))))
    except BenchmarkError as error:
        print(error)
        return 1
    return 0
