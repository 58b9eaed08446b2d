"""The rosbag of a trial: when it records, and when it is whole."""

from __future__ import annotations

import os
import sys

import pytest

from nao_library_modules.core.errors import NaoError
from nao_library_modules.studies import trial_recordings as module
from nao_library_modules.studies.trial_recordings import BagRecorder, end_bag, is_bag

RECORDER = f"""#!{sys.executable}
import os, signal, sys, threading
file = sys.argv[sys.argv.index("-O") + 1]
ends = threading.Event()
signal.signal(signal.SIGINT, lambda *_: ends.set())
open(file + ".active", "w").close()
ends.wait(30)
threading.Event().wait(0.2)  # it takes its time to close the file
os.rename(file + ".active", file)
"""


@pytest.fixture
def recorder(tmp_path, monkeypatch):
    """A program that is told as the recorder is, and what it records into."""
    program = tmp_path / "record"
    program.write_text(RECORDER)
    program.chmod(0o755)
    monkeypatch.setattr(module, "_program", lambda: str(program))
    monkeypatch.setattr(BagRecorder, "_missing", lambda self: [])
    found = BagRecorder(tmp_path / "trial.bag", ["/tf"], tmp_path / "log")
    yield found
    found._process.kill()
    found._process.wait()


@pytest.mark.parametrize("own", [True, False])
def test_a_bag_is_whole_when_its_recording_has_ended(recorder, own):
    recorder.wait_until_it_records()
    end_bag(recorder.file, {"pid": recorder.pid}, recorder if own else None)
    assert recorder.file.exists()


def test_a_recorder_that_ends_at_once_is_told(recorder):
    recorder._process.kill()
    recorder._process.wait()
    with pytest.raises(NaoError, match="ended at once"):
        recorder.wait_until_it_records()


def test_topics_that_do_not_come_are_told_and_not_waited_for_without_end(recorder, monkeypatch):
    monkeypatch.setattr(module, "BEGIN_LIMIT", 0.3)
    monkeypatch.setattr(BagRecorder, "_missing", lambda self: ["/tf"])
    with pytest.raises(NaoError, match="does not read /tf"):
        recorder.wait_until_it_records()


def test_only_the_process_that_records_into_the_file_is_ended(recorder, tmp_path):
    recorder.wait_until_it_records()
    assert is_bag(recorder.file, {"pid": recorder.pid})
    assert not is_bag(tmp_path / "other.bag", {"pid": recorder.pid})
    assert not is_bag(recorder.file, {"pid": os.getpid()})
