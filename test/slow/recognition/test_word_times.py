"""Words that begin 50 ms after the robot says that it listens: none is lost in a quiet room, their times are right."""

from __future__ import annotations

import numpy as np
import pytest
from amount import amount, part_of
from sounds import noise, put
from word_trials import trial

from nao_library_actions.msg import NaoAudioInGoal
from nao_library_modules.audio_in.audio_in_server import NaoAudioInput

WORDS = ["yes", "no", "stop", "start", "left", "right", "hello", "seven", "four", "good morning"]
VOICES = ("slt", "rms", "awb")
TRIALS = amount(20, 100)


@pytest.fixture
def ears(robot, goals_to):
    robot.ALSpeechRecognition.setVocabulary(["theirs"], False)  # its recogniser has been started
    return goals_to(NaoAudioInput, NaoAudioInGoal)


ROOMS = [pytest.param(None, id="quiet"), pytest.param(45.0, id="noise")]


@pytest.mark.parametrize("noise_db", part_of(ROOMS, 2))
def test_no_word_is_lost_and_its_times_are_told(robot, ears, noise_db):
    may_be_lost, may_be_wrong = (0.0, 0.05) if noise_db is None else (0.03, 0.15)  # of all
    if noise_db is not None:
        put(robot, (0.0, 1.5, 0.5), noise(2.0), noise_db, loop=True, name="fan")
        robot.advance(2.0)
    lost, wrong, rows = [], [], []
    for number in range(TRIALS):
        text, voice = WORDS[number % len(WORDS)], VOICES[number // len(WORDS) % len(VOICES)]
        result, onset, end, answered = trial(robot, ears, text, voice, WORDS)
        if not result.words:
            lost.append((text, voice))
            continue
        if result.words != [text]:
            wrong.append((text, voice, result.words))
        rows.append((result.onsets[0].to_sec() - onset, result.ends[0].to_sec() - end, answered - end))
        robot.advance(number % 7 * 0.05)  # blocks of sound begin at any place of a word
    errors = np.abs(np.array(rows))
    for name, values in zip(("onset", "end", "end to answer"), errors.T):
        print(f"{name}: {np.median(values):.3f} {np.percentile(values, 95):.3f} {values.max():.3f} s")
    print(f"lost {lost}, taken for another {wrong}")
    assert len(lost) <= may_be_lost * TRIALS and len(wrong) <= may_be_wrong * TRIALS
    assert np.median(errors[:, 0]) < 0.02 and np.percentile(errors[:, 0], 95) < 0.06
    assert np.median(errors[:, 1]) < 0.03 and np.percentile(errors[:, 1], 90) < 0.06
