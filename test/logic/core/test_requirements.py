"""What pip installs is pinned with hashes, and pip is told to take nothing without one."""

from __future__ import annotations

import re
from pathlib import Path

import lock_requirements as locks
import pytest

ROOT = Path(locks.__file__).resolve().parents[1]
LISTS = sorted(locks.SETUP.glob("requirements*.txt"))
HASH = "--hash=sha256:" + "0" * 64


@pytest.mark.parametrize("listed", LISTS, ids=lambda path: path.name)
def test_everything_that_is_listed_has_its_hashes(listed):
    assert locks.pins(listed) and locks.problems(listed) == []


@pytest.mark.parametrize(
    "listed, locked, told",
    [
        ("a==1.0", f"a==1.0 \\\n    {HASH}", []),
        ('a==1.0 ; python_version < "3.11"', f'a==1.0 ; python_version < "3.11" \\\n    {HASH}', []),
        ("a==1.0", "a==1.0", ["a==1.0 has no hash"]),
        ("a==1.0", f"a==1.1 \\\n    {HASH}", ["a is a==1.1, not a==1.0"]),
        ("a==1.0\nb==2", f"a==1.0 \\\n    {HASH}", ["b is None, not b==2"]),
        ("a==1.0", f"a==1.0 {HASH}\nb==2 {HASH}", ["b is not in requirements.txt"]),
    ],
)
def test_a_lock_that_lacks_something_is_told(tmp_path, listed, locked, told):
    (tmp_path / "requirements.txt").write_text(listed)
    (tmp_path / "requirements.lock").write_text(locked)
    assert locks.problems(tmp_path / "requirements.txt") == [f"requirements.lock: {one}" for one in told]


def test_a_requirement_without_a_version_is_refused(tmp_path):
    (tmp_path / "requirements.txt").write_text("numpy<2")
    with pytest.raises(ValueError, match="'numpy<2' pins no version"):
        locks.pins(tmp_path / "requirements.txt")


def test_wheels_are_told_by_their_names():
    assert locks.fits("cp311-cp311-manylinux_2_17_x86_64.manylinux2014_x86_64", "311", "x86_64")
    assert locks.fits("cp37-abi3-manylinux_2_17_aarch64", "38", "aarch64") and locks.fits(
        "py3-none-any", "38", "x86_64"
    )
    assert not locks.fits("cp311-cp311-manylinux_2_17_x86_64", "38", "x86_64")
    assert not locks.fits("cp311-cp311-musllinux_1_1_x86_64", "311", "x86_64")
    assert not locks.fits("cp311-cp311-win_amd64", "311", "x86_64")


def test_every_call_of_pip_demands_hashes():
    files = [*(ROOT / "scripts").iterdir(), ROOT / "test" / "faults" / "run.py", ROOT / ".ci" / "run"]
    calls = [
        match[0]
        for file in files
        if file.is_file()
        for match in re.finditer(r"pip\"?,? \"?install\b(?:[^|>\]]|\\\n)*", file.read_text(encoding="utf-8"))
    ]
    assert len(calls) == 2 and all("--require-hashes" in call and "--no-deps" in call for call in calls)
