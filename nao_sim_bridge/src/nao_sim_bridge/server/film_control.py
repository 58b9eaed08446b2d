"""Films as clients ask for them: one at a time, into files of theirs. For any thread."""

from __future__ import annotations

import logging
import threading

from nao_sim_bridge.base.errors import BadValue, NotAllowed
from nao_sim_bridge.base.record_dir import ClientFiles, unused
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task, WorkThreads
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import known
from nao_sim_bridge.render.client import RenderError
from nao_sim_bridge.server.film import END_LIMIT, Film, FilmReport
from nao_sim_bridge.world.render_state import PRESETS

log = logging.getLogger("nao_sim.film")

FRAME_RATE, MAX_FRAME_RATE = 20.0, 60.0
SIZE, MAX_SIZE = (480, 480), 1920
VIEW = "three_quarter"
FILE, TYPE = "film.mp4", ".mp4"


class FilmControl:
    """Begins and ends films, one at a time. For any thread."""

    def __init__(self, runner: RobotRunner, files: ClientFiles, engine: str = "auto") -> None:
        self._runner = runner
        self._files = files
        self._engine = engine
        self._lock = threading.Lock()
        self._film: Film | None = None
        self._working = WorkThreads("films", 2)  # another one may begin while the last frames of one are drawn

    def start(self, file: str, view: str, width: int, height: int, frame_rate: float) -> Task:
        """Begin a film; the task ends with its path, as text, when the camera runs.

        Args:
            file: Name inside the folder for recordings, ending with .mp4; one that is there is replaced. Empty for
                film.mp4, or film-2.mp4, ...: the first one that is not there.
            view: A view of pictures; empty for three_quarter.
            width, height: Pixels, even; 0 for 480.
            frame_rate: Pictures a second of simulated time; 0 for 20.

        Raises:
            SimulationError: One of them is wrong.
            ValueError: There can be no such file.
        """
        view, frame_rate = view or VIEW, frame_rate or FRAME_RATE
        size = (width or SIZE[0], height or SIZE[1])
        known(view, "view", PRESETS)
        if not all(16 <= side <= MAX_SIZE and side % 2 == 0 for side in size):
            raise BadValue("film size", size, f"even numbers, 16 to {MAX_SIZE} pixels each way")
        if not 1.0 <= frame_rate <= MAX_FRAME_RATE:
            raise BadValue("frame_rate", frame_rate, f"1 to {MAX_FRAME_RATE:g} a second")
        if file and not file.endswith(TYPE):
            raise BadValue("file", file, f"a name that ends with {TYPE}")
        path = self._files.to_keep(file) if file else unused(self._files.to_keep(FILE))

        def start() -> str:
            with self._lock:
                if self._film is not None:
                    raise NotAllowed(f"{self._film.path.name} is being filmed: end it first")
                film = Film(self._runner.simulation, path, view, size, frame_rate, self._engine)
                self._runner.call(film.begin)
                self._film = film
            return str(path)

        return self._working.work_out("startFilm", start)

    def caption(self, text: str) -> None:
        """Write a text into the film from now on; empty for none.

        A BadValue when it is too long, a NotAllowed when nothing is filmed.
        """
        longest = load_sizes().film.caption_characters
        if len(text) > longest:
            raise BadValue("caption", f"{text[:40]}... of {len(text)} characters", f"{longest} characters at most")
        self._running().caption(text)

    def stop(self) -> Task:
        """End the film; the task ends with its `FilmReport` when the file is complete."""

        def stop() -> FilmReport:
            with self._lock:
                film = self._running()
                self._runner.call(film.pause)
                self._film = None
            return film.end()

        return self._working.work_out("stopFilm", stop)

    def close(self, limit: float = END_LIMIT) -> None:
        """End the film that is taken, before the simulation ends; what is not drawn in `limit` s is left out."""
        with self._lock:
            film, self._film = self._film, None
        if film is not None:
            self._runner.call(film.pause)
            try:
                log.info("%s is complete", film.end(limit).path)
            except RenderError as error:
                log.warning("%s", error)

    def _running(self) -> Film:
        if self._film is None:
            raise NotAllowed("nothing is being filmed: start a film first")
        return self._film
