"""Bytes among any values, as answers of the robot."""

import threading

import pytest
from raw_calls import Dynamic, RawCalls

from nao_sim_bridge.server.messages import Messages

VALUE = [1, b"\xff\x00", {"picture": b"\x02"}]


@pytest.fixture
def raw(robot):
    calls = RawCalls(robot.port, robot.session)
    yield calls
    calls.close()


def test_bytes_that_a_client_stores_come_back_as_bytes(robot, raw):
    raw.answer("ALMemory", "insertData", "alone", b"\xff\x00")
    raw.answer("ALMemory", "insertData", "among", VALUE)
    assert raw.answer("ALMemory", "getData", "alone") == ("r", b"\xff\x00")
    assert robot.ALMemory.getData("among") == VALUE
    assert raw.answer("ALMemory", "getListData", ["alone", "among"])[1][0] == Dynamic(("r", b"\xff\x00"))


def test_many_clients_get_their_own_bytes_at_once(robot, raw):
    keys = [f"key{number}" for number in range(6)]
    for number, key in enumerate(keys):
        raw.answer("ALMemory", "insertData", key, bytes([number]) * 100_000)
    wrong = []

    def ask(number, key):
        for _ in range(10):
            if robot.ALMemory.getData(key) != bytes([number]) * 100_000:
                wrong.append(key)

    threads = [threading.Thread(target=ask, args=each) for each in enumerate(keys)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_an_answer_whose_connection_breaks_fails_and_the_next_one_gets_another(robot, raw, monkeypatch):
    def broken(_):
        raise ConnectionError("it has closed the connection")

    raw.answer("ALMemory", "insertData", "alone", b"\xff\x00")
    with monkeypatch.context() as patch:
        patch.setattr(Messages, "receive", broken)
        with pytest.raises(RuntimeError, match="bytes cannot be answered: it has closed the connection"):
            robot.ALMemory.getData("alone")
    assert robot.ALMemory.getData("alone") == b"\xff\x00"
