"""NAOqi's modules that sound and hear, over libqi."""

from __future__ import annotations

import pytest
from sounds import tone, write


@pytest.fixture(autouse=True)
def full_volume(robot):
    """What the loudspeakers play has the level of its file."""
    robot.ALAudioDevice.setOutputVolume(100)


@pytest.fixture
def sound(robot):
    return robot.server.simulation.sound


@pytest.fixture
def refused(robot):
    """Checks what a module refuses: rows (method, arguments, words of the text)."""

    def check(module, rows):
        for method, arguments, words in rows:
            with pytest.raises(RuntimeError, match=words):
                robot.answer(getattr(robot, module).call(method, *arguments, _async=True))
        assert robot.ALMemory.ping() is True

    return check


@pytest.fixture
def tone_file(robot):
    """A tone of 440 Hz and 1 s; its name."""
    return write(robot, "tone.wav", tone(440.0, 1.0)).name
