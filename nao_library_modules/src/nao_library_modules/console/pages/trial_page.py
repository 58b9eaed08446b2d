"""`/study?protocol=NAME&participant=PSEUDONYM`: begins trials, and steers the one that runs on the robot.

The trial runs in the console; a page shows what there is of it, whenever it is opened. A mistyped pseudonym of a
participant is corrected here, or taken back.
"""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Awaitable, Callable, Iterable, Mapping
from typing import Any
from urllib.parse import quote

from nicegui import ui
from starlette.requests import Request

from naoqi.errors import NaoError

from ...behaviors.parameters import text_of
from ...studies.commands import revision_of
from ...studies.protocol import (
    BAG_TOPICS,
    BranchStep,
    ChoiceStep,
    RoundsStep,
    StudyError,
    StudyProtocol,
    WantedRecordings,
    filled,
)
from ...studies.protocol_check import checked_for
from ...studies.protocol_reader import read_protocol
from ...studies.schedule import all_steps, any_round, order_of
from ...studies.studies import Studies
from ...studies.study_files import Participant, participants_of, schedule_of
from ...studies.trial_log import (
    CUT,
    DONE,
    FAILED,
    HELD,
    PAUSED,
    REPEATED,
    RUNNING,
    SKIPPED,
    STOPPED,
    TIMEOUT,
    TrialState,
)
from ...studies.trial_runner import TrialRunner
from .frame import framed, page_at, sure
from .text_editor import Draft, YamlEditor, mistakes, problems_of

PAGES = {"Trial": "/study", "Results": "/study/results"}


def study_links(page: Any) -> None:
    """Links between the pages of studies, for the same robot."""
    with ui.row().classes("gap-4"):
        for name, path in PAGES.items():
            ui.link(name, f"{path}?robot={page.robot.name}")


MOST_SHOWN = 100
"""Participants in the list, the newest."""


class ParticipantsCard:
    """The list of them. `changed`: called when a pseudonym is another one."""

    def __init__(self, page: Any, studies: Studies, changed: Callable[[], Awaitable[None]]) -> None:
        self._page, self._studies, self._changed = page, studies, changed
        self._protocol: StudyProtocol | None = None
        self._shown: tuple[StudyProtocol, list[Participant]] | None = None
        with ui.card().classes("w-full max-h-[40vh] overflow-auto") as self._box:
            ui.label("Participants").classes("text-h6")
            ui.label("A mistyped pseudonym can be corrected; while nothing was played, it can be taken back.")
            self._rows = ui.column().classes("w-full gap-1")
        self._box.set_visibility(False)

    async def show(self, protocol: StudyProtocol) -> None:
        """Show those of a study."""
        self._protocol = protocol
        try:
            found = await self._page.work(participants_of, self._studies.files, protocol.name)
        except (NaoError, OSError) as error:
            ui.notify(str(error), type="negative")
            return
        if self._rows.is_deleted or protocol is not self._protocol or self._shown == (protocol, found):
            return  # what somebody types beside a name stays
        self._shown = (protocol, found)
        self._rows.clear()
        self._box.set_visibility(bool(found))
        with self._rows:
            for each in found[-MOST_SHOWN:]:
                self._row(each, protocol)

    def _row(self, each: Participant, protocol: StudyProtocol) -> None:
        number = "" if protocol.blind else f"number {each.number}, "
        with ui.row().classes("items-center"):
            ui.label(f"{each.pseudonym}: {number}{each.trials} trial{'' if each.trials == 1 else 's'}")
            field = ui.input("Right pseudonym").props(
                f'dense maxlength=64 aria-label="Right pseudonym of {each.pseudonym}"'
            )
            ui.button("Correct", on_click=lambda: self._correct(each.pseudonym, field.value or "")).props(
                f'no-caps outline aria-label="Correct {each.pseudonym}"'
            )
            if not each.played:
                ui.button("Take back", on_click=lambda: self._take_back(each.pseudonym)).props(
                    f'no-caps outline aria-label="Take {each.pseudonym} back"'
                )

    async def _correct(self, old: str, new: str) -> None:
        if not new.strip():
            ui.notify("Write the right pseudonym beside it", type="warning")
            return
        question = f"Call {old} {new.strip()} from now on, in all trials?"
        if self._page.operate() and await sure(question, "Correct", "Leave it"):
            await self._do(self._studies.correct_pseudonym, old, new.strip())

    async def _take_back(self, pseudonym: str) -> None:
        question = f"Take {pseudonym} back? The number is free again, and trials without a step stay as aborted."
        if self._page.operate() and await sure(question, "Take back", "Leave it"):
            await self._do(self._studies.take_back, pseudonym)

    async def _do(self, act: Callable[..., int], *names: str) -> None:
        assert self._protocol is not None
        try:
            await self._page.work(act, self._protocol.name, *names, self._page.visitor.name, self._page.robot)
        except (NaoError, OSError) as error:
            ui.notify(str(error), type="negative", multi_line=True)
        await self.show(self._protocol)
        await self._changed()


