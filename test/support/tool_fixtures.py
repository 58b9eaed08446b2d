"""The programs that measure and improve the simulator; they find each other as when one is started."""

from __future__ import annotations

import importlib
import logging
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "nao_sim_bridge" / "tools"


class Tools:
    """The modules of the programs, as attributes."""

    def __getattr__(self, name):
        return importlib.import_module(name)


@pytest.fixture
def tools(monkeypatch):
    """Tools silence the simulator in a process of their own; that of the tests is to hear its warnings again."""
    loggers = [logging.getLogger(name) for name in ("nao_sim", "nao_sim.motion")]
    levels = [logger.level for logger in loggers]
    monkeypatch.syspath_prepend(str(FOLDER))
    yield Tools()
    for logger, level in zip(loggers, levels):
        logger.setLevel(level)
    for path in FOLDER.glob("*.py"):
        sys.modules.pop(path.stem, None)


@pytest.fixture
def run(tools, capsys, monkeypatch):
    """Runs a program with options; its exit status and what it printed."""

    def run(name, *options):
        monkeypatch.setattr(sys, "argv", [f"{name}.py", *options])
        try:
            status = getattr(tools, name).main()
        except SystemExit as end:
            status = end.code
        captured = capsys.readouterr()
        return int(status or 0), captured.out + captured.err

    return run
