"""The command line of programs that measure several parts, which can be chosen by name."""

from __future__ import annotations

import argparse
import math
from typing import Collection, Sequence


def parts_parser(description: str, parts: Collection[str]) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"{', '.join(parts)} (default: all)")
    return parser


def parse(
    parser: argparse.ArgumentParser, parts: Collection[str], arguments: Sequence[str] | None, **least: float
) -> argparse.Namespace:
    """What was asked for, checked; ends the program with what is wrong. `least` has the least values of options."""
    chosen = parser.parse_args(arguments)
    unknown = [part for part in chosen.parts if part not in parts]
    if unknown:
        parser.error(f"no part {', '.join(unknown)}; there are {', '.join(parts)}")
    for name, value in least.items():
        given = getattr(chosen, name)
        if given is not None and not value <= given < math.inf:
            parser.error(f"--{name} is {given:g}, allowed is {value:g} or more")
    chosen.parts = chosen.parts or list(parts)
    return chosen
