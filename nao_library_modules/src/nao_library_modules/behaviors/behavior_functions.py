"""The functions of NaoBehavior and their fields: they run and show behaviours, store them, and record them."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence
from pathlib import PurePath
from typing import Any, List

from nao_library_msgs.msg import BehaviorInfo, BehaviorParameter, BehaviorProblem, BehaviorStep, FunctionResult
from naoqi.errors import NaoError

from ..core.chain import Part, checked_by
from ..core.describe import NotValidated
from ..core.errors import BadGoal, Preempted
from ..core.fields import Annotated, flag, free, number
from ..core.files import written
from ..core.goal_checks import GoalCheck
from ..nao_basic import NaoBasic
from ..process_modules.failures import PlanFailure
from .behavior_reader import NAME_ALLOWED, read, require_name
from .behavior_store import BehaviorStore, PlannedStore, UnknownYet, from_goal, text_of
from .binder import Library, bind
from .checking import Facts, check_given, facts_of, preview_facts
from .clients import BehaviorRecording, GoalLog
from .execution import Execution, StepEvent, StepRecord
from .model import Behavior
from .parameters import Parameter
from .server_functions import NAMES, FunctionTables
from .strict_yaml import dump_line

# --- fields -----------------------------------------------------------------------------------------------------------

EITHER = "either a name in str_param or a behavior in text"
EITHER_TO_STORE = "either a behavior, or the server whose last goal is to be stored"


def _require_name_if_any(name: str, value: str) -> None:
    if value.strip():
        require_name(value, name)


_NAME = free("name of the behaviour", allowed=NAME_ALLOWED, check=lambda name, value: require_name(value, name))
_TEXT = free("a behaviour as YAML, instead of the name of one", allowed=EITHER)
_SERVERS = free(
    "servers whose goals are recorded; empty: all",
    allowed=f"the servers are {', '.join(NAMES)}, and others while they run",
    choices=NAMES,
)

Name = Annotated[str, _NAME]
NameOrNone = Annotated[
    str, _NAME.but(help="name of the behaviour; empty: `text` is the behaviour", check=_require_name_if_any)
]
OwnName = Annotated[str, _NAME.but(help="name of a behaviour of one's own")]
StoredName = Annotated[str, _NAME.but(help="name that it is stored under")]
NewName = Annotated[str, _NAME.but(help="the new name")]
CopyName = Annotated[str, _NAME.but(help="name of the copy")]
Text = Annotated[str, _TEXT]
TextToStore = Annotated[
    str, _TEXT.but(help="the behaviour as YAML; empty: the last goal of `server`", allowed=EITHER_TO_STORE)
]
File = Annotated[str, free("file that `text` was read from; errors tell it with their lines")]
Values = Annotated[
    List[str],
    free("values of its parameters; the others have their defaults", allowed="name=value, each one string, each once"),
]
Server = Annotated[str, _SERVERS.but(help="server whose last goal is stored, instead of `text`")]
Servers = Annotated[List[str], _SERVERS]
Length = Annotated[float, number("recording", "length of the recording", zero=": until stopRecording")]
Overwrite = Annotated[bool, flag("whether one of that name in the folder of the user is replaced")]


# --- run and show -----------------------------------------------------------------------------------------------------

UNNAMED = "text"
"""What a behaviour is called that has no name yet."""


def _require_one(str_param: str, text: str) -> None:
    if bool(str_param.strip()) == bool(text.strip()):
        raise BadGoal("text", text[:200], EITHER)


def _behavior(load: Library, str_param: str, text: str, file: str) -> Behavior:
    return read(text, PurePath(file).stem or UNNAMED, file) if text.strip() else load(str_param)


class RunningFunctions(Part):
    """Functions that run and show behaviours. Parameters are fields of BehaviorFunction.

    `steps`: what became of the steps of behaviours that this goal has run. `shown`: behaviours that this goal has asked
    for. `clients`: name of a server -> its client.
    """

    def __init__(self, module: NaoBasic, store: BehaviorStore, tables: FunctionTables, clients: Any) -> None:
        self._module = module
        self._store = store
        self.tables = tables
        self._clients = clients
        self.steps: list[StepRecord] = []
        self.shown: list[Facts] = []
        self._replaced = ""  # behaviour that the goal before ran when this one came
        self._ended = ""  # behaviour that this goal ran when the next one came

    def begin_goal(self) -> None:
        """Forget what the last goal did, but for what it was doing when this one came."""
        self.steps, self.shown = [], []
        self._replaced, self._ended = self._ended, ""

    def _check_run(
        self, str_param: str, text: str, file: str, parameters: Sequence[str], context: dict[str, Any]
    ) -> None:
        """A behaviour, stored or in `text`, that can be run with these values; its servers look at all of its goals."""
        if text.strip():
            _require_one(str_param, text)
        planned = PlannedStore.of(self._store, context)
        try:
            behavior = _behavior(planned.load, str_param, text, file)
            check_given(behavior, planned.load, parameters, self.tables, self.ask)
        except UnknownYet:
            pass  # an earlier function of this chain records it

    @checked_by(_check_run)
    def run_behavior(self, str_param: NameOrNone, text: Text, file: File, parameters: Values) -> float:
        """Run a behaviour, stored or in `text`, and wait for its end; answers how long it took, s of ROS time."""
        self._ended = ""
        behavior = _behavior(self._store.load, str_param, text, file)
        program, _ = check_given(behavior, self._store.load, parameters, self.tables)
        execution = Execution(program, self._clients, self._module.clock, self._publish)
        try:
            execution.run(self._module.interrupt)
        except PlanFailure:
            try:
                self._module.interrupt.check()
            except Preempted:
                self._ended = behavior.name
                raise
            raise
        finally:
            self.steps += execution.report.records()
        return execution.report.now()

    def stop_behavior(self) -> list[str]:
        """End the behaviour that runs, and with it what it does; answers which one that was, nothing if none ran."""
        # Every goal replaces the one before: it was ended when this one came.
        return [self._replaced] if self._replaced else []

    def list_behaviors(self) -> list[str]:
        """Names of the behaviours, those that come with the library and one's own."""
        names = self._store.names()
        self.shown += [facts_of(name, self._store.load, self.tables) for name in names]
        return names

    def _check_name(self, str_param: str, context: dict[str, Any]) -> None:
        """A behaviour that is there."""
        PlannedStore.of(self._store, context).text(str_param)

    @checked_by(_check_name)
    def describe_behavior(self, str_param: Name) -> str:
        """The text of a behaviour; what it does, its parameters and servers are in the result as well."""
        text = self._store.text(str_param)
        self.shown.append(self.preview(str_param))
        return text

    def _check_what(self, str_param: str, text: str, context: dict[str, Any]) -> None:
        """A name or a text."""
        _require_one(str_param, text)
        if str_param.strip():
            self._check_name(str_param, context)

    @checked_by(_check_what)
    def check_behavior(self, str_param: NameOrNone, text: Text, file: File, parameters: Values) -> list[str]:
        """What is wrong with a behaviour, stored or in `text`; nothing if it can be run; then the result tells more."""
        facts = self.preview(str_param.strip(), text, file, parameters, validate=True)
        self.shown.append(facts)
        return list(map(str, facts.problems))

    def preview(
        self, name: str, text: str = "", file: str = "", parameters: Sequence[str] = (), validate: bool = False
    ) -> Facts:
        """All there is to know about a behaviour, stored or in a text. Any thread may ask.

        Args:
            name: Of one that is stored.
            text: YAML.
            parameters: Values as "name=value".
            validate: Whether its servers look at its goals.
        """
        return preview_facts(
            PurePath(file).stem or UNNAMED if text.strip() else name,
            lambda: _behavior(self._store.load, name, text, file),
            self._store.load,
            self.tables,
            parameters,
            self.ask if validate else None,
        )

    def ask(self, server: str, goals: Sequence[Any]) -> GoalCheck:
        """Have a server check goals. Raises NotValidated if it does not."""
        check = getattr(self._clients(server), "check", None)
        if check is None:
            raise NotValidated("it cannot be asked")
        return check(goals)

    def _publish(self, event: StepEvent) -> None:
        """Publish what happens to a step. Called from threads of the plan, one after the other."""
        node = event.node
        self._module.publish_feedback(
            behavior=node.behavior,
            path=node.where,
            label=node.label,
            what=node.what,
            state=event.state,
            time=event.time,
            text=event.text,
        )

    functions = {
        "runBehavior": run_behavior,
        "stopBehavior": stop_behavior,
        "listBehaviors": list_behaviors,
        "getInstalledBehaviors": list_behaviors,
        "describeBehavior": describe_behavior,
        "checkBehavior": check_behavior,
    }


