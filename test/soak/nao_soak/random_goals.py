"""Random goals: chains that make sense, with strange values put into them now and then."""

from __future__ import annotations

import math
import random
from pathlib import Path
from typing import Any

import genpy
import yaml

from nao_library_modules.core.server_types import server_type

FILE = Path(__file__).with_name("goals.yaml")
HUGE = 100_000
TEXTS = (
    "",
    " ",
    "\n\t",
    "\x00\x01\x7f",
    "../../../etc/passwd",
    "/dev/zero",
    "~root/.bashrc",
    "%s%n%d",
    "${HOME}",
    "'; rm -rf / #",
    "{'a': [1, 2",
    "Ünïcödé ☃ 你好 \U0001f600",
    "NaN",
    "x" * HUGE,
)
FLOATS = (math.nan, math.inf, -math.inf, -1.0, 0.0, 1e-320, 1e18, 1.7e308)


def load_chains() -> dict[str, list[list[dict[str, Any]]]]:
    """Server -> chains that make sense."""
    return yaml.safe_load(FILE.read_text(encoding="utf-8"))


class RandomGoals:
    """Goals of one server.

    Args:
        server: Its name.
        seed: Where chance comes from; equal seeds give equal goals.
        strange: Share 0..1 of the fields that get a strange value.
    """

    def __init__(self, server: str, seed: int, strange: float) -> None:
        self._chains = load_chains()[server]
        self._random = random.Random(f"{server} {seed}")
        self._strange = strange
        types = server_type(server)
        self._goal, self._function = types.goal, types.function

    def sensible(self) -> Any:
        """A goal without anything strange in it."""
        return self._goal([self._message(function) for function in self._random.choice(self._chains)])

    def next(self) -> Any:
        """The next goal."""
        chance = self._random
        if chance.random() < self._strange / 4:
            return self._goal([self._function()] * chance.choice((0, 1, 3000)))
        messages = [self._message(function) for function in chance.choice(self._chains)]
        for message in messages:
            self._spoil(message)
        if chance.random() < 0.3:
            messages *= 2
        return self._goal(messages)

    def _message(self, fields: dict[str, Any]) -> Any:
        values = {k: v for k, v in fields.items() if k != "time"}
        message = self._function(**values)
        message.time = genpy.Duration.from_sec(fields.get("time", 0.0))
        return message

    def _spoil(self, message: Any) -> None:
        for name, kind in zip(message.__slots__, message._slot_types):
            if self._random.random() < self._strange:
                value = self._odd(kind)
                if value is not None:
                    setattr(message, name, value)

    def _odd(self, kind: str) -> Any:
        """A strange value that a field of this type can carry; None where there is nothing strange."""
        chance = self._random
        if kind.endswith("[]"):
            odd = [self._odd(kind[:-2]) for _ in range(chance.choice((0, 1, 2, 7)))]
            if any(value is None for value in odd):
                return None
            short = odd and max(len(str(value)) for value in odd) < 100
            return odd * (HUGE // len(odd)) if short and chance.random() < 0.1 else odd
        if kind == "string":
            return chance.choice(TEXTS)
        if kind.startswith("float"):
            return chance.choice(FLOATS if kind == "float64" else FLOATS[:5])
        if kind == "bool":
            return chance.random() < 0.5
        if kind == "duration":
            return genpy.Duration(chance.choice((0, -3, 1, 2**31 - 1)), chance.choice((0, 999_999_999)))
        if kind.startswith(("int", "uint")):
            bits = int(kind.lstrip("uint"))
            return chance.choice((0, 1, 2 ** (bits - 1) - 1) if kind[0] == "u" else (0, -1, -(2 ** (bits - 1))))
        return None
