"""The servers that steps may use: their actions, their functions, and what can be checked of a goal without a robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from naoqi.errors import NaoError

from ..errors import BadGoal, FunctionFailed
from ..function_chain import FunctionChain
from ..offline_module import offline_module
from ..server_types import ACTIONS, ServerType, server_type
from ..suggestion import did_you_mean

OWN = "NaoBehavior"
NAMES = tuple(name for name in ACTIONS if name != OWN)
"""Servers that steps may use."""


def server_of(name: str) -> ServerType:
    """The types of a server that steps may use.

    Raises:
        BadGoal: If there is none of that name.
    """
    if name in NAMES:
        return server_type(name)
    problem = f"there is no server {name!r}{did_you_mean(name, NAMES)}"
    if name == OWN:
        problem = "a behavior that sends goals to NaoBehavior would end itself: use 'behavior: NAME'"
    raise BadGoal("step", name, f"the servers are {', '.join(NAMES)}", problem)


class FunctionTables:
    """What the servers can do, read from their code: functions, and checks that need no robot.

    A server's class is looked at when it is asked for the first time. Any thread may ask; two that come at the same
    time do the same work.
    """

    def __init__(self) -> None:
        """Know nothing yet."""
        self._tables: dict[str, Mapping[str, Callable[..., Any]]] = {}
        self._chains: dict[str, FunctionChain] = {}

    def functions(self, server: ServerType) -> Mapping[str, Callable[..., Any]]:
        """Functions of a server by name."""
        if server.name not in self._tables:
            self._tables[server.name] = dict(offline_module(server.module)[0].function_table)
        return self._tables[server.name]

    def check(self, server: ServerType, messages: Sequence[Any]) -> list[int]:
        """Check a goal as far as that is possible without the robot and without what goals before it have done.

        Args:
            server: That it is for.
            messages: Its function messages.

        Returns:
            Places, counted from 1, of the functions whose checks only the server can finish.

        Raises:
            FunctionFailed: Names the function that is wrong and says why; the position only if there are several.
            NaoError: What is wrong, of a single function.
        """
        unfinished = []
        try:
            for position, (message, binding) in enumerate(zip(messages, self._chain(server).bind(messages)), start=1):
                try:
                    binding.run_check(message, {}, _Elsewhere())
                except _AtTheServer:
                    unfinished.append(position)
                except NaoError as error:
                    raise FunctionFailed(position, message.function, error) from error
        except FunctionFailed as failed:
            if len(messages) == 1 and isinstance(failed.cause, NaoError):
                raise failed.cause from None
            raise
        return unfinished

    def _chain(self, server: ServerType) -> FunctionChain:
        """Reads goals of a server, without a robot."""
        if server.name not in self._chains:
            self._chains[server.name] = FunctionChain(self.functions(server), server.name)
        return self._chains[server.name]


class _AtTheServer(Exception):  # noqa: N818  a signal: the rest of a check can only be done by the server
    """A check asks for something that is only known where the server runs."""


class _Elsewhere:
    """Stands for the server in its checks: it knows nothing."""

    def __getattr__(self, name: str) -> Any:
        raise _AtTheServer(name)
