"""Recordings of a trial: a rosbag as a process of its own, videos and sounds by the servers.

All of them continue when the console is killed, and a trial that is resumed finds them by what its log says.

The process of the rosbag is the recorder itself, not the program `rosbag` around it: where signals were ignored when
that one began, as in the background of a shell, a signal ends it with an error before the recorder has closed its file.
"""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from subprocess import SubprocessError
from typing import Any

from naoqi.errors import NaoError

from ..core.files import FileTrouble, move_whole
from ..ros.master_api import GONE, Api, Refused
from . import trial_log as told
from .commands import call
from .protocol import WantedRecordings
from .robot_events import within

LONGEST = "4h"
"""Of a bag whose console does not come back."""
BAG_LIMIT = 30.0
"""s of this computer that the recorder has for its end."""
BEGIN_LIMIT = 15.0
"""s of this computer that it has until it reads all topics."""
SETTLED = 1.0
"""s of this computer without a new connection, behind which a publisher that is still missing counts as dead."""
ACTIVE = ".active"
"""End of the name of a bag that is not whole yet."""
CALLER, NODE = "/nao_study", "/nao_study_bag"


class BagRecorder:
    """Records topics into a file.

    `file`: the bag. `topics`: full names. `log`: where the recorder writes what it has to say. Raises NaoError if there
    is no recorder.
    """

    def __init__(self, file: Path, topics: Sequence[str], log: Path) -> None:
        self.file, self.topics = file, tuple(topics)
        self._node = f"{NODE}_{os.getpid()}_{time.monotonic_ns()}"
        self._connections: Counter[str] = Counter()
        self._changed = 0.0
        command = [_program(), "--lz4", "--duration", LONGEST, "-O", str(file), *topics, f"__name:={self._node[1:]}"]
        environment = {name: value for name, value in os.environ.items() if name != "ROS_NAMESPACE"}
        with log.open("ab") as output:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=output,
                env=environment,
                start_new_session=True,  # neither Ctrl-C nor the end of the console ends it
            )

    @property
    def pid(self) -> int:
        """Of its process."""
        return self._process.pid

    def wait_until_it_records(self) -> None:
        """Wait until it has a file and is connected to those who publish its topics.

        Raises NaoError if it ends before, or that takes too long.
        """
        missing = list(self.topics)

        def records() -> bool:
            if self._process.poll() is not None:
                raise NaoError("rosbag has ended at once: see rosbag.log")
            if not self.file.with_name(self.file.name + ACTIVE).exists():
                return False
            missing[:] = self._missing()
            return not missing

        if not within(BEGIN_LIMIT, records):
            what = f"does not read {', '.join(missing)}"
            raise NaoError(f"rosbag {what} after {BEGIN_LIMIT:g} s: what comes before is missing in the bag")

    def wait_for_end(self) -> None:
        """Wait until its process is over. Raises NaoError if that takes too long."""
        try:
            self._process.wait(BAG_LIMIT)
        except subprocess.TimeoutExpired:
            raise NaoError(f"rosbag (process {self.pid}) has not ended within {BAG_LIMIT:g} s") from None

    def _missing(self) -> list[str]:
        """Topics that somebody publishes and that it does not get yet."""
        import rosgraph

        master = Api(rosgraph.get_master_uri(), CALLER)
        try:
            publishers = {topic: len(nodes) for topic, nodes in master.ask("getSystemState")[0]}
            links = Api(master.ask("lookupNode", self._node), CALLER).ask("getBusInfo")
        except (Refused, *GONE):
            return list(self.topics)
        found = Counter(link[4] for link in links if link[2] == "i" and link[5])
        if found != self._connections:
            self._connections, self._changed = found, time.monotonic()
        most = 1 if time.monotonic() > self._changed + SETTLED else max(publishers.values(), default=0)
        return [topic for topic in self.topics if found[topic] < min(most, publishers.get(topic, 0))]


def is_bag(file: Path, about: Mapping[str, Any]) -> bool:
    """Whether the process that was noted records into a file: other programs may have had its number since."""
    try:
        arguments = Path(f"/proc/{int(about['pid'])}/cmdline").read_bytes().split(b"\0")
    except (OSError, KeyError, ValueError):
        return False
    wanted = os.path.realpath(os.fsencode(file))
    return b"-O" in arguments and any(os.path.realpath(each) == wanted for each in arguments if each)


def end_bag(file: Path, about: Mapping[str, Any], recorder: BagRecorder | None = None) -> None:
    """End a recording, and wait until its file is whole.

    `recorder`: it, if this program began it. Raises NaoError if it does not end, or has left no whole file.
    """
    if is_bag(file, about):
        os.kill(int(about["pid"]), signal.SIGINT)
    if recorder is not None and recorder.pid == about["pid"]:
        recorder.wait_for_end()
    elif not within(BAG_LIMIT, lambda: not is_bag(file, about)):
        raise NaoError(f"rosbag (process {about['pid']}) has not ended within {BAG_LIMIT:g} s")
    if not file.exists():
        raise NaoError("rosbag left no whole file: see rosbag.log")


def _program() -> str:
    from roslib.packages import find_node

    found = find_node("rosbag", "record")
    if not found:
        raise NaoError("rosbag is not installed: apt install ros-noetic-rosbag, or rosbag of your system")
    return str(found[0])


BAG, VIDEO, SOUND = "bag", "video", "sound"
SERVERS = {VIDEO: "NaoVision", SOUND: "nao_audio_in"}
GONE_AFTER = 5.0
"""s of this computer without a report of a server, which reports its recordings once a second."""
BEGUN_AFTER = 3.0
"""s of this computer from the begin of a recording until its server's reports count."""
FRESH = 1.5
"""s of this computer for which a report is that of the server that began: to start one again takes longer."""
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
        self._started: dict[str, str] = {}  # recording -> when its server was started

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
                self._started.pop(kind, None)
                continue
            since = self._seen.setdefault(kind, now)
            if now - report.heard <= FRESH:
                self._started.setdefault(kind, report.started)
            if now - report.heard > GONE_AFTER:
                found[kind] = f"{server} does not report any more"
            elif report.heard > since + BEGUN_AFTER and not report.names:
                found[kind] = f"{server} does not record"
            elif report.started != self._started.get(kind, report.started):
                found[kind] = f"{server} was started again, and what was meanwhile is lacking"
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
