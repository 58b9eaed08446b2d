"""Remote modules, their methods and the calls of them: what the proxies are made of."""

from __future__ import annotations

import functools
import logging
import threading
import time
from collections import OrderedDict
from threading import get_ident
from typing import Any, Callable, Dict, List, Mapping, Optional, Protocol, Tuple

from . import translate
from .errors import BadArguments, CallCanceled, CallTimeout, NaoError, RobotUnreachable
from .limits import wait_while_answering
from .session import MEMORY, RUNNING, Live, Presence
from .translate import NOT_SENT, CallSite, call_error, mentions_raw, readable_call, unknown_method

logger = logging.getLogger("naoqi")

ENDED_BY = {"unsubscribeToEvent": "subscribeToEvent", "unsubscribeToMicroEvent": "subscribeToMicroEvent"}
"""Methods of ALMemory that end an event subscription, and those that begin it."""
SUBSCRIBING = frozenset(ENDED_BY) | frozenset(ENDED_BY.values())

NOT_YET = "Future timeout."
FIRST_SLICE_MS = 100
INTERRUPTIBLE_MS = 200
"""A wait inside libqi blocks Ctrl-C, so the main thread waits in slices of this length, in ms."""
LONGEST_WAIT_MS = 2**31 - 2  # libqi takes a 32-bit integer, and its largest value as "for ever"

Witness = Callable[[str, str, Tuple[Any, ...]], Optional[Callable[[Any], None]]]


class Transport(Protocol):
    """What calls need of the connection to their robot; `naoqi.Connection` has it, and describes it."""

    host: str
    port: int
    live: Optional[Live]
    generation: int
    last_error: str
    tasks: TaskTable
    presence: Presence
    witness: Optional[Witness]

    @property
    def address(self) -> str: ...

    @property
    def state(self) -> str: ...

    def answering_time(self) -> float: ...

    def service(self, name: str) -> Any: ...

    def forget_service(self, name: str) -> None: ...

    def note_subscription(self, method: str, arguments: Tuple[Any, ...]) -> None: ...


