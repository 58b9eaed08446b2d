"""Pure functions and state machines: no process, no physics, no network."""

from __future__ import annotations

import json

import pytest

from nao_sim_bridge.base.config import config_file


@pytest.fixture(autouse=True)
def no_master(monkeypatch):
    """A master that runs for other tests is none of these tests' business."""
    monkeypatch.setenv("ROS_MASTER_URI", "http://127.0.0.1:9")  # the port of the discard service: nobody listens


@pytest.fixture
def change_file(tmp_path, monkeypatch):
    """Has a module read its FILE of the package after a change of the content."""

    def change_for(module, change):
        content = json.loads(config_file(module.FILE).read_text())
        change(content)
        path = tmp_path / module.FILE
        path.write_text(json.dumps(content))
        monkeypatch.setattr(module, "config_file", lambda name: path)

    return change_for
