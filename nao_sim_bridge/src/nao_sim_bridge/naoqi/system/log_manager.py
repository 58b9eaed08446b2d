"""LogManager of the simulated robot: libqi's service through which programs read the log of the robot. No NAOqi module.

Its form is that of libqicore (github.com/aldebaran/libqicore, logmanager.hpp and loglistener.hpp).
"""

from __future__ import annotations

import itertools
import logging
import os
import time
from fnmatch import fnmatchcase
from typing import Any, Callable, Mapping

import qi

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.binding import typed
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

SILENT, FATAL, ERROR, WARNING, INFO, VERBOSE, DEBUG = range(7)
"""Levels of NAOqi's messages."""
PYTHON_LEVELS = (
    *(logging.NOTSET, logging.CRITICAL, logging.ERROR, logging.WARNING),
    *(logging.INFO, logging.DEBUG, logging.DEBUG),
)
programs = logging.getLogger("nao_sim.programs")
programs.setLevel(logging.DEBUG)  # what is written is up to each robot's verbosity
NAME, LISTENER = "LogManager", "LogListener"
FIELDS = ("source", "level", "category", "location", "message", "id", "date", "systemDate")
MESSAGE = f"(sisssILL)<LogMessage,{','.join(FIELDS)}>"
MESSAGES = f"[{MESSAGE}]"
"""source: file:function:line; location: machine:process; date since this process began, systemDate since 1970, ns."""
SIMULATOR = "nao_sim"
LARGEST_ID = 2**32
MOST_PROVIDERS = 100


class LogManager:
    """LogManager as the simulated robot offers it: the log of the simulator, with what programs write there.

    There is one listener for all programs: libqi keeps for ever what it hands over of Python. Programs that write
    messages get its level and filters, so that they send no others.
    """

    def __init__(self) -> None:
        self._numbers = itertools.count(1)
        self._providers: dict[int, Any] = {}
        self._listener = LogListener(self._instruct_all)
        self._handler = _ToListener(self._listener)

    @typed(NAME, qi.Void, [MESSAGES])
    def log(self, messages: Any) -> None:
        """Write messages of a program."""
        for message in map(_fields, messages):
            level = min(max(int(message["level"]), FATAL), DEBUG)
            told = {"naoqi": {**message, "level": level}}
            programs.log(PYTHON_LEVELS[level], "%s: %s", message["category"], message["message"], extra=told)

    @typed(NAME, qi.Object, [])
    def createListener(self) -> Any:
        """An object whose signals tell each message from now on."""
        return self._handler.begin()

    @typed(NAME, qi.Object, [])
    def getListener(self) -> Any:
        """The same, as before NAOqi 2.3."""
        return self._handler.begin()

    @typed(NAME, qi.Int32, [qi.Object])
    def addProvider(self, provider: Any) -> int:
        """Have a program told which messages are wanted, by its `setLevel` and `setFilters`; answers its number."""
        if len(self._providers) >= MOST_PROVIDERS:
            raise NaoqiError(f"there are {MOST_PROVIDERS} providers already, which is the most")
        number = next(self._numbers)
        self._providers[number] = provider
        self._instruct(number, provider)
        return number

    @typed(NAME, qi.Void, [qi.Int32])
    def removeProvider(self, provider: int) -> None:
        """Tell a program no more."""
        if self._providers.pop(provider, None) is None:
            raise NaoqiError(f"there is no provider {provider}")

    @qi.nobind
    def _instruct_all(self) -> None:
        for number, provider in list(self._providers.items()):
            self._instruct(number, provider)

    @qi.nobind
    def _instruct(self, number: int, provider: Any) -> None:
        """Tell a program the level and the filters; one that cannot be told has ended, and is forgotten."""

        def ended(answer: Any) -> None:
            if answer.hasError():
                self._providers.pop(number, None)

        level, filters = self._listener.wanted
        provider.call("setLevel", level, _async=True).addCallback(ended)
        provider.call("setFilters", list(filters.items()), _async=True).addCallback(ended)

    @qi.nobind
    def close(self) -> None:
        """Tell no more."""
        self._handler.end()


