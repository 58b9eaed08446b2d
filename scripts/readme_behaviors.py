#!/usr/bin/env python3
"""Draws the contact sheet of docs/behaviors.md anew: the behaviours that come with the library, six moments of each.

It needs the built workspace: `scripts/ros-env python3 scripts/readme_behaviors.py`.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "nao_library_modules" / "examples"))
from film_behaviors import FILM, film_behaviors

from example_parts.contact_sheet import contact_sheet, save_small
from example_parts.demo_support import Table

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "images"
NAME = "behaviors.png"
SIDE, COLUMNS, SHARE = 92, 2, 0.74


def main() -> int:
    """Play, film, and draw; the exit status tells whether all went well."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, default=FOLDER, help="where the picture goes (default: docs/images)")
    folder = parser.parse_args().folder
    table = Table()
    with tempfile.TemporaryDirectory() as kept:
        parts = film_behaviors(Path(kept), table)
        save_small(contact_sheet(Path(kept) / FILM, parts, SIDE, COLUMNS, SHARE), folder / NAME)
    print(NAME, flush=True)
    return 1 if table.failures else 0


if __name__ == "__main__":
    sys.exit(main())
