"""Numbers as English words: what a person says who reads digits."""

from __future__ import annotations

import re

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
