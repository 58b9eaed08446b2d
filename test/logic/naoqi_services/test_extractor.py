"""What modules share: subscribers with periods and precisions, switches, failures of walks, a clock, names of LEDs."""

from __future__ import annotations

from datetime import timedelta
from types import SimpleNamespace

import pytest

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.model.leds_layout import load_leds
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.body.leds import LedNames
from nao_sim_bridge.naoqi.memory import live_keys
from nao_sim_bridge.naoqi.memory.extractor import MOST, Extractor, Subscription
from nao_sim_bridge.naoqi.memory.store import EVENT, MemoryStore
from nao_sim_bridge.naoqi.motion.walking import FAILED, Moves
from nao_sim_bridge.naoqi.system.time_zone import TimeZone

LEDS = load_leds()


@pytest.fixture
def memory():
    return MemoryStore(lambda: 0.0)


# --- extractors -------------------------------------------------------------------------------------------------------


@pytest.fixture
def done():
    """What the extractor was told to do, and of which changes."""
    return []


@pytest.fixture
def extractor(memory, done):
    start, stop = (lambda word=word: done.append(word) for word in ("start", "stop"))
    return Extractor("ALTest", memory, start, stop, ["Heard", "Seen"], ["Key"], Subscription(170, 0.25), done.append)


def test_who_has_gone_is_subscribed_no_longer(extractor, done):
    extractor.subscribe("gone")
    extractor.client_gone("nobody")
    assert "stop" not in done
    extractor.client_gone("gone")
    assert done[-1] == "stop" and extractor.getSubscribersInfo() == []


def test_of_too_many_names_the_one_that_came_first_is_taken_off(extractor, caplog):
    for number in range(MOST + 1):
        extractor.subscribe(f"client {number}")
    extractor.subscribe("client 1")  # which is subscribed already
    names = [name for name, *_ in extractor.getSubscribersInfo()]
    assert names == [f"client {number}" for number in range(1, MOST + 1)]
    assert "ALTest: more than 100 are subscribed, 'client 0' is taken off" in caplog.text


def test_it_works_from_the_first_subscriber_to_the_last_and_is_told_of_every_change(extractor, done):
    extractor.subscribe("one")
    extractor.subscribe("two", 100, 0.5)
    extractor.subscribe("two", 200, 0.75)
    assert extractor.getSubscribersInfo() == [["one", 170, 0.25], ["two", 200, 0.75]]
    extractor.updatePeriod("one", 50)
    extractor.updatePrecision("one", 1.0)
    extractor.unsubscribe("one")
    extractor.unsubscribe("two")
    extractor.subscribe("three")
    one, two = Subscription(170, 0.25), Subscription(200, 0.75)
    assert done == [
        "start",
        {"one": one},
        {"one": one, "two": Subscription(100, 0.5)},
        {"one": one, "two": two},
        {"one": Subscription(50, 0.25), "two": two},
        {"one": Subscription(50, 1.0), "two": two},
        {"two": two},
        {},
        "stop",
        "start",
        {"three": one},
    ]


def test_the_shortest_period_and_the_highest_precision_count(extractor, memory):
    assert (extractor.getCurrentPeriod(), extractor.getCurrentPrecision()) == (170, 0.25)
    extractor.subscribe("slow", 500, 0.1)
    extractor.subscribe("quick", 50, 0.0)
    assert (extractor.getCurrentPeriod(), extractor.getCurrentPrecision()) == (50, 0.1)
    extractor.updatePeriod("quick", 600)
    extractor.updatePrecision("quick", 1.0)
    assert (extractor.getCurrentPeriod(), extractor.getCurrentPrecision()) == (500, 1.0)
    assert (extractor.getMyPeriod("quick"), extractor.getMyPrecision("quick")) == (600, 1.0)
    assert memory.events_of("ALTest") == extractor.getEventList() == ["Heard", "Seen"]
    assert extractor.getMemoryKeyList() == ["Key"] and extractor.getOutputNames() == ["Heard", "Seen", "Key"]


def test_who_is_a_stranger_nameless_or_asks_for_what_cannot_be_is_refused(extractor, done):
    for period, precision in ((-1, 0.5), (100, -0.1), (100, 1.1), (100, float("nan"))):
        with pytest.raises(BadValue):
            extractor.subscribe("one", period, precision)
    with pytest.raises(BadValue, match="name is ''"):
        extractor.subscribe("")
    assert done == [] and extractor.getSubscribersInfo() == []
    strangers = [("unsubscribe",), ("getMyPeriod",), ("getMyPrecision",), ("updatePeriod", 1), ("updatePrecision", 1.0)]
    for known in ("nobody", "'friend'"):
        for name, *more in strangers:
            with pytest.raises(RuntimeError, match=f"'stranger' is not subscribed; subscribed is {known}"):
                getattr(extractor, name)("stranger", *more)
        extractor.subscribe("friend")


# --- keys, walks ------------------------------------------------------------------------------------------------------


