"""ALProxy: a remote module with the interface of the maker's SDK."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Optional

from .broker import current_broker
from .calls import ANSWERED_BY_ALL, Call, RemoteMethod, RemoteModule
from .errors import BadArguments
from .limits import Timing
from .robot_connection import Connection, connection
from .translate import readable_call, readable_parameters, readable_type

# What every NAOqi module has; a service written against libqi alone lacks it, and these functions stand in.


def answers(module: RemoteModule) -> bool:
    """True; an error if the module does not answer."""
    module.method(ANSWERED_BY_ALL)()
    return True


def method_help(module: RemoteModule, method: str) -> List[Any]:
    """Help on a method: `[name, [[parameter, description], ...], return type, return description]`.

    The overload with the most parameters counts. A parameter without a name is named after its type. Raises
    UnknownMethod if the module has no such method.
    """
    description = max(_overloads(module, method), key=lambda each: len(each["parametersSignature"]))
    parameters = [[name, text] for name, text in map(_pair, description["parameters"])]
    if not parameters:
        parameters = [[words, ""] for words in readable_parameters(description["parametersSignature"])]
    returned = readable_type(description["returnSignature"])
    return [method, parameters, returned, description["returnDescription"]]


def module_help(module: RemoteModule) -> List[Any]:
    """Help on a module: `[description, [[language, example], ...]]`."""
    return [module.service().metaObject()["description"], []]


def usage(module: RemoteModule, method: str) -> str:
    """Signature and description of a method, one line for each overload.

    Raises UnknownMethod if the module has no such method.
    """
    lines = []
    for each in _overloads(module, method):
        returned = readable_type(each["returnSignature"])
        line = f"{readable_call(method, each['parametersSignature'])} -> {returned}"
        description = each["description"]
        lines.append(line if description in ("", "None") else f"{line}: {description}")
    return "\n".join(lines)


def _overloads(module: RemoteModule, method: str) -> List[Dict[str, Any]]:
    found = module.overloads(method)
    if not found:
        module.find(method)  # raises UnknownMethod with the closest names
    return found


def _pair(parameter: Any) -> List[str]:
    """Name and description; the version of libqi decides whether they come as a structure or a dictionary."""
    if isinstance(parameter, dict):
        return [parameter["name"], parameter["description"]]
    return [parameter[0], parameter[1]]


class ALProxy:
    """A module of the robot; its methods are attributes of this object.

        motion = ALProxy("ALMotion", "nao.local", 9559)
        motion.setStiffnesses("Head", 1.0)
        task = motion.post.angleInterpolation("HeadYaw", 0.5, 1.0, True)
        motion.wait(task, 0)

    A proxy survives the loss of its connection: once the robot is back, it works again. It may be used from
    any thread. Its errors are listed in `naoqi.errors`.
    """

    def __init__(
        self,
        name: str,
        ip: Optional[str] = None,
        port: Optional[int] = None,
        *,
        timeout: Optional[float] = None,
        connect_timeout: Optional[float] = None,
        patience: Optional[float] = None,
        lazy: bool = False,
    ) -> None:
        """Find the module.

        Raises RobotUnreachable if the robot is not there (unless lazy), UnknownModule if it has no such module (unless
        lazy), BrokerError if no address is given and there is no ALBroker.

        Args:
            name: NAOqi's name of the module, such as `ALMotion`.
            ip: Without it, the robot of the newest ALBroker.
            timeout: Limit of each waiting call, in s, without the time in which the robot is silent. None waits as long
                as the connection lives.
            connect_timeout: Limit of the wait for the robot, in s; None: the patience.
            patience: A robot that is silent so long, in s, is lost: calls under way fail. Of all proxies of this robot;
                without one it stays as it is, 20 s at first.
            lazy: Connect in the background; until that succeeds, calls fail at once.
        """
        if not isinstance(name, str) or not name:
            reason = "the first is the name of a module"
            raise BadArguments("naoqi", "ALProxy", (name, ip, port), reason=reason)
        timing = None if patience is None else Timing(patience=patience)
        if ip is None:
            robot = current_broker().connection
            robot.timing = timing or robot.timing
        else:
            address = (ip,) if port is None else (ip, port)
            robot = connection(*address, wait=not lazy, connect_timeout=connect_timeout, timing=timing)
        self.connection: Connection = robot
        self._remote = RemoteModule(name, robot, timeout)
        self.post = Post(self._remote)
        if not lazy:
            self._remote.service()

    def __getattr__(self, name: str) -> Any:
        """Find a remote method, signal or property; methods are cached.

        Raises UnknownMethod if the module has nothing of that name.
        """
        if name.startswith("__") or name == "_remote":
            raise AttributeError(name)  # a lookup of Python's own protocols, or before __init__ is done
        found = self._remote.attribute(name)
        if isinstance(found, RemoteMethod) and self.connection.live is not None:
            self.__dict__[name] = found
        return found

    def __dir__(self) -> List[str]:
        remote = self._remote.method_names() if self.connection.live is not None else []
        return sorted({*super().__dir__(), *remote})

    def __repr__(self) -> str:
        robot = self.connection
        return f"<ALProxy {self._remote.name} at {robot.address} ({robot.state})>"

    def call(self, method: str, *arguments: Any) -> Any:
        """Call a method by its name, and wait for its result."""
        return getattr(self, method)(*arguments)

    def call_async(self, method: str, *arguments: Any) -> Call:
        """Call a method by its name without waiting.

        Raises RobotUnreachable if there is no connection now, UnknownMethod if the module does not have it,
        BadArguments if an argument cannot be sent.
        """
        return self._method(method).start(*arguments)

    def pCall(self, method: str, *arguments: Any) -> int:
        """Post a call by its name, as `post.method` does."""
        return getattr(self.post, method)(*arguments)

    # What every NAOqi module has.

    def wait(self, task: int, timeout_ms: int = 0) -> bool:
        """Wait for the end of a posted call.

        `task`: the number that `post.method()` returned. `timeout_ms`: limit in ms; 0 waits for ever. Returns True if
        the limit was reached first. Raises NaoError: the error of the call, if it failed.
        """
        tasks = self.connection.tasks
        if self._is_the_robots(task, "wait"):
            return self._remote.method("wait")(task, timeout_ms)
        return tasks.wait(task, timeout_ms / 1000.0 if timeout_ms > 0 else None)

    def stop(self, *arguments: Any) -> Any:
        """Cancel a posted call by its number; a finished one is no error.

        A module may have a `stop` of its own, which gets the call unless the argument is a number given out here.
        """
        task = arguments[0] if len(arguments) == 1 else None
        if self._is_the_robots(task, "stop"):
            return self._remote.method("stop")(*arguments)
        return self.connection.tasks.stop(task)

    def isRunning(self, *arguments: Any) -> bool:
        """Whether a posted call is still in progress, by its number.

        A module may have an `isRunning` of its own, which gets the call as that of `stop` does.
        """
        task = arguments[0] if len(arguments) == 1 else None
        if self._is_the_robots(task, "isRunning"):
            return self._remote.method("isRunning")(*arguments)
        return self.connection.tasks.is_running(task)

    def ping(self) -> bool:
        """True if the module answers. Raises RobotUnreachable if there is no connection."""
        return self._own("ping", answers)

    def getMethodList(self) -> List[str]:
        return self._own("getMethodList", RemoteModule.method_names)

    def getMethodHelp(self, method: str) -> List[Any]:
        """`[name, [[parameter, description], ...], return name, return description]` of a method."""
        return self._own("getMethodHelp", method_help, method)

    def getModuleHelp(self) -> List[Any]:
        """`[description, [[language, example], ...]]` of the module."""
        return self._own("getModuleHelp", module_help)

    def getUsage(self, method: str) -> str:
        return self._own("getUsage", usage, method)

    def _own(self, name: str, substitute: Callable[..., Any], *arguments: Any) -> Any:
        """Call the module's own method of that name, or the substitute where it has none."""
        if self._remote.offers(name):
            return self._remote.method(name)(*arguments)
        return substitute(self._remote, *arguments)

    def _method(self, name: str) -> RemoteMethod:
        """A remote method, even where this class has one of the same name."""
        found = self.__dict__.get(name)
        if not isinstance(found, RemoteMethod):
            found = self._remote.attribute(name) if hasattr(type(self), name) else getattr(self, name)
        if not isinstance(found, RemoteMethod):
            raise BadArguments(self._remote.name, name, (), reason="it is no method, so it cannot be called")
        return found

    def _is_the_robots(self, task: Any, method: str) -> bool:
        """Whether a number was not given out here, so that the robot's module must know it.

        Raises BadArguments if the module has no such method either.
        """
        if self.connection.tasks.knows(task):
            return False
        if self._remote.offers(method):
            return True
        reason = "the first must be the number of a posted call, as post.method() returns it"
        raise BadArguments(self._remote.name, method, (task,), reason=reason)


class Post:
    """`proxy.post.method(...)` calls a method without waiting and returns the number of the call."""

    def __init__(self, remote: RemoteModule) -> None:
        self._remote = remote

    def __getattr__(self, name: str) -> Any:
        """Raises UnknownMethod if the module does not have it."""
        if name.startswith("__") or name == "_remote":
            raise AttributeError(name)
        remote = self._remote
        found = remote.attribute(name)
        if not isinstance(found, RemoteMethod):
            raise BadArguments(remote.name, name, (), reason="it is no method, so it cannot be posted")

        def post(*arguments: Any, **options: Any) -> int:
            if options:
                found.leave_out(options)
            return remote.connection.tasks.add(found.start(*arguments))

        if remote.connection.live is not None:
            self.__dict__[name] = post
        return post
