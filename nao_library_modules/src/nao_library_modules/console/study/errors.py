"""What is wrong with a study.

NaoError                 (naoqi.errors)
    StudyError           a study or a trial cannot be done, or its files cannot be read
        ProtocolError    a protocol cannot be run: problems
"""

from __future__ import annotations

from collections.abc import Sequence

from naoqi.errors import NaoError

from ...base.errors import cut
from ...behaviors.language.errors import MOST_TOLD, Problem


class StudyError(NaoError):
    """A study or a trial cannot be done."""


class ProtocolError(StudyError):
    """A protocol cannot be run. `problems`: what is wrong, in the order of the file."""

    def __init__(self, name: str, problems: Sequence[Problem]) -> None:
        more = f"; and {len(problems) - MOST_TOLD} more" if len(problems) > MOST_TOLD else ""
        super().__init__(cut(f"protocol {name}: {'; '.join(map(str, problems[:MOST_TOLD]))}{more}"))
        self.problems = tuple(problems)
