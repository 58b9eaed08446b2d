"""Parameters of nao_speech, in the forms of today and of its first versions."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.speech_settings import (
    from_config,
    given_parameters,
    join_vocabulary,
    percent,
    split_vocabulary,
)
from naoqi.errors import NaoError

CONFIG = {
    "voice": " naoenu ",
    "language": "",
    "volume": -1,
    "vocabulary": "",
    "audio_expression": True,
    "visual_expression": False,
    "word_spotting": False,
}


def test_settings_leave_open_what_is_not_set():
    settings = from_config(CONFIG)
    assert (settings.voice, settings.language, settings.volume, settings.vocabulary) == ("naoenu", "", None, ())
    assert settings.audio_expression and not settings.visual_expression
    assert from_config({**CONFIG, "volume": 80}).volume == pytest.approx(0.8)
    assert from_config({**CONFIG, "volume": 0}).volume == 0.0


@pytest.mark.parametrize("volume, result", [(0, 0), (1, 1), (100, 100), (-1, -1), (0.0, 0), (1.0, 100), (0.55, 55)])
def test_volume_is_percent_or_a_share_with_a_point(volume, result):
    assert percent(volume) == result


@pytest.mark.parametrize("volume", [101, -2, 1.5, -0.5, True, "50", float("nan"), float("inf")])
def test_other_volumes_are_refused(volume):
    with pytest.raises(NaoError, match="~volume"):
        percent(volume)


def test_parameters_of_former_versions_are_understood():
    given = given_parameters(
        {
            "pip": "10.0.0.7",
            "volume": 0.4,
            "vocabulary": ["yes", " good morning "],
            "enable_word_spotting": True,
            "enable_audio_expression": False,
            "audio_expression": True,
        }
    )
    assert given == {
        "volume": 40,
        "vocabulary": "yes / good morning",
        "word_spotting": True,
        "audio_expression": False,
    }


@pytest.mark.parametrize(
    "parameters", [{"voice": 3}, {"vocabulary": [1]}, {"vocabulary": 1}, {"word_spotting": 1}, {"volume": "loud"}]
)
def test_parameters_of_a_wrong_kind_are_named(parameters):
    with pytest.raises(NaoError, match="~" + next(iter(parameters))):
        given_parameters(parameters)


def test_vocabulary_as_one_text_and_back():
    words = split_vocabulary(" yes / good morning //no/")
    assert words == ("yes", "good morning", "no")
    assert split_vocabulary(join_vocabulary(words)) == words


@pytest.mark.parametrize("words, problem", [(["and/or"], "separates words"), (["yes", " "], "is empty")])
def test_words_that_would_not_come_back_are_refused(words, problem):
    with pytest.raises(NaoError, match=problem):
        join_vocabulary(words)
