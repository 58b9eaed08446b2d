"""The robot's memory for every module: functions with `str_param` as argument and texts as answers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..base.answers import value_of_json
from ..base.errors import BadGoal
from .chain import checked_by

MEMORY = "ALMemory"


def parse_assignment(text: str) -> tuple[str, Any]:
    """Split `key=value`; the value is JSON, or plain text where it is not.

    Raises:
        BadGoal: If there is no key or no equals sign.
    """
    key, equals, value = text.partition("=")
    key = key.strip()
    if not equals or not key:
        raise BadGoal("str_param", text, "'key=value', the value as JSON or plain text")
    try:
        return key, value_of_json(value)
    except ValueError:
        return key, value


def parse_pairs(text: str) -> list[list[Any]]:
    """Keys and values out of JSON: `{"key": value, ...}` or `[["key", value], ...]`.

    Raises:
        BadGoal: If it is something else.
    """
    try:
        told = value_of_json(text)
    except ValueError:
        told = None
    pairs = list(told.items()) if isinstance(told, dict) else told
    if pairs and isinstance(pairs, list) and all(map(_is_pair, pairs)):
        return [list(pair) for pair in pairs]
    raise BadGoal("str_param", text, 'JSON: {"key": value, ...} or [["key", value], ...]')


def _is_pair(pair: Any) -> bool:
    return isinstance(pair, (list, tuple)) and len(pair) == 2 and isinstance(pair[0], str) and bool(pair[0].strip())


def parse_mapping(text: str) -> tuple[str, str, str]:
    """Service, signal and event out of `service.signal=event`.

    Raises:
        BadGoal: If it is something else.
    """
    source, _, event = text.partition("=")
    service, _, signal = (part.strip() for part in source.rpartition("."))
    if not (service and signal and event.strip()):
        raise BadGoal("str_param", text, "'service.signal=event'")
    return service, signal, event.strip()


def parse_keys(text: str) -> list[str]:
    """Split keys at commas."""
    return [key.strip() for key in text.split(",") if key.strip()]


def _check_assignment(_self: MemoryFunctions, str_param: str) -> None:
    parse_assignment(str_param)


def _check_key(_self: MemoryFunctions, str_param: str) -> None:
    if not str_param.strip():
        raise BadGoal("str_param", str_param, "the name of a key or an event", problem="it is empty")


def _check_pairs(_self: MemoryFunctions, str_param: str) -> None:
    parse_pairs(str_param)


def _check_mapping(_self: MemoryFunctions, str_param: str) -> None:
    parse_mapping(str_param)


def _check_keys(_self: MemoryFunctions, str_param: str) -> None:
    if not parse_keys(str_param):
        raise BadGoal("str_param", str_param, "keys, separated by commas", problem="it names no key")


class MemoryFunctions:
    """Functions of ALMemory. To be mixed into a class with `robot`, `call` and `events`."""

    robot: Any  # Robot
    call: Callable[..., Any]  # of NaoBasic: a call that preemption interrupts
    events: Any  # EventRelay

    def memory_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "getData": self.get_data,
            "getListData": self.get_list_data,
            "getDataList": self.get_data_list,
            "getDataListName": self.get_data_list_name,
            "getDataOnChange": self.get_data_on_change,
            "getDescriptionList": self.get_description_list,
            "setDescription": self.set_description,
            "getEventList": self.get_event_list,
            "getMicroEventList": self.get_micro_event_list,
            "getEventHistory": self.get_event_history,
            "getType": self.get_type,
            "getTimestamp": self.get_timestamp,
            "insertData": self.insert_data,
            "insertListData": self.insert_list_data,
            "removeData": self.remove_data,
            "declareEvent": self.declare_event,
            "removeEvent": self.remove_event,
            "removeMicroEvent": self.remove_micro_event,
            "getSubscribers": self.get_subscribers,
            "getExtractorEvent": self.get_extractor_event,
            "addMapping": self.add_mapping,
            "raiseEvent": self.raise_event,
            "raiseMicroEvent": self.raise_micro_event,
            "subscribeToEvent": self.subscribe_to_event,
            "unsubscribeToEvent": self.unsubscribe_to_event,
            "subscribeToMicroEvent": self.subscribe_to_event,
            "unsubscribeToMicroEvent": self.unsubscribe_to_event,
            "ping": self.ping,
        }

    def _memory(self, method: str, *args: Any) -> Any:
        return self.call(self.robot.proxy(MEMORY), method, *args)

    @checked_by(_check_key)
    def get_data(self, str_param: str) -> list[Any]:
        """The value of one key."""
        return [self._memory("getData", str_param.strip())]

    @checked_by(_check_keys)
    def get_list_data(self, str_param: str) -> list[Any]:
        """The values of several keys, in order; None for a key that is not there."""
        return list(self._memory("getListData", parse_keys(str_param)))

    def get_data_list(self, str_param: str) -> list[str]:
        """The keys whose name contains a text; all keys for an empty text."""
        return list(self._memory("getDataList", str_param))

    def get_data_list_name(self) -> list[str]:
        """All keys."""
        return list(self._memory("getDataListName"))

    @checked_by(_check_key)
    def get_data_on_change(self, str_param: str) -> list[Any]:
        """The value of a key when it changes next."""
        return [self._memory("getDataOnChange", str_param.strip(), 0)]

    def get_description_list(self, str_param: str) -> list[Any]:
        """Name, type and description of keys; of all that have one for an empty text."""
        return list(self._memory("getDescriptionList", parse_keys(str_param)))

    @checked_by(_check_assignment)
    def set_description(self, str_param: str) -> None:
        """Describe a key: `key=description`."""
        key, _, description = str_param.partition("=")
        self._memory("setDescription", key.strip(), description)

    def get_event_list(self) -> list[str]:
        """The names of all events."""
        return list(self._memory("getEventList"))

    def get_micro_event_list(self) -> list[str]:
        """The names of all micro events."""
        return list(self._memory("getMicroEventList"))

    @checked_by(_check_key)
    def get_event_history(self, str_param: str) -> list[Any]:
        """The past values of a key, each with its time in s and us."""
        return list(self._memory("getEventHistory", str_param.strip()))

    @checked_by(_check_key)
    def get_type(self, str_param: str) -> list[str]:
        """The kind of a key: Data, Event or MicroEvent."""
        return [self._memory("getType", str_param.strip())]

    @checked_by(_check_key)
    def get_timestamp(self, str_param: str) -> list[Any]:
        """The value of a key and when it was written, in s and us."""
        return list(self._memory("getTimestamp", str_param.strip()))

    @checked_by(_check_assignment)
    def insert_data(self, str_param: str) -> None:
        """Write a key: `key=value`."""
        self._memory("insertData", *parse_assignment(str_param))

    @checked_by(_check_pairs)
    def insert_list_data(self, str_param: str) -> None:
        """Write several keys: `{"key": value, ...}` as JSON."""
        self._memory("insertListData", parse_pairs(str_param))

    @checked_by(_check_key)
    def declare_event(self, str_param: str) -> None:
        """Make an event known: `name`, or `name=extractor` to say what raises it."""
        name, equals, extractor = (part.strip() for part in str_param.partition("="))
        self._memory("declareEvent", *([name, extractor] if equals else [name]))

    @checked_by(_check_key)
    def remove_event(self, str_param: str) -> None:
        """Delete an event and its subscriptions."""
        self._memory("removeEvent", str_param.strip())

    @checked_by(_check_key)
    def remove_micro_event(self, str_param: str) -> None:
        """Delete a micro event and its subscriptions."""
        self._memory("removeMicroEvent", str_param.strip())

    @checked_by(_check_key)
    def get_subscribers(self, str_param: str) -> list[str]:
        """The names of the modules that are subscribed to an event."""
        return list(self._memory("getSubscribers", str_param.strip()))

    @checked_by(_check_key)
    def get_extractor_event(self, str_param: str) -> list[str]:
        """The names of the events that an extractor raises."""
        return list(self._memory("getExtractorEvent", str_param.strip()))

    @checked_by(_check_mapping)
    def add_mapping(self, str_param: str) -> None:
        """Have an event raised whenever a service emits a signal: `service.signal=event`."""
        self._memory("addMapping", *parse_mapping(str_param))

    @checked_by(_check_key)
    def remove_data(self, str_param: str) -> None:
        """Delete a key."""
        self._memory("removeData", str_param.strip())

    @checked_by(_check_assignment)
    def raise_event(self, str_param: str) -> None:
        """Write an event and tell its subscribers: `name=value`."""
        self._memory("raiseEvent", *parse_assignment(str_param))

    @checked_by(_check_assignment)
    def raise_micro_event(self, str_param: str) -> None:
        """Write a micro event and tell its subscribers: `name=value`."""
        self._memory("raiseMicroEvent", *parse_assignment(str_param))

    @checked_by(_check_key)
    def subscribe_to_event(self, str_param: str) -> None:
        """Republish an event, or a micro event, on the topic `memory_events` from now on."""
        self.events.subscribe(str_param.strip())

    @checked_by(_check_key)
    def unsubscribe_to_event(self, str_param: str) -> None:
        """Stop republishing an event."""
        self.events.unsubscribe(str_param.strip())

    def ping(self) -> list[bool]:
        """Whether the robot's memory answers."""
        return [bool(self._memory("ping"))]
