"""ALLogger of the simulated robot: messages of programs, in the log of the simulator and in files of the robot."""

from __future__ import annotations

import os
import time
from contextlib import suppress
from fnmatch import fnmatchcase
from typing import BinaryIO

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.record_dir import ClientFiles, NoSuchFile, OutsideRecordDir, UnusableName
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.written_numbers import written_number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.system.log_manager import DEBUG, ERROR, FATAL, INFO, PYTHON_LEVELS, SILENT, VERBOSE, WARNING
from nao_sim_bridge.naoqi.system.log_manager import programs as log

LEVELS = ("silent", "fatal", "error", "warning", "info", "verbose", "debug")
"""By NAOqi's numbers of them: a message is written if its level is not above the verbosity."""
STANDARD = "std"
"""The handler that writes to the log of the simulator; others have the name of their file."""
MOST_FILES = 10
LINE = "-" * 60


class ALLogger:
    """ALLogger as the simulated robot offers it."""

    def __init__(self, files: ClientFiles) -> None:
        self._files = files
        self._verbosity = INFO
        self._filters: list[tuple[str, int]] = []
        self._standard = True
        self._open: dict[str, BinaryIO] = {}

    def fatal(self, module: str, message: str) -> None:
        self._write(FATAL, module, message)

    def error(self, module: str, message: str) -> None:
        self._write(ERROR, module, message)

    def warn(self, module: str, message: str) -> None:
        self._write(WARNING, module, message)

    def info(self, module: str, message: str) -> None:
        self._write(INFO, module, message)

    def lowInfo(self, module: str, message: str) -> None:
        self._write(VERBOSE, module, message)

    def debug(self, module: str, message: str) -> None:
        self._write(DEBUG, module, message)

    lowDebug = debug

    def separator(self) -> None:
        self._write(INFO, "ALLogger", LINE)

    def verbosity(self) -> int:
        return self._verbosity

    def setVerbosity(self, verbosity: str) -> None:
        self._verbosity = _level("verbosity", verbosity)

    def setFilter(self, filters: str = "") -> None:
        """Levels of single modules, the last that fits counts: "Game*=debug:Noise=silent", also "+Game:-Noise"."""
        rules, most = [rule for rule in filters.split(":") if rule], load_sizes().kept
        if len(rules) > most.log_filters:
            raise BadValue("filter", f"{len(rules)} rules", f"{most.log_filters} at most")
        for rule in rules:
            if rule.count("*") > most.filter_stars:  # to look whether a name fits takes time that grows with each
                raise BadValue("filter", rule, f"{most.filter_stars} * at most in the name of a module")
        self._filters = [_rule(rule) for rule in rules]

    def logInStd(self) -> None:
        self._standard = True

    def logInFile(self, name: str) -> None:
        """Write to a file of the robot, too, behind what is in it."""
        if name == STANDARD:
            raise BadValue("file", name, f"another name: {STANDARD} is the log of the simulator")
        file = self._files.to_write(name)
        path = self._files.to_robot(file)
        if path not in self._open:
            if len(self._open) >= MOST_FILES:
                raise NaoqiError(
                    f"{MOST_FILES} files are written to already: removeHandler({next(iter(self._open))!r})"
                )
            self._open[path] = open(file, "ab", buffering=0)

    def removeHandler(self, name: str) -> None:
        """Write to a file no more, or, with "std", not to the log of the simulator."""
        if name == STANDARD and self._standard:
            self._standard = False
            return
        path = name
        with suppress(NoSuchFile, OutsideRecordDir, UnusableName):
            path = self._files.to_robot(self._files.to_read(name))
        if path not in self._open:
            raise UnknownName("handler", name, [*([STANDARD] if self._standard else []), *self._open])
        self._open.pop(path).close()

    def logInSys(self) -> None:
        raise NaoqiError("there is no system log: messages are in the log of the simulator, and in files by logInFile")

    def logInForwarder(self, _address: str) -> None:
        raise NaoqiError("messages are not sent to other computers: logInFile writes them to a file of the robot")

    def close(self) -> None:
        """Write to no file any more."""
        while self._open:
            self._open.popitem()[1].close()

    def _write(self, level: int, module: str, message: str) -> None:
        limit = next((limit for name, limit in reversed(self._filters) if fnmatchcase(module, name)), self._verbosity)
        if level > limit:
            return
        if self._standard:
            log.log(PYTHON_LEVELS[level], "%s: %s", module, message)
        line = f"[{LEVELS[level][0].upper()}] {time.time():.6f} {os.getpid()} {module}: {message}\n".encode(
            errors="replace"
        )
        most = load_sizes().kept.log_bytes
        full = [path for path, file in list(self._open.items()) if file.tell() + len(line) > most]
        for path in full:
            self._open.pop(path).close()
        for file in list(self._open.values()):
            file.write(line)
        if full:
            raise NaoqiError(f"full, {most} bytes at most, and written to no more: {', '.join(full)}")


def _level(field: str, text: str) -> int:
    """The number of a level, also of one that is given as a number."""
    if text in LEVELS:
        return LEVELS.index(text)
    number = written_number(text, DEBUG)
    if number is None:
        raise BadValue(field, text, f"one of {', '.join(LEVELS)}")
    return number


def _rule(rule: str) -> tuple[str, int]:
    """The module and the highest level of a rule of a filter."""
    name, equals, level = rule.partition("=")
    if equals and name:
        return name, _level("filter", level)
    if not equals and name[0] in "+-" and len(name) > 1:
        return name[1:], DEBUG if name[0] == "+" else SILENT
    raise BadValue("filter", rule, "module=level, +module or -module, several with : between them")
