"""Phrases as clients write them, cut into the words that a person says; numbers as a person reads them."""

from __future__ import annotations

import re
import unicodedata

from nao_sim_bridge.base.errors import BadValue

SIGNS = {"&": " and ", "+": " plus ", "=": " equals ", "@": " at "}
QUOTES = str.maketrans({"’": "'", "‘": "'", "`": "'", "´": "'"})
# A token: a number with what belongs to it, letters with dots between ("U.S."), or a word with apostrophes.
TOKEN = re.compile(r"\d+(?:\.\d+)?(?:st|nd|rd|th)?%?|(?:[^\W\d_]\.){2,}|[^\W\d_]+(?:'[^\W\d_]+)*'?", re.IGNORECASE)
THOUSANDS = re.compile(r"(?<=\d),(?=\d{3}(?:\D|$))")
ONES = (
    "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen "
    "eighteen nineteen"
).split()
TENS = "twenty thirty forty fifty sixty seventy eighty ninety".split()
SCALES = ((10**9, "billion"), (10**6, "million"), (1000, "thousand"), (100, "hundred"))
ORDINALS = {
    "one": "first",
    "two": "second",
    "three": "third",
    "five": "fifth",
    "eight": "eighth",
    "nine": "ninth",
    "twelve": "twelfth",
}
# Longer ones are said digit by digit, as a telephone number.
MOST_DIGITS = 12
NUMBER = re.compile(r"(\d+)(?:\.(\d+))?(st|nd|rd|th|%)?$", re.IGNORECASE)


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


def number_words(text: str) -> list[str] | None:
    """Words of a number ("21", "3.5", "2nd", "50%"); None for what is none."""
    match = NUMBER.match(text)
    if match is None:
        return None
    whole, fraction, ending = match.groups()
    if len(whole) > MOST_DIGITS or (len(whole) > 1 and whole.startswith("0")):
        words = [ONES[int(digit)] for digit in whole]
    else:
        words = cardinal(int(whole))
    if fraction is not None:
        words += ["point", *(ONES[int(digit)] for digit in fraction)]
    if ending == "%":
        return [*words, "percent"]
    return [*words[:-1], ordinal(words[-1])] if ending else words


def cardinal(number: int) -> list[str]:
    """Words of a number that is not negative."""
    if number < 20:
        return [ONES[number]]
    if number < 100:
        tens, ones = divmod(number, 10)
        return [TENS[tens - 2], *([ONES[ones]] if ones else [])]
    for size, name in SCALES:
        if number >= size:
            count, rest = divmod(number, size)
            return [*cardinal(count), name, *(cardinal(rest) if rest else [])]
    raise AssertionError(number)  # every number from 100 on has a scale


def ordinal(word: str) -> str:
    """The last word of a number, counting: "one" becomes "first"."""
    if word in ORDINALS:
        return ORDINALS[word]
    return word[:-1] + "ieth" if word.endswith("y") else word + "th"
