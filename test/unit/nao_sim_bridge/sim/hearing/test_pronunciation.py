"""How words are said: from the dictionary, else by rules; what cannot be said is named."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.hearing.pronunciation import NoPronunciation, Pronouncer, phones_of_ipa, read_by_rules


@pytest.fixture
def pronouncer(tmp_path):
    path = tmp_path / "words.dict"
    path.write_text("read R IY D\nread(2) R EH D\nrobot R OW B AA T\n")
    return Pronouncer(path)


def test_a_word_of_the_dictionary_has_all_its_pronunciations(pronouncer):
    assert pronouncer.phones("read") == ["R IY D", "R EH D"]


def test_a_possessive_is_made_of_its_word(pronouncer):
    assert pronouncer.phones("robot's") == ["R OW B AA T S"]


def test_another_word_is_read_by_rules(pronouncer):
    assert pronouncer.phones("nao") == ["N AW"]


@pytest.mark.parametrize(
    "ipa, phones", [("nˈaʊ", "N AW"), ("tʃˈɜːtʃ", "CH ER CH"), ("(en)bˈeɪkə(fr)", "B EY K AH"), ("ʘ", "")]
)
def test_phones_follow_from_the_phonetic_alphabet(ipa, phones):
    assert phones_of_ipa(ipa) == phones


def test_a_word_of_another_alphabet_is_named():
    with pytest.raises(NoPronunciation, match="猫"):
        read_by_rules("猫")


def test_without_a_reader_the_word_is_named(monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(NoPronunciation, match="'blorp'.*espeak-ng.*is missing"):
        read_by_rules("blorp")
