"""Grammar files: what is read, what is refused with its line, and what contexts make of it."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import BadValue, UnknownName
from nao_sim_bridge.sim.hearing import grammar as g
from nao_sim_bridge.sim.hearing.bnf import GrammarError, parse_bnf
from nao_sim_bridge.sim.hearing.contexts import ContextError, Contexts

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


def test_a_grammar_says_what_it_describes(contexts):
    contexts.put("house", contexts.get("house").with_slot("room", ["kitchen"]))
    said = sentences(contexts.get("house").root())
    assert {"turn on the light", "turn off the light in the kitchen if you may", "good bye bye"} <= said
    assert len(said) == 2 * 2 * 3 + 2


def test_an_empty_slot_cannot_be_said(contexts):
    assert not [s for s in sentences(contexts.get("house").root()) if " in the" in s]


def test_rules_are_switched(contexts):
    context = contexts.get("house").switched("polite", False).switched("end", False)
    assert sentences(context.root()) == {"turn on the light", "turn off the light"}
    assert context.rules("active") == ["order"]
    assert context.all_switched(True).rules("active") == ["order", "end", "polite"]
    assert sentences(context.all_switched(False).root()) == set()


def test_rules_are_listed_by_type(contexts):
    house = contexts.get("house")
    assert house.rules("start") == ["order", "end"]
    assert house.rules("activatable") == ["order", "end", "polite"]
    assert house.rules("slot") == ["room"]
    with pytest.raises(BadValue, match="start, active, activatable, slot"):
        house.rules("stop")


@pytest.mark.parametrize("change", [lambda c: c.switched("room", True), lambda c: c.with_slot("order", ["x"])])
def test_a_rule_of_another_type_is_refused(contexts, change):
    with pytest.raises(UnknownName):
        change(contexts.get("house"))


@pytest.mark.parametrize(
    "text, problem",
    [
        ("!grammar x;", "line 1: does not begin"),
        ("#BNF+EM V2.1;\n!grammar x;", "no start rule"),
        ("#BNF+EM V2.1;\n!start <a>;\n<a>: b;", "no name"),
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: b <c>;", "line 4: unknown rule <c>"),
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: b <a>;", "uses itself: a > a"),
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: (b | c;", "line 4"),
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: b", "ends in the middle"),
        ("#BNF+EM V2.1;\n!grammar x;\n!stop <a>;", "line 3: unknown directive !stop"),
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: b;\n<a>: c;", "line 5: rule <a> is there already"),
        ("#BNF+EM V2.1;\n!grammar x;\n!start <a>;\n<a>: !repeat(b, 3, 2);", "line 4: !repeat from 3 to 2"),
    ],
)
def test_a_bad_grammar_is_refused_with_its_place(text, problem):
    with pytest.raises(GrammarError, match=problem.replace("(", r"\(")):
        parse_bnf(text)


def test_rules_that_double_each_other_are_read_at_once():
    rules = "".join(f"<r{i}>: <r{i + 1}> <r{i + 1}>;\n" for i in range(60))
    bnf = parse_bnf(f"#BNF+EM V2.1;\n!grammar x;\n!start <r0>;\n{rules}<r60>: word;\n")
    contexts = Contexts()
    contexts.add("deep", bnf)
    assert list(contexts.grammars())


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
