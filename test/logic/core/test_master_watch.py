"""What a new ROS master is told of what the former one knew."""

from __future__ import annotations

import socket

import pytest

from nao_library_modules.ros import master_watch
from nao_library_modules.ros.master_watch import Book, Refused, restore


class NewMaster:
    """Knows nothing yet; what it is told is in `told`."""

    def __init__(self):
        self.told = []

    def ask(self, method, *arguments, caller=""):
        if method == "lookupNode":
            raise Refused
        if method == "getParamNames":
            return []
        self.told.append((method, arguments[0], caller))
        return []


@pytest.fixture
def busy(monkeypatch):
    """Address of a node that has no time to answer."""
    monkeypatch.setattr(master_watch, "LIMIT", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}/"


def test_a_node_that_takes_its_time_is_not_forgotten_and_one_that_has_ended_is(busy):
    with socket.create_server(("127.0.0.1", 0)) as listener:
        ended = f"http://127.0.0.1:{listener.getsockname()[1]}/"
    book = Book(
        1, publishers={"/chatter": ("/busy", "/ended")}, types={"/chatter": "*"}, nodes={"/busy": busy, "/ended": ended}
    )
    master = NewMaster()
    assert restore(book, master, "/watch") == 1
    assert master.told == [("registerPublisher", "/chatter", "/busy")]
