"""The line between an owner and a watch: it lasts as long as both do."""

from __future__ import annotations

import json
import os
import queue
import socket
from unittest.mock import Mock

import pytest

from nao_library_modules.core.process_owners import OwnerLine, OwnerWatch, place

DEFAULT_TIMEOUT = 0.05
"""s that sockets of this process wait, if they do not say otherwise; rospy gives them 60 s."""
STOP = ["ALMotion", "stopMove", []]


def test_a_line_outlives_the_patience_of_other_sockets(monkeypatch):
    monkeypatch.setattr(socket, "socket", _impatient)
    address, stopped = f"line of {os.getpid()}", queue.Queue()
    watch, line = OwnerWatch(address, stopped.put), OwnerLine(address)
    line.hold("walk", "walk", STOP)
    with pytest.raises(queue.Empty):
        stopped.get(timeout=10 * DEFAULT_TIMEOUT)
    line.let_go("walk")
    watch.close()


def test_what_is_set_going_again_later_is_told_again():
    address, clock = f"line of {os.getpid()}", Mock(return_value=10.0)
    with socket.socket(socket.AF_UNIX) as watch:
        watch.bind(place(address))
        watch.listen()
        line = OwnerLine(address, clock)
        line.hold("walk", "walk", STOP)
        told = watch.accept()[0].makefile()
        for clock.return_value in (10.5, 12.0):
            line.hold("walk", "walk", STOP)
        line.let_go("walk")
        said = [json.loads(told.readline()) for _ in range(4)]
    assert [each.get("since") for each in said] == [None, 10.0, 12.0, None]
    assert said[1]["hold"] == said[2]["hold"] == said[3]["release"]


def test_another_user_who_has_the_place_of_the_watch_is_told_nothing(monkeypatch, caplog):
    monkeypatch.setattr("nao_library_modules.core.process_owners.peer_of", lambda _: (7, 12345))
    address = f"line of {os.getpid()}"
    with socket.socket(socket.AF_UNIX) as other:
        other.bind(place(address))
        other.listen()
        line = OwnerLine(address)
        line.hold("walk", "walk", STOP)
        assert [other.accept()[0].recv(100) for _ in range(3)] == [b""] * 3
        line.let_go("walk")
    assert [record.levelname for record in caplog.records] == ["ERROR"]
    assert "process 7 of user 12345 has the place of the watch" in caplog.text


class _impatient(socket.socket):  # noqa: N801  it stands for a class of that form
    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self.settimeout(DEFAULT_TIMEOUT)
