"""Phrases and grammar files, what contexts make of them, and networks of what can be said."""

from __future__ import annotations

import pytest

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.hearing.grammars import grammar as g
from nao_sim_bridge.hearing.grammars.bnf import GrammarError, parse_bnf
from nao_sim_bridge.hearing.grammars.contexts import ContextError, Contexts
from nao_sim_bridge.hearing.grammars.grammar import spoken_words
from nao_sim_bridge.hearing.network import MOST_ARCS, build, spoken_word
from nao_sim_bridge.hearing.pronunciation import Pronouncer, phones_of_ipa

HOUSE = """#BNF+EM V2.1;
!grammar House; // of a flat
!start <order>, <end>;
!activatable <polite>;
!slot <room>;
/* what can
   be done */
<order>: turn (on | off) the light [in the <room>] !optional(<polite>);
<polite>: please | "if you may";
<end>: good !repeat(bye, 2, 3);
"""


def sentences(node):
    """All that can be said, as the words heard; only for nodes without endless repeats."""
    if isinstance(node, g.Words):
        return {node.heard}
    if isinstance(node, g.Anything):
        return {g.OTHER_SPEECH}
    if isinstance(node, g.Choice):
        return set().union(*map(sentences, node.parts)) if node.parts else set()
    if isinstance(node, g.Sequence):
        said = {""}
        for part in node.parts:
            said = {f"{a} {b}".strip() for a in said for b in sentences(part)}
        return said
    rows = (g.Sequence((node.part,) * count) for count in range(node.least, node.most + 1))
    return set().union(*map(sentences, rows))


@pytest.fixture
def contexts():
    made = Contexts()
    made.add("house", parse_bnf(HOUSE))
    return made


@pytest.mark.parametrize(
    "phrase, words",
    [
        ("Stand up!", "stand up"),
        ("  I don’t KNOW. ", "i don't know"),
        ("room 21", "room twenty one"),
        ("the 2nd and 30th", "the second and thirtieth"),
        ("1,234", "one thousand two hundred thirty four"),
        ("007", "zero zero seven"),
        ("50% of it", "fifty percent of it"),
        ("the U.S.A.", "the u s a"),
    ],
)
def test_phrases_become_the_words_that_people_say(phrase, words):
    assert spoken_words(phrase) == words.split()


@pytest.mark.parametrize("phrase", ["", "?!"])
def test_a_phrase_without_words_is_refused(phrase):
    with pytest.raises(BadValue, match="at least one word"):
        spoken_words(phrase)


def test_a_grammar_says_what_it_describes(contexts):
    assert not [s for s in sentences(contexts.get("house").root()) if " in the" in s]  # the slot is empty
    contexts.put("house", contexts.get("house").with_slot("room", ["kitchen"]))
    said = sentences(contexts.get("house").root())
    assert {"turn on the light", "turn off the light in the kitchen if you may", "good bye bye"} <= said
    assert len(said) == 2 * 2 * 3 + 2


def test_rules_are_switched(contexts):
    context = contexts.get("house").switched("polite", False).switched("end", False)
    assert sentences(context.root()) == {"turn on the light", "turn off the light"}
    assert context.rules("active") == ["order"]
    assert context.all_switched(True).rules("active") == ["order", "end", "polite"]
    assert sentences(context.all_switched(False).root()) == set()


@pytest.mark.parametrize(
    "text, problem",
    [
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: b <c>;", "line 4: unknown rule <c>"),
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: b <a>;", "uses itself: a > a"),
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: (b | c;", "line 4"),
        ("#BNF+EM V2.1;\n!grammar x;\n!stop <a>;", "line 3: unknown directive !stop"),
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: !repeat(b, 3, 2);", "line 4: !repeat from 3 to 2"),
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: !repeat(b, 3, \N{SUPERSCRIPT TWO});", "line 4: expected a"),
    ],
)
def test_a_bad_grammar_is_refused_with_its_place(text, problem):
    with pytest.raises(GrammarError, match=problem.replace("(", r"\(")):
        parse_bnf(text)


def test_contexts_are_put_aside_saved_and_taken_back(contexts):
    contexts.save("mine")
    contexts.push()
    assert contexts.names() == []
    contexts.pop()
    assert contexts.names() == ["house"]
    contexts.clear()
    contexts.load("mine")
    assert contexts.names() == ["house"]
    contexts.erase("mine")
    with pytest.raises(UnknownName, match="saved context set 'mine'"):
        contexts.load("mine")
    with pytest.raises(ContextError, match="no contexts have been pushed"):
        contexts.pop()
    with pytest.raises(ContextError, match="already exists"):
        contexts.add("house", parse_bnf(HOUSE))


def word(text):
    return g.Words((text,), text)


def made(*roots, other=("AA", "S")):
    grammars = [g.Grammar(f"g{i}", root) for i, root in enumerate(roots)]
    return build(grammars, lambda spoken: [spoken.upper()], other)


def said(network, most=4):
    """Everything of up to so many tokens that leads from start to end, as words."""
    found, seen, ways = set(), set(), [(network.start, ())]
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


def test_any_grammar_may_be_said_and_is_known_by_its_words():
    network = made(word("yes"), g.Choice((word("no"), word("maybe"))))
    assert said(network) == {"yes", "no", "maybe"}
    grammars = {spoken_word(name): token.grammar for name, token in network.tokens.items()}
    assert grammars == {"yes": "g0", "no": "g1", "maybe": "g1"}
    assert said(made(g.Sequence(()))) == {""} and said(made(g.Choice(()))) == set()


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
def test_parts_are_repeated_and_loops_are_left_only_where_they_end(least, most, wanted):
    assert said(made(g.Repeat(word("no"), least, most)), most=3) == wanted
    loop = made(g.Sequence((word("a"), g.Repeat(word("no"), least, most), word("c"))))
    assert said(loop, most=5) == {" ".join(f"a {w} c".split()) for w in wanted}


def test_too_large_a_grammar_is_refused():
    with pytest.raises(BadValue, match="smaller"):
        made(g.Repeat(word("no"), MOST_ARCS, MOST_ARCS))


def test_pronunciations_are_those_of_the_dictionary(tmp_path):
    (tmp_path / "words.dict").write_text("read R IY D\nread(2) R EH D\nrobot R OW B AA T\n")
    pronouncer = Pronouncer(tmp_path / "words.dict")
    assert pronouncer.phones("read") == ["R IY D", "R EH D"]
    assert pronouncer.phones("robot's") == ["R OW B AA T S"]
    for ipa, phones in [("nˈaʊ", "N AW"), ("tʃˈɜːtʃ", "CH ER CH"), ("(en)bˈeɪkə(fr)", "B EY K AH"), ("ʘ", "")]:
        assert phones_of_ipa(ipa) == phones