def test_every_led_has_its_key_the_status_of_a_motor_follows_its_warmth():
    for version in ("V6", "V5"):
        leds = load_leds(version)
        numbers = tuple(range(len(leds.devices)))
        keys = live_keys.live_keys(None, load_model(version), leds, lambda numbers=numbers: numbers)
        for index, device in enumerate(leds.devices):
            assert keys[f"Device/SubDeviceList/{device}"]() == index
    steps = [(27.0, 0), (67.9, 0), (68.0, 1), (73.9, 1), (74.0, 2), (79.9, 2), (80.0, 3), (120.0, 3)]
    for warmth, status in steps:
        runner = SimpleNamespace(snapshot=SimpleNamespace(temperatures=(warmth,) * 26))
        keys = live_keys.live_keys(runner, load_model(), LEDS, tuple)
        assert keys["Device/SubDeviceList/HeadYaw/Temperature/Sensor/Status"]() == status


@pytest.mark.parametrize(
    "started, obstacle, told",
    [(False, None, [0, None]), (True, None, [1, None]), (True, (0.5, 0.1, 0.2), [1, [0.5, 0.1, 0.2]])],
)
def test_a_move_that_fails_tells_cause_status_and_obstacle_once(memory, started, obstacle, told):
    heard, locomotion, failures = [], SimpleNamespace(failures=[]), Moves(memory)
    assert FAILED in memory.names(EVENT)
    memory.subscribe(FAILED, "test", lambda name, value, message: heard.append(value))
    for _ in range(3):
        failures.watch(locomotion)
    for tell in locomotion.failures:
        tell("something is wrong", started, obstacle)
    assert heard == [["something is wrong", *told]] and memory.get(FAILED) == heard[0]


# --- the clock --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "told, name, hours, warned",
    [("Asia/Tokyo", "Asia/Tokyo", 9, 0), (":Asia/Tokyo", "Asia/Tokyo", 9, 0), ("Mars/Olympus", "UTC", 0, 1)],
)
def test_the_zone_is_what_tz_says_and_utc_where_nobody_knows_it(monkeypatch, caplog, told, name, hours, warned):
    monkeypatch.setenv("TZ", told)
    zone = TimeZone()
    assert (zone.name, zone.now().utcoffset(), len(caplog.records)) == (name, timedelta(hours=hours), warned)
    for wrong in ("x" * 256, "Europe\0Paris", "Europe", "../x", ""):
        assert zone.change(wrong) is False and zone.name == name
    assert zone.change("Europe/Paris") is True and zone.name == "Europe/Paris"


# --- names of LEDs ----------------------------------------------------------------------------------------------------


@pytest.fixture
def names():
    return LedNames(LEDS)


def test_groups_mean_their_members_each_once_may_hold_groups_and_be_made_anew(names):
    for name in ("FaceLeds", "LeftFaceLed1", "Brain0", "ChestBoard/Led/Blue/Actuator/Value"):
        assert names.devices(name) == LEDS.devices_of(name)
    names.createGroup("mine", ["LeftFaceLed1", "LeftFaceLed1", "FaceLedLeft0", "Brain3"])
    assert names.listGroup("mine") == ["LeftFaceLed1", "LeftFaceLed1", "FaceLedLeft0", "Brain3"]
    assert set(names.devices("mine")) == {*LEDS.devices_of("FaceLedLeft0"), *LEDS.devices_of("Brain3")}
    assert len(names.devices("mine")) == 4 and len(names.listGroups()) == 71 and len(names.listLEDs()) == 57
    names.createGroup("all", ["mine", "Brain0"])
    assert set(names.devices("all")) == {*names.devices("mine"), *LEDS.devices_of("Brain0")}
    names.createGroup("mine", ["Brain0"])
    assert names.devices("mine") == LEDS.devices_of("Brain0") and names.listGroup("FaceLedLeft0") == ["LeftFaceLed1"]
    assert names.listLED("LeftFaceLed1")[0].startswith("Face/Led/Red/Left/")


def test_impossible_groups_and_unknown_names_are_refused(names):
    names.createGroup("group0", ["Brain0"])
    names.createGroup("group1", ["group0"])
    for call, message in (
        (lambda: names.createGroup("FaceLeds", ["Brain0"]), "'FaceLeds' is taken by the robot's own LEDs"),
        (lambda: names.createGroup("mine", []), "'mine' has no members"),
        (lambda: names.createGroup("group0", ["group1"]), "'group0' would hold itself"),
        (lambda: names.createGroup("mine", ["Brian0"]), "unknown LED or group 'Brian0'.*'Brain0'"),
        (lambda: names.listGroup("FaceLed"), "unknown group 'FaceLed'.*'FaceLeds'"),
        (lambda: names.listLED("FaceLeds"), "unknown LED 'FaceLeds'"),
    ):
        with pytest.raises((NaoqiError, UnknownName), match=message):
            call()
    assert "mine" not in names.listGroups() and names.devices("group1") == LEDS.devices_of("Brain0")
