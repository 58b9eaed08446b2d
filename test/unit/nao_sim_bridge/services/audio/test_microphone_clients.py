"""Modules of clients that hear the microphones, over real libqi; what the ears deliver is made up here."""

from __future__ import annotations

import ast
import logging
import queue
import threading
from dataclasses import dataclass

import numpy as np
import pytest
import qi

from nao_sim_bridge.broker import Broker
from nao_sim_bridge.services.audio import microphone_clients
from nao_sim_bridge.services.audio.microphone_clients import HELD_UP, WAITING, MicrophoneClients
from nao_sim_bridge.services.audio.microphone_formats import MicrophoneFormat
from nao_sim_bridge.services.errors import NaoqiError
from naoqi import ALBroker, ALModule


@dataclass
class Block:
    time: float
    samples: np.ndarray


class Ears:
    """Delivers blocks when a test says so."""

    def __init__(self):
        self.listening = {}

    def listen(self, name, callback, wants="48k4", channel="front"):
        ears = self

        class Listener:
            def close(self):
                if ears.listening.get(name, (None,))[0] is callback:
                    del ears.listening[name]

        self.listening[name] = (callback, wants, channel)
        return Listener()

    def deliver(self, name, samples, time=1.5):
        callback = self.listening.get(name, (lambda _: None,))[0]  # it may have gone a moment ago
        callback(Block(time, samples))


class Module:
    """A module as a client makes it with libqi alone."""

    def __init__(self):
        self.heard = queue.Queue()
        self.may_return = threading.Event()
        self.may_return.set()

    @qi.bind(qi.Void, [qi.Int32, qi.Int32, qi.Dynamic, "r"])
    def processRemote(self, channels, frames, time, buffer):
        self.heard.put((channels, frames, list(time), bytes(buffer)))
        self.may_return.wait(20.0)


class Failing(Module):
    """One that cannot cope."""

    @qi.bind(qi.Void, [qi.Int32, qi.Int32, qi.Dynamic, "r"])
    def processRemote(self, channels, frames, time, buffer):
        self.heard.put(frames)
        raise ValueError("not today")


class Undeclared:
    """One that does not say what it takes."""

    def __init__(self):
        self.heard = queue.Queue()

    def processRemote(self, channels, frames, time, buffer):
        self.heard.put(buffer)


@pytest.fixture(scope="module")
def broker():
    made = Broker("microphones")
    made.listen("127.0.0.1", 0)
    yield made
    made.close()


@pytest.fixture
def ears():
    return Ears()


@pytest.fixture
def clients(broker, ears):
    made = MicrophoneClients(ears, broker.service)
    yield made
    made.close()


@pytest.fixture
def module_of(broker):
    """Serves a module from a session of its own; ends it after the test."""
    sessions = []

    def serve(name, module):
        session = qi.Session()
        session.connect(f"tcp://127.0.0.1:{broker.port}")
        session.listen("tcp://127.0.0.1:0")
        session.registerService(name, module)
        sessions.append(session)
        return session

    yield serve
    for session in sessions:
        session.close()


def numbered(number, frames=100, channels=4):
    return np.full((frames, channels), number, dtype=np.int16)


def test_a_module_gets_blocks_in_order_with_their_times(clients, ears, module_of, patience):
    module = Module()
    module_of("Hears", module)
    clients.subscribe("Hears")
    assert ears.listening["Hears"][1] == "48k4"
    for number in range(5):
        ears.deliver("Hears", numbered(number), 2.0 + 0.17 * number)
    for number in range(5):
        channels, frames, time, buffer = module.heard.get(timeout=patience)
        assert (channels, frames) == (4, 100)
        assert time == [2, 170000 * number]
        np.testing.assert_array_equal(np.frombuffer(buffer, "<i2"), np.full(400, number))


def test_a_module_may_get_two_blocks_at_once(clients, ears, module_of, patience):
    module = Module()
    module_of("Patient", module)
    clients.subscribe("Patient")
    clients.set_at_once(2)
    for number in range(5):
        ears.deliver("Patient", numbered(number), 2.0 + 0.25 * number)
    for number, time in ((0, [2, 0]), (2, [2, 500000])):
        channels, frames, begun, buffer = module.heard.get(timeout=patience)
        assert (channels, frames, begun) == (4, 200, time)
        assert np.frombuffer(buffer, "<i2").tolist() == [number] * 400 + [number + 1] * 400
    clients.set_at_once(1)
    ears.deliver("Patient", numbered(5), 3.25)
    assert module.heard.get(timeout=patience)[1:3] == (200, [3, 0]), "what was begun is not lost"


