"""What `${...}` stands for."""

from __future__ import annotations

import pytest

from nao_library_modules.behaviors.expressions import BadExpression, escaped, names_in, substitute

VALUES = {"n": 3, "x": 0.5, "text": "hi", "flag": True, "names": ["a", "b"]}


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("${n}", 3),
        ("${flag}", True),
        ("${names}", ["a", "b"]),
        ("${n / 2}", 1.5),
        ("${-(n + 1) * x}", -2.0),
        ("say ${text}, ${n} times, ${x}", "say hi, 3 times, 0.5"),
        ("${n * 1.0}x", "3x"),
        ("${flag}!", "true!"),
        ("${names}!", "a, b!"),
        ("$${n} and ${n}", "${n} and 3"),
        ("$${n}", "${n}"),
        ({"a": ["${x}", {"b": "${n}"}]}, {"a": [0.5, {"b": 3}]}),
        (4, 4),
    ],
)
def test_values(value, expected):
    result = substitute(value, VALUES)
    assert result == expected and type(result) is type(expected)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("${m}", "there is no parameter 'm'"),
        ("${txt}", "did you mean 'text'"),
        ("${n", "its } is missing"),
        ("${}", "cannot be read"),
        ("${n +}", "cannot be read"),
        ("${n ** 9999999}", "cannot be read"),
        ("${n(3)}", "cannot be read"),
        ("${n.real}", "cannot be read"),
        ("${'a' * 9}", "cannot be read"),
        ("${n / 0}", "divides by zero"),
        ("${1e308 * 1e308}", "too large"),
        ("${text + 1}", "'hi' is no number"),
        ("${flag + 1}", "no number"),
        ("${" + "1+" * 150 + "1}", "characters"),
    ],
)
def test_what_cannot_be_worked_out_is_told(text, told):
    with pytest.raises(BadExpression, match=".*"):
        substitute(text, VALUES)
    try:
        substitute(text, VALUES)
    except BadExpression as error:
        assert told in str(error)


def test_names_are_found_everywhere():
    assert sorted(names_in({"a": ["${x + n}", "$${no}", 3], "b": "${text}"})) == ["n", "text", "x"]


@pytest.mark.parametrize("text", ["${n}", "$${n}", "$$${n}", "a ${ b", "$$", "}{$", ["${x}"], {"a": "${"}])
def test_escaped_values_stay_as_they_are(text):
    assert substitute(escaped(text), VALUES) == text
