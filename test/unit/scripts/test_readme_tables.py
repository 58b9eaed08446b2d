"""README.md and docs/*.md say what the code says."""

from __future__ import annotations

import ast
import re

import actionlib
import pytest
import readme_tables
import rospy
from actionlib_msgs.msg import GoalStatus
from readme_tables import DOCUMENTS, ReadmeError, fill, functions_table, launch_default, table, untold

from nao_library_actions.msg import NaoLedResult
from nao_sim_bridge.cli import parser

ONE = "before\n<!-- begin: one -->\n{}<!-- end: one -->\nafter\n"


@pytest.fixture(scope="module")
def tables():
    return readme_tables.all_tables()


@pytest.fixture(scope="module")
def lights():
    servers = {server.name: server for server in readme_tables.find_servers()}
    return servers["NaoLights"]


def cells(text):
    """Rows of a Markdown table below its head, without code type."""
    return [[cell.strip(" `") for cell in line.strip("|").split(" | ")] for line in text.splitlines()[2:]]


# Marks


def test_what_stands_between_the_marks_is_replaced_and_the_rest_stays():
    assert fill(ONE.format("old\n"), {"one": "new"}) == ONE.format("\nnew\n\n")


def test_filling_twice_changes_nothing():
    once = fill(ONE.format(""), {"one": r"new \1"})
    assert fill(once, {"one": r"new \1"}) == once


@pytest.mark.parametrize(
    "text, names, complaint",
    [
        (ONE.format(""), {"two": ""}, "there is no table 'one'; there are: two"),
        ("<!-- begin: one -->\n<!-- end: two -->\n", {"one": "", "two": ""}, "not followed by its 'end: one'"),
        ("<!-- begin: one -->\n" + ONE.format(""), {"one": ""}, "not followed by its 'end: one'"),
        (ONE.format("") + "<!-- begin: one -->\n", {"one": ""}, "a mark has no partner"),
        ("<!-- end: one -->\n" + ONE.format(""), {"one": ""}, "a mark has no partner"),
    ],
)
def test_marks_and_tables_must_belong_together(text, names, complaint):
    with pytest.raises(ReadmeError, match=re.escape(complaint)):
        fill(text, names)


# Tables


def test_a_bar_inside_a_cell_does_not_end_it():
    assert table(("a", "b"), [("x|y", "z")]).splitlines()[2] == r"| x\|y | z |"


@pytest.mark.parametrize(
    "default, text",
    [
        ("false", "`false`"),
        ("$(optenv NAO_IP 127.0.0.1)", "`127.0.0.1`"),
        ("$(eval float(arg('speed')) != 1.0)", "depends on `speed`"),
        ("", "–"),
    ],
)
def test_defaults_of_launch_files_are_told_in_words(default, text):
    assert launch_default(default) == text


def test_a_function_is_told_with_the_fields_it_takes_and_its_first_line():
    def fade(lights, duration):
        """Fade them.

        Slowly.
        """

    def listLEDs():
        """Names."""

    assert cells(functions_table({"fade": fade, "listLEDs": listLEDs})) == [
        ["fade", "lights`, `duration", "Fade them."],
        ["listLEDs", "–", "Names."],
    ]


def test_a_function_without_docstring_is_refused():
    with pytest.raises(ReadmeError, match="has no docstring"):
        functions_table({"on": lambda lights: None})


def test_the_light_server_presents_itself(lights):
    assert (lights.action, lights.message) == ("NaoLedAction", "LedFunction")
    assert {"setIntensity", "setColor", "fadeListRGB"} <= set(lights.functions)
    assert "getData" not in lights.functions


def test_every_field_that_is_told_is_a_field_of_the_message(lights, tables):
    from nao_library_msgs.msg import LedFunction

    for rows in (cells(tables["functions NaoLights"]), cells(tables["memory functions"])):
        assert rows
        for _, fields, _ in rows:
            assert set(re.findall(r"\w+", fields)) <= set(LedFunction.__slots__), fields