class LogListener:
    """What `createListener` answers. Up to `logLevel` messages are told, of some categories by filters up to theirs.

    Signals are properties: libqi lets go of what a property was set to before.
    """

    def __init__(self, changed: Callable[[], None]) -> None:
        """Listen to what is of level INFO or more. `changed`: called when other messages are wanted."""
        self._changed = changed
        self.onLogMessage = qi.Property(MESSAGE)
        self.onLogMessages = qi.Property(MESSAGES)
        self.onLogMessagesWithBacklog = qi.Property(MESSAGES)
        self.logLevel = qi.Property("i")
        self._level = INFO
        self._filters: dict[str, int] = {}
        self.logLevel.connect(self._set_level)
        self.logLevel.setValue(INFO)

    @property
    def wanted(self) -> tuple[int, dict[str, int]]:
        """The level, and those of categories."""
        return self._level, self._filters

    @qi.nobind
    def _set_level(self, level: int) -> None:
        self._level = level
        self._changed()

    @typed(LISTENER, qi.Void, [qi.Int32])
    def setLevel(self, level: int) -> None:
        """Tell messages up to a level: 1 fatal, 2 error, 3 warning, 4 info, 5 verbose, 6 debug; 0 for none."""
        self._level = level
        self.logLevel.setValue(level, _async=True)  # which tells of the change

    @typed(LISTENER, qi.Void, [qi.String, qi.Int32])
    def addFilter(self, category: str, level: int) -> None:
        """Another level for a category, or for several with * in its name."""
        kept = load_sizes().kept
        if len({*self._filters, category}) > kept.log_filters or category.count("*") > kept.filter_stars:
            raise NaoqiError(f"{kept.log_filters} filters at most, with {kept.filter_stars} * each")
        self._filters = {**self._filters, category: level}
        self._changed()

    @typed(LISTENER, qi.Void, [])
    def clearFilters(self) -> None:
        """Forget all filters."""
        self._filters = {}
        self._changed()


def _tell(listener: LogListener, message: tuple) -> None:
    _, level, category, *_ = message
    most, filters = listener.wanted
    own = [most for name, most in filters.items() if fnmatchcase(category, name)]
    if level <= (own[-1] if own else most):
        listener.onLogMessage.setValue(message, _async=True)
        listener.onLogMessages.setValue([message], _async=True)
        listener.onLogMessagesWithBacklog.setValue([message], _async=True)


class _ToListener(logging.Handler):
    """Tells a listener of the records of the simulator's logger, from its first client on."""

    def __init__(self, listener: LogListener) -> None:
        super().__init__()
        self._listener = listener
        self._answer: Any = None
        self._location = f"{SIMULATOR}:{os.getpid()}"
        self._numbers = itertools.count(1)

    def begin(self) -> Any:
        """The listener as libqi's object, the same each time."""
        with self.lock:
            if self._answer is None:
                self._answer = qi.Future(self._listener).value()
                logging.getLogger(SIMULATOR).addHandler(self)
        return self._answer

    def end(self) -> None:
        """Leave the logger."""
        logging.getLogger(SIMULATOR).removeHandler(self)

    def emit(self, record: logging.LogRecord) -> None:
        fields = getattr(record, "naoqi", None) or self._fields_of(record)
        fields = {**fields, "id": next(self._numbers) % LARGEST_ID}
        _tell(self._listener, tuple(fields[name] for name in FIELDS))

    def _fields_of(self, record: logging.LogRecord) -> Mapping[str, Any]:
        category, text = record.name, record.getMessage()
        if record.name == programs.name:  # of ALLogger, whose clients say which module it is
            category, _, text = text.partition(": ")
        return {
            "source": f"{record.filename}:{record.funcName}:{record.lineno}",
            "level": _level(record.levelno),
            "category": category,
            "location": self._location,
            "message": text,
            "date": time.monotonic_ns(),
            "systemDate": int(record.created * 1e9),
        }


def _level(python: int) -> int:
    """NAOqi's number of a level of Python's."""
    for level in (FATAL, ERROR, WARNING, INFO):
        if python >= PYTHON_LEVELS[level]:
            return level
    return VERBOSE if python > logging.DEBUG else DEBUG


def _fields(message: Any) -> Mapping[str, Any]:
    """A message by the names of its fields, as libqi gives structures whose fields have names."""
    return message if isinstance(message, Mapping) else dict(zip(FIELDS, message))
