"""What opens over a page of the console, from its code and as a person opens it."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from pathlib import Path

import nao_library_modules.console.pages as pages

FOLDER = Path(pages.__file__).parent
OPENERS = {
    *("dialog", "select", "menu", "context_menu", "dropdown_button", "color_input", "color_picker", "date_input"),
    *("time_input", "left_drawer", "right_drawer", "drawer", "footer", "page_sticky", "fab"),
}
"""Elements of NiceGUI that open, or stand, over a page."""
DIALOG, LIST = ".q-dialog__inner", ".q-menu"


@dataclass(frozen=True)
class Overlay:
    """One of them.

    Attributes:
        page: Its path.
        steps: What is done until it is open: (verb, selector, text), with the verbs of `ConsoleBrowser`.
        shown: Selector of it.
        escapes: Times that Escape is pressed until it is closed.
        closes: Whether it is gone soon then; what it shows may take a while to end.
    """

    page: str
    steps: tuple[tuple[str, str, str], ...]
    shown: str = DIALOG
    escapes: int = 1
    closes: bool = True


def drop_down(page: str, label: str, *before: tuple[str, str, str]) -> Overlay:
    """A list to choose from, by its label. `before`: steps until it is there."""
    return Overlay(page, (*before, ("click", ".q-select", label)), LIST)


def click(text: str, css: str = "button") -> tuple[str, str, str]:
    return "click", css, text


OPEN_NOD = (click("nod", ".q-item"), ("one", "[role=heading]", "nod"))
PUT_IN = (*OPEN_NOD, click("Put in"))
OPEN_POSTURE = (("type", "input[aria-label='Search functions']", "goToPosture"), click("goToPosture", ".q-item"))
OVERLAYS = {
    "frame.framed.footer": None,  # stands on every page
    "frame._choice_of_robot.select": None,  # is there where several robots are: test_console_robots.py opens it
    "step_editor.InsertDialog.__init__.dialog": Overlay("/behaviors", PUT_IN),
    "step_editor.InsertDialog.__init__.select": drop_down("/behaviors", "What", *PUT_IN),
    "step_editor.InsertDialog._ask.select": drop_down("/behaviors", "Function (type to search)", *PUT_IN),
    "field_inputs.FieldInputs._select.select": drop_down("/functions", "str_param", *OPEN_POSTURE),
    "wizard_page.WizardEditor.__init__.dialog": Overlay("/wizard", (click("Edit"),), escapes=2),
    "wizard_page._WizardPage._talk.select": drop_down("/wizard", "Templates"),
    "robot_page.EventPanel.__init__.select": drop_down("/", "Show"),
    "robot_page.PlotPanel.__init__.select": drop_down("/", "Joint or sensor"),
    "robot_page.SimulatorPanel._build.select": drop_down("/", "Speed"),
    "robot_page.SimulatorPanel._build_things.select": drop_down(
        "/", "Kind", click("Place a thing", ".q-expansion-item .q-item")
    ),
    "behaviors_page.BehaviorsView._project.dialog": Overlay(
        "/behaviors", (*OPEN_NOD, click("Project")), escapes=2, closes=False
    ),
    "behaviors_page._ask_name.dialog": Overlay("/behaviors", (click("Record"),)),
    "functions_page.FunctionsView.build.select": drop_down("/functions", "Server"),
    "functions_page.show_copy.dialog": Overlay("/functions", (*OPEN_POSTURE, click("Command"))),
    "results_page.build.show.select": drop_down("/study/results", "Study"),
    "trial_page._StudyPage._build_begin.select": drop_down("/study", "Protocol"),
    # Behind the other of its page: a trial runs from then on.
    "frame.sure.dialog": Overlay("/study", (click("Start trial"), click("Abort"))),
}
"""Module, function and element -> how it is opened."""


def paths_in_code() -> set[str]:
    """The paths of all pages."""
    return {
        call.args[-1].value
        for _, call in _calls()
        if _name(call.func) in ("page_at", "page") and call.args and isinstance(call.args[-1], ast.Constant)
    }


def overlays_in_code() -> set[str]:
    """Where the code makes what opens over a page."""
    return {f"{where}.{_name(call.func)}" for where, call in _calls() if _is_opener(call.func)}


def _is_opener(called: ast.expr) -> bool:
    of_ui = isinstance(called, ast.Attribute) and isinstance(called.value, ast.Name) and called.value.id == "ui"
    return of_ui and _name(called) in OPENERS


def _name(called: ast.expr) -> str:
    return called.attr if isinstance(called, ast.Attribute) else called.id if isinstance(called, ast.Name) else ""


def _calls():
    """Module and functions around, and the call, of all calls of the pages."""
    for path in FOLDER.rglob("*.py"):
        left = [(path.stem, ast.parse(path.read_text(encoding="utf-8")))]
        while left:
            where, node = left.pop()
            if isinstance(node, ast.Call):
                yield where, node
            named = isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef))
            inner = f"{where}.{node.name}" if named else where
            outside = list(node.decorator_list) if named else []
            left += [(where if child in outside else inner, child) for child in ast.iter_child_nodes(node)]
