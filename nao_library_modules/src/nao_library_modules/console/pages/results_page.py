"""`/study/results` and `/study/replay?trial=STUDY/PSEUDONYM-N`: what was measured, and a trial with its video."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any
from urllib.parse import quote

from nicegui import ui
from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response

from naoqi.errors import NaoError

from ...studies.protocol import NOTHING, StudyError
from ...studies.studies import Studies
from ...studies.study_files import StudyFiles, TrialFolder
from ...studies.study_table import ConditionSummary, StudyTable, summaries_of, table_of
from ...studies.trial_log import RESUMED, TrialState, read_events
from ..view.background import in_background
from .frame import framed, page_at
from .trial_page import study_links

MOST_ROWS = 20
"""Rows of a table on the page at once."""
MOST_TRIALS = 100
"""Trials in the list, the newest; the table has all."""


SWITCHES = {"by_round": "By round", "all_trials": "Count aborted trials and rehearsals, too"}
"""Parameters of the address -> what their switches say."""
COLOURS = ("#1565c0", "#e65100", "#2e7d32", "#8e24aa", "#c62828", "#00838f", "#f9a825", "#6d4c41")
GREY = "#9e9e9e"


def build(console: Any) -> None:
    """Add the page."""
    studies: Studies = console.studies
    build_replay(console)

    @page_at(console, "/study/results")
    async def show(request: Request, study: str = "") -> None:
        with framed(console, "Study", request) as page:
            study_links(page)
            names = await page.ask(studies.files.studies)
            if not names:
                ui.label("There are no trials yet.")
                return
            chosen = study if study in names else names[0]
            ui.select(
                names,
                value=chosen,
                label="Study",
                on_change=lambda event: ui.navigate.to(
                    f"/study/results?robot={quote(page.robot.name)}&study={quote(event.value)}"
                ),
            ).classes("min-w-[16rem]")
            switches = {name: request.query_params.get(name) == "1" for name in SWITCHES}
            try:
                trials, table, summaries = await page.work(_results_of, studies, chosen, *switches.values())
            except NaoError as error:
                ui.label(str(error)).classes("text-negative")
                return
            _trials(page, trials)
            address = f"/study/results?robot={quote(page.robot.name)}&study={quote(chosen)}"
            for name, text in SWITCHES.items():
                ui.switch(
                    text,
                    value=switches[name],
                    on_change=lambda event, name=name: ui.navigate.to(
                        address + "".join(f"&{key}={int(on)}" for key, on in {**switches, name: event.value}.items())
                    ),
                )
            if table.left_out:
                verb = "Counted too" if switches["all_trials"] else "Left out"
                ui.label(f"{verb}: {', '.join(f'{trial} ({what})' for trial, what in table.left_out)}")
            for trial, gap in table.gaps:
                ui.label(f"{trial}: {gap}").classes("text-negative")
            _summaries(summaries)

            async def download() -> None:
                table = await page.work(lambda: table_of(studies.files, chosen).csv().encode())
                ui.download(table, f"{chosen}.csv", "text/csv")

            async def download_trials() -> None:
                table = await page.work(lambda: table_of(studies.files, chosen).trials_csv().encode())
                ui.download(table, f"{chosen}_trials.csv", "text/csv")

            ui.button("Table as CSV, a row a step", icon="download", on_click=download).props("no-caps")
            ui.button("A row a trial", icon="download", on_click=download_trials).props("no-caps")


def _results_of(
    studies: Studies, study: str, by_round: bool, all_trials: bool
) -> tuple[list[Any], StudyTable, list[ConditionSummary]]:
    """The newest trials of a study with their states, its table, and what was measured. Reads all its files."""
    table = table_of(studies.files, study)
    trials = sorted(studies.files.trials(study), key=lambda trial: trial.path.stat().st_mtime)[-MOST_TRIALS:]
    return [(each, each.state()) for each in trials], table, summaries_of(table, by_round, all_trials)


def _trials(page: Any, trials: list[Any]) -> None:
    ui.label("Trials" if len(trials) < MOST_TRIALS else f"The newest {MOST_TRIALS} trials").classes("text-h6")
    with ui.element("div").classes("w-full overflow-auto max-h-[40vh]"), ui.grid(columns=6).classes(
        "items-center gap-x-6"
    ):
        for title in ("Trial", "Condition", "State", "Steps", "Notes, deviations", "Replay"):
            ui.label(title).classes("text-bold")
        for trial, state in trials:
            ui.label(trial.path.name)
            ui.label(", ".join(f"{name}: {level}" for name, level in state.about.get("condition", {}).items()))
            ui.label(state.status_text).classes("" if state.counts else "text-negative")
            ui.label(state.steps_text)
            ui.label(f"{state.notes}, {state.deviations}")
            target = f"/study/replay?robot={quote(page.robot.name)}&trial={quote(trial.id)}"
            ui.link("replay", target).props(f'aria-label="replay of {trial.path.name}"')


def _summaries(summaries: list[ConditionSummary]) -> None:
    if not summaries:
        ui.label("No step with an answer was done yet.")
        return
    ui.label("Answers and reaction times").classes("text-h6")
    columns = [
        {"name": name, "label": label, "field": name, "align": "left", "sortable": True}
        for name, label in (
            ("label", "Step"),
            ("round", "Round"),
            ("condition", "Condition"),
            ("count", "Times"),
            ("answers", "Answers"),
            ("mean", "Mean, s"),
            ("median", "Median, s"),
            ("deviation", "Standard deviation, s"),
        )
    ]
    rows = [
        {
            "id": i,
            "label": each.label,
            "round": each.round,
            "condition": each.condition,
            "count": each.count,
            "answers": ", ".join(f"{answer} {count}" for answer, count in sorted(each.answers.items())),
            "mean": _number(each.mean),
            "median": _number(each.median),
            "deviation": _number(each.deviation),
        }
        for i, each in enumerate(summaries)
    ]
    ui.table(columns=columns, rows=rows, row_key="id", pagination=MOST_ROWS).classes("w-full").props("dense flat")
    colours = colours_of(answer for each in summaries for answer in each.answers)
    with ui.row().classes("w-full"):
        for label in dict.fromkeys(each.label for each in summaries):
            of_step = [each for each in summaries if each.label == label]
            if any(each.reactions for each in of_step):
                _plot(f"Reaction time of {label}, s", of_step, _reaction_series(of_step))
            answers = [answer for answer in colours if any(answer in each.answers for each in of_step)]
            series = [_count_series(answer, of_step, colours[answer]) for answer in answers]
            _plot(f"Answers of {label}", of_step, series, legend=True)


def _plot(title: str, summaries: list[ConditionSummary], series: list[Any], legend: bool = False) -> None:
    """A plot; the table above has the same numbers, for who does not see it."""
    with ui.column().classes("min-w-[20rem] flex-1 gap-0"):
        ui.label(title).classes("text-subtitle2")
        ui.echart(
            {
                "animation": False,
                "aria": {"enabled": True},
                "legend": {"show": legend, "type": "scroll", "top": 0, "textStyle": {"color": "#888"}},
                "grid": {"left": 40, "right": 10, "top": 40, "bottom": 60},
                "xAxis": {
                    "type": "category",
                    "data": [_levels(each) for each in summaries],
                    "axisLabel": {"interval": 0, "color": "#888", "lineHeight": 15},
                },
                "yAxis": {"type": "value", "axisLabel": {"color": "#888"}},
                "series": series,
            }
        ).classes("w-full h-72")


def _reaction_series(summaries: list[ConditionSummary]) -> list[dict[str, Any]]:
    points = [[i, seconds] for i, each in enumerate(summaries) for seconds in each.reactions]
    return [
        {"type": "bar", "name": "mean", "data": [each.mean for each in summaries], "barMaxWidth": 60},
        {"type": "scatter", "name": "single", "data": points, "symbolSize": 7, "itemStyle": {"color": "#e65100"}},
    ]


def _count_series(answer: str, summaries: list[ConditionSummary], colour: str) -> dict[str, Any]:
    counts = [each.answers.get(answer, 0) for each in summaries]
    style = {"color": colour}
    return {"type": "bar", "name": answer, "stack": "answers", "data": counts, "barMaxWidth": 60, "itemStyle": style}


def colours_of(answers: Iterable[str]) -> dict[str, str]:
    """A colour for each answer, the same in all plots of a study; no answer is grey, and the last."""
    known = sorted({*answers} - {NOTHING})
    return {**{answer: COLOURS[i % len(COLOURS)] for i, answer in enumerate(known)}, NOTHING: GREY}


def _levels(summary: ConditionSummary) -> str:
    """The levels of a condition beneath each other, and the round."""
    levels = [part.partition(": ")[2] or part for part in summary.condition.split(", ")]
    return "\n".join([*levels, *([f"round {summary.round}"] if summary.round else [])])


def _number(value: float | None) -> float | None:
    return None if value is None else round(value, 3)


LOGGED = ("n", "stamp", "kind", "by", "text")


def replay_of(trial: TrialFolder) -> dict[str, Any]:
    """What the timeline shows of a trial, JSON values; times are ROS times, s."""
    events = read_events(trial.path)
    state = TrialState.of(events)
    stamps = [event["stamp"] for event in events if event.get("stamp")] or [0.0]
    ended = state.ended or max(stamps)
    return {
        "trial": trial.id,
        "began": state.began or min(stamps),
        "ended": ended,
        "events": sorted(
            ({name: event.get(name) or "" for name in LOGGED} for event in events if event.get("stamp")),
            key=lambda event: event["stamp"],
        ),
        "steps": [
            {
                "path": step.path,
                "text": step.text,
                "began": step.ended if step.began is None else step.began,
                "ended": ended if step.ended is None else step.ended,
                "outcome": step.outcome,
                "answer": step.answer,
            }
            for step in state.outcomes
        ],
        "goals": _goals(events, ended),
        "media": [
            {
                "kind": file["recording"],
                "url": f"/console/study/media/{trial.id}/{file['file']}",
                "began": file["began"],
            }
            for file in state.files
            if file["recording"] in ("video", "sound") and file.get("file") and file.get("began")
        ],
    }


def _goals(events: list[dict[str, Any]], ended: float) -> list[dict[str, Any]]:
    """Goals of the console; one whose end was not logged lasts until the trial was resumed, or was over."""
    goals: dict[str, dict[str, Any]] = {}
    for event in events:
        about = event.get("data") or {}
        goal = about.get("goal")
        if about.get("what") == RESUMED:
            for each in goals.values():
                each["ended"] = min(each["ended"], event["stamp"])
        if goal and event.get("kind") == "sent":
            text = str(event.get("text", ""))
            goals[goal] = {"path": "", "text": text, "began": event["stamp"], "ended": ended, "outcome": ""}
        elif goal in goals and event.get("kind") == "ended":
            goals[goal].update(ended=event["stamp"], outcome=about.get("state", ""))
    return list(goals.values())


def build_replay(console: Any) -> None:
    """Add the page, its data, and the media."""
    files: StudyFiles = console.studies.files

    def replay(trial: str) -> str:
        return json.dumps(replay_of(files.trial(trial)), ensure_ascii=False)

    @console.app.get("/console/study/replay/{study}/{name}")
    async def data(study: str, name: str) -> Response:
        try:
            return Response(await in_background(replay, f"{study}/{name}"), media_type="application/json")
        except StudyError as error:
            return PlainTextResponse(str(error), 404)

    @console.app.get("/console/study/media/{study}/{name}/{file}")
    async def media(study: str, name: str, file: str) -> Response:
        try:
            path = await in_background(files.media, f"{study}/{name}", file)
        except StudyError as error:
            return PlainTextResponse(str(error), 404)
        return FileResponse(path)  # answers parts, which a browser needs to go to a time

    @page_at(console, "/study/replay")
    async def show(request: Request, trial: str = "") -> None:
        with framed(console, "Study", request) as page:
            study_links(page)
            try:
                folder = await page.ask(files.trial, trial)
            except StudyError as error:
                ui.label(str(error)).classes("text-negative")
                return
            ui.label(f"Trial {folder.id}").classes("text-h6")
            place = ui.element("div").classes("w-full")
            url = f"/console/study/replay/{folder.id}"
            ui.timer(
                0.1,
                lambda: ui.run_javascript(
                    f"import('/console/static/replay.js').then(m => m.mount('c{place.id}', {json.dumps(url)}))"
                ),
                once=True,
            )
