"""The action server for behaviours: runs them, stores them, records them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from nao_library_actions.msg import NaoBehaviorAction
from nao_library_msgs.srv import ListBehaviors, ListBehaviorsResponse
from naoqi.errors import NaoError

from ..core.chain import joined
from ..core.files import config_file
from ..core.memory_functions import Outcome
from ..core.processes import LaunchPath
from ..nao_basic import NaoBasic
from .behavior_functions import (
    BehaviorRecordingFunctions,
    LibraryFunctions,
    RunningFunctions,
    info_message,
    step_message,
)
from .behavior_reader import NAME
from .behavior_store import BehaviorStore
from .checking import facts_of
from .clients import Clients, GoalLog, describe, running
from .server_functions import NAMES, FunctionTables

PARAMETERS = {"behavior_dir": "~/.ros/nao_behaviors"}
"""Private parameters of the node -> default."""
SHIPPED = "behaviors"
"""Folder in `config` with those that come with the library."""


class NaoBehavior(NaoBasic):
    """Behaviour goals: run what is written down for all modules together; store it, list it, record it.

    A behaviour sends goals to the other servers, as any client does. Preempted, it cancels all of them at once, and
    sees them end.

    Attributes:
        store: Behaviours by name.
        tables: Functions of the servers.
        runs: Runs behaviours.
        recordings: Records them.

    ROS API:
        Action `NaoBehavior` (nao_library_actions/NaoBehaviorAction) and what NaoBasic offers. Service
        `NaoBehavior/list` (nao_library_msgs/ListBehaviors). Sends goals to the other servers, and listens to those that
        others send. Parameter `~behavior_dir`: folder of the user's behaviours.
    """

    part_types = (RunningFunctions, LibraryFunctions, BehaviorRecordingFunctions)
    without_robot = frozenset(joined(part_types))
    """The servers of the steps need it."""

    def __init__(
        self,
        ip: str,
        port: int,
        autostart: bool = False,
        launchpath: LaunchPath | None = None,
        behavior_dir: str | Path = PARAMETERS["behavior_dir"],
        clients: Any = None,
        **options: Any,
    ) -> None:
        """Start the server; arguments as NaoBasic takes them, but for two.

        `behavior_dir`: folder of the user's behaviours; under ROS_HOME if relative, "~" stands for the home. `clients`:
        clients of the servers by name, where not those of this process's node.
        """
        super().__init__(ip, port, autostart, launchpath, **options)
        self.store = BehaviorStore(Path(behavior_dir).expanduser(), config_file(SHIPPED))
        self.tables = FunctionTables(describe, running)
        goals = GoalLog(self._node, map(self.tables.server, NAMES))
        self.runs = RunningFunctions(self, self.store, self.tables, clients or Clients(self.tables.server))
        self.recordings = BehaviorRecordingFunctions(self, self.store, self.tables, goals)
        self.add_parts(self.runs, LibraryFunctions(self, self.store, self.tables, goals), self.recordings)
        self.at_end(self.recordings.keep_recording)
        self._node.serve("NaoBehavior/list", ListBehaviors, self.answer_list)
        self.serve("NaoBehavior", NaoBehaviorAction)

    # The life of a goal

    def begin_chain(self) -> None:
        self.runs.begin_goal()
        self.recordings.cut_short = []

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Add what became of the steps, and what was asked about behaviours."""
        super().fill_result(result, outcomes)
        result.results += self.recordings.cut_short
        result.steps = [step_message(record) for record in self.runs.steps]
        result.behaviors = [info_message(facts, self._is_shipped(facts.name)) for facts in self.runs.shown]

    def argument_choices(self, function: str, field: str) -> Sequence[str]:
        """Names of the behaviours, for the description of the functions."""
        named = ("runBehavior", "describeBehavior", "checkBehavior", "renameBehavior", "copyBehavior", "deleteBehavior")
        return self.store.names() if field == "str_param" and function in named else ()

    def answer_list(self, request: Any) -> ListBehaviorsResponse:
        """Which behaviours there are; called in threads of clients."""
        if request.name or request.text:
            there = request.text or request.name in self.store.names()
            asked = (request.name, request.text, request.file, request.parameters, request.validate)
            facts = [self.runs.preview(*asked)] if there else []
        else:
            facts = [facts_of(name, self.store.load, self.tables) for name in self.store.names()]
        answer = ListBehaviorsResponse(
            [info_message(each, not request.text and self._is_shipped(each.name)) for each in facts]
        )
        if request.name and not request.text:
            for each in answer.behaviors:
                each.text = self._text(each.name)
        return answer

    def _text(self, name: str) -> str:
        """The YAML of a behaviour; empty where its file cannot be read, as its problem tells then."""
        try:
            return self.store.text(name)
        except NaoError:
            return ""

    def _is_shipped(self, name: str) -> bool:
        """Whether a name means one that comes with the library."""
        return NAME.fullmatch(name) is not None and self.store.is_shipped(name) and not self.store.of_user(name)
