"""A program ends when nothing of it is inside libqi any more."""

from __future__ import annotations

import threading

from naoqi.session import Presence
from naoqi.state import Worker

SOON = 60.0


def test_jobs_under_way_and_in_the_queue_are_waited_for_but_not_the_job_that_waits():
    presence, begun, let_go, waited = Presence(), threading.Event(), threading.Event(), []
    worker = Worker("worker", presence)
    worker.submit(lambda: (begun.set(), let_go.wait(SOON)))
    worker.submit(lambda: waited.append(presence.wait_until_empty(SOON)))
    worker.close()
    assert begun.wait(SOON) and not presence.wait_until_empty(0.05)
    let_go.set()
    assert presence.wait_until_empty(SOON) and waited == [True]


def test_a_callback_that_libqi_holds_is_waited_for_until_its_last_reference_is_gone():
    presence, held = Presence(), [lambda: None]
    presence.lend(held[0])
    assert not presence.wait_until_empty(0.05)
    held.clear()
    assert presence.wait_until_empty(SOON)
