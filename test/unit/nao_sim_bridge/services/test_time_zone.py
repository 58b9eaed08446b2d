"""The zone of the robot's clock: TZ, else that of the computer; and names that are none."""

from __future__ import annotations

import logging
import os
import time
from datetime import timedelta

import pytest

from nao_sim_bridge.services import time_zone
from nao_sim_bridge.services.time_zone import TimeZone

needs_zones = pytest.mark.skipif(
    not os.path.isfile("/usr/share/zoneinfo/Asia/Tokyo"), reason="no time zones on this machine"
)


@pytest.fixture
def computer(monkeypatch, tmp_path):
    """Puts the computer into a zone, and a link to it where its name stands."""
    monkeypatch.setattr(time_zone, "LOCAL", tmp_path / "localtime")

    def be_in(zone, link=""):
        monkeypatch.setenv("TZ", zone)
        time.tzset()
        monkeypatch.delenv("TZ")
        if link:
            time_zone.LOCAL.symlink_to(link)

    yield be_in
    monkeypatch.undo()
    time.tzset()


@pytest.mark.parametrize("link", ["/usr/share/zoneinfo/Asia/Tokyo", "../usr/share/zoneinfo/Asia/Tokyo"])
def test_without_tz_it_is_the_zone_of_the_computer(computer, link):
    computer("JST-9", link)
    zone = TimeZone()
    assert zone.name == "Asia/Tokyo"
    assert zone.now().utcoffset() == timedelta(hours=9)


@pytest.mark.parametrize("link", ["", "/somewhere/else"])
def test_without_a_link_that_tells_it_has_no_name_of_its_own(computer, link):
    computer("JST-9", link)
    zone = TimeZone()
    assert zone.name == "UTC"
    assert zone.now().utcoffset() == timedelta(hours=9)


@needs_zones
@pytest.mark.parametrize("name", ["Asia/Tokyo", ":Asia/Tokyo"])
def test_what_tz_says_goes_first(monkeypatch, name):
    monkeypatch.setenv("TZ", name)
    zone = TimeZone()
    assert (zone.name, zone.now().utcoffset()) == ("Asia/Tokyo", timedelta(hours=9))


@pytest.mark.parametrize("name", ["Mars/Olympus", "/etc/passwd", "x" * 300], ids=["unknown", "no zone", "long"])
def test_a_zone_that_nobody_knows_is_utc_and_that_is_told(computer, monkeypatch, caplog, name):
    computer("JST-9")
    monkeypatch.setenv("TZ", name)
    with caplog.at_level(logging.WARNING, "nao_sim.time_zone"):
        zone = TimeZone()
    assert (zone.name, zone.now().utcoffset()) == ("UTC", timedelta(0))
    assert f"TZ is {name!r}, which this machine does not know" in caplog.text


def test_an_empty_tz_is_utc_as_everywhere(computer, monkeypatch, caplog):
    computer("JST-9")
    monkeypatch.setenv("TZ", "")
    zone = TimeZone()
    assert (zone.name, zone.now().utcoffset()) == ("UTC", timedelta(0))
    assert caplog.text == ""


@pytest.mark.parametrize(
    "name",
    ["x" * 256, "Europe/" + "x" * 300, "x/" * 3000, "Europe\0Paris", "\udc80"],
    ids=["long", "long inside", "deep", "NUL", "no text"],
)
def test_what_no_file_can_be_called_is_no_zone(monkeypatch, name):
    monkeypatch.setenv("TZ", "UTC")
    zone = TimeZone()
    assert zone.change(name) is False
    assert zone.name == "UTC"
