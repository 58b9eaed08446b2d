#!/usr/bin/env python3
"""Write setup/*.lock anew: what setup/*.txt pins, with the hashes of all files that pip may install on our platforms.

    scripts/lock_requirements.py [--check [--quiet]]

The hashes are asked of the package index that pip is told to use (PIP_INDEX_URL, or PyPI). With --check nothing is
asked or written; it ends with 1 if a lock does not have what its list pins.
"""

from __future__ import annotations

import json
import os
import re
import sys
import urllib.request
from pathlib import Path

SETUP = Path(__file__).resolve().parent.parent / "setup"
INDEX = os.environ.get("PIP_INDEX_URL", "https://pypi.org/simple").rstrip("/")
FORM = "application/vnd.pypi.simple.v1+json"
PYTHONS, MACHINES = ("38", "39", "310", "311", "312"), ("x86_64", "aarch64")
# Those that are really used: on Ubuntu 20.04 and Debian 12. Where there is no wheel for one, the source may be built.
USED = ("38", "311")
PIN = re.compile(r"^([A-Za-z0-9_.-]+)==([^\s;\\]+)\s*(;[^\\]*)?")
HASH = re.compile(r"--hash=sha256:[0-9a-f]{64}\b")


def pins(path: Path) -> dict[str, str]:
    """Name, with the marker if it has one, to the whole requirement, as a list or a lock has it.

    Raises:
        ValueError: A line is no pin.
    """
    found = {}
    text = path.read_text(encoding="utf-8").replace("\\\n", " ")
    for line in (line.split("#")[0].strip() for line in text.splitlines()):
        match = PIN.match(line)
        if line and not match:
            raise ValueError(f"{path.name}: {line!r} pins no version")
        if match:
            marker = (match[3] or "").split("--hash")[0].strip("; ")
            suffix = f" ; {marker}" if marker else ""
            found[match[1] + suffix] = f"{match[1]}=={match[2]}{suffix}"
    return found


def problems(listed: Path) -> list[str]:
    """What is wrong with the lock of a list."""
    lock = listed.with_suffix(".lock")
    if not lock.exists():
        return [f"{lock.name} is not there"]
    wanted, locked = pins(listed), pins(lock)
    told = [
        f"{lock.name}: {name} is {locked.get(name)}, not {one}"
        for name, one in wanted.items()
        if locked.get(name) != one
    ]
    told += [f"{lock.name}: {name} is not in {listed.name}" for name in locked if name not in wanted]
    for entry in lock.read_text(encoding="utf-8").replace("\\\n", " ").splitlines():
        if PIN.match(entry) and not HASH.search(entry):
            told.append(f"{lock.name}: {entry.split()[0]} has no hash")
    return told


def fits(tags: str, python: str, machine: str) -> bool:
    """Whether the end of a wheel's name (cp311-cp311-manylinux...) is for an interpreter on Linux."""
    interpreters, abis, platforms = (part.split(".") for part in tags.rsplit("-", 2))
    if "any" not in platforms and not any(p.startswith("manylinux") and p.endswith(machine) for p in platforms):
        return False
    if f"cp{python}" in interpreters:
        return True
    if "abi3" in abis:
        return any(i.startswith("cp3") and int(i[3:]) <= int(python[1:]) for i in interpreters)
    return "none" in abis and any(i in ("py3", "py2.py3") or i == f"py{python}" for i in interpreters)


def hashes(name: str, version: str) -> list[str]:
    """Hashes of the files of a version that may be installed."""
    request = urllib.request.Request(f"{INDEX}/{re.sub('[-_.]+', '-', name).lower()}/", headers={"Accept": FORM})
    with urllib.request.urlopen(request, timeout=60) as answer:  # noqa: S310 the index of pip
        files = json.load(answer)["files"]
    plain = re.escape(version)
    wheel = re.compile(rf"^[A-Za-z0-9_.]+-{plain}(?:-\d[^-]*)?-([^-]+-[^-]+-[^-]+)\.whl$")
    wheels = {file["filename"]: match[1] for file in files for match in [wheel.match(file["filename"])] if match}
    kept = {n for n, tags in wheels.items() if any(fits(tags, p, m) for p in PYTHONS for m in MACHINES)}
    if not all(any(fits(wheels[n], p, m) for n in kept) for p in USED for m in MACHINES):
        kept |= {f["filename"] for f in files if re.search(rf"-{plain}\.(tar\.gz|zip)$", f["filename"])}
    found = sorted(f["hashes"]["sha256"] for f in files if f["filename"] in kept)
    if not found:
        raise SystemExit(f"{name} {version}: there is nothing for our platforms")
    return found


def write(listed: Path) -> None:
    """Write the lock of a list."""
    lines = [
        f"# Made by scripts/lock_requirements.py from {listed.name}: Linux, x86_64 and aarch64, CPython 3.8 to 3.12."
    ]
    for name, requirement in pins(listed).items():
        version = requirement.split("==")[1].split(" ")[0]
        sums = (f"--hash=sha256:{one}" for one in hashes(name.split(" ")[0], version))
        lines.append(" \\\n    ".join([requirement, *sums]))
    listed.with_suffix(".lock").write_text("\n".join(lines) + "\n", encoding="utf-8")


def main() -> int:
    """Write the locks, or only look at them; returns the exit status."""
    lists = sorted(SETUP.glob("requirements*.txt"))
    if "--check" not in sys.argv[1:]:
        for listed in lists:
            write(listed)
    told = [problem for listed in lists for problem in problems(listed)]
    if told or "--quiet" not in sys.argv[1:]:
        print("\n".join(told) or f"{len(lists)} locks have hashes for all that is pinned")
    return bool(told)


if __name__ == "__main__":
    sys.exit(main())
