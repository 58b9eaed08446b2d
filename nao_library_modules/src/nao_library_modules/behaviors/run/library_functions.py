"""Functions that store, rename, copy and delete behaviours."""

from __future__ import annotations

from typing import Any

from ...base.errors import BadGoal
from ...functions.chain import checked_by
from ...functions.parts import Part
from ...server.nao_basic import NaoBasic
from ..language.binder import bind
from ..language.planned import PlannedStore, UnknownYet
from ..language.reader import read
from ..language.servers import NAMES, FunctionTables
from ..language.store import BehaviorStore
from ..language.writer import from_goal
from .clients import GoalLog
from .fields import EITHER_TO_STORE, CopyName, Name, NewName, Overwrite, OwnName, Server, StoredName, TextToStore


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
