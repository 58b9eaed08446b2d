"""Who listens chooses the port: nothing asks the system for a number that another program is to have."""

from __future__ import annotations

import ast
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PYTHON = ("*.py", "*/nodes/*", "scripts/*")


def test_no_code_binds_port_0_for_anybody_else():
    """A socket that listens itself is made by `create_server`, or by the server that keeps it."""
    names = subprocess.run(["git", "ls-files", *PYTHON], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    files = [ROOT / name for name in names.splitlines()]
    python = [file for file in files if file.suffix == ".py" or b"python" in file.read_bytes().partition(b"\n")[0]]
    assert len(python) > 1000
    assert [f"{file.relative_to(ROOT)}:{line}" for file in python for line in guesses(file)] == []


def guesses(file):
    """Lines of a file that call `bind` with port 0."""
    text = file.read_text(encoding="utf-8")
    if "bind(" in text:
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "bind":
                address = node.args[0] if node.args else None
                if isinstance(address, ast.Tuple) and getattr(address.elts[-1], "value", None) == 0:
                    yield node.lineno
