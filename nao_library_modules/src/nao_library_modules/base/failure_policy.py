"""What becomes of a chain when one of its functions fails: the field `on_error` of function messages."""

from __future__ import annotations

import re
from dataclasses import dataclass

from .errors import BadGoal
from .limits import limit

ALLOWED = 'empty or "stop", "skip", "retry N" or "retry N skip" with N from 1 to 100'
_RETRY = re.compile(r"retry +(\d{1,3})(?: +(stop|skip))?")
MOST_RETRIES = limit("retries").highest


@dataclass(frozen=True)
class FailurePolicy:
    """How often a function that fails is tried again, and whether the chain goes on without it afterwards."""

    retries: int = 0  # how often it is tried again
    skip: bool = False  # True: the chain goes on with the next function; False: the goal is aborted

    @classmethod
    def of(cls, text: str) -> FailurePolicy:
        """The policy that a text names. `text`: see `ALLOWED`. Raises BadGoal if it names none."""
        words = text.strip().lower()
        if words in ("", "stop"):
            return cls()
        if words == "skip":
            return cls(skip=True)
        match = _RETRY.fullmatch(words)
        if match is None or not 1 <= int(match[1]) <= MOST_RETRIES:
            raise BadGoal("on_error", text, ALLOWED)
        return cls(int(match[1]), match[2] == "skip")
