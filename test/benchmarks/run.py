#!/usr/bin/env python3
"""Benchmarks of the stack: prints a table and writes a file; see --help."""

import signal
import sys

from nao_benchmarks.cli import main
from nao_benchmarks.rows import ROWS


def end(number: int, _: object) -> None:
    """Leave by the usual way, on which everything that was started is ended."""
    sys.exit(128 + number)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, end)
    signal.signal(signal.SIGTERM, end)
    sys.exit(main(ROWS))