def test_a_module_of_the_naoqi_package_gets_bytes(clients, ears, broker, patience):
    class Sound(ALModule):
        heard = queue.Queue()

        def processRemote(self, nbOfChannels, nbrOfSamplesByChannel, timestamp, buffer):
            self.heard.put((nbOfChannels, nbrOfSamplesByChannel, timestamp, buffer))

    samples = np.arange(-32768, 32768, 8, dtype=np.int16).reshape(-1, 4)
    naoqi_broker = ALBroker("clientBroker", "127.0.0.1", 0, "127.0.0.1", broker.port)
    try:
        module = Sound("SoundOfNaoqi")
        clients.subscribe("SoundOfNaoqi")
        ears.deliver("SoundOfNaoqi", samples)
        channels, frames, time, buffer = module.heard.get(timeout=patience)
    finally:
        naoqi_broker.shutdown()
    assert (channels, frames, list(time)) == (4, 2048, [1, 500000])
    assert isinstance(buffer, bytes)
    assert buffer == samples.tobytes()


def test_a_module_that_declares_nothing_is_told_how_and_can_still_get_at_its_bytes(
    clients, ears, module_of, patience, caplog
):
    module = Undeclared()
    module_of("Undeclared", module)
    with caplog.at_level(logging.WARNING, "nao_sim.microphones"):
        clients.subscribe("Undeclared")
        ears.deliver("Undeclared", numbered(-2))
        text = module.heard.get(timeout=patience)
    assert ast.literal_eval(text) == numbered(-2).tobytes()
    assert "Undeclared.processRemote does not declare its buffer as raw" in caplog.text
    assert "ast.literal_eval(buffer)" in caplog.text


def test_preferences_count_before_and_after_subscribing(clients, ears, module_of, patience):
    module = Module()
    module_of("Prefers", module)
    clients.prefer("Prefers", MicrophoneFormat(16000, 4))
    clients.subscribe("Prefers")
    assert ears.listening["Prefers"][1:] == ("16k1", "rear")
    clients.prefer("Prefers", MicrophoneFormat(48000, 0, True))
    assert ears.listening["Prefers"][1] == "48k4"
    ears.deliver("Prefers", np.array([[1, 2, 3, 4], [5, 6, 7, 8]], dtype=np.int16))
    assert np.frombuffer(module.heard.get(timeout=patience)[3], "<i2").tolist() == [1, 5, 2, 6, 3, 7, 4, 8]


def test_subscribing_twice_is_no_harm(clients, ears, module_of, patience):
    module = Module()
    module_of("Twice", module)
    clients.subscribe("Twice")
    clients.subscribe("Twice")
    ears.deliver("Twice", numbered(1))
    assert module.heard.get(timeout=patience)
    assert clients.names() == ["Twice"]
    clients.unsubscribe("Twice")
    assert clients.names() == [] and ears.listening == {}
    assert module.heard.empty()


def test_names_that_are_not_there_are_refused(clients):
    with pytest.raises(NaoqiError, match="there is no module 'Nobody' to send sound to; register it first"):
        clients.subscribe("Nobody")
    with pytest.raises(NaoqiError, match="module 'Nobody' is not subscribed; subscribed are none"):
        clients.unsubscribe("Nobody")


def test_a_slow_module_loses_the_oldest_blocks_and_others_do_not_notice(clients, ears, module_of, patience, caplog):
    slow, quick = Module(), Module()
    slow.may_return.clear()
    module_of("Slow", slow)
    module_of("Quick", quick)
    clients.subscribe("Slow")
    clients.subscribe("Quick")
    total = 5 * WAITING
    with caplog.at_level(logging.WARNING, "nao_sim.microphones"):
        ears.deliver("Slow", numbered(0))
        assert slow.heard.get(timeout=patience)  # it is busy with the first block from now on
        for number in range(1, total):
            ears.deliver("Slow", numbered(number))
            ears.deliver("Quick", numbered(number))
            assert quick.heard.get(timeout=patience)
    assert clients.lost("Slow") == total - 1 - WAITING
    assert clients.lost("Quick") == 0
    assert clients.behind()
    assert "Slow is too slow for the microphones: 32 blocks lost so far" in caplog.text
    assert len(caplog.records) < 10
    slow.may_return.set()
    newest = [np.frombuffer(slow.heard.get(timeout=patience)[3], "<i2")[0] for _ in range(WAITING)]
    assert newest == list(range(total - WAITING, total))
    assert not clients.behind()


