"""Grammars become networks: what can be said on the ways from start to end."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.hearing import grammar as g
from nao_sim_bridge.sim.hearing.network import MOST_ARCS, OTHER, build, spoken_word


def word(text):
    return g.Words((text,), text)


def made(*roots, other=("AA", "S")):
    grammars = [g.Grammar(f"g{i}", root) for i, root in enumerate(roots)]
    return build(grammars, lambda spoken: [spoken.upper()], other)


def said(network, most=4):
    """Everything of up to so many tokens that leads from start to end, as words."""
    found, seen = set(), set()
    ways = [(network.start, ())]
    while ways:
        state, tokens = ways.pop()
        if (state, tokens) in seen:
            continue
        seen.add((state, tokens))
        if state == network.end:
            found.add(" ".join(tokens))
        for arc in network.arcs:
            if arc.start == state:
                more = () if arc.token is None else (spoken_word(arc.token),)
                if len(tokens) + len(more) <= most:
                    ways.append((arc.end, tokens + more))
    return found


def test_words_follow_each_other():
    assert said(made(g.words("stand up"))) == {"stand up"}


def test_any_grammar_may_be_said_and_is_known_by_its_words():
    network = made(word("yes"), g.Choice((word("no"), word("maybe"))))
    assert said(network) == {"yes", "no", "maybe"}
    assert {spoken_word(name): token.grammar for name, token in network.tokens.items()} == {
        "yes": "g0",
        "no": "g1",
        "maybe": "g1",
    }


def test_only_the_first_word_tells_what_was_heard():
    network = made(g.words("Stand up!"))
    assert [token.heard for token in network.tokens.values()] == ["Stand up!", ""]
    assert [token.phones for token in network.tokens.values()] == [["STAND"], ["UP"]]


@pytest.mark.parametrize(
    "least, most, wanted",
    [
        (0, 1, {"", "no"}),
        (1, 2, {"no", "no no"}),
        (2, 2, {"no no"}),
        (0, None, {"", "no", "no no", "no no no"}),
        (2, None, {"no no", "no no no"}),
    ],
)
def test_parts_are_repeated(least, most, wanted):
    assert said(made(g.Repeat(word("no"), least, most)), most=3) == wanted


def test_a_loop_cannot_be_left_before_what_follows_it():
    network = made(g.Sequence((word("a"), g.Repeat(word("b"), 0, None), word("c"))))
    assert said(network, most=3) == {"a c", "a b c"}


def test_nothing_and_never():
    assert said(made(g.Sequence(()))) == {""}
    assert said(made(g.Choice(()))) == set()


def test_other_speech_is_any_row_of_sounds():
    network = made(g.Sequence((g.Anything(), word("yes"))))
    words = said(network, most=3)
    assert {"yes", "OTHER-written yes", "OTHER-written OTHER-written yes"} == words
    others = {name: token for name, token in network.tokens.items() if name.startswith(OTHER)}
    assert sorted(token.phones[0] for token in others.values()) == ["AA", "S"]
    assert {token.heard for token in others.values()} == {g.OTHER_SPEECH}


def test_other_speech_that_is_not_written_is_not_heard():
    network = made(g.vocabulary("v", ["yes"], word_spotting=True).root)
    assert {token.heard for token in network.tokens.values()} == {"", "<...> yes <...>"}


def test_too_large_a_grammar_is_refused():
    with pytest.raises(BadValue, match="smaller"):
        made(g.Repeat(word("no"), MOST_ARCS, MOST_ARCS))
