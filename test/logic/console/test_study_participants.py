"""The program that plays participants, where nothing runs."""

from __future__ import annotations

import queue
import random
import threading
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest
from played_study import LIMIT, PlayedRobot, Trial

from nao_library_modules.studies import studies as module

PROGRAM = Path(__file__).parents[3] / "nao_library_modules/examples/console_participants.py"


@pytest.fixture
def program():
    spec = spec_from_file_location("console_participants", PROGRAM)
    found = module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


def test_a_trial_that_is_held_is_told_and_ends(program, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(module, "settings", lambda namespace: {})
    trial = Trial(tmp_path, PlayedRobot(plays=()))
    changes = queue.SimpleQueue()
    runner = trial.studies.begin(trial.protocol, "P01", trial.robot, listener=changes.put)
    participant = program.SimulatedParticipant.__new__(program.SimulatedParticipant)
    participant._chance = random.Random(1)
    ended = []
    playing = threading.Thread(target=lambda: ended.append(participant.play(runner, changes)))
    playing.start()
    assert trial.robot.sent.acquire(timeout=LIMIT)
    trial.robot.runs[-1].end("aborted", "no voice")
    playing.join(LIMIT)
    assert ended == ["aborted"]
    assert program.fail(runner) == 1
    assert "is held: step 1.1 (say Hello) failed: no voice" in capsys.readouterr().err
