"""Recordings of a trial: a rosbag as a process of its own, videos and sounds by the servers.

All of them go on when the console is killed, and a trial that is resumed finds them by what its log tells.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from subprocess import SubprocessError
from typing import Any

from naoqi.errors import NaoError

from ...base.whole_file import FileTrouble, move_whole
from ..robots.commands import call
from . import state as told
from .bag import ACTIVE, BagRecorder, end_bag, is_bag
from .protocol import WantedRecordings

BAG, VIDEO, SOUND = "bag", "video", "sound"
SERVERS = {VIDEO: "NaoVision", SOUND: "nao_audio_in"}
GONE_AFTER = 5.0
"""s of this computer without a report of a server, which reports its recordings once a second."""
BEGUN_AFTER = 3.0
"""s of this computer from the begin of a recording until its server's reports count."""
LIMIT = 30.0
"""s of this computer that a server has for the begin or the end of a recording."""


class TrialRecordings:
    """Begins what is wanted of a trial, and ends what runs.

    `folder`: of the trial; files come there where they can be reached. `wanted`: what is recorded.
    """

    def __init__(self, folder: Path, wanted: WantedRecordings) -> None:
        self._folder, self._wanted = folder, wanted
        self._bag: BagRecorder | None = None
        self._ending = False
        self._seen: dict[str, float] = {}  # recording -> when it was first seen to run

    def begin(self, runner: Any) -> None:
        """Begin what is wanted and does not run yet. What cannot be recorded is a deviation of the trial."""
        running = dict(runner.state.recordings)
        bag = running.get(BAG)
        if bag is not None and not is_bag(self._folder / str(bag["file"]), bag):
            self._tell_end(runner, BAG, file=bag["file"], error="the process was gone")
            bag = None
        for kind, wanted, begin in (
            (BAG, self._wanted.bag and bag is None, self._begin_bag),
            (VIDEO, self._wanted.video and VIDEO not in running, self._begin_video),
            (SOUND, self._wanted.sound and SOUND not in running, self._begin_sound),
        ):
            if wanted:
                try:
                    begin(runner)
                except (NaoError, OSError, SubprocessError) as error:
                    runner.deviation(f"the {kind}: {error}")

    def end(self, runner: Any) -> None:
        """End what runs, and fetch the files."""
        self._ending = True
        ends = {BAG: self._end_bag, VIDEO: self._end_video, SOUND: self._end_sound}
        for kind, about in list(runner.state.recordings.items()):
            try:
                ends[kind](runner, about)
            except (NaoError, OSError, SubprocessError) as error:
                self._tell_end(runner, kind, error=str(error))
                runner.deviation(f"the {kind} could not be ended: {error}")

    def stopped(
        self, running: Mapping[str, Mapping[str, Any]], reports: Mapping[str, Any], now: float
    ) -> dict[str, str]:
        """Recordings that have ended unasked -> reason.

        Args:
            running: Those of the trial, from its log.
            reports: Those of the servers, by name: `names` of what each records, and when that was `heard`.
            now: Time by the clock of the reports, s.
        """
        if self._ending:
            return {}
        found = {}
        bag = running.get(BAG)
        if bag is not None and not is_bag(self._folder / str(bag["file"]), bag):
            found[BAG] = "its process has ended"
        for kind, server in SERVERS.items():
            report = reports.get(server)
            if kind not in running or report is None:  # an older server does not report them
                self._seen.pop(kind, None)
                continue
            since = self._seen.setdefault(kind, now)
            if now - report.heard > GONE_AFTER:
                found[kind] = f"{server} does not report any more"
            elif report.heard > since + BEGUN_AFTER and not report.names:
                found[kind] = f"{server} does not record"
        return found

    def _begin_bag(self, runner: Any) -> None:
        file = _free(self._folder / "trial.bag")
        space = runner.robot.namespace.rstrip("/")
        topics = [topic if topic.startswith("/") else f"{space}/{topic}" for topic in self._wanted.bag]
        self._bag = BagRecorder(file, topics, self._folder / "rosbag.log")
        self._tell_begin(runner, BAG, file=file.name, pid=self._bag.pid, topics=topics)
        self._bag.wait_until_it_records()

    def _end_bag(self, runner: Any, about: Mapping[str, Any]) -> None:
        file = self._folder / str(about["file"])
        try:
            end_bag(file, about, self._bag)
        except NaoError as error:
            self._tell_end(runner, BAG, file=file.name, error=str(error))
        else:
            self._tell_end(runner, BAG, file=file.name)

    def _begin_video(self, runner: Any) -> None:
        fields = {"id": self._name(runner), "camera": self._wanted.video, "file_type": "mp4"}
        run = self._send(runner, SERVERS[VIDEO], "startRecording", **fields)
        self._tell_begin(runner, VIDEO, name=fields["id"], at=_path_of(run))

    def _end_video(self, runner: Any, about: Mapping[str, Any]) -> None:
        run = self._send(runner, SERVERS[VIDEO], "stopRecording", id=about["name"])
        for video in run.result.get("recordings") or [{}]:
            file = self._fetch(video.get("path", ""), f"video{Path(video.get('path', '')).suffix or '.mp4'}")
            self._tell_end(
                runner,
                VIDEO,
                file=file,
                began=_seconds(video.get("began")),
                duration=video.get("duration", 0.0),
                error=video.get("error", "") if file else "there is no file",
            )

    def _begin_sound(self, runner: Any) -> None:
        name = f"{self._name(runner)}.wav"
        run = self._send(runner, SERVERS[SOUND], "startRecording", str_param=name, overwrite=True)
        results = run.result.get("results") or [{}]
        self._tell_begin(runner, SOUND, name=name, began=_seconds(results[-1].get("end")) or runner.robot.now())

    def _end_sound(self, runner: Any, about: Mapping[str, Any]) -> None:
        run = self._send(runner, SERVERS[SOUND], "stopRecording")
        for sound in run.result.get("files") or [{}]:
            file = self._fetch(sound.get("file", ""), "sound.wav")
            duration, began = sound.get("duration", 0.0), about.get("began")
            problem = {} if file else {"error": f"on the robot alone: {sound.get('path', '')}"}
            self._tell_end(runner, SOUND, file=file, began=began, duration=duration, **problem)

    @staticmethod
    def _send(runner: Any, server: str, function: str, **fields: Any) -> Any:
        if runner.robot is None:
            raise NaoError("there is no robot")
        run = runner.robot.send(call(server, function, **fields))
        if not run.wait(LIMIT):
            run.cancel()
            raise NaoError(f"{server} does not answer within {LIMIT:g} s")
        if run.state != "succeeded":
            raise NaoError(run.text or run.state)
        return run

    @staticmethod
    def _name(runner: Any) -> str:
        return runner.id.replace("/", "_")[-64:]

    def _fetch(self, path: str, name: str) -> str:
        """Put a file of a server into the folder; its name there, empty if it is not on this computer."""
        source = Path(path)
        if not path or not source.is_file():
            return ""
        try:
            return move_whole(source, self._folder / name).name
        except FileTrouble:
            return ""

    @staticmethod
    def _tell_begin(runner: Any, kind: str, **about: Any) -> None:
        runner.tell(told.RECORDING_BEGAN, f"the recording of the {kind} begins", recording=kind, **about)

    @staticmethod
    def _tell_end(runner: Any, kind: str, **about: Any) -> None:
        error = about.get("error", "")
        text = f"the {kind} has ended" + (f": {error}" if error else "")
        runner.tell(told.RECORDING_ENDED, text, recording=kind, **about)


def _free(path: Path) -> Path:
    """A name that no recording has had in this trial."""
    number, name = 2, path
    while name.exists() or name.with_name(name.name + ACTIVE).exists():
        name = path.with_name(f"{path.stem}-{number}{path.suffix}")
        number += 1
    return name


def _path_of(run: Any) -> str:
    answers = run.result.get("memList") or [""]
    return str(answers[0])


def _seconds(value: Any) -> float | None:
    to_sec = getattr(value, "to_sec", None)
    return float(to_sec() if to_sec is not None else value or 0.0) or None
