#!/usr/bin/env python3
"""Soak test of the whole stack on two machines: random and strange goals, a simulator that dies, a network that drops.

See --help. It needs root, or the right to make network namespaces.
"""

import signal
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from nao_soak.cli import main  # noqa: E402


def end(number: int, _: object) -> None:
    """Leave by the usual way, on which everything that was started is ended."""
    sys.exit(128 + number)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, end)
    signal.signal(signal.SIGTERM, end)
    sys.exit(main())
