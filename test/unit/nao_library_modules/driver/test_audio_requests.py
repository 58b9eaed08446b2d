"""Requests to nao_audio, checked and in the words of NAOqi."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.audio_requests import file_on_robot, read_recording, read_volume
from nao_library_modules.errors import BadGoal


@pytest.mark.parametrize(
    "name, full",
    [
        ("a.wav", "/home/nao/a.wav"),
        ("music/rock.ogg", "/home/nao/music/rock.ogg"),
        ("/music/rock.ogg", "/home/nao/music/rock.ogg"),
        ("/home/nao/a.wav", "/home/nao/a.wav"),
        ("a/../b.wav", "/home/nao/b.wav"),
    ],
)
def test_files_are_in_the_home_of_the_robot(name, full):
    assert file_on_robot(name) == full


@pytest.mark.parametrize(
    "name", ["", " ", "..", "../etc/passwd", "/home/nao/../root/a.wav/../../..", "a/", ".", "a\0b"]
)
def test_other_files_are_refused(name):
    with pytest.raises(BadGoal, match="file_path"):
        file_on_robot(name)


def test_a_recording_in_the_words_of_naoqi():
    request = read_recording("day/one", 5, 1, (False, False, True, False), 16000)
    assert (request.file, request.kind) == ("/home/nao/day/one.ogg", "ogg")
    assert (request.seconds, request.rate, request.channels) == (5, 16000, (0, 0, 1, 0))
    assert read_recording("one.wav", 5, 0, (True,) * 4, 48000).file == "/home/nao/one.wav"


@pytest.mark.parametrize(
    "change, field",
    [
        ({"seconds": 0}, "secs"),
        ({"seconds": 3601}, "secs"),
        ({"kind": 2}, "audio_type"),
        ({"rate": 44100}, "samplerate"),
        ({"channels": (False,) * 4}, "channels"),
        ({"file": "../a.wav"}, "file_path"),
    ],
)
def test_what_is_wrong_with_a_recording_is_named(change, field):
    request = {"file": "a.wav", "seconds": 1, "kind": 0, "channels": (True,) * 4, "rate": 48000}
    with pytest.raises(BadGoal, match=field):
        read_recording(**{**request, **change})


def test_volume_is_percent():
    assert (read_volume(0), read_volume(100)) == (0, 100)
    for volume in (-1, 101):
        with pytest.raises(BadGoal, match="master_volume"):
            read_volume(volume)
