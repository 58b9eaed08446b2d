"""Events that are passed on."""

from __future__ import annotations

from types import SimpleNamespace

from nao_library_modules.core.robot_events import EventRelay


def test_one_event_that_cannot_be_subscribed_again_keeps_no_other_from_it(caplog):
    connected, breaks = [], []

    def connect(name, _callback):
        if name in breaks:
            raise RuntimeError("Socket Disconnected")
        connected.append(name)

    def subscriber(name):
        signal = SimpleNamespace(connect=lambda callback: connect(name, callback), disconnect=lambda link: None)
        return SimpleNamespace(signal=signal)

    relay = EventRelay(lambda: SimpleNamespace(subscriber=subscriber), lambda name, value: None)
    for name in ("first", "second"):
        relay.subscribe(name)
    connected.clear()
    breaks.append("first")
    relay.renew()
    assert connected == ["second"]
    assert "event first could not be subscribed again: Socket Disconnected" in caplog.text
