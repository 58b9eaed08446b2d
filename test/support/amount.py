"""How much of a long table a run takes: `make test-long` all of it, the other runs a part."""

import os

LONG = os.environ.get("NAO_LIBRARY_LONG_TESTS") == "1"


def amount(short, long):
    """What a run of this length takes."""
    return long if LONG else short


def part_of(rows, step):
    """Every `step`-th row, from the first one on, of the short form; all of the long form."""
    return list(rows)[:: amount(step, 1)]
