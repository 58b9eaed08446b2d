#!/usr/bin/env python3
"""Benchmarks of the stack: prints a table and writes a file; see --help."""

import sys

from nao_benchmarks.cli import main
from nao_benchmarks.rows import ROWS

if __name__ == "__main__":
    sys.exit(main(ROWS))
