"""Phrases as clients write them, cut into the words that a person says."""

from __future__ import annotations

import re
import unicodedata

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.hearing.grammars.number_words import number_words

SIGNS = {"&": " and ", "+": " plus ", "=": " equals ", "@": " at "}
QUOTES = str.maketrans({"’": "'", "‘": "'", "`": "'", "´": "'"})
# A token: a number with what belongs to it, letters with dots between ("U.S."), or a word with apostrophes.
TOKEN = re.compile(r"\d+(?:\.\d+)?(?:st|nd|rd|th)?%?|(?:[^\W\d_]\.){2,}|[^\W\d_]+(?:'[^\W\d_]+)*'?", re.IGNORECASE)
THOUSANDS = re.compile(r"(?<=\d),(?=\d{3}(?:\D|$))")


def spoken_words(phrase: str) -> list[str]:
    """The words of a phrase in lower case: without punctuation, numbers written out.

    Raises:
        BadValue: The phrase has no word.
    """
    text = unicodedata.normalize("NFC", phrase).translate(QUOTES)
    for sign, word in SIGNS.items():
        text = text.replace(sign, word)
    words: list[str] = []
    for token in TOKEN.findall(THOUSANDS.sub("", text)):
        if token[0].isdigit():
            words += number_words(token) or []
        elif "." in token:
            words += [letter.lower() for letter in token if letter.isalpha()]
        else:
            words.append(token.lower())
    if not words:
        raise BadValue("phrase", phrase, "at least one word or number")
    return words
