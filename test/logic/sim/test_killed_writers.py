"""What a process that is killed has written so far can be played, and what it was to replace is still there."""

from __future__ import annotations

import subprocess
import sys

import av
import pytest
import soundfile

START = """
import sys
from pathlib import Path
import numpy as np
path, noise = Path(sys.argv[1]), np.random.default_rng(0)
picture = lambda: noise.integers(0, 255, (96, 96, 3), np.uint8)
sound = lambda: noise.integers(-9000, 9000, (4800, 2), np.int16)
"""
END = """
print("written", flush=True)
sys.stdin.read()
"""
FILM = """
from nao_sim_bridge.render.film_file import FilmFile
film = FilmFile(path, 96, 96, 48000)
for number in range(150):
    film.picture(picture(), 0.1 * number)
    film.sound(sound(), 4800 * number)
"""
RECORDING = """
from nao_sim_bridge.naoqi.cameras.film_recorder import Film
film = Film(path, sys.argv[2], 96, 96, 10.0)
for number in range(150):
    film.write(picture())
"""
SOUND = """
from nao_sim_bridge.naoqi.sound.recorder import KINDS
file = KINDS[path.suffix[1:]](path, 48000, 2)
for number in range(150):
    file.write(sound())
"""


def frames(path):
    """How many frames a film has; an error in it is one here."""
    with av.open(str(path)) as film:
        return sum(1 for _ in film.decode(video=0))


def seconds(path):
    return len(soundfile.read(str(path))[0]) / 48000


@pytest.mark.parametrize(
    "name, kind, program, most, least, measured",
    [
        ("a.mp4", "", FILM, 150, 60, frames),  # an encoder keeps some, and a part is of 30
        ("a.avi", "MJPG", RECORDING, 150, 149, frames),
        ("b.avi", "IYUV", RECORDING, 150, 149, frames),
        ("a.wav", "", SOUND, 15.0, 15.0, seconds),
        ("a.ogg", "", SOUND, 15.0, 14.0, seconds),
    ],
    ids=["film", "recording", "raw recording", "wav", "ogg"],
)
def test_it_can_be_played(tmp_path, name, kind, program, most, least, measured):
    path, part = tmp_path / name, tmp_path / name.replace(".", ".part1.")
    path.write_bytes(b"old")
    for file in (part, path):
        child = subprocess.Popen(
            [sys.executable, "-W", "ignore", "-c", START + program + END, str(path), kind],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        )  # fmt: skip
        with child:
            assert child.stdout.readline() == b"written\n"
            child.kill()
        assert least <= measured(file) <= most
        if file == part:
            assert path.read_bytes() == b"old"
            path.unlink()
    assert {file.name for file in tmp_path.iterdir()} == {path.name, part.name}
