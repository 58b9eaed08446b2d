"""libqi type signatures in words: `(s[f])` becomes `string, list of float`."""

from __future__ import annotations

from typing import List, Tuple

WORDS = {
    "v": "nothing",
    "b": "bool",
    "c": "int8",
    "C": "uint8",
    "w": "int16",
    "W": "uint16",
    "i": "int",
    "I": "uint",
    "l": "int64",
    "L": "uint64",
    "f": "float",
    "d": "double",
    "s": "string",
    "m": "any value",
    "o": "object",
    "r": "raw bytes",
    "X": "unknown",
}
PREFIXES = {"#": "any number of", "~": "named", "+": "optional"}
CLOSING = {"(": ")", "[": "]", "{": "}"}
ANY_ARGUMENTS = "m"
"""As parameters of a method, without brackets: it looks at the arguments itself."""


def readable_type(signature: str) -> str:
    """Words for one type.

    `signature`: a libqi signature such as `[(sf)]`. Returns its meaning, such as `list of (string, float)`; the
    signature itself where it is not understood.
    """
    try:
        text, rest = _read_type(signature)
    except (IndexError, KeyError):
        return signature
    return signature if rest else text


def readable_call(method: str, parameters: str) -> str:
    """Words for a method with its parameters.

    `method`: name of the method. `parameters`: its parameters as libqi writes them, such as `(sf)`. Returns text such
    as `setIntensity(string, float)`.
    """
    try:
        return f"{method}({', '.join(readable_parameters(parameters))})"
    except (IndexError, KeyError):
        return f"{method}{parameters}"


def readable_parameters(parameters: str) -> List[str]:
    """Words for each parameter of a method; `...` stands for any number of any values."""
    if parameters == ANY_ARGUMENTS:
        return ["..."]
    words, rest = [], parameters[1:-1]
    while rest:
        text, rest = _read_type(rest)
        words.append(text)
    return words


def mentions_raw(signature: str) -> bool:
    """Whether a signature holds raw bytes; struct and field names between < and > do not count."""
    depth = 0
    for letter in signature:
        depth += (letter == "<") - (letter == ">")
        if letter == "r" and depth == 0:
            return True
    return False


def _read_type(signature: str) -> Tuple[str, str]:
    """Read one type off the front; return its words and what is left of the signature."""
    letter, rest = signature[0], signature[1:]
    if letter in PREFIXES:
        text, rest = _read_type(rest)
        return f"{PREFIXES[letter]} {text}", rest
    if letter not in CLOSING:
        return WORDS[letter], rest
    members = []
    while rest[0] != CLOSING[letter]:
        text, rest = _read_type(rest)
        members.append(text)
    rest = _skip_annotation(rest[1:])
    if letter == "(":
        return f"({', '.join(members)})", rest
    if letter == "[":
        return f"list of {members[0]}", rest
    return f"map of {members[0]} to {members[1]}", rest


def _skip_annotation(signature: str) -> str:
    """Drop the names a struct carries: `<Name,field,field>`."""
    if not signature.startswith("<"):
        return signature
    depth = 0
    for index, letter in enumerate(signature):
        depth += (letter == "<") - (letter == ">")
        if depth == 0:
            return signature[index + 1 :]
    raise IndexError(signature)
