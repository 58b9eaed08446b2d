"""`/study/replay?trial=STUDY/PSEUDONYM-N`: a trial as a timeline with its video."""

from __future__ import annotations

import json
from typing import Any

from nicegui import ui
from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response

from ...study.errors import StudyError
from ...study.files import StudyFiles, TrialFolder
from ...study.log import read_events
from ...study.state import RESUMED, TrialState
from ...view.background import in_background
from ..frame import framed, page_at
from .links import study_links

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
