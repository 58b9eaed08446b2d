"""Keys of a terminal, and that it gets its settings back."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
import termios

import pytest

from nao_library_modules.driver.terminal_keys import TerminalKeys, decode
from naoqi.errors import NaoError

LOCAL_FLAGS = 3


@pytest.fixture
def terminal():
    """Both ends of a terminal: the one with the keyboard, and the one of the program."""
    keyboard, program = pty.openpty()
    yield keyboard, program
    for file in (keyboard, program):
        try:
            os.close(file)
        except OSError:
            pass


def flags(file):
    return termios.tcgetattr(file)[LOCAL_FLAGS] & (termios.ICANON | termios.ECHO)


@pytest.mark.parametrize(
    "text, keys",
    [
        ("w", ["w"]),
        ("ww1 ", ["w", "w", "1", " "]),
        ("\x1b[A\x1b[B\x1b[C\x1b[D", ["up", "down", "right", "left"]),
        ("\x1bOAw", ["up", "w"]),
        ("\x1b", ["escape"]),
        ("\x1b[15~w", ["another key", "w"]),
        ("\x1b[1;5Aw", ["up", "w"]),
        ("\x1b[", ["another key"]),
        ("\x03\x04", ["ctrl-c", "ctrl-d"]),
    ],
)
def test_characters_and_sequences_become_keys(text, keys):
    assert decode(text) == keys


def test_keys_count_at_once_and_the_settings_come_back(terminal):
    keyboard, program = terminal
    before = flags(program)
    with TerminalKeys(program) as keys:
        assert flags(program) == 0
        os.write(keyboard, b"w\x1b[A")
        assert keys.read(5.0) == ["w", "up"]
        assert keys.read(0.0) == []
    assert before and flags(program) == before


def test_an_error_gives_the_settings_back_too(terminal):
    _, program = terminal
    before = flags(program)
    with pytest.raises(RuntimeError):
        with TerminalKeys(program):
            raise RuntimeError("whatever")
    assert flags(program) == before


def test_a_terminal_that_is_gone_ends_it(terminal):
    keyboard, program = terminal
    with TerminalKeys(program) as keys:
        os.close(keyboard)
        assert keys.read(5.0) == ["ctrl-d"]


def test_a_program_that_exits_without_leaving_the_block_restores_the_terminal(terminal):
    _, program = terminal
    before = flags(program)
    code = (
        "import sys\n"
        "from nao_library_modules.driver.terminal_keys import TerminalKeys\n"
        "keys = TerminalKeys(0).__enter__()\n"
        "sys.exit(3)\n"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    ended = subprocess.run([sys.executable, "-c", code], stdin=program, env=environment, timeout=30)
    assert ended.returncode == 3
    assert flags(program) == before


def test_a_pipe_is_no_terminal():
    reading, writing = os.pipe()
    with pytest.raises(NaoError, match="keys need a terminal"):
        TerminalKeys(reading)
    os.close(reading)
    os.close(writing)