def test_every_option_of_the_simulator_is_told(tables):
    told = {row[0]: row[1] for row in cells(tables["simulator options"])}
    help_text = parser("nao_sim").format_help()
    assert set(told) == set(re.findall(r"--[\w-]+", help_text)) - {"--help"}
    assert told["--port"] == "9559" and told["--gui"] == "off"


def test_no_more_methods_are_answered_than_the_robot_has(tables):
    rows = {module: (int(answered), int(of)) for module, answered, of in cells(tables["naoqi"])}
    assert {"ALLeds", "ALMemory", "ALMotion", "ALSystem"} <= set(rows)
    assert all(0 < answered <= of for answered, of in rows.values())


# The documents


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_a_document_is_up_to_date(tables, document):
    text = document.read_text(encoding="utf-8")
    assert fill(text, tables) == text, "run 'make docs'"


def test_every_table_is_told(tables):
    assert untold([document.read_text(encoding="utf-8") for document in DOCUMENTS], tables) == []


def test_a_table_that_nobody_tells_is_named(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(readme_tables, "all_tables", lambda: {"one": "new", "two": "new"})
    file = tmp_path / "README.md"
    file.write_text(ONE.format(""), encoding="utf-8")
    assert readme_tables.main([str(file)]) == 1
    assert "nobody has marks for two" in capsys.readouterr().err


def test_check_tells_by_its_status_and_writes_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(readme_tables, "all_tables", lambda: {"one": "new"})
    file = tmp_path / "README.md"
    file.write_text(ONE.format("old\n"))
    assert readme_tables.main(["--check", str(file)]) == 1
    assert "run 'make docs'" in capsys.readouterr().err
    assert file.read_text() == ONE.format("old\n")
    assert readme_tables.main([str(file)]) == 0
    assert readme_tables.main(["--check", str(file)]) == 0


def test_marks_that_do_not_fit_are_told_and_nothing_is_written(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(readme_tables, "all_tables", lambda: {"two": "new"})
    file = tmp_path / "README.md"
    file.write_text(ONE.format("old\n"))
    assert readme_tables.main([str(file)]) == 1
    assert "there is no table 'one'" in capsys.readouterr().err
    assert file.read_text() == ONE.format("old\n")


# Programs in README.md


def programs():
    return re.findall(r"```python\n(.*?)```", DOCUMENTS[0].read_text(encoding="utf-8"), re.DOTALL)


def test_every_program_compiles():
    assert len(programs()) >= 2
    for program in programs():
        compile(program, "README.md", "exec")


def test_the_printed_client_is_the_example_without_its_docstring():
    example = ast.parse(readme_tables.CLIENT.read_text(encoding="utf-8"))
    assert ast.get_docstring(example)
    del example.body[0]
    assert ast.dump(ast.parse(programs()[0])) == ast.dump(example)


def test_the_printed_client_asks_for_functions_with_fields_that_they_take(lights, monkeypatch, capsys):
    goals = []

    class Client:
        def __init__(self, name, action):
            assert (name, action.__name__) == (lights.name, lights.action)

        def wait_for_server(self):
            return True

        def send_goal_and_wait(self, goal):
            goals.append(goal)
            return GoalStatus.SUCCEEDED

        def get_goal_status_text(self):
            return ""

        def get_result(self):
            return NaoLedResult(memList=["0.75"])

    monkeypatch.setattr(actionlib, "SimpleActionClient", Client)
    monkeypatch.setattr(rospy, "init_node", lambda name: None)
    exec(compile(programs()[0], "README.md", "exec"), {})
    assert capsys.readouterr().out == "['0.75']\n"
    (goal,) = goals
    functions = {**readme_tables.memory_functions(), **lights.functions}
    empty = type(goal.functions[0])()
    for message in goal.functions:
        given = {name for name in message.__slots__ if getattr(message, name) != getattr(empty, name)}
        taken = functions_table({message.function: functions[message.function]})
        assert given - {"function", "time"} <= set(re.findall(r"`(\w+)`", taken)), message.function
