"""Functions that record what is sent to the servers, as a behaviour that sends it again."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence
from typing import Any

from nao_library_msgs.msg import FunctionResult
from naoqi.errors import NaoError

from ...base.errors import BadGoal
from ...base.whole_file import written
from ...functions.chain import checked_by
from ...functions.parts import Part
from ...server.nao_basic import NaoBasic
from ..language.binder import bind
from ..language.planned import PlannedStore
from ..language.reader import read
from ..language.servers import NAMES, FunctionTables
from ..language.store import BehaviorStore
from ..language.writer import text_of
from .clients import GoalLog
from .fields import Length, Overwrite, Servers, StoredName
from .recording import BehaviorRecording

log = logging.getLogger(__name__)

ON_THE_WAY = 0.2
"""s of the computer that a goal may take to be heard of."""
TAG = "recorded"
BEGUN = "recording"
LONGEST_NAMES = 200
"""Characters of the feedback for a goal that was recorded."""


class BehaviorRecordingFunctions(Part):
    """Functions that record behaviours. Parameters are fields of BehaviorFunction.

    `recording`: the one that goes on; None if none does. `cut_short`: what a recording that was interrupted has left,
    for the result of the chain.
    """

    def __init__(self, module: NaoBasic, store: BehaviorStore, tables: FunctionTables, goals: GoalLog) -> None:
        self._module = module
        self._store = store
        self.tables = tables
        self._goals = goals
        self.recording: BehaviorRecording | None = None
        self.cut_short: list[FunctionResult] = []

    def _check_recording(
        self,
        str_param: str,
        servers: Sequence[str],
        duration: float,
        overwrite: bool,
        context: dict[str, Any],
    ) -> None:
        """A name that is free, servers, and no other recording."""
        planned = PlannedStore.of(self._store, context)
        planned.require_free(str_param, overwrite)
        for server in servers:
            self.tables.server(server, "servers")
        if context.get(BEGUN, self.recording is not None):
            name = self.recording.name if self.recording is not None else "of this chain"
            raise BadGoal("function", "recordBehavior", "stopRecording before", problem=f"the recording {name} goes on")
        context[BEGUN] = duration == 0.0
        planned.put(str_param, None)

    @checked_by(_check_recording)
    def record_behavior(
        self, str_param: StoredName, servers: Servers, duration: Length, overwrite: Overwrite
    ) -> list[str] | None:
        """Record what anybody sends to the servers, for `duration`, or on until stopRecording; answers as that does."""
        for server in servers:
            self._goals.listen(self.tables.server(server, "servers"))
        self.recording = BehaviorRecording(str_param, servers or NAMES, overwrite, self._publish_recorded)
        self._goals.record(self.recording)
        self._module.publish_feedback(behavior=str_param, what="recordBehavior", state="recording")
        if duration == 0.0:
            return None
        try:
            self._module.wait(duration)
        except BaseException:
            # What came until then is kept; why it ends is what the goal tells.
            kept = self.keep_recording()
            if kept:
                self.cut_short.append(FunctionResult(function="recordBehavior", values=kept))
            raise
        return self.stop_recording()

    def _check_stop(self, context: dict[str, Any]) -> None:
        """A recording that goes on."""
        if not context.get(BEGUN, self.recording is not None):
            raise BadGoal("function", "stopRecording", "recordBehavior before", problem="nothing is recorded")
        context[BEGUN] = False

    @checked_by(_check_stop)
    def stop_recording(self) -> list[str]:
        """End a recording and store it; answers its name, how many goals it has, and what was left out."""
        answer, told = self._store_recording()
        self._module.remark(told)
        return answer

    def keep_recording(self) -> list[str]:
        """Store what came so far of a recording that goes on, where nobody can be told if that fails.

        Returns as stopRecording, and where it is; empty if nothing is stored.
        """
        if self.recording is None:
            return []
        name = self.recording.name
        try:
            answer, told = self._store_recording()
        except NaoError as error:
            log.warning("the recording %s is not stored: %s", name, error)
            return []
        for text in answer[2:]:
            log.warning("recording %s: %s", name, text)
        log.info("recording %s: %s", name, told)
        return [*answer, told]

    def _store_recording(self) -> tuple[list[str], str]:
        """End a recording and store it; what stopRecording answers, and where it is."""
        # What was sent a moment ago may still be on its way here. Nothing tells whether it is: topics keep no order
        # among each other, and only the senders know how many messages they have handed to their connections.
        time.sleep(ON_THE_WAY)
        recording, self.recording = self.recording, None
        self._goals.record(None)
        if recording is None:
            raise BadGoal("function", "stopRecording", "recordBehavior before", problem="nothing is recorded")
        entries, left_out = recording.timeline(self._check_step)
        length = max(entry["at"] for entry in entries)
        text = text_of(f"Recorded: {len(entries)} goals in {length:.1f} s.", [{"timeline": entries}], [TAG])
        path = self._store.save(recording.name, text, recording.overwrite, numbered=True)
        return [path.stem, str(len(entries)), *left_out], written(path, self._store.path(recording.name))

    def _check_step(self, step: dict[str, Any]) -> None:
        bind(read(text_of("A step.", [step]), "recording"), {}, self._store.load, self.tables)

    def _publish_recorded(self, server: str, goal: Any) -> None:
        """Publish that a goal was recorded, while a goal records. Called from threads of subscribers."""
        recording = self.recording
        if recording is None or self._module.running_function != "recordBehavior":
            return
        names = ", ".join(each.function for each in getattr(goal, goal.__slots__[0]))
        what = f"{server}.{names}"[:LONGEST_NAMES]
        self._module.publish_feedback(behavior=recording.name, what=what, state="recorded")

    functions = {
        "recordBehavior": record_behavior,
        "stopRecording": stop_recording,
    }
