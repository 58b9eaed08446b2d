"""Names that types of nao_robot's interface have in the older packages, and whether these packages are there. No ROS.

As a program it prints which of the two a driver that is started with `messages:=WORD` is to speak; launch files ask it.
"""

from __future__ import annotations

import importlib.util
import json
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from naoqi.errors import NaoError

from ..base.paths import config_file
from ..base.suggestion import did_you_mean

FILE = "nao_robot_types.json"
AUTO, OURS, THEIRS = "auto", "nao_library", "naoqi_bridge"
"""What `messages` may be: of what is installed; packages of this library; naoqi_bridge_msgs and humanoid_nav_msgs."""
FOUND = (
    f"messages {AUTO}: the driver speaks the types of naoqi_bridge_msgs and humanoid_nav_msgs, which are installed;"
    f" clients have them from spoken(), messages:={OURS} keeps those of nao_library_msgs"
)
LONGEST_LIST = 5
"""Types that an error names one by one."""
_SECTION = re.compile(r"^=+\nMSG: (\S+)\n", re.MULTILINE)
_TYPE = re.compile(r"\b[a-z][a-z0-9_]*/[A-Za-z]\w*\b")
_CLASS = re.compile(r"^class ", re.MULTILINE)
_FIELDS = {name: re.compile(rf"^  {name}\s*=\s*[\"']([^\"']+)[\"']", re.MULTILINE) for name in ("_type", "_md5sum")}


@dataclass(frozen=True)
class TypeNames:
    """Types by their full names, as `package/Name`; services, requests and responses as well.

    Attributes:
        theirs: Type of ours -> its name in the older packages.
        ours: The other way round.
        sums: Type of theirs -> md5 sum.
        definitions: Type of theirs that has other fields than ours -> these fields, as in a .msg file.
        former: Package that was there before -> the one of theirs that took its types over.
    """

    theirs: Mapping[str, str]
    ours: Mapping[str, str]
    sums: Mapping[str, str]
    definitions: Mapping[str, str]
    former: Mapping[str, str]

    @property
    def packages(self) -> list[str]:
        """The older packages."""
        return sorted({name.partition("/")[0] for name in self.ours}, reverse=True)

    def their_definition(self, text: str) -> str:
        """The definition of a type of ours, with all types in it, as the older packages have it.

        `text`: what genpy calls the full text: the fields, then a section for each type in them.
        """
        root, *rest = _SECTION.split(text)
        sections = [self._renamed(root)]
        for name, body in zip(rest[::2], rest[1::2]):
            new = self.theirs.get(name, name)
            fields = f"{self.definitions[new]}\n" if new in self.definitions else self._renamed(body)
            sections.append(f"{'=' * 80}\nMSG: {new}\n{fields}")
        return "".join(sections)

    def _renamed(self, fields: str) -> str:
        return _TYPE.sub(lambda found: self.theirs.get(found[0], found[0]), fields)


@lru_cache(maxsize=None)
def type_names() -> TypeNames:
    content = json.loads(config_file(FILE).read_text(encoding="utf-8"))
    theirs: dict[str, str] = {}
    sums: dict[str, str] = {}
    for package, packages in content["types"].items():
        for own_package, types in packages.items():
            theirs.update({f"{own_package}/{name}": f"{package}/{name}" for name in types})
            sums.update({f"{package}/{name}": value for name, value in types.items()})
    ours = {name: own for own, name in theirs.items()}
    return TypeNames(theirs, ours, sums, content["definitions"], content["former"])


def choose(wanted: object) -> tuple[str, str]:
    """Which names a driver speaks, OURS or THEIRS, and what is to be told where AUTO found older packages; else empty.

    Raises NaoError if there is no such choice, or the packages that were named are not there or do not fit.
    """
    if wanted not in (AUTO, OURS, THEIRS):
        hint = did_you_mean(str(wanted), (AUTO, OURS, THEIRS))
        raise NaoError(f"messages {wanted!r}: it is {AUTO}, {OURS} or {THEIRS}{hint}")
    if wanted == OURS:
        return OURS, ""
    there = {package: generated(package) for package in type_names().packages}
    if wanted == AUTO and not any(there.values()):
        return OURS, ""
    problem = _problem(there)
    if not problem:
        return THEIRS, FOUND if wanted == AUTO else ""
    if wanted == AUTO:
        return OURS, f"the driver keeps the types of nao_library_msgs, for {problem}"
    raise NaoError(f"messages {THEIRS}: {problem}; install or build what is missing, or say {OURS}")


def generated(package: str) -> list[Path]:
    """Files of Python that genpy has made of the messages and services of a package; none if it is not installed."""
    files: list[Path] = []
    try:
        found = [importlib.util.find_spec(f"{package}.{kind}") for kind in ("msg", "srv")]
    except ImportError:
        return []
    for spec in found:
        for folder in (spec and spec.submodule_search_locations) or ():
            files += sorted(Path(folder).glob("_[A-Za-z]*.py"))
    return files


def sums_in(files: Sequence[Path]) -> dict[str, str]:
    """Type -> md5 sum, as files of genpy have them. Reading is some hundred times as fast as importing."""
    return {name: value for file in files for name, value in _classes(file.read_text(encoding="utf-8"))}


def _classes(text: str) -> Iterator[tuple[str, str]]:
    for body in _CLASS.split(text)[1:]:
        found = [_FIELDS[name].search(body) for name in ("_type", "_md5sum")]
        if all(found):
            yield found[0][1], found[1][1]  # type: ignore[index]


def _problem(there: Mapping[str, Sequence[Path]]) -> str:
    """What is wrong with the older packages; empty if nothing is."""
    absent = [package for package, files in there.items() if not files]
    if absent:
        return f"{' and '.join(absent)} cannot be imported: not built, or its workspace not sourced"
    wanted, found = type_names().sums, {}
    for files in there.values():
        found.update(sums_in(files))
    missing = [name for name in wanted if name not in found]
    if missing:
        return f"{_some(missing)} {'is' if len(missing) == 1 else 'are'} not there: another version of the package"
    other = [name for name, value in wanted.items() if found[name] != value]
    wrong = [f"{name} has md5 sum {found[name]} instead of {wanted[name]}" for name in other]
    return f"{_some(wrong)}: another version of the package" if wrong else ""


def _some(names: Sequence[str]) -> str:
    more = len(names) - LONGEST_LIST
    return ", ".join(names[:LONGEST_LIST]) + (f" and {more} more" if more > 0 else "")


def main(arguments: Sequence[str]) -> int:
    """Print the choice for a word, without the end of a line: it becomes a parameter. Returns the exit status."""
    try:
        choice, told = choose(arguments[0] if arguments else AUTO)
    except NaoError as error:
        print(error, file=sys.stderr)
        return 1
    if told:
        print(told, file=sys.stderr)
    print(choice, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
