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

from ..core.errors import did_you_mean
from ..core.files import config_file

FILE = "nao_robot_types.json"
AUTO, OURS, THEIRS = "auto", "nao_library", "naoqi_bridge"
"""What `messages` may be: by what is installed; names of this library; those of naoqi_bridge_msgs and its like."""
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
        ours: The other way round, also from names that types had there earlier.
        sums: Type of theirs -> md5 sum.
        definitions: Type of theirs that has other fields than ours -> these fields, as in a .msg file.
        former: Package that was there before -> the one of theirs that took its types over.
        former_sums: Sum of a definition that had fewer constants -> that of the present one, with the same fields.
    """

    theirs: Mapping[str, str]
    ours: Mapping[str, str]
    sums: Mapping[str, str]
    definitions: Mapping[str, str]
    former: Mapping[str, str]
    former_sums: Mapping[str, str]

    @property
    def packages(self) -> list[str]:
        """The older packages; the first has the types whose fields are others."""
        return list(dict.fromkeys(name.partition("/")[0] for name in self.sums))

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
    theirs.update(content["renamed"])
    for own, name in content["renamed"].items():
        ours[f"{name.partition('/')[0]}/{own.partition('/')[2]}"] = own
    return TypeNames(theirs, ours, sums, content["definitions"], content["former"], content["former_sums"])


@dataclass(frozen=True)
class Choice:
    """What a driver speaks.

    Attributes:
        names: OURS or THEIRS.
        told: Whose names that are, and which types keep those of this library; empty where nobody would ask.
        problem: What will not work with it; empty if nothing.
    """

    names: str
    told: str = ""
    problem: str = ""


def choose(wanted: object) -> Choice:
    """Which names a driver speaks.

    With THEIRS, a type that the older packages on this computer lack, or define otherwise, keeps its name of this
    library. Those whose fields differ from ours have to be there.

    Raises NaoError if there is no such choice, or what THEIRS needs is not there.
    """
    if wanted not in (AUTO, OURS, THEIRS):
        hint = did_you_mean(str(wanted), (AUTO, OURS, THEIRS))
        raise NaoError(f"messages {wanted!r}: it is {AUTO}, {OURS} or {THEIRS}{hint}")
    if wanted == OURS:
        return Choice(OURS)
    found = installed()
    problem = _problem(found)
    if not problem:
        return _their_choice(found)
    if wanted == THEIRS:
        raise NaoError(f"messages {THEIRS}: {problem}; install or build what is missing, or say {OURS}")
    return Choice(OURS, problem=f"the driver keeps the types of nao_library_msgs, for {problem}" if found else "")


def installed() -> dict[str, str]:
    """Type -> md5 sum, of the older packages that are on this computer."""
    return {name: value for package in type_names().packages for name, value in sums_in(generated(package)).items()}


def unfit(found: Mapping[str, str]) -> dict[str, str]:
    """Type of theirs that is not as in the table -> its md5 sum, empty if it is not there. `found`: as `installed`."""
    return {name: found.get(name, "") for name, value in type_names().sums.items() if found.get(name) != value}


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


def _problem(found: Mapping[str, str]) -> str:
    """Why their names cannot be spoken; empty if they can."""
    package, *_ = type_names().packages
    if not any(name.startswith(f"{package}/") for name in found):
        return f"{package} cannot be imported: not built, or its workspace not sourced"
    wrong = {name: value for name, value in unfit(found).items() if name in type_names().definitions}
    return f"{_differing(wrong) or _some(list(wrong)) + ' is not there'}: another version of {package}" if wrong else ""


def _their_choice(found: Mapping[str, str]) -> Choice:
    packages, wrong = type_names().packages, unfit(found)
    there = [package for package in packages if any(name.startswith(f"{package}/") for name in found)]
    halves = {f"{name}{half}" for name in wrong for half in ("Request", "Response")}
    absent = [f"all of {package}" for package in packages if package not in there]
    absent += [name for name in wrong.keys() - halves if not wrong[name] and name.partition("/")[0] in there]
    but = f", but for {_some(sorted(absent))}, not on this computer" if absent else ""
    names = f"{', '.join(there)}{but}; messages:={OURS} keeps those of nao_library_msgs"
    differing = _differing(wrong)
    problem = f"{differing}: clients with another version of a type cannot connect" if differing else ""
    return Choice(THEIRS, f"messages: types of the driver have the names of {names}", problem)


def _differing(wrong: Mapping[str, str]) -> str:
    wanted = type_names().sums
    return _some([f"{name} has md5 sum {value} instead of {wanted[name]}" for name, value in wrong.items() if value])


def _some(names: Sequence[str]) -> str:
    more = len(names) - LONGEST_LIST
    return ", ".join(names[:LONGEST_LIST]) + (f" and {more} more" if more > 0 else "")


def main(arguments: Sequence[str]) -> int:
    """Print the choice for a word, without the end of a line: it becomes a parameter. Returns the exit status."""
    try:
        choice = choose(arguments[0] if arguments else AUTO)
    except NaoError as error:
        print(error, file=sys.stderr)
        return 1
    if choice.names == OURS and choice.problem:  # else the driver tells it
        print(choice.problem, file=sys.stderr)
    print(choice.names, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
