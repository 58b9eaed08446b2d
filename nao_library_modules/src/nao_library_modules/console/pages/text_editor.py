"""Editors of texts: the browser keeps what was typed and is not saved; YAML has its mistakes beside its lines."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Union

from nicegui import ui

from ...behaviors.behavior_errors import Problem
from ...studies.commands import ConsoleFileError, revision_of
from .frame import PageContext

MOST_PROBLEMS = 100
"""Mistakes that are shown."""
HEIGHT = "60vh"


class Draft:
    """Offers what was typed into an editor and not saved, when the page or the editor is opened again.

    It is kept in the browser for each person and file: see static/drafts.js.

    Args:
        editor: NiceGUI's element, with a `value`.
        kind: What the texts are.
        show: Gets the text and the revision of a draft that the visitor wants; None: it becomes the value.
    """

    def __init__(
        self, page: PageContext, editor: Any, kind: str, show: Callable[[str, str], Any] | None = None
    ) -> None:
        users = page.console.sessions.users
        self._place = f"{page.visitor.role if users is None else page.visitor.name}/{kind}"
        self._show = show or (lambda text, _: editor.set_value(text))
        self._element = ui.element("nao-draft").classes("nao-draft w-full")
        self._element.props["editor"] = str(editor.id)
        self._element.on("nao-draft-shown", self._wanted, ["detail"])

    def of(self, name: str, saved: str = "") -> None:
        """The editor is for the text of this name, which is saved as it is here."""
        self._element.props.update(draft=f"{self._place}/{name}", saved=saved, revision=revision_of(saved), text=saved)
        self._element.update()

    def keep(self, text: str) -> None:
        """The text of an editor that may not be drawn has become another one."""
        if self._element.props.get("text") != text:
            self._element.props["text"] = text
            self._element.update()

    def _wanted(self, event: Any) -> Any:
        detail = event.args.get("detail") if isinstance(event.args, dict) else None
        if isinstance(detail, dict):
            return self._show(str(detail.get("text", "")), str(detail.get("revision", "")))
        return None


class YamlEditor:
    """A YAML text with numbered lines, what is wrong with it beside them and in a list, and its draft.

    Attributes:
        code: The text itself.
        draft: Its draft.

    Args:
        label: Of the text, for who does not see it.
        kind, show: As `Draft` takes them; a draft that is wanted becomes the text in any case.
        height: Of the text, in CSS.
        offers: Element that holds what is said of drafts; None: it stands above the text.
    """

    def __init__(
        self,
        page: PageContext,
        label: str,
        kind: str,
        show: Callable[[str, str], Any] = lambda *_: None,
        height: str = HEIGHT,
        offers: Any = None,
    ) -> None:
        self.told = ui.label().classes("font-medium").props("role=status")
        self._list = ui.column().classes("w-full gap-0 max-h-40 shrink-0 overflow-auto no-wrap")
        offers = offers or ui.column().classes("w-full")
        theme = "vscodeDark" if page.visitor.dark else "vscodeLight"
        self.code = ui.codemirror(
            language="YAML", theme=theme, indent="  ", line_wrapping=True, on_change=lambda: self.tell("")
        )
        self.code.classes("w-full border rounded").style(f"height: {height}")
        self.code.props["aria-label"] = label

        def wanted(text: str, revision: str) -> Any:
            self.code.value = text
            return show(text, revision)

        with offers:
            self.draft = Draft(page, self.code, kind, wanted)
        ui.label("Tab indents; Escape and then Tab leave the text.").classes("text-caption")

    @property
    def text(self) -> str:
        return self.code.value or ""

    def open(self, name: str, text: str) -> None:
        """Show the text that is saved under a name."""
        self.code.value = text.replace("\r\n", "\n")  # as the browser has it
        self.mark([])
        self.draft.of(name, text)

    def tell(self, text: str) -> None:
        """Say what was found of the text as it is."""
        self.told.text = text

    def mark(self, problems: Sequence[Union[Problem, Exception]]) -> None:
        """Show what is wrong, beside the lines and in a list whose entries lead to them."""
        self._list.clear()
        with self._list:
            for each in problems[:MOST_PROBLEMS]:
                line = each.line if isinstance(each, Problem) else 0
                button = ui.button(str(each), on_click=lambda _, line=line: self._go_to(line))
                button.props("flat dense no-caps align=left color=negative")
        self.code.decorations = marks_of(self.text, problems[:MOST_PROBLEMS])

    def _go_to(self, line: int) -> None:
        if line:
            self.code.reveal_line(line)


def marks_of(text: str, problems: Sequence[Any]) -> list[dict[str, Any]]:
    """What CodeMirror shows of problems in a text: their lines, and at the end of each what is wrong with it."""
    found: dict[int, list[str]] = {}
    lines = text.split("\n")
    for each in problems:
        if isinstance(each, Problem) and 0 < each.line <= len(lines):
            found.setdefault(each.line, []).append(each.text)
    ends = [0]
    for line in lines:
        ends.append(ends[-1] + len(line) + 1)
    marks: list[dict[str, Any]] = []
    for number, texts in sorted(found.items()):
        marks.append({"kind": "line", "line": number, "class": "nao-wrong-line"})
        told = f"  \u2190 {'; '.join(dict.fromkeys(texts))}"
        marks.append({"kind": "widget", "position": ends[number] - 1, "text": told, "class": "nao-wrong", "side": 1})
    return marks


def problems_of(error: Exception) -> Sequence[Union[Problem, Exception]]:
    """What is wrong with a text that was refused."""
    return error.problems if isinstance(error, ConsoleFileError) else (error,)


def mistakes(count: int) -> str:
    """A number of mistakes, in words."""
    return "1 mistake" if count == 1 else f"{count} mistakes"
