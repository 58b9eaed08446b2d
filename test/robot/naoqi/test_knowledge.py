"""ALKnowledge: triples of programs, kept in a file of the robot."""

import pytest

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.naoqi.system.knowledge import FILE, ALKnowledge
from nao_sim_bridge.naoqi.system.knowledge_store import LEARNING

MEAL = (LEARNING, "user1", "eat", "pizza")


@pytest.fixture
def knowledge(robot):
    return robot.ALKnowledge


def test_triples_are_added_asked_for_and_removed(knowledge):
    for subject, colour in (("sky", "blue"), ("smurf", "blue"), ("smurf", "white")):
        knowledge.add("tutorial", subject, "hasColor", colour)
    assert knowledge.getSubject("tutorial", "hasColor", "blue") == ["sky", "smurf"]
    assert knowledge.getPredicate("tutorial", "sky", "blue") == ["hasColor"]
    assert knowledge.getObject("tutorial", "smurf", "hasColor") == ["blue", "white"]
    knowledge.update("tutorial", "smurf", "hasColor", "red")
    assert knowledge.query("tutorial", "smurf", "hasColor", "?") == ["red"]
    assert knowledge.query("tutorial", "?", "hasColor", "*") == ["sky", "smurf"]
    assert knowledge.contains("tutorial", "smurf", "hasColor", "*") is True
    assert knowledge.queryTriplet("tutorial", "*", "hasColor", "*") == [
        ["tutorial", "sky", "hasColor", "blue"],
        ["tutorial", "smurf", "hasColor", "red"],
    ]
    knowledge.remove("tutorial", "smurf", "*", "*")
    assert knowledge.contains("tutorial", "smurf", "hasColor", "red") is False
    knowledge.resetKnowledge("tutorial")
    assert knowledge.queryTriplet("tutorial", "*", "*", "*") == []


def test_metadata_belong_to_a_triple_whether_it_is_there_or_not(knowledge):
    knowledge.add(*MEAL)
    for friend in ("user2", "user3"):
        assert knowledge.addMetadata(*MEAL, "with", friend) is True
    assert knowledge.query(LEARNING, "?", "eat", "pizza", "with", "user2") == ["user1"]
    assert knowledge.query(*MEAL, "with", "?") == knowledge.queryMetadata(*MEAL, "with") == ["user2", "user3"]
    assert knowledge.queryTriplet(LEARNING, "*", "*", "*", "with", "*") == [list(MEAL)]
    assert knowledge.updateMetadata(*MEAL, "with", "user4") is True
    assert knowledge.queryMetadata(*MEAL, "with", "?") == ["user4"]
    knowledge.remove(*MEAL)
    assert knowledge.containsMetadata(*MEAL, "with", "*") is True and knowledge.query(*MEAL, "with", "?") == []
    assert knowledge.queryTripletWithMetadata(*MEAL, "with", "*", False) == [[*MEAL, "with", "user4"]]
    assert knowledge.queryTripletWithMetadata(*MEAL, "with", "*", True) == []
    assert knowledge.removeMetadata(*MEAL, "with", "user4") is True
    assert knowledge.containsMetadata(*MEAL, "with", "*") is False
    key = knowledge.getId(*MEAL)
    assert knowledge.getTripletFromId(LEARNING, key) == list(MEAL[1:])
    assert knowledge.getTripletFromId(LEARNING, "1") == []
    assert knowledge.addMetadata("tutorial", *MEAL[1:], "with", "user2") is False


def test_a_triple_is_gone_after_its_date_and_another_is_there_from_it_on(knowledge):
    knowledge.addExpirationDate(*MEAL, "2100-01-01T00:00:00Z")
    assert knowledge.contains(*MEAL) is True
    knowledge.updateExpirationDate(*MEAL, "2000-01-01T00:00:00Z")
    assert knowledge.contains(*MEAL) is False
    knowledge.addHappeningDate(*MEAL, "P1D")
    assert knowledge.contains(*MEAL) is False
    knowledge.updateHappeningDate(*MEAL, "2000-01-01T00:00:00Z")
    assert knowledge.contains(*MEAL) is True


def test_another_run_of_the_simulator_knows_it_but_nothing_that_was_refused(robot, knowledge):
    knowledge.add(*MEAL)
    with pytest.raises(RuntimeError, match="addExpirationDate expirationDate is 'soon', allowed is a date such as"):
        knowledge.addExpirationDate(LEARNING, "user1", "eat", "salad", "soon")
    with pytest.raises(RuntimeError, match="only com.aldebaran.learning has metadata"):
        knowledge.addExpirationDate("tutorial", "a", "b", "c", "2100-01-01T00:00:00Z")
    again = ALKnowledge(ClientFiles(robot.server.files.folder))
    for one in (knowledge, again):
        assert one.queryTriplet(LEARNING, "*", "*", "*") == [list(MEAL)]


def test_questions_are_answered_also_when_the_file_cannot_be_written(robot, knowledge):
    knowledge.addHappeningDate(*MEAL, "2000-01-01T00:00:00Z")
    file = robot.server.files.folder / FILE
    file.unlink()
    file.mkdir()
    assert knowledge.contains(*MEAL) is True
    with pytest.raises(RuntimeError, match="knowledge.json' cannot be written"):
        knowledge.add("tutorial", "sky", "hasColor", "blue")


def test_questions_without_a_question_and_wildcards_that_are_no_questions_are_refused(refuses):
    refuses("ALKnowledge", """
        query('a', 'b', 'c', 'd') -> query is .*, allowed is one \\? for what is asked for
        query('a', '?', '?', 'd') -> query is .*, allowed is one \\? for what is asked for
        add('a', '*', 'c', 'd') -> subject is '\\*', allowed is something else than
    """)  # fmt: skip