def step_message(record: StepRecord) -> BehaviorStep:
    """What became of a step, as a message."""
    node = record.node
    return BehaviorStep(
        behavior=node.behavior,
        path=node.where,
        label=node.label,
        what=node.what,
        state=record.state,
        began=record.began,
        ended=record.ended,
        late=record.late,
        attempts=record.attempts,
        error=record.error,
        results=record.results,
        file=node.file,
        line=node.line,
    )


def info_message(facts: Facts, shipped: bool) -> BehaviorInfo:
    """What there is to know about a behaviour, as a message."""
    info = BehaviorInfo(name=facts.name, servers=list(facts.servers), shipped=shipped, problem=facts.problem)
    if facts.behavior is not None:
        info.help, info.tags = facts.behavior.help, list(facts.behavior.tags)
        info.parameters = [_parameter_message(each) for each in facts.behavior.parameters.values()]
    preview = facts.preview
    info.steps, info.boxes, info.unchecked = list(preview.steps), list(preview.boxes), list(preview.unchecked)
    info.waits = preview.waits
    info.unvalidated = list(facts.unvalidated)
    info.problems = [BehaviorProblem(each.file, each.line, each.where, each.text) for each in facts.problems]
    return info


def _parameter_message(parameter: Parameter) -> BehaviorParameter:
    return BehaviorParameter(
        name=parameter.name,
        type=parameter.kind,
        default=dump_line(parameter.default),
        help=parameter.help,
        unit=parameter.unit,
        choices=[dump_line(each) for each in parameter.choices],
        min=parameter.lowest,
        max=parameter.highest,
    )


