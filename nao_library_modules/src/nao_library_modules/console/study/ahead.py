"""Listening ahead: a word that is said before a trial waits for it is heard, unless the robot speaks meanwhile."""

from __future__ import annotations

import logging
from typing import Any, Callable

from naoqi.errors import NaoError

from ..robots.commands import BEHAVIORS, SPEECH
from ..robots.errors import Stopped
from .course import is_inside, step_at, steps_in
from .protocol import NOW, CommandStep, ProtocolStep, SenseStep, WhileStep
from .waits import command_of, word_of

log = logging.getLogger(__name__)

EARS = (SPEECH, "nao_audio_in")
"""Servers that speak and listen: the robot does not listen ahead of their steps, it would hear itself."""
LIMIT = 3600.0
"""s for which the robot listens ahead."""


class ListeningAhead:
    """The goal that listens already.

    Args:
        trial: The `TrialRunner`.
        speaks: Whether a stored behaviour speaks or listens.
    """

    def __init__(self, trial: Any, speaks: Callable[[str], bool]) -> None:
        self._trial, self._speaks = trial, speaks
        self._path = ""  # of the wait that it is for
        self._run: Any = None

    def begin(self, path: str, step: ProtocolStep) -> None:
        """A step begins: listen from now on if a wait for a word comes and nothing before it is heard or listens."""
        if word_of(step) is not None or is_inside(path):
            return
        found = self._next(path, step)
        if found is None or found[0] != self._path:
            self.end()
        if found is None or self._run is not None:
            return
        try:
            self._path, self._run = found[0], self._trial.send(command_of(found[1], LIMIT))
        except Stopped:
            raise
        except NaoError as error:  # the wait itself fails with it
            log.info("the robot does not listen ahead: %s", error)

    def take(self, path: str) -> Any:
        """The goal that listens for the wait at a path, which has it from now on; None if none does."""
        run, wanted = self._run, self._path
        if run is None or wanted != path or (run.done and run.state != "succeeded"):
            self.end()
            return None
        self._run, self._path = None, ""
        return run

    def end(self) -> None:
        """Listen no longer."""
        if self._run is not None and not self._run.done:
            self._run.cancel()
        self._run, self._path = None, ""

    def _next(self, path: str, step: ProtocolStep) -> tuple[str, SenseStep] | None:
        """The wait for a word behind a step, with its path; None if a step before speaks or listens."""
        done = {outcome.label for outcome in self._trial.state.outcomes}
        behaviors: list[str] = []
        while not self._uses_ears(step, behaviors):
            path = self._trial.following(path)
            if not path:
                return None
            step = step_at(self._trial.protocol, path)
            word = word_of(step)
            if word is not None:
                later = word.since == NOW or (word.since and word.since not in done)
                return None if later or any(map(self._speaks, behaviors)) else (path, word)
        return None

    def _uses_ears(self, step: ProtocolStep, behaviors: list[str]) -> bool:
        """Whether a step speaks or listens; behaviours, which may, are added to a list."""
        if isinstance(step, CommandStep):
            command = step.command.filled({name: str(value) for name, value in self._trial.state.values.items()})
            if command.server == BEHAVIORS:
                behaviors += [str(fields.get("str_param", "")) for _, fields in command.chain]
            return command.stops or command.server in EARS
        parts, acts = (step.waits, steps_in(step.steps)) if isinstance(step, WhileStep) else ((step,), ())
        hears = any(isinstance(each, SenseStep) and each.sense == "sound" for each in parts)
        return hears or any(self._uses_ears(each, behaviors) for each in acts)
