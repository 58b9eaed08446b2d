"""Functions that record what is sent to the servers, as a behaviour that sends it again."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Sequence
from typing import Any

from naoqi.errors import NaoError

from ..errors import BadGoal
from ..field_checks import require_known, require_number
from ..function_chain import checked_by
from .checking import check
from .planned import PlannedStore
from .reader import read
from .recording import Recording
from .servers import NAMES, FunctionTables
from .store import BehaviorStore
from .writer import text_of

log = logging.getLogger(__name__)

LONGEST = 3600.0
ON_THE_WAY = 0.2
"""s of the computer that a goal may take to be heard of."""
TAG = "recorded"
BEGUN = "recording"


def check_recording(
    self: NotingFunctions,
    str_param: str,
    servers: Sequence[str],
    duration: float,
    overwrite: bool,
    context: dict[str, Any],
) -> None:
    """A name that is free, servers, a duration, and no other recording."""
    planned = PlannedStore.of(self.store, context)
    planned.require_free(str_param, overwrite)
    for server in servers:
        require_known("servers", server, NAMES, "server")
    require_number("duration", duration, 0.0, LONGEST, "0..3600 s")
    if context.get(BEGUN, self.recording is not None):
        name = self.recording.name if self.recording is not None else "of this chain"
        raise BadGoal("function", "recordBehavior", "stopRecording before", problem=f"the recording {name} goes on")
    context[BEGUN] = duration == 0.0
    planned.put(str_param, None)


def check_stop(self: NotingFunctions, context: dict[str, Any]) -> None:
    """A recording that goes on."""
    if not context.get(BEGUN, self.recording is not None):
        raise BadGoal("function", "stopRecording", "recordBehavior before", problem="nothing is recorded")
    context[BEGUN] = False


class NotingFunctions:
    """Functions that record behaviours. Parameters are fields of BehaviorFunction.

    Attributes:
        store: Behaviours by name.
        recording: The one that goes on; None if none does.
    """

    store: BehaviorStore
    tables: FunctionTables
    recording: Recording | None
    goals: Any  # GoalLog
    tell_recorded: Callable[[str, Any], None]  # of NaoBehavior
    wait: Callable[[float], None]  # of NaoBasic: a wait that preemption ends

    def noting_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {"recordBehavior": self.record_behavior, "stopRecording": self.stop_recording}

    @checked_by(check_recording)
    def record_behavior(
        self, str_param: str, servers: Sequence[str], duration: float, overwrite: bool
    ) -> list[str] | None:
        """Record what anybody sends to the servers, for `duration`, or on until stopRecording; answers as that does."""
        self.recording = Recording(str_param, servers or NAMES, overwrite, self.tell_recorded)
        self.goals.record(self.recording)
        if duration == 0.0:
            return None
        try:
            self.wait(duration)
        except BaseException:
            # What came until then is kept; why it ends is what the goal tells.
            self.keep_recording()
            raise
        return self.stop_recording()

    @checked_by(check_stop)
    def stop_recording(self) -> list[str]:
        """End a recording and store it; answers its name, how many goals it has, and what was left out."""
        # What was sent a moment ago may still be on its way here. Nothing tells whether it is: topics keep no order
        # among each other, and only the senders know how many messages they have handed to their connections.
        time.sleep(ON_THE_WAY)
        recording, self.recording = self.recording, None
        self.goals.record(None)
        if recording is None:
            raise BadGoal("function", "stopRecording", "recordBehavior before", problem="nothing is recorded")
        entries, left_out = recording.timeline(self._check_step)
        length = max(entry["at"] for entry in entries)
        help_ = f"Recorded: {len(entries)} goals in {length:.1f} s."
        self.store.save(recording.name, text_of(help_, [{"timeline": entries}], [TAG]), recording.overwrite)
        return [recording.name, str(len(entries)), *left_out]

    def keep_recording(self) -> None:
        """Store what came so far of a recording that goes on, where nobody can be told if that fails."""
        if self.recording is None:
            return
        name = self.recording.name
        try:
            for text in self.stop_recording()[2:]:
                log.warning("recording %s: %s", name, text)
        except NaoError as error:
            log.warning("the recording %s is not stored: %s", name, error)

    def _check_step(self, step: dict[str, Any]) -> None:
        check(read(text_of("A step.", [step]), "recording"), self.store.load, None, self.tables)
