"""Files of ALSpeechRecognition: grammars as people write them, compiled grammars, lists of phrases."""

from __future__ import annotations

import json
from pathlib import Path

from nao_sim_bridge.base.config import TooLarge, read_bounded
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.hearing.grammars.bnf import BnfGrammar, GrammarError, parse_bnf
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

FORMAT = "nao_library compiled grammar 1"
LARGEST = 1_000_000
"""Bytes; a larger file is no grammar that somebody wrote."""


def compile_grammar(source: Path, target: Path, language: str) -> None:
    """Check a grammar and write it for `load_grammar`.

    A NaoqiError, which tells the line, when the source cannot be read or is no grammar; a FileTrouble when the target
    cannot be written.
    """
    text = _text(source)
    _parsed(text, source)
    content = {"format": FORMAT, "language": language, "grammar": text}
    write_whole(target, json.dumps(content, indent=1).encode())


def load_grammar(path: Path) -> tuple[BnfGrammar, int]:
    """A compiled grammar, and its characters; a NaoqiError when the file is none."""
    text = _text(path)
    try:
        content = json.loads(text)
        if content["format"] != FORMAT:
            raise ValueError(content["format"])
        grammar = content["grammar"]
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise NaoqiError(f"file {path.name!r} is no compiled grammar; make one of a BNF file with compile()") from error
    return _parsed(grammar, path), len(str(grammar))


def read_vocabulary(path: Path) -> list[str]:
    """Phrases of a file, one a line; empty lines and lines that begin with # are left out.

    A NaoqiError when the file cannot be read or has none.
    """
    lines = [line.strip() for line in _text(path).splitlines()]
    phrases = [line for line in lines if line and not line.startswith("#")]
    if not phrases:
        raise NaoqiError(f"file {path.name!r} has no phrases")
    return phrases


def _parsed(text: object, path: Path) -> BnfGrammar:
    try:
        return parse_bnf(str(text))
    except GrammarError as error:
        raise NaoqiError(f"grammar {path.name!r}, {error}") from error


def _text(path: Path) -> str:
    try:
        return read_bounded(path, LARGEST).decode("utf-8-sig")
    except TooLarge as error:
        raise NaoqiError(f"file {path.name!r} {error}") from error
    except (OSError, UnicodeDecodeError) as error:
        raise NaoqiError(f"file {path.name!r} cannot be read: {error}") from error