# --- store ------------------------------------------------------------------------------------------------------------


class LibraryFunctions(Part):
    """Functions that store, rename, copy and delete behaviours. Parameters are fields of BehaviorFunction."""

    def __init__(self, module: NaoBasic, store: BehaviorStore, tables: FunctionTables, goals: GoalLog) -> None:
        self._module = module
        self._store = store
        self.tables = tables
        self._goals = goals

    def _check_new(self, str_param: str, text: str, server: str, overwrite: bool, context: dict[str, Any]) -> None:
        """A name that is free, and a behaviour that can be run or a server."""
        planned = PlannedStore.of(self._store, context)
        planned.require_free(str_param, overwrite)
        if bool(text.strip()) == bool(server):
            raise BadGoal("text", text[:200], EITHER_TO_STORE)
        if server:
            self.tables.server(server, "server")
        else:
            # It is there already: whoever is a box of itself is found out.
            planned.put(str_param, text)
            try:
                bind(read(text, str_param), {}, planned.load, self.tables)
            except UnknownYet:
                pass  # a box that an earlier function of this chain records
        planned.put(str_param, text or None)

    @checked_by(_check_new)
    def store_behavior(self, str_param: StoredName, text: TextToStore, server: Server, overwrite: Overwrite) -> None:
        """Store a behaviour: the one in `text`, or the goal that `server` got last."""
        if server:
            self._goals.listen(self.tables.server(server, "server"))
            goal = self._goals.last(server)
            if goal is None:
                since = "so far" if server in NAMES else "since NaoBehavior listens to it, which it does from now on"
                raise BadGoal("server", server, "one that got a goal", problem=f"{server} got no goal {since}")
            kind = self.tables.server(server, "server")
            text = from_goal(server, goal, unusual=bool(self.tables.unusual(kind, getattr(goal, goal.__slots__[0]))))
            bind(read(text, str_param), {}, self._store.load, self.tables)
        self._module.remark(f"written: {self._store.save(str_param, text, overwrite)}")

    def _check_rename(self, str_param: str, new_name: str, overwrite: bool, context: dict[str, Any]) -> None:
        """One's own behaviour, and a name that is free."""
        planned = PlannedStore.of(self._store, context)
        planned.require_of_user(str_param)
        planned.require_free(new_name, overwrite, "new_name")
        planned.put(new_name, planned.text(str_param))
        planned.remove(str_param)

    @checked_by(_check_rename)
    def rename_behavior(self, str_param: OwnName, new_name: NewName, overwrite: Overwrite) -> list[str]:
        """Give one of one's own behaviours another name; answers which other ones still use the old one as a box."""
        self._module.remark(f"written: {self._store.rename(str_param, new_name, overwrite)}")
        return self._users_of(str_param)

    def _check_copy(self, str_param: str, new_name: str, overwrite: bool, context: dict[str, Any]) -> None:
        """A behaviour, and a name that is free."""
        planned = PlannedStore.of(self._store, context)
        text = planned.text(str_param)
        planned.require_free(new_name, overwrite, "new_name")
        planned.put(new_name, text)

    @checked_by(_check_copy)
    def copy_behavior(self, str_param: Name, new_name: CopyName, overwrite: Overwrite) -> None:
        """Make a behaviour of one's own that is the same as another one, also as one that comes with the library."""
        self._module.remark(f"written: {self._store.save(new_name, self._store.text(str_param), overwrite)}")

    def _check_delete(self, str_param: str, context: dict[str, Any]) -> None:
        """One's own behaviour."""
        planned = PlannedStore.of(self._store, context)
        planned.require_of_user(str_param)
        planned.remove(str_param)

    @checked_by(_check_delete)
    def delete_behavior(self, str_param: OwnName) -> list[str]:
        """Delete one of one's own behaviours; answers which other ones still use it as a box."""
        self._store.delete(str_param)
        return self._users_of(str_param)

    def _users_of(self, name: str) -> list[str]:
        """Behaviours with a box of a name that nothing has any more."""
        return [] if self._store.exists(name) else self._store.users_of(name)

    functions = {
        "storeBehavior": store_behavior,
        "renameBehavior": rename_behavior,
        "copyBehavior": copy_behavior,
        "deleteBehavior": delete_behavior,
    }


# --- record -----------------------------------------------------------------------------------------------------------


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
