#!/usr/bin/env python3
"""Runs the generators of Python code for messages that `make -n` prints on standard input, all in this process.

make starts a Python for each message and service, and most of its time goes to importing what the generator needs. What
is generated here is up to date for make, which does the rest.
"""

from __future__ import annotations

import shlex
import sys

from genpy.generator import MsgGenerator, SrvGenerator
from genpy.genpy_main import genmain

GENERATORS = {"genmsg_py.py": MsgGenerator, "gensrv_py.py": SrvGenerator}


def main() -> int:
    """Run them in their order; the exit status is that of the first one that fails."""
    for line in sys.stdin:
        words = shlex.split(line)
        names = [word.rpartition("/")[2] for word in words]
        place = next((place for place, name in enumerate(names) if name in GENERATORS), None)
        if place is None or "--initpy" in words:
            continue
        try:
            genmain(words[place:], names[place], GENERATORS[names[place]]())
        except SystemExit as end:
            if end.code:
                return int(end.code)
    return 0


if __name__ == "__main__":
    sys.exit(main())
