"""Answers of functions as text, and the functions of the robot's memory, which every module has."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from .chain import Part
from .errors import BadGoal
from .fields import Annotated, free, text

_SCALARS = (bool, int, float)
LONGEST_NUMBER = 40
"""Digits of a whole number; the robot knows those of 10."""


@dataclass(frozen=True)
class Outcome:
    """A function of a chain that was done, or failed.

    Attributes:
        position: Place in the chain, counted from 1.
        function: Its name.
        values: Its answers as strings.
        elapsed: s it took, without the wait after it.
        error: Why it failed; empty if it did not.
        began: ROS time of its begin, s.
        happened: ROS times, s, at which what it waited for or did in the world began and ended; 0: not known.
    """

    position: int
    function: str
    values: list[str]
    elapsed: float
    error: str = ""
    began: float = 0.0
    happened: tuple[float, float] = (0.0, 0.0)


def text_of(value: Any) -> str:
    """One value as a string: text as it is, scalars as Python prints them, anything else as JSON."""
    if isinstance(value, str):
        return value
    if value is None or isinstance(value, _SCALARS):
        return str(value)
    return json_of(value)


def json_of(value: Any) -> str:
    """A value as JSON.

    What JSON does not know becomes its text (bytes, objects), or null (numbers that are none, or infinite).
    """
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except ValueError:  # Python would write NaN and Infinity, which other languages do not read
        return json.dumps(json.loads(json.dumps(value, default=_plain), parse_constant=lambda _: None))


def value_of_json(text: str) -> Any:
    """The value of a text.

    Raises ValueError if it is no JSON, is nested too deep, or has a whole number that no robot knows.
    """
    try:
        return json.loads(text, parse_int=_whole)
    except RecursionError:
        raise ValueError("it is nested too deep") from None


def _whole(digits: str) -> int:
    if len(digits) > LONGEST_NUMBER:
        raise ValueError(f"a whole number has {len(digits)} digits")
    return int(digits)


def _plain(value: Any) -> Any:
    if isinstance(value, (bytes, bytearray)):
        return value.hex()
    to_list = getattr(value, "tolist", None)  # arrays and scalars of numpy
    return str(value) if to_list is None else to_list()


def values_of(answer: Any) -> list[str]:
    """The answer of a function as a list of strings: nothing for None, one string a member of a list.

    A function that answers one value which is itself a list returns it inside a list: `[[1, 2]]`.
    """
    if answer is None:
        return []
    if isinstance(answer, (list, tuple)):
        return [text_of(value) for value in answer]
    return [text_of(answer)]


MEMORY = "ALMemory"
ASSIGNMENT = "'key=value', the value as JSON or plain text"
PAIRS = 'JSON: {"key": value, ...} or [["key", value], ...]'
MAPPING = "'service.signal=event'"


def parse_assignment(text: str) -> tuple[str, Any]:
    """Split `key=value`; the value is JSON, or plain text where it is not.

    Raises BadGoal if there is no key or no equals sign.
    """
    key, equals, value = text.partition("=")
    key = key.strip()
    if not equals or not key:
        raise BadGoal("str_param", text, ASSIGNMENT)
    try:
        return key, value_of_json(value)
    except ValueError:
        return key, value


def parse_pairs(text: str) -> list[list[Any]]:
    """Keys and values out of JSON: `{"key": value, ...}` or `[["key", value], ...]`.

    Raises BadGoal if it is something else.
    """
    try:
        told = value_of_json(text)
    except ValueError:
        told = None
    pairs = list(told.items()) if isinstance(told, dict) else told
    if pairs and isinstance(pairs, list) and all(map(_is_pair, pairs)):
        return [list(pair) for pair in pairs]
    raise BadGoal("str_param", text, PAIRS)


def _is_pair(pair: Any) -> bool:
    return isinstance(pair, (list, tuple)) and len(pair) == 2 and isinstance(pair[0], str) and bool(pair[0].strip())


def parse_mapping(text: str) -> tuple[str, str, str]:
    """Service, signal and event out of `service.signal=event`. Raises BadGoal if it is something else."""
    source, _, event = text.partition("=")
    service, _, signal = (part.strip() for part in source.rpartition("."))
    if not (service and signal and event.strip()):
        raise BadGoal("str_param", text, MAPPING)
    return service, signal, event.strip()


def parse_keys(text: str) -> list[str]:
    """Split keys at commas."""
    return [key.strip() for key in text.split(",") if key.strip()]


def _require_keys(name: str, text: str) -> None:
    if not parse_keys(text):
        raise BadGoal(name, text, KEYS, problem="it names no key")


KEYS = "keys, separated by commas"
Key = Annotated[str, text("the name of a key or an event", "name of the key or event")]
Keys = Annotated[str, free(KEYS, allowed=KEYS, check=_require_keys)]
Assignment = Annotated[str, free(ASSIGNMENT, allowed=ASSIGNMENT, check=lambda _, text: parse_assignment(text))]
Pairs = Annotated[str, free("keys and their values", allowed=PAIRS, check=lambda _, text: parse_pairs(text))]
Mapping = Annotated[str, free("signal and event", allowed=MAPPING, check=lambda _, text: parse_mapping(text))]
PartOfName = Annotated[str, free("part of the names; empty: all")]
SomeKeys = Annotated[str, free(f"{KEYS}; empty: all that have a description")]


class MemoryFunctions(Part):
    """Functions of ALMemory, and its events as messages."""

    def __init__(self, memory: Callable[[], Any], call: Callable[..., Any], events: Any) -> None:
        """Keep what the functions need.

        Args:
            memory: Gives the proxy of ALMemory.
            call: Calls a method of a proxy; preemption interrupts it.
            events: The EventRelay that republishes events.
        """
        self._proxy = memory
        self._call = call
        self._events = events

    def _memory(self, method: str, *args: Any) -> Any:
        return self._call(self._proxy(), method, *args)

    def get_data(self, str_param: Key) -> list[Any]:
        """The value of one key."""
        return [self._memory("getData", str_param.strip())]

    def get_list_data(self, str_param: Keys) -> list[Any]:
        """The values of several keys, in order; None for a key that is not there."""
        return list(self._memory("getListData", parse_keys(str_param)))

    def get_data_list(self, str_param: PartOfName) -> list[str]:
        """The keys whose name contains a text; all keys for an empty text."""
        return list(self._memory("getDataList", str_param))

    def get_data_list_name(self) -> list[str]:
        """All keys."""
        return list(self._memory("getDataListName"))

    def get_data_on_change(self, str_param: Key) -> list[Any]:
        """The value of a key when it changes next."""
        return [self._memory("getDataOnChange", str_param.strip(), 0)]

    def get_description_list(self, str_param: SomeKeys) -> list[Any]:
        """Name, type and description of keys; of all that have one for an empty text."""
        return list(self._memory("getDescriptionList", parse_keys(str_param)))

    def set_description(self, str_param: Assignment) -> None:
        """Describe a key: `key=description`."""
        key, _, description = str_param.partition("=")
        self._memory("setDescription", key.strip(), description)

    def get_event_list(self) -> list[str]:
        """The names of all events."""
        return list(self._memory("getEventList"))

    def get_micro_event_list(self) -> list[str]:
        """The names of all micro events."""
        return list(self._memory("getMicroEventList"))

    def get_event_history(self, str_param: Key) -> list[Any]:
        """The past values of a key, each with its time in s and us."""
        return list(self._memory("getEventHistory", str_param.strip()))

    def get_type(self, str_param: Key) -> list[str]:
        """The kind of a key: Data, Event or MicroEvent."""
        return [self._memory("getType", str_param.strip())]

    def get_timestamp(self, str_param: Key) -> list[Any]:
        """The value of a key and when it was written, in s and us."""
        return list(self._memory("getTimestamp", str_param.strip()))

    def insert_data(self, str_param: Assignment) -> None:
        """Write a key: `key=value`."""
        self._memory("insertData", *parse_assignment(str_param))

    def insert_list_data(self, str_param: Pairs) -> None:
        """Write several keys: `{"key": value, ...}` as JSON."""
        self._memory("insertListData", parse_pairs(str_param))

    def declare_event(self, str_param: Key) -> None:
        """Make an event known: `name`, or `name=extractor` to say what raises it."""
        name, equals, extractor = (part.strip() for part in str_param.partition("="))
        self._memory("declareEvent", *([name, extractor] if equals else [name]))

    def remove_event(self, str_param: Key) -> None:
        """Delete an event and its subscriptions."""
        self._memory("removeEvent", str_param.strip())

    def remove_micro_event(self, str_param: Key) -> None:
        """Delete a micro event and its subscriptions."""
        self._memory("removeMicroEvent", str_param.strip())

    def get_subscribers(self, str_param: Key) -> list[str]:
        """The names of the modules that are subscribed to an event."""
        return list(self._memory("getSubscribers", str_param.strip()))

    def get_extractor_event(self, str_param: Key) -> list[str]:
        """The names of the events that an extractor raises."""
        return list(self._memory("getExtractorEvent", str_param.strip()))

    def add_mapping(self, str_param: Mapping) -> None:
        """Have an event raised whenever a service emits a signal: `service.signal=event`."""
        self._memory("addMapping", *parse_mapping(str_param))

    def remove_data(self, str_param: Key) -> None:
        """Delete a key."""
        self._memory("removeData", str_param.strip())

    def raise_event(self, str_param: Assignment) -> None:
        """Write an event and tell its subscribers: `name=value`."""
        self._memory("raiseEvent", *parse_assignment(str_param))

    def raise_micro_event(self, str_param: Assignment) -> None:
        """Write a micro event and tell its subscribers: `name=value`."""
        self._memory("raiseMicroEvent", *parse_assignment(str_param))

    def subscribe_to_event(self, str_param: Key) -> None:
        """Republish an event, or a micro event, on the topic `memory_events` from now on."""
        self._events.subscribe(str_param.strip())

    def unsubscribe_to_event(self, str_param: Key) -> None:
        """Stop republishing an event."""
        self._events.unsubscribe(str_param.strip())

    def ping(self) -> list[bool]:
        """Whether the robot's memory answers."""
        return [bool(self._memory("ping"))]

    functions = {
        "getData": get_data,
        "getListData": get_list_data,
        "getDataList": get_data_list,
        "getDataListName": get_data_list_name,
        "getDataOnChange": get_data_on_change,
        "getDescriptionList": get_description_list,
        "setDescription": set_description,
        "getEventList": get_event_list,
        "getMicroEventList": get_micro_event_list,
        "getEventHistory": get_event_history,
        "getType": get_type,
        "getTimestamp": get_timestamp,
        "insertData": insert_data,
        "insertListData": insert_list_data,
        "removeData": remove_data,
        "declareEvent": declare_event,
        "removeEvent": remove_event,
        "removeMicroEvent": remove_micro_event,
        "getSubscribers": get_subscribers,
        "getExtractorEvent": get_extractor_event,
        "addMapping": add_mapping,
        "raiseEvent": raise_event,
        "raiseMicroEvent": raise_micro_event,
        "subscribeToEvent": subscribe_to_event,
        "unsubscribeToEvent": unsubscribe_to_event,
        "subscribeToMicroEvent": subscribe_to_event,
        "unsubscribeToMicroEvent": unsubscribe_to_event,
        "ping": ping,
    }
