"""Load of the local processors."""

import os

import pytest

from nao_library_modules.ros import action_server


@pytest.mark.parametrize(("more", "short"), [(0, False), (1, True)])
def test_processors_are_short_when_more_threads_want_one_than_there_are(tmp_path, monkeypatch, more, short):
    load = tmp_path / "loadavg"
    load.write_text(f"0.00 0.01 0.05 {os.cpu_count() + more}/345 1234\n")
    monkeypatch.setattr(action_server, "LOAD", load)
    assert action_server.processors_are_short() is short


def test_a_system_that_does_not_report_it_has_enough(tmp_path, monkeypatch):
    monkeypatch.setattr(action_server, "LOAD", tmp_path / "missing")
    assert not action_server.processors_are_short()
