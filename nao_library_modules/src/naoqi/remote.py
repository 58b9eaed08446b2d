"""Remote modules and their methods, without any magic: what the proxies are made of."""

from __future__ import annotations

import functools
import logging
from threading import get_ident
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional

from . import wire
from .calls import Call
from .errors import BadArguments, CallTimeout, NaoError, RobotUnreachable
from .session import Live
from .signatures import mentions_raw, readable_call
from .translate import NOT_SENT, CallSite, call_error, unknown_method

if TYPE_CHECKING:
    from .robot_connection import Connection

logger = logging.getLogger("naoqi")

FIRST_OWN_UID = 100
"""libqi numbers the methods of the module itself from here; those below it adds to every object."""
ANSWERED_BY_ALL = "isStatsEnabled"
"""A method without effect that libqi adds to every object."""
LOCAL_NAMES = frozenset(("isValid", "metaObject"))
"""What libqi's own object can do without asking the robot; passed through as it is."""


class RemoteModule:
    """One module of one robot, across losses of the connection.

    Attributes:
        name: Name of the module.
        connection: The way to it.
        timeout: Limit of each waiting call, in s; None for none.
    """

    def __init__(self, name: str, connection: Connection, timeout: Optional[float] = None) -> None:
        self.name = name
        self.connection = connection
        self.timeout = timeout

    def service(self) -> Any:
        """The remote object of the present session.

        Raises RobotUnreachable if there is no session, UnknownModule if the robot does not have the module.
        """
        return self.connection.service(self.name)

    def method(self, name: str) -> RemoteMethod:
        """A method of the module; whether it is there shows when it is called."""
        kind = SubscribingMethod if self.connection.subscriptions.concerns(self.name, name) else RemoteMethod
        return kind(self, name)

    def attribute(self, name: str) -> Any:
        """What the module has under a name: a method, or libqi's own object for a signal or property.

        While there is no connection everything is taken for a method. Raises UnknownMethod if there is nothing of that
        name, UnknownModule if the robot does not have the module.
        """
        try:
            found = self.find(name)
        except RobotUnreachable:
            return self.method(name)
        if hasattr(found, "connect") or name in LOCAL_NAMES:  # signals and properties can be connected to
            return found
        return self.method(name)

    def find(self, name: str) -> Any:
        """What libqi has under a name in the present session.

        Raises RobotUnreachable if there is no session, UnknownMethod if there is nothing of that name, UnknownModule if
        the robot does not have the module.
        """
        service = self.service()
        found = getattr(service, name, None)
        if found is not None:
            return found
        methods = service.metaObject()["methods"].values()
        if any(each["name"] == name for each in methods):  # libqi hides what every object has
            return functools.partial(service.call, name)
        raise unknown_method(self.name, name, self.method_names())

    def offers(self, name: str) -> bool:
        """Whether the module itself has a method of that name.

        Raises RobotUnreachable if there is no session, UnknownModule if the robot does not have the module.
        """
        return bool(self.overloads(name))

    def descriptions(self) -> List[Dict[str, Any]]:
        """What the module says of its methods, one dictionary for each overload, as libqi gives it."""
        methods = self.service().metaObject()["methods"]
        return [methods[uid] for uid in sorted(methods) if uid >= FIRST_OWN_UID]

    def method_names(self) -> List[str]:
        """Names of the methods, each once, in the order of the module."""
        return list(dict.fromkeys(each["name"] for each in self.descriptions()))

    def overloads(self, method: str) -> List[Dict[str, Any]]:
        return [each for each in self.descriptions() if each["name"] == method]


