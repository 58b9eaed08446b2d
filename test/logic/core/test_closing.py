"""The end of a program: all its steps, each guarded, within a limit."""

from __future__ import annotations

import subprocess
import sys
import threading

import pytest

from nao_library_modules.core.processes import close_all
from nao_sim_bridge.base.closing import close_all as close_simulator

LIMIT = 60.0


@pytest.mark.parametrize("close_all", [close_all, close_simulator], ids=["node", "simulator"])
def test_steps_are_made_in_order_after_one_that_fails_and_one_that_hangs(close_all, caplog):
    made, hang, over = [], threading.Event(), threading.Event()

    def fails():
        made.append("fails")
        raise ZeroDivisionError

    def hangs():
        made.append("hangs")
        hang.wait(LIMIT)
        over.set()

    close_all(fails, hangs, lambda: made.append("last"), limit=0.2)
    assert made == ["fails", "hangs", "last"]
    assert not over.is_set()
    assert "fails failed" in caplog.text and "hangs has not ended within 0.2 s" in caplog.text
    hang.set()


def test_a_step_that_is_given_up_may_end_in_the_time_of_all():
    ended, next_one = [], threading.Event()

    def slow():
        next_one.wait(LIMIT)
        ended.append("slow")

    def quick():
        ended.append("quick")
        next_one.set()

    close_all(slow, quick, limit=4.0)
    assert ended == ["quick", "slow"]


def test_a_process_ends_whatever_its_threads_wait_for():
    program = "from nao_library_modules.core.processes import exit_in_time; import threading; exit_in_time(0.1)"
    done = subprocess.run(
        [sys.executable, "-c", f"{program}; threading.Event().wait()"],
        timeout=LIMIT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1 and "longer than 0.1 s" in done.stderr
