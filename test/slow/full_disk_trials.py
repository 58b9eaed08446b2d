"""Trials on a real disk that is full for a second at random moments; `test_full_disk.py` runs it on one of 8 MB.

`MOMENTS` (environment): how many trials; 3 without.
"""

from __future__ import annotations

import os
import random
import shutil
import threading
import time
from pathlib import Path

import pytest
from logged_trial import LoggedTrial

from nao_library_modules.studies import studies as module

DISK = Path(os.environ["SMALL_DISK"])
MOMENTS = int(os.environ.get("MOMENTS", "3"))
FULL_FOR = 1.0
PERIOD = 0.25
"""s from one answer to the next: a trial takes about two seconds."""


@pytest.fixture(autouse=True)
def no_ros(monkeypatch):
    monkeypatch.setattr(module, "settings", lambda namespace: {})
    monkeypatch.setattr(module, "ros_after", lambda seconds, callback: lambda: None)


def fill(file):
    """Leave no byte."""
    for size in (1 << 20, 1 << 12, 1):
        try:
            while True:
                file.write(bytes(size))
        except OSError:
            continue


def full_for_a_second(moment):
    time.sleep(moment)
    with (DISK / "filler").open("wb", buffering=0) as file:
        fill(file)
        time.sleep(FULL_FOR)
        file.truncate(0)


def test_trials_on_a_disk_that_is_full_for_a_second_are_in_their_logs_as_they_were_played():
    waited = 0
    for seed in range(MOMENTS):
        trial = LoggedTrial(DISK / "studies", seed).begin()
        acts = list(trial.acts())
        moment = random.Random(seed).uniform(0.0, PERIOD * len(acts))
        full = threading.Thread(target=full_for_a_second, args=(moment,))
        full.start()
        for act in acts:
            time.sleep(PERIOD)
            act()
        trial.end()
        full.join()
        events = trial.compare()
        gaps = [event for event in events if event["data"].get("what") == "log gap"]
        waited += sum(gap["data"]["events"] for gap in gaps)
        lasted = sum(gap["data"]["wall_ended"] - gap["data"]["wall_began"] for gap in gaps)
        print(f"full from {moment:.2f} s: {len(events)} events, the log waited {lasted:.2f} s in {len(gaps)} gaps")
        shutil.rmtree(DISK / "studies")
    print(f"{MOMENTS} of {MOMENTS} trials as they were played; {waited} events waited in memory")
    assert waited