PERIOD = 0.1
"""s between looks at whether the trial has changed, while the page is open."""
SHOWN_EVENTS = 60
MOST_STEPS, MOST_PROBLEMS, MOST_OPENED = 200, 100, 50
"""Steps of a protocol, mistakes, and trials that have not ended, which the page shows."""
NEW = "new_study"
EXAMPLE = """\
name: new_study
help: What it is about.
phases:
  - phase: Task
    steps:
      - say: Please touch my head.
      - {wait: touch, sensors: [head], timeout: 20, label: head}
"""
ICONS = {
    "": "radio_button_unchecked",
    RUNNING: "play_circle",
    DONE: "check_circle",
    TIMEOUT: "hourglass_disabled",
    SKIPPED: "skip_next",
    FAILED: "error",
    REPEATED: "replay",
    STOPPED: "stop_circle",
    CUT: "content_cut",
}
STATUS_COLOURS = {RUNNING: "positive", PAUSED: "warning", HELD: "negative"}
SHORTCUTS = {"p": "pause or continue", "n": "next", "r": "repeat", "m": "write a note", "1..9": "a choice"}


def build(console: Any) -> None:
    """Add the page."""
    studies: Studies = console.studies

    @page_at(console, "/study")
    async def show(request: Request) -> None:
        with framed(console, "Study", request) as page:
            study_links(page)
            await _StudyPage(page, studies, request.query_params).build()


