"""A stack of one's own: what is told when it does not come up."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from nao_library_modules.processes.own_stack import OwnStack


def test_a_roslaunch_that_ends_is_told_at_once_with_its_last_words(tmp_path):
    log = tmp_path / "log.txt"
    with OwnStack(log, {}, launch=("nao_library", "no_such.launch")) as stack:
        with pytest.raises(TimeoutError, match="the simulated robot does not come up: roslaunch has ended: .*no_such"):
            stack.wait_for_robot(60.0)
        assert not stack.alive()


def test_a_program_that_blocks_ctrl_c_can_end_its_stack(tmp_path):
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        stack = OwnStack(tmp_path / "log.txt", {})
        blocked = signal.pthread_sigmask(signal.SIG_BLOCK, [])
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    with stack:
        words = (Path("/proc") / str(stack.pid) / "status").read_text().split()
    assert signal.SIGINT in blocked
    assert not int(words[words.index("SigBlk:") + 1], 16) & 1 << signal.SIGINT - 1