def test_time_does_not_wait_for_one_that_hangs(clients, ears, module_of, patience, monkeypatch):
    hanging = Module()
    hanging.may_return.clear()
    module_of("Hangs", hanging)
    clients.subscribe("Hangs")
    for number in range(WAITING):
        ears.deliver("Hangs", numbered(number))
    hanging.heard.get(timeout=patience)
    assert clients.behind()
    monkeypatch.setattr(microphone_clients, "PATIENCE", 0.0)
    assert not clients.behind()
    hanging.may_return.set()


def test_a_module_that_has_gone_is_unsubscribed(clients, ears, module_of, patience, caplog):
    module = Module()
    session = module_of("Goes", module)
    clients.subscribe("Goes")
    ears.deliver("Goes", numbered(1))
    assert module.heard.get(timeout=patience)
    with caplog.at_level(logging.WARNING, "nao_sim.microphones"):
        session.close()
        gone = threading.Event()
        while "Goes" in ears.listening:
            ears.deliver("Goes", numbered(2))
            assert not gone.wait(0.01)
    assert "Goes is gone, so it is unsubscribed" in caplog.text
    assert clients.names() == []


def test_a_module_that_fails_is_called_on_and_named_once(clients, ears, module_of, patience, caplog):
    module = Failing()
    module_of("Fails", module)
    clients.subscribe("Fails")
    with caplog.at_level(logging.WARNING, "nao_sim.microphones"):
        for number in range(3):
            ears.deliver("Fails", numbered(number))
            assert module.heard.get(timeout=patience)
    clients.close()
    assert sum("Fails.processRemote failed" in record.getMessage() for record in caplog.records) == 1


def test_closed_microphones_are_silent_until_they_are_opened(clients, ears, module_of, patience):
    module = Module()
    module_of("Waits", module)
    clients.subscribe("Waits")
    clients.set_closed(True)
    assert ears.listening == {}
    clients.set_closed(False)
    ears.deliver("Waits", numbered(3))
    assert module.heard.get(timeout=patience)[1] == 100


def test_a_block_of_a_format_that_counts_no_more_is_dropped(clients, ears, module_of, patience):
    module = Module()
    module_of("Changes", module)
    clients.subscribe("Changes")
    clients.set_at_once(2)
    ears.deliver("Changes", numbered(1))
    late = ears.listening["Changes"][0]  # under way while the format changes
    clients.prefer("Changes", MicrophoneFormat(16000, 3))
    late(Block(1.5, numbered(2)))
    for number in range(3, 7):
        ears.deliver("Changes", numbered(number, channels=1))
    for number in (3, 5):
        channels, frames, _, buffer = module.heard.get(timeout=patience)
        assert (channels, frames) == (1, 200)
        assert np.frombuffer(buffer, "<i2").tolist() == [number] * 100 + [number + 1] * 100


def test_blocks_that_were_under_way_when_the_microphones_closed_are_dropped(clients, ears, module_of, patience):
    module = Module()
    module.may_return.clear()
    module_of("Shuts", module)
    clients.subscribe("Shuts")
    ears.deliver("Shuts", numbered(0))
    module.heard.get(timeout=patience)  # it is busy with this one from now on
    late = ears.listening["Shuts"][0]
    clients.set_closed(True)
    for _ in range(HELD_UP + 1):
        late(Block(1.5, numbered(1)))
    assert not clients.behind()
    clients.set_closed(False)
    ears.deliver("Shuts", numbered(2))
    module.may_return.set()
    assert np.frombuffer(module.heard.get(timeout=patience)[3], "<i2")[0] == 2


def test_blocks_that_do_not_fit_together_make_nobody_deaf(clients, ears, module_of, patience):
    module = Module()
    module_of("Odd", module)
    clients.subscribe("Odd")
    clients.set_at_once(2)
    ears.deliver("Odd", numbered(1))
    with pytest.raises(ValueError):
        ears.deliver("Odd", numbered(2, channels=1))
    for number in (3, 4):
        ears.deliver("Odd", numbered(number))
    assert np.frombuffer(module.heard.get(timeout=patience)[3], "<i2").tolist() == [3] * 400 + [4] * 400
