"""Pages call nothing in the event loop that waits for ROS, the disk or a lock, or takes the processor for long."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import nao_library_modules.console.pages as pages
from nao_library_modules.console.access.connections import LATE, console_time
from nao_library_modules.console.pages.frame import PageContext

FILES = sorted(Path(pages.__file__).parent.rglob("*.py"))
FUNCTIONS = {
    *("open", "model_of", "checked_for", "doubts", "stored_behaviors", "load", "safe_load", "read_layout"),
    *("read_protocol", "compose", "dump", "BehaviorDocument", "tracks_of", "table_of", "summaries_of", "replay_of"),
    *("schedule_of", "participants_of", "correct_pseudonym", "take_back"),
    *("as_python", "as_command", "as_yaml", "read_model", "project_behavior"),
}
"""What a module of pages may import and not call in the loop."""
METHODS = {
    *("get_param", "has_param", "Subscriber", "Publisher", "ServiceProxy", "wait_for_service", "wait_for_message"),
    *("call", "topic", "describe", "describe_all", "state_of", "servers", "has_service", "send_goal", "infos", "check"),
    *(
        "read_text",
        "read_bytes",
        "write_text",
        "write_bytes",
        "stat",
        "glob",
        "is_file",
        "exists",
        "get_path",
        "runs_on",
    ),
    *("protocols", "protocol_text", "newest_protocol", "store_protocol", "participants", "media", "studies", "trials"),
    *("trial", "open_trials", "resume", "save", "run", "Popen", "csv", "robot", "names", "shift", "stretch"),
    *("duplicate", "reorder", "undo", "redo", "set_field", "set_key", "set_parameter", "note", "deviation", "choose"),
}
"""Methods of robots, files and documents."""
BESIDE = {"work", "ask", "in_background", "do", "submit", "run_in_executor", "Thread", "partial", "begin", "_edit"}
"""Functions that have others called beside the event loop."""


def name_of(node):
    """What is called, or named: the last part of it."""
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def is_long(call):
    """Whether a call is of what may take a while."""
    return name_of(call.func) in (FUNCTIONS if isinstance(call.func, ast.Name) else METHODS)


def calls_in(function):
    """Calls of a function itself, without those of functions and lambdas in it."""
    found, left = [], list(ast.iter_child_nodes(function))
    while left:
        node = left.pop()
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            continue
        if isinstance(node, ast.Call):
            found.append(node)
        left += ast.iter_child_nodes(node)
    return found


def in_loop(tree):
    """Functions of a module that are not just called beside the event loop."""
    functions = [node for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and name_of(node.func) in BESIDE]
    given = [each for call in calls for each in (*call.args, *(keyword.value for keyword in call.keywords))]
    inner = [call for each in given if isinstance(each, ast.Lambda) for call in calls_in(each)]
    beside = {*map(name_of, given), *(name_of(call.func) for call in inner)} - {""}
    while True:
        called = {name_of(call.func) for each in functions if each.name in beside for call in calls_in(each)}
        if called <= beside:
            return [each for each in functions if each.name not in beside]
        beside |= called


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_pages_leave_to_threads_what_takes_a_while(path):
    found = [
        f"{path.name}:{call.lineno}: {function.name} calls {name_of(call.func)}"
        for function in in_loop(ast.parse(path.read_text()))
        for call in calls_in(function)
        if is_long(call)
    ]
    assert found == []


@pytest.mark.parametrize(
    "text, right",
    [
        ("async def show(self):\n    read_protocol(self.text)", False),
        ("async def show(self):\n    await self.page.work(read_protocol, self.text)", True),
        ("async def show(self):\n    await self.page.ask(lambda: self.robot.describe('NaoLights'))", True),
        ("def listen(self):\n    self.page.on_leave(self.robot.topic('feedback'))", False),
        ("def made():\n    return load(other())\n\nasync def show(self):\n    await in_background(made)", True),
    ],
)
def test_the_look_at_pages_finds_what_is_called_in_the_loop(text, right):
    found = [call for each in in_loop(ast.parse(text)) for call in calls_in(each) if is_long(call)]
    assert (not found) == right


def test_a_press_that_comes_late_is_told_and_not_passed_on():
    page, passed, told = object.__new__(PageContext), [], []
    page._handle_event, page.failed = passed.append, lambda _, reason: told.append(reason)
    late, fresh, typed = {"id": 1, "at": console_time() - 2 * LATE}, {"id": 2, "at": console_time()}, {"id": 3}
    for event in (late, fresh, typed):
        page._take_event(event)
    assert passed == [fresh, typed] and "late" in told[0]
