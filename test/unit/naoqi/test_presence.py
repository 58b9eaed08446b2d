"""A program can wait until nobody of it is inside libqi any more."""

from __future__ import annotations

import threading
import weakref

import pytest

from naoqi import errors
from naoqi.presence import Presence


def test_an_empty_place_need_not_be_waited_for():
    assert Presence().wait_until_empty(0.0)


def test_who_is_inside_is_waited_for_until_it_leaves(in_thread, patience):
    presence = Presence()
    presence.enter("somebody")
    assert not presence.wait_until_empty(0.01)
    finish = in_thread(lambda: presence.wait_until_empty(patience))
    presence.leave("somebody")
    assert finish()["value"] is True


def test_the_waiting_thread_itself_does_not_count():
    presence = Presence()
    presence.enter(threading.get_ident())
    assert presence.wait_until_empty(0.0)


def test_a_lent_callback_has_left_when_nobody_holds_it():
    presence = Presence()
    lent = threading.Event()
    presence.lend(lent)
    assert not presence.wait_until_empty(0.0)
    del lent
    assert presence.wait_until_empty(0.0)


def test_a_served_object_dies_in_the_hands_of_who_waits():
    presence = Presence()
    died_in = []
    served = threading.Event()
    weakref.finalize(served, lambda: died_in.append(threading.current_thread()))
    presence.serve(served)
    assert not presence.wait_until_empty(0.0)
    other = threading.Thread(target=lambda kept=served: None)
    del served
    assert died_in == []
    other.start()
    other.join()
    del other
    assert presence.wait_until_empty(0.0)
    assert died_in == [threading.main_thread()]


def test_a_served_object_is_waited_for_until_its_queue_is_dropped_too():
    presence = Presence()
    served = threading.Event()
    strand = served.__qi_strand__ = object()
    presence.serve(served)
    del served
    assert not presence.wait_until_empty(0.01)
    del strand
    assert presence.wait_until_empty(0.0)


def test_leaving_twice_is_no_error():
    presence = Presence()
    presence.leave("nobody")
    assert presence.wait_until_empty(0.0)


def test_finished_calls_leave_nothing_behind(proxy, eventually):
    for number in range(100):
        proxy.wait(proxy.post.add(number, 1))
    with pytest.raises(errors.RobotError):
        proxy.wait(proxy.post.fails())
    proxy.call_async("fails").add_done_callback(lambda _: 1 / 0)
    presence = proxy.connection.presence
    eventually(lambda: len(presence._inside) == 0, "libqi lets go of all callbacks")
