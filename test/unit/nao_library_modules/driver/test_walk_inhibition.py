"""Who keeps whom from walking."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.walk_inhibition import NotInhibited, WalkInhibition


def test_it_is_counted():
    inhibition = WalkInhibition()
    assert (inhibition.inhibit("/path"), inhibition.inhibit("/path"), inhibition.inhibit("/me")) == (1, 2, 3)
    assert inhibition.owners == ["/path", "/me"]
    assert (inhibition.let_go("/path"), inhibition.let_go("/path")) == (2, 1)
    assert inhibition.owners == ["/me"]


def test_it_means_the_others():
    inhibition = WalkInhibition()
    inhibition.inhibit("/path")
    assert inhibition.against("/joystick") == ["/path"]
    assert inhibition.against("/path") == []
    inhibition.inhibit("/joystick")
    assert inhibition.against("/path") == ["/joystick"]


def test_whoever_has_no_hold_takes_off_the_first():
    inhibition = WalkInhibition()
    inhibition.inhibit("/rosservice_1")
    inhibition.inhibit("/path")
    assert inhibition.let_go("/rosservice_2") == 1
    assert inhibition.owners == ["/path"]


def test_there_must_be_something_to_let_go():
    inhibition = WalkInhibition()
    with pytest.raises(NotInhibited):
        inhibition.let_go("/path")
    inhibition.inhibit("/path")
    inhibition.let_go("/path")
    with pytest.raises(NotInhibited):
        inhibition.let_go("/path")