class _StudyPage:
    """What one visitor sees."""

    def __init__(self, page: Any, studies: Studies, wanted: Mapping[str, str]) -> None:
        self.page, self.studies, self.robot, self._wanted = page, studies, page.robot, wanted
        self.runner: TrialRunner | None = None
        self.protocol: StudyProtocol | None = None
        self._chosen = wanted.get("protocol", "")
        self._revision = ""  # of the protocol that is edited, as it was when it was opened
        self._fields: dict[str, Any] = {}
        self._dirty = True
        self._leave: Any = None
        self._shown: tuple[bool, Any] | None = None
        self._trouble: Any = None
        self._fresh: deque[Any] = deque(maxlen=SHOWN_EVENTS)  # events that are not shown yet
        self._recordings: tuple[str, ...] | None = None
        self._choices_of: tuple[str, int] | None = None

    async def build(self) -> None:
        self._area = ui.column().classes("w-full gap-4")
        self._follow()
        leave = [self.studies.on_change(self._mark), self.robot.events.subscribe(self._keep)]
        self.page.every(PERIOD, self._refresh)
        self.page.on_leave(lambda: [each() for each in (*leave, self._leave) if each])
        ui.keyboard(on_key=self._key, ignore=["input", "select", "textarea"])
        await self._refresh()

    def _mark(self, *_: Any) -> None:
        """Called in any thread."""
        self._dirty = True

    def _keep(self, event: Any) -> None:
        self._fresh.append(event)
        self._dirty = True

    def _follow(self) -> None:
        """Look at the trial that runs on the robot, which another page may have begun."""
        runner = self.studies.running(self.robot.namespace)
        if runner is not self.runner:
            if self._leave is not None:
                self._leave()
            self.runner = runner
            self._leave = runner.on_change(self._mark) if runner is not None else None
            self._dirty = True
            self._shown = None

    async def _refresh(self) -> None:
        self._follow()
        running = self.runner is not None and not self.runner.state.over
        if self._shown != (running, self.runner):
            self._shown = (running, self.runner)
            if running:
                self._area.clear()
                with self._area:
                    self._build_trial()
            else:
                await self._show_begin()
        elif self._dirty and running:
            self._dirty = False
            self._update_trial()
        if running:
            self._tick()
        if self.runner is not None:
            self._show_trouble()

    # A trial that is to begin

    async def _show_begin(self) -> None:
        shown = self._shown
        opened = await self.page.work(self._opened)
        names = list(await self.page.ask(self.studies.files.protocols))
        chosen = self._chosen or await self.page.work(self.studies.files.newest_protocol)
        if self._shown is shown and not self._area.is_deleted:  # no trial has begun meanwhile
            self._area.clear()
            with self._area:
                self._build_begin(opened, names)
            if names:
                self._choice.value = chosen if chosen in names else names[0]

    def _build_begin(self, opened: list[tuple[Any, TrialState, bool]], names: list[str]) -> None:
        last = self.runner
        if last is not None:
            state = last.state
            ui.label(f"Trial {last.id} is {state.status_text}; {state.steps_text}.").props('role="status"')
            self._build_trouble()
        if opened:
            with ui.card().classes("w-full"):
                ui.label("Trials that have not ended").classes("text-h6")
                for folder, state, runs in opened[:MOST_OPENED]:
                    with ui.row().classes("items-center"):
                        if runs:
                            ui.label(f"{folder.id}: {state.status}, runs in another program")
                            continue
                        ui.label(f"{folder.id}: {state.status}, last step {state.path or 'none'}")
                        if state.recordings:
                            ui.badge(f"records {', '.join(state.recordings)}").props("color=negative")
                        ui.button(
                            "Resume", icon="restart_alt", on_click=lambda _, each=folder.id: self._resume(each)
                        ).props("no-caps")
                        ui.button(
                            "Abort",
                            icon="cancel",
                            color="negative",
                            on_click=lambda _, each=folder.id: self._give_up(each),
                        ).props("no-caps outline")
        with ui.card().classes("w-full"):
            ui.label("New trial").classes("text-h6")
            with ui.row().classes("items-start w-full"):
                self._choice = ui.select(names, label="Protocol", on_change=self._read).classes("min-w-[16rem]")
                self._person = ui.input("Participant (pseudonym)", on_change=self._tell_order).classes("min-w-[12rem]")
                self._person.props('maxlength=64 autocomplete="off"')
            self._help = ui.label().classes("whitespace-pre-line")
            self._values = ui.row()
            with ui.row():
                self._bag = ui.checkbox("Rosbag")
                self._video = ui.checkbox("Video of the camera")
                self._sound = ui.checkbox("Sound of the microphones")
                self._rehearsal = ui.checkbox("Rehearsal").tooltip(
                    "No trial of the participant: it uses up no number, and results leave it out"
                )
            self._begin_button = ui.button("Start trial", icon="play_arrow", on_click=self._begin).props("no-caps")
            self._problems = ui.column().classes("text-negative gap-0").props('role="alert"')
        self._participants = ParticipantsCard(self.page, self.studies, self._tell_order)
        offers = ui.column().classes("w-full")
        with ui.expansion("Protocol as YAML", icon="edit").classes("w-full") as self._expansion:
            self._name = ui.input("Name", value=NEW).props("maxlength=64")
            with ui.row():
                ui.button("Check", on_click=self._check).props("no-caps outline")
                ui.button("Save", on_click=self._save).props("no-caps")
            self._editor = YamlEditor(self.page, "Protocol", "protocol", self._take_draft, offers=offers)
            self._editor.open(NEW, EXAMPLE)
        self._person.value = self._wanted.get("participant", "")

    def _opened(self) -> list[tuple[Any, TrialState, bool]]:
        """Trials that have not ended, their states, and whether another program runs them."""
        return [(folder, state, folder.runs()) for folder, state in self.studies.open_trials()]

    async def _read(self) -> None:
        name = self._chosen = self._choice.value
        person = f"&participant={quote(self._person.value.strip())}" if self._person.value else ""
        ui.navigate.history.replace(f"/study?robot={quote(self.robot.name)}&protocol={quote(name)}{person}")
        try:
            text = await self.page.ask(self.studies.files.protocol_text, name)
            self._name.value, self._revision = name, revision_of(text)
            self._editor.open(name, text)
            self.protocol = await self.page.work(read_protocol, text, name)
        except (NaoError, OSError) as error:
            self.protocol = None
            problems = problems_of(error)
            self._editor.mark(problems)
            self._tell_problems([f"{name}, as it is saved, cannot be run: {mistakes(len(problems))}", *problems])
        if self._problems.is_deleted:
            return  # a trial has begun meanwhile, or the page was left
        if self.protocol is not None:
            record = self.protocol.record
            self._bag.value, self._video.value, self._sound.value = bool(record.bag), bool(record.video), record.sound
            self._problems.clear()
        self._begin_button.set_enabled(self.protocol is not None)
        self._build_values()
        if self.protocol is not None:
            await self._participants.show(self.protocol)
        await self._tell_order()

    def _build_values(self) -> None:
        """A field for each value of the protocol, with what the protocol has."""
        self._values.clear()
        self._fields = {}
        with self._values:
            for name, value in (self.protocol.values if self.protocol is not None else {}).items():
                if not isinstance(value, (list, dict)):
                    self._fields[name] = ui.input(name, value=text_of(value)).props('autocomplete="off"')

    async def _tell_order(self) -> None:
        protocol, person = self.protocol, self._person.value.strip()
        if protocol is None:
            self._help.text = ""
            return
        self._help.text = protocol.help
        try:
            schedule = await self.page.work(schedule_of, self.studies.files, protocol, person) if person else None
            lines = [f"A participant has {len(order_of(protocol, 1))} trials."] if protocol.factors else []
            lines = schedule.lines(protocol.blind) if schedule is not None else lines
        except (NaoError, OSError) as error:  # half a pseudonym may be none
            lines = [str(error)]
        if self._help.is_deleted or (protocol, person) != (self.protocol, self._person.value.strip()):
            return  # a trial has begun meanwhile, or somebody has typed on, which is told by itself
        self._help.text = "\n".join(filter(None, (protocol.help, *lines)))

    async def _begin(self) -> None:
        if self.protocol is None or not self.page.operate():
            return
        pseudonym, protocol = self._person.value.strip(), self.protocol
        if not pseudonym:
            ui.notify("The trial needs the pseudonym of its participant", type="warning")
            return
        bag = protocol.record.bag or BAG_TOPICS
        wanted = WantedRecordings(
            bag if self._bag.value else (),
            (protocol.record.video or "top") if self._video.value else "",
            bool(self._sound.value),
        )
        given = {name: field.value or "" for name, field in self._fields.items()}
        values = {name: text for name, text in given.items() if text != text_of(protocol.values[name])}
        by = self.page.visitor.name
        more = {"record": wanted, "values": values, "stops": self.robot.stops}
        more["rehearsal"] = bool(self._rehearsal.value)
        await self._try(lambda: self.studies.begin(protocol, pseudonym, self.robot, by, **more))

    async def _resume(self, trial: str) -> None:
        if self.page.operate():
            by, stops = self.page.visitor.name, self.robot.stops
            await self._try(lambda: self.studies.resume(trial, self.robot, by, stops=stops))

    async def _give_up(self, trial: str) -> None:
        if self.page.operate() and await _sure_to_abort(trial):
            await self._try(lambda: self.studies.abort(trial, self.robot, self.page.visitor.name))
            self._shown = None
            await self._refresh()

    async def _try(self, begin: Any) -> None:
        try:
            await self.page.ask(begin)
        except (NaoError, OSError) as error:
            ui.notify(str(error), type="negative", multi_line=True)
        await self._refresh()

    async def _check(self) -> bool:
        """Whether the text can be run, also by the robot of the page."""
        editor = self._editor
        try:
            protocol = await self.page.work(read_protocol, editor.text, self._name.value or "")
            problems = await self.page.work(checked_for, self.robot, protocol)
        except NaoError as error:
            problems = problems_of(error)
        if editor.code.is_deleted:
            return False  # a trial has begun meanwhile, which the page shows; the text is kept as a draft
        editor.mark(problems)
        found = f"The protocol cannot be run: {mistakes(len(problems))}" if problems else "Nothing wrong was found"
        editor.tell(found)
        return not problems

    async def _save(self) -> None:
        if not self.page.operate("Save") or not await self._check():
            return
        files, name, text = self.studies.files, self._name.value, self._editor.text
        try:
            if await self._would_undo(name) and not await sure(
                f"There is another {name}, or it has changed since. Save over it?", "Save over it", "Do not save"
            ):
                return
            await self.page.work(files.store_protocol, name, text)
            names = list(await self.page.ask(files.protocols))
        except (NaoError, OSError) as error:
            self._editor.tell(f"It is not saved: {error}")
            return
        self._choice.set_options(names)
        self._choice.value = name
        await self._read()

    async def _would_undo(self, name: str) -> bool:
        """Whether to save a protocol would replace another one, or what somebody else has saved meanwhile."""
        if name not in await self.page.ask(self.studies.files.protocols):
            return False
        return revision_of(await self.page.ask(self.studies.files.protocol_text, name)) != self._revision

    def _take_draft(self, _text: str, revision: str) -> None:
        """A draft is shown; it is of the protocol as it was then."""
        self._revision = revision
        self._expansion.open()

    def _tell_problems(self, problems: Iterable[Any]) -> None:
        if self._problems.is_deleted:
            return  # a trial has begun meanwhile, which the page shows
        self._problems.clear()
        with self._problems:
            for problem in itertools.islice(problems, MOST_PROBLEMS):
                ui.label(str(problem))

    # A trial that runs

    def _build_trial(self) -> None:
        runner = self.runner
        assert runner is not None
        about = runner.state.about
        with ui.card().classes("w-full"):
            with ui.row().classes("items-center w-full"):
                ui.label(f"{about['study']}, {about['participant']}, trial {about['position']}").classes("text-h6")
                condition = ", ".join(f"{name}: {level}" for name, level in about["condition"].items())
                if condition and not runner.protocol.blind:
                    ui.label(condition)
                if runner.state.rehearsal:
                    ui.badge("rehearsal")
                self._status = ui.badge().classes("nao-state").props('role="status"')
                self._recorded = ui.row()
            self._now = ui.label().classes("text-h5 nao-state").props('role="status" aria-live="polite"')
            self._since = ui.label().classes("text-caption nao-kept nao-state")
            self._build_trouble()
            self._error = ui.label().classes("text-negative nao-kept").props('role="alert"')
            self._choices = ui.row().classes("min-h-[3.5rem]")
            with ui.row():
                self._pause = ui.button("Pause", on_click=self._toggle).props("no-caps")
                self._next = self._button("Next", "skip_next", lambda by: runner.next(by))
                self._repeat = self._button("Repeat", "replay", lambda by: runner.repeat(by))
                ui.button("Abort", icon="cancel", color="negative", on_click=self._abort).props("no-caps outline")
            with ui.row().classes("items-center w-full"):
                self._note = ui.input("Note").classes("flex-1").on("keydown.enter", lambda: self._write("note"))
                ui.button("Note", on_click=lambda: self._write("note")).props("no-caps outline")
                ui.button("Deviation", on_click=lambda: self._write("deviation")).props(
                    "no-caps outline color=negative"
                )
            Draft(self.page, self._note, "note").of(runner.id)
        with ui.row().classes("w-full items-start no-wrap max-md:flex-wrap"):
            with ui.card().classes("flex-1 min-w-[18rem]"):
                self._build_steps(runner)
            with ui.card().classes("flex-1 min-w-[18rem]"):
                ui.label("Events").classes("text-h6")
                self._log = ui.column().classes("w-full gap-0 max-h-[50vh] overflow-auto text-sm").props("tabindex=0")
        keys = ", ".join(f"{key}: {what}" for key, what in SHORTCUTS.items())
        ui.label(f"Keys: {keys}").classes("text-caption")
        self._fresh.clear()
        self._fresh.extend(self.robot.events.last(SHOWN_EVENTS))
        self._choices_of = self._recordings = None
        self._update_trial()

    def _build_steps(self, runner: TrialRunner) -> None:
        self._marks: dict[str, Any] = {}
        self._texts: dict[str, tuple[Any, str]] = {}  # path -> label, text that may have names in it
        phase = ""
        steps = list(all_steps(runner.protocol))
        for path, step in steps[:MOST_STEPS]:
            name = runner.protocol.phases[int(path.partition(".")[0]) - 1].name
            if name != phase:
                phase = name
                ui.label(name).classes("text-subtitle1 text-bold")
            with ui.row().classes("items-center gap-2 no-wrap").style(f"padding-left: {path.count('.') * 10 - 10}px"):
                if isinstance(step, BranchStep):
                    branches = [" and ".join(map(str, ifs)) or "else" for ifs, _ in step.branches]
                    ui.label(f"{path} branch: {'; '.join(branches)}").classes("italic")
                elif isinstance(step, RoundsStep):
                    ui.label(f"{path} {step.count} rounds").classes("italic")
                else:
                    self._marks[any_round(path)] = ui.icon(ICONS[""]).props('role="img" aria-label="to come"')
                    self._texts[any_round(path)] = (ui.label(), f"{path} {step.text}")
        if len(steps) > MOST_STEPS:
            ui.label(f"and {len(steps) - MOST_STEPS} steps more").classes("italic")

    def _build_trouble(self) -> None:
        """What is wrong with the log of the trial, or was; it stays until somebody says that it was seen."""
        with ui.row().classes("items-center w-full nao-kept-row") as self._trouble_row:
            self._trouble = ui.label().classes("text-negative flex-1").props('role="alert"')
            self._seen = ui.button("Seen", icon="done", on_click=self._mark_seen).props("no-caps outline")
        self._show_trouble()

    def _show_trouble(self) -> None:
        runner = self.runner
        if self._trouble is None:
            return  # nothing is shown yet
        self._trouble.text = runner.trouble if runner is not None else ""
        self._trouble_row.set_visibility(bool(self._trouble.text))
        self._seen.set_enabled(runner is not None and bool(runner.state.trouble))

    async def _mark_seen(self) -> None:
        if self.runner is not None and self.page.operate():
            await self.page.ask(self.runner.seen, self.page.visitor.name)
            self._show_trouble()

    def _update_trial(self) -> None:
        runner = self.runner
        assert runner is not None
        state: TrialState = runner.state
        outcome = runner.outcome
        self._status.text = state.status
        self._status.props(f"color={STATUS_COLOURS.get(state.status, 'grey')}")
        self._now.text = runner.title or (f"paused behind step {state.path}" if state.path else "it starts")
        self._error.text = outcome.error if outcome is not None and state.status == HELD else ""
        self._pause.text = "Continue" if state.status in (PAUSED, HELD) else "Pause"
        if tuple(state.recordings) != self._recordings:
            self._recordings = tuple(state.recordings)
            self._recorded.clear()
            with self._recorded:
                for kind in state.recordings:
                    ui.badge(f"records {kind}").props("color=negative")
        self._update_choices(runner)
        self._update_marks(state)
        while self._fresh:
            event = self._fresh.popleft()
            by = f" ({event.by})" if event.by else ""
            with self._log:
                ui.label(f"{event.stamp - state.began:.2f} s {event.kind}{by}: {event.text}").move(self._log, 0)
        for line in self._log.default_slot.children[SHOWN_EVENTS:]:
            self._log.remove(line)

    def _update_choices(self, runner: TrialRunner) -> None:
        step, outcome = runner.step, runner.outcome
        place = (outcome.path, outcome.attempt) if isinstance(step, ChoiceStep) and outcome is not None else None
        if place == self._choices_of:
            return
        self._choices_of = place
        self._choices.clear()
        if place is not None and isinstance(step, ChoiceStep):
            with self._choices:
                for i, choice in enumerate(step.choices, 1):
                    text = f"{i}  {choice}" if i < 10 else choice
                    ui.button(text, on_click=lambda _, each=choice: self._choose(each)).props("no-caps size=lg")

    def _update_marks(self, state: TrialState) -> None:
        latest = {any_round(outcome.path): outcome for outcome in state.outcomes}
        for path, mark in self._marks.items():
            outcome = latest.get(path)
            kind = "" if outcome is None else RUNNING if outcome.ended is None else outcome.outcome
            if mark.name != ICONS[kind]:
                mark.name = ICONS[kind]
                mark.props(f'aria-label="{kind}"')
        for label, text in self._texts.values():
            label.text = filled(text, state.values)

    def _tick(self) -> None:
        outcome = self.runner.outcome if self.runner is not None else None
        if outcome is not None and outcome.began is not None and outcome.ended is None:
            again = f", attempt {outcome.attempt}" if outcome.attempt > 1 else ""
            self._since.text = (
                f"step {outcome.path}, {outcome.phase}, for {self.robot.now() - outcome.began:.0f} s{again}"
            )
        else:
            self._since.text = ""

    def _button(self, text: str, icon: str, act: Any) -> Any:
        async def press() -> None:
            if self.page.operate():
                await self.page.ask(act, self.page.visitor.name)

        return ui.button(text, icon=icon, on_click=press).props("no-caps")

    async def _toggle(self) -> None:
        runner = self.runner
        if runner is not None and self.page.operate():
            act = runner.go_on if runner.state.status in (PAUSED, HELD) else runner.pause
            await self.page.ask(act, self.page.visitor.name)

    async def _abort(self) -> None:
        runner = self.runner
        if runner is None or not self.page.operate():
            return
        if await _sure_to_abort(runner.id):
            await self.page.ask(runner.abort, self.page.visitor.name)

    async def _choose(self, choice: str) -> None:
        if self.runner is not None and self.page.operate():
            try:
                await self.page.ask(self.runner.choose, choice, self.page.visitor.name)
            except StudyError as error:
                ui.notify(str(error), type="warning")

    async def _write(self, kind: str) -> None:
        text = self._note.value.strip()
        if self.runner is None or not self.page.operate():
            return
        if not text:
            ui.notify("Write what is to be noted", type="warning")
            return
        self._note.value = ""
        await self.page.ask(self.runner.note if kind == "note" else self.runner.deviation, text, self.page.visitor.name)

    async def _key(self, event: Any) -> None:
        runner = self.runner
        if runner is None or runner.state.over or not event.action.keydown or event.action.repeat:
            return
        if event.modifiers.ctrl or event.modifiers.alt or event.modifiers.meta:
            return
        key, by = event.key.name, self.page.visitor.name
        step = runner.step
        if key == "m":
            self._note.run_method("focus")
        elif key == "p":
            await self._toggle()
        elif key in ("n", "r") and self.page.operate():
            await self.page.ask(runner.next if key == "n" else runner.repeat, by)
        elif key.isdigit() and isinstance(step, ChoiceStep) and 0 < int(key) <= len(step.choices):
            await self._choose(step.choices[int(key) - 1])


async def _sure_to_abort(trial: str) -> bool:
    return await sure(f"Abort trial {trial}? What was logged stays.", "Abort the trial", "Do not abort")