class RemoteMethod:
    """A method of a remote module. It may be kept: after a loss it works again with the next session."""

    __slots__ = ("_bound", "_live", "_service", "module", "name")

    def __init__(self, module: RemoteModule, name: str) -> None:
        self.module = module
        self.name = name
        self._live: Optional[Live] = None
        self._service: Any = None
        self._bound: Any = None

    def __repr__(self) -> str:
        return f"{self.module.name}.{self.name}"

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        """Call it and wait for what it returns. Keyword arguments are left out, as by the SDK: the log says which.

        Raises:
            NaoError: If anything goes wrong, see `naoqi.errors`. A call that runs into the time limit, or
                that is interrupted from the keyboard, is cancelled on the robot too.
        """
        if options:
            self.leave_out(options)
        try:
            return self._wait_for(RemoteMethod.start(self, *arguments))
        except RobotUnreachable as error:
            if str(error.__cause__) not in NOT_SENT or self.module.connection.live is None:
                raise
        # The module had left and perhaps come back. Nothing had been sent, so that sending it again is safe.
        return self._wait_for(RemoteMethod.start(self, *arguments))

    def leave_out(self, options: Mapping[str, Any]) -> None:
        """Warn of keyword arguments, which only the package `qi` knows."""
        text = "%r: %s is left out; `post` of a proxy, or the package `qi`, calls without waiting"
        logger.warning(text, self, ", ".join(options))

    def start(self, *arguments: Any) -> Call:
        """Call it without waiting.

        Raises RobotUnreachable if there is no session now, UnknownMethod if the module does not have it, UnknownModule
        if the robot does not have the module, BadArguments if an argument cannot travel.
        """
        connection = self.module.connection
        presence, thread = connection.presence, get_ident()
        presence.enter(thread)  # before looking for the session: when that is closed, nobody new comes in
        try:
            live = connection.live
            if live is None or live is not self._live or live.services.get(self.module.name) is not self._service:
                self._bind(live)
            try:
                sent = wire.to_wire(arguments, self._takes_raw)
            except wire.UnsendableError as error:
                raise BadArguments(self.module.name, self.name, arguments, self._readable(), str(error)) from None
            witness = connection.witness
            seen = witness(self.module.name, self.name, arguments) if witness is not None else None
            call = Call(self._bound(*sent, _async=True), self, arguments)
            if seen is not None:
                call.add_done_callback(seen)
            return call
        finally:
            presence.leave(thread)

    def _wait_for(self, call: Call) -> Any:
        try:
            return call.result(self.module.timeout)
        except (CallTimeout, KeyboardInterrupt):
            call.cancel()
            raise

    def translate(self, raised: Exception, call: Call) -> NaoError:
        """The error for what libqi raised at the end of a call."""
        connection = self.module.connection
        if str(raised) in NOT_SENT:
            connection.forget_service(self.module.name)  # the next call looks the module up afresh
        site = CallSite(
            connection.host,
            connection.port,
            self.module.name,
            self.name,
            call.arguments,
            self._readable,
            self._method_names,
            connection.last_error if connection.state == "lost" else "",
        )
        return call_error(raised, site)

    def _bind(self, live: Optional[Live]) -> None:
        service = self.module.service()
        self._bound = self.module.find(self.name)
        self._live, self._service = live, service

    def _takes_raw(self) -> bool:
        return any(mentions_raw(each["parametersSignature"]) for each in self.module.overloads(self.name))

    def _readable(self) -> List[str]:
        """Signatures in words; none if the connection does not let us ask."""
        try:
            overloads = self.module.overloads(self.name)
        except NaoError:
            return []
        return [readable_call(self.name, each["parametersSignature"]) for each in overloads]

    def _method_names(self) -> List[str]:
        try:
            return self.module.method_names()
        except NaoError:
            return []


class SubscribingMethod(RemoteMethod):
    """A method of ALMemory that begins or ends an event subscription: the connection remembers it."""

    __slots__ = ()

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        """Call it and wait; it is taken down before anybody can go on to the next."""
        value = super().__call__(*arguments, **options)
        self.module.connection.subscriptions.note(self.name, arguments)
        return value

    def start(self, *arguments: Any) -> Call:
        """Call it without waiting; it is taken down when it has succeeded."""

        def note(call: Call) -> None:
            try:
                call.result()
            except NaoError:
                return  # whoever made the call hears of it
            self.module.connection.subscriptions.note(self.name, arguments)

        call = super().start(*arguments)
        call.add_done_callback(note)
        return call
