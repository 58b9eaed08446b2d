"""Functions that run and show behaviours."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePath
from typing import Any

from nao_library_msgs.msg import BehaviorInfo, BehaviorParameter, BehaviorProblem, BehaviorStep

from ...base.errors import BadGoal, Preempted
from ...functions.chain import checked_by
from ...functions.check_service import NotValidated
from ...functions.goal_checks import GoalCheck
from ...functions.parts import Part
from ...process_modules.language.failures import PlanFailure
from ...server.nao_basic import NaoBasic
from ..language.binder import Library
from ..language.checking import Facts, check_given, facts_of, preview_facts
from ..language.model import Behavior
from ..language.parameters import Parameter
from ..language.planned import PlannedStore, UnknownYet
from ..language.reader import read
from ..language.servers import FunctionTables
from ..language.store import BehaviorStore
from ..language.yaml_text import dump_line
from .execution import Execution
from .fields import EITHER, File, Name, NameOrNone, Text, Values
from .report import StepEvent, StepRecord

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