class Call:
    """One call of a remote method. All methods may be used from any thread.

    Nothing polls: libqi wakes the waiting thread when the answer arrives, when the call is cancelled, and when the
    connection breaks.
    """

    __slots__ = ("_future", "arguments", "method")

    def __init__(self, future: Any, method: RemoteMethod, arguments: Tuple[Any, ...]) -> None:
        self._future = future
        self.method = method
        self.arguments = arguments

    def result(self, timeout: Optional[float] = None) -> Any:
        """Wait for the end of the call.

        Returns what the method returned; raw data is `bytes`.

        Args:
            timeout: Limit of the wait in s, without the time in which the robot answers nothing at all, see `limits`;
                None waits as long as the connection lives.

        Raises:
            CallTimeout: If the call still runs after the limit. It continues; `cancel` ends it.
            NaoError: Any other failure, see `naoqi.errors`.
        """
        # Most answers arrive within the first slice, so this is the fast path.
        first_ms = FIRST_SLICE_MS if timeout is None else max(0, min(FIRST_SLICE_MS, int(1000.0 * timeout)))
        presence, thread = self.method.module.connection.presence, get_ident()
        presence.enter(thread)
        try:
            value = self._future.value(first_ms)
        except RuntimeError as error:
            value = self._late_value(error, timeout, first_ms)
        finally:
            presence.leave(thread)
        return translate.from_wire(value)

    def wait(self, timeout: Optional[float] = None) -> bool:
        """Wait up to `timeout` s for the end of the call, whatever its outcome; whether it is finished."""
        presence, thread = self.method.module.connection.presence, get_ident()
        presence.enter(thread)
        try:
            return self._wait(timeout)
        finally:
            presence.leave(thread)

    def done(self) -> bool:
        """Whether the call is finished: with a value, an error, or cancelled."""
        return self._future.isFinished()

    def cancelled(self) -> bool:
        return self._future.isFinished() and self._future.isCanceled()

    def cancel(self) -> None:
        """Ask the robot to cancel the call; a method that cannot be interrupted runs to its end."""
        self._future.cancel()

    def add_done_callback(self, callback: Callable[[Call], None]) -> None:
        """Call a function with this call when it is finished; at once if it already is.

        `callback`: runs in a thread of libqi and must not wait: it may set an event, no more. Its exceptions are
        logged.
        """
        # No closure: the traceback frames of a stored error would keep it alive.
        held = functools.partial(self._run, callback)
        self.method.module.connection.presence.lend(held)
        self._future.addCallback(held)

    def _run(self, callback: Callable[[Call], None], _future: Any) -> None:
        try:
            callback(self)
        except Exception:
            logger.exception("the done-callback %r of a call failed", callback)

    def _wait(self, timeout: Optional[float]) -> bool:
        wait = self._future.wait
        in_main_thread = threading.current_thread() is threading.main_thread()
        slice_ms = INTERRUPTIBLE_MS if in_main_thread else LONGEST_WAIT_MS
        if timeout is None:
            while wait(slice_ms) == RUNNING:
                pass
            return True
        deadline = time.monotonic() + timeout
        while True:
            left_ms = int(1000.0 * (deadline - time.monotonic())) + 1
            if wait(max(0, min(left_ms, slice_ms))) != RUNNING:
                return True
            if time.monotonic() >= deadline:
                return False

    def _ends_within(self, limit: float) -> bool:
        return wait_while_answering(self._wait, self.method.module.connection.answering_time, limit)

    def _late_value(self, error: RuntimeError, timeout: Optional[float], waited_ms: int) -> Any:
        """The value after the first wait raised: either the call failed, or it takes longer."""
        if str(error) == NOT_YET:
            if timeout is None:
                self._wait(None)
            elif not self._ends_within(max(0.0, timeout - 0.001 * waited_ms)):
                raise CallTimeout(self.method.module.name, self.method.name, timeout) from None
            try:
                return self._future.value()
            except RuntimeError as late_error:
                # Raised here: a frame that holds an error raised through it makes a reference cycle.
                raise self.method.translate(late_error, self) from late_error
        raise self.method.translate(error, self) from error


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
        connection: The connection to the robot.
        timeout: Limit of each waiting call, in s; None for none.
    """

    def __init__(self, name: str, connection: Transport, timeout: Optional[float] = None) -> None:
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
        kind = SubscribingMethod if self.name == MEMORY and name in SUBSCRIBING else RemoteMethod
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
        presence.enter(thread)  # before looking for the session: when that is closed, no other thread enters
        try:
            live = connection.live
            if live is None or live is not self._live or live.services.get(self.module.name) is not self._service:
                self._bind(live)
            try:
                sent = translate.to_wire(arguments, self._takes_raw)
            except translate.UnsendableError as error:
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
        """Call it and wait; it is recorded before the caller can make the next call."""
        value = super().__call__(*arguments, **options)
        self.module.connection.note_subscription(self.name, arguments)
        return value

    def start(self, *arguments: Any) -> Call:
        """Call it without waiting; it is recorded when it has succeeded."""

        def note(call: Call) -> None:
            try:
                call.result()
            except NaoError:
                return  # the caller gets this error from the call itself
            self.module.connection.note_subscription(self.name, arguments)

        call = super().start(*arguments)
        call.add_done_callback(note)
        return call


REMEMBERED_ERRORS = 256
"""The errors of so many failed calls are kept until a program waits for them; all are logged anyway."""


class TaskTable:
    """The calls posted over one connection. A call that is finished is removed; only its error is kept for a while."""

    def __init__(self) -> None:
        self._lock = threading.Lock()  # guards all below; never held while a call is asked anything
        self._last_id = 0
        self._error_level = logging.ERROR
        self._running: Dict[int, Call] = {}
        self._errors: OrderedDict[int, NaoError] = OrderedDict()

    def add(self, call: Call) -> int:
        """Add a call. Returns its number, unique on this connection."""
        with self._lock:
            self._last_id += 1
            task = self._last_id
            self._running[task] = call
        call.add_done_callback(lambda done: self._finished(task, done))
        return task

    def knows(self, task: Any) -> bool:
        """Whether this number was ever given out here."""
        return isinstance(task, int) and not isinstance(task, bool) and 0 < task <= self._last_id

    def is_running(self, task: int) -> bool:
        """Whether this call is under way."""
        call = self._call(task)
        return call is not None and not call.done()

    def wait(self, task: int, timeout: Optional[float]) -> bool:
        """Wait for the end of a call; one that was stopped has ended like any other.

        `task`: its number. `timeout`: limit in s, or None. Returns whether the limit was over first. Raises NaoError:
        the error of the call, if it failed.
        """
        call = self._call(task)
        if call is None:
            with self._lock:
                error = self._errors.get(task)
            if error is not None:
                raise error
            return False
        if not call.wait(timeout):
            return True
        try:
            call.result()
        except CallCanceled:
            pass
        return False

    def abandon(self) -> None:
        """Log later failures at debug level: the program closes the connection itself, so they are expected."""
        self._error_level = logging.DEBUG

    def stop(self, task: int) -> None:
        """Cancel a call; one that is finished already is no error."""
        call = self._call(task)
        if call is not None:
            call.cancel()

    def _call(self, task: int) -> Optional[Call]:
        with self._lock:
            return self._running.get(task)

    def _finished(self, task: int, call: Call) -> None:
        """Runs in a thread of libqi, as the call is finished."""
        error: Optional[NaoError] = None
        try:
            call.result()
        except CallCanceled:
            logger.debug("posted call %d (%s) was cancelled", task, call.method)
        except NaoError as failure:
            error = failure
            logger.log(self._error_level, "posted call %d: %s", task, failure)
        with self._lock:
            self._running.pop(task, None)
            if error is not None:
                self._errors[task] = error
                while len(self._errors) > REMEMBERED_ERRORS:
                    self._errors.popitem(last=False)
