"""ALPreferenceManager of the simulated robot: settings of programs, which outlast them."""

from __future__ import annotations

import logging
import threading
from typing import Any, Callable, Mapping

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.preference_files import Preference, PreferenceFiles
from nao_sim_bridge.naoqi.system.robot_file import RobotFile

NAME = "ALPreferenceManager"
FILE = ".local/share/PreferenceManager/prefs.json"
LONGEST_NAME, LARGEST_VALUE = 512, 1_000_000
"""Bytes of the name of a domain or a setting, and of a value."""
ADDED, CHANGED, REMOVED, DOMAIN_REMOVED = (
    f"preference{what}" for what in ("Added", "Changed", "Removed", "DomainRemoved")
)
UPDATED = "preferenceUpdated"
"""The signal beside the event `CHANGED`."""
log = logging.getLogger("nao_sim.preferences")

Domains = Mapping[str, Mapping[str, str]]


class ALPreferenceManager:
    """ALPreferenceManager as the simulated robot offers it: texts by domain and setting, in a file of the robot.

    Events and signals tell of each change once it is in the file.
    """

    def __init__(self, files: ClientFiles, memory: MemoryStore, signals: Callable[..., None]) -> None:
        self._file = RobotFile(files, FILE)
        self._old = PreferenceFiles(files)
        self._memory = memory
        self._signals = signals
        self._lock = threading.Lock()
        self._domains: Domains = self._file.load(_domains_of)
        for event in (ADDED, CHANGED, REMOVED, DOMAIN_REMOVED):
            memory.declare_event(event, NAME)

    def getDomainList(self) -> list[str]:
        return list(self._domains)

    def getValues(self) -> list[list[Any]]:
        """[[domain, setting, value], ...]."""
        return [[domain, *pair] for domain, settings in self._domains.items() for pair in settings.items()]

    def getValueList(self, domain: str) -> list[list[Any]]:
        """[[setting, value], ...]; empty for a domain that is not there."""
        return [list(pair) for pair in self._domains.get(domain, {}).items()]

    def getValue(self, domain: str, setting: str) -> str | None:
        return self._domains.get(domain, {}).get(setting)

    def setValue(self, domain: str, setting: str, value: Any) -> None:
        self._put({domain: {setting: value}})

    def setValues(self, values: Any) -> None:
        if not isinstance(values, dict) or not all(isinstance(settings, dict) for settings in values.values()):
            raise BadValue("values", values, "texts by setting by domain: {domain: {setting: value}}")
        self._put(values)

    def removeValue(self, domain: str, setting: str) -> None:
        with self._lock:
            settings = self._domains.get(domain, {})
            if setting not in settings:
                raise UnknownName(f"setting of {domain!r}", setting, settings)
            left = {name: value for name, value in settings.items() if name != setting}
            others = {name: values for name, values in self._domains.items() if name != domain}
            self._keep({**others, **({domain: left} if left else {})})
        self._tell(REMOVED, REMOVED, domain, setting)

    def removeDomainValues(self, domain: str) -> None:
        with self._lock:
            if domain not in self._domains:
                raise UnknownName("domain", domain, self._domains)
            self._keep({name: values for name, values in self._domains.items() if name != domain})
        self._memory.raise_event(DOMAIN_REMOVED, domain)
        self._signals(DOMAIN_REMOVED, domain)

    def importPrefFile(self, domain: str, application: str, filename: str, override: bool) -> None:
        """Take in the texts of an XML file of ALPreferences; what is nested is called outer/inner."""
        texts = dict(_texts(self._old.read(application, filename).value))
        there = {} if override else self._domains.get(domain, {})
        self._put({domain: {setting: value for setting, value in texts.items() if setting not in there}})

    def update(self) -> None:
        raise NaoqiError(f"there is no cloud to synchronize with; preferences are in the robot's own {FILE}")

    def _put(self, values: Mapping[str, Mapping[str, Any]]) -> None:
        for domain, settings in values.items():
            _check_name("domain", domain)
            for setting, value in settings.items():
                _check_name("setting", setting)
                if not isinstance(value, str) or len(value.encode(errors="replace")) > LARGEST_VALUE:
                    raise BadValue(f"value of {setting}", value, f"a text of at most {LARGEST_VALUE} bytes")
        with self._lock:
            before = self._domains
            self._keep({**before, **{d: {**before.get(d, {}), **new} for d, new in values.items() if new}})
        for domain, settings in values.items():
            for setting, value in settings.items():
                former = before.get(domain, {}).get(setting)
                if former is None:
                    self._tell(ADDED, ADDED, domain, setting, value)
                elif former != value:
                    self._tell(CHANGED, UPDATED, domain, setting, value)

    def _keep(self, domains: Domains) -> None:
        self._file.save(domains)
        self._domains = domains

    def _tell(self, event: str, signal: str, domain: str, setting: str, *value: str) -> None:
        self._memory.raise_event(event, [domain, setting])
        self._signals(signal, domain, setting, *value)


def _check_name(field: str, name: Any) -> None:
    if not isinstance(name, str) or not 0 < len(name.encode(errors="replace")) <= LONGEST_NAME:
        raise BadValue(field, name, f"a text of 1 to {LONGEST_NAME} bytes")


def _texts(preferences: list[Preference], before: str = "") -> list[tuple[str, str]]:
    """Names and values of the texts among preferences; numbers are left out, as NAOqi does."""
    found: list[tuple[str, str]] = []
    for one in preferences:
        if isinstance(one.value, list):
            found += _texts(one.value, f"{before}{one.name}/")
        elif isinstance(one.value, str):
            found.append((before + one.name, one.value))
        else:
            log.info("%s%s is no text and is not imported", before, one.name)
    return found


def _domains_of(content: dict[str, Any]) -> Domains:
    """Preferences as a file has them; a ValueError for values that are no texts, an AttributeError for no domains."""
    for domain, settings in content.items():
        if not all(isinstance(value, str) for value in settings.values()):
            raise ValueError(f"domain {domain!r} has a value that is no text")
    return content
