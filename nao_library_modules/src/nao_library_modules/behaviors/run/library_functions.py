"""Functions that store, rename, copy and delete behaviours."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...base.errors import BadGoal
from ...functions.chain import checked_by
from ..language.binder import bind
from ..language.planned import PlannedStore, UnknownYet
from ..language.reader import read
from ..language.servers import NAMES, FunctionTables
from ..language.store import BehaviorStore
from ..language.writer import from_goal
from .fields import EITHER_TO_STORE, CopyName, Name, NewName, Overwrite, OwnName, Server, StoredName, TextToStore


def check_new(
    self: KeepingFunctions, str_param: str, text: str, server: str, overwrite: bool, context: dict[str, Any]
) -> None:
    """A name that is free, and a behaviour that can be run or a server."""
    planned = PlannedStore.of(self.store, context)
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


def check_rename(
    self: KeepingFunctions, str_param: str, new_name: str, overwrite: bool, context: dict[str, Any]
) -> None:
    """One's own behaviour, and a name that is free."""
    planned = PlannedStore.of(self.store, context)
    planned.require_of_user(str_param)
    planned.require_free(new_name, overwrite, "new_name")
    planned.put(new_name, planned.text(str_param))
    planned.remove(str_param)


def check_copy(self: KeepingFunctions, str_param: str, new_name: str, overwrite: bool, context: dict[str, Any]) -> None:
    """A behaviour, and a name that is free."""
    planned = PlannedStore.of(self.store, context)
    text = planned.text(str_param)
    planned.require_free(new_name, overwrite, "new_name")
    planned.put(new_name, text)


def check_delete(self: KeepingFunctions, str_param: str, context: dict[str, Any]) -> None:
    """One's own behaviour."""
    planned = PlannedStore.of(self.store, context)
    planned.require_of_user(str_param)
    planned.remove(str_param)


class KeepingFunctions:
    """Functions that store, rename, copy and delete behaviours. Parameters are fields of BehaviorFunction."""

    store: BehaviorStore
    tables: FunctionTables
    goals: Any  # GoalLog
    remark: Callable[[str], None]  # of NaoBasic

    @checked_by(check_new)
    def store_behavior(self, str_param: StoredName, text: TextToStore, server: Server, overwrite: Overwrite) -> None:
        """Store a behaviour: the one in `text`, or the goal that `server` got last."""
        if server:
            self.goals.listen(self.tables.server(server, "server"))
            goal = self.goals.last(server)
            if goal is None:
                since = "so far" if server in NAMES else "since NaoBehavior listens to it, which it does from now on"
                raise BadGoal("server", server, "one that got a goal", problem=f"{server} got no goal {since}")
            text = from_goal(server, goal)
            bind(read(text, str_param), {}, self.store.load, self.tables)
        self.remark(f"written: {self.store.save(str_param, text, overwrite)}")

    @checked_by(check_rename)
    def rename_behavior(self, str_param: OwnName, new_name: NewName, overwrite: Overwrite) -> list[str]:
        """Give one of one's own behaviours another name; answers which other ones still use the old one as a box."""
        self.remark(f"written: {self.store.rename(str_param, new_name, overwrite)}")
        return self._users_of(str_param)

    @checked_by(check_copy)
    def copy_behavior(self, str_param: Name, new_name: CopyName, overwrite: Overwrite) -> None:
        """Make a behaviour of one's own that is the same as another one, also as one that comes with the library."""
        self.remark(f"written: {self.store.save(new_name, self.store.text(str_param), overwrite)}")

    @checked_by(check_delete)
    def delete_behavior(self, str_param: OwnName) -> list[str]:
        """Delete one of one's own behaviours; answers which other ones still use it as a box."""
        self.store.delete(str_param)
        return self._users_of(str_param)

    def _users_of(self, name: str) -> list[str]:
        """Behaviours with a box of a name that nothing has any more."""
        return [] if self.store.exists(name) else self.store.users_of(name)

    functions = {
        "storeBehavior": store_behavior,
        "renameBehavior": rename_behavior,
        "copyBehavior": copy_behavior,
        "deleteBehavior": delete_behavior,
    }
