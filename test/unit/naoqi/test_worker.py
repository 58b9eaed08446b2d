"""Jobs are done one after the other, in one thread, whatever they do."""

from __future__ import annotations

import threading

import pytest

from naoqi.worker import Worker


@pytest.fixture
def worker():
    worker = Worker("test worker")
    yield worker
    worker.close()


def test_jobs_keep_their_order_and_their_thread(worker, patience):
    done, seen = threading.Event(), []
    for number in range(100):
        worker.submit(lambda number=number: seen.append((number, threading.current_thread().name)))
    worker.submit(done.set)
    assert done.wait(patience)
    assert seen == [(number, "test worker") for number in range(100)]


@pytest.mark.parametrize("error", [ValueError("a job with a fault"), SystemExit("a job with a fault")])
def test_a_failing_job_is_logged_and_the_next_one_done(worker, patience, caplog, error):
    def fail():
        raise error

    done = threading.Event()
    worker.submit(fail)
    worker.submit(done.set)
    assert done.wait(patience)
    assert "a job with a fault" in caplog.text


def test_closing_does_what_is_there_and_takes_nothing_more(worker, patience):
    seen = []
    worker.submit(lambda: seen.append(1))
    worker.close(patience)
    assert worker.submit(lambda: seen.append(2)) is False
    assert seen == [1]


def test_a_job_may_close_its_worker(worker, patience):
    done = threading.Event()
    worker.submit(lambda: (worker.close(patience), done.set()))
    assert done.wait(patience)
    assert worker.submit(done.set) is False
