"""What the demonstration and the film share: the stack they start, its film, and how to look at what it left."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any, Callable, List, Tuple

from nao_library_modules.core.files import write_whole
from nao_library_modules.ros.own_stack import OwnStack

SPEED = "3"
"""Times real time: nobody watches. The simulator goes slower where the computer cannot follow."""
START_LIMIT = 240.0
"""s of wall time for a server to come up on a busy computer."""
# Everything the loudspeakers play.
SOUND = "sound.wav"
# Of films.
VIEW = "stage"
# Root mean square of speech, of full scale.
LOUD = 0.02

Row = Tuple[str, str, bool]
"""Of the table: what was asked, what the robot reports, whether that is good."""


class Table:
    """Rows of what was asked and what the robot reports, printed as they come.

    Attributes:
        rows: All so far.
    """

    def __init__(self) -> None:
        self.rows: List[Row] = []

    def add(self, asked: str, reported: str, good: bool) -> None:
        self.rows.append((asked, reported, good))
        print(f"  {'ok  ' if good else 'FAIL'}  {asked}: {reported}", flush=True)

    @property
    def failures(self) -> int:
        return sum(not good for _, _, good in self.rows)

    @property
    def summary(self) -> str:
        return f"{len(self.rows) - self.failures} of {len(self.rows)} as asked"

    def write(self, path: Path) -> None:
        """Write it as Markdown."""
        lines = ["| asked | the robot reports | |", "|---|---|---|"]
        lines += [f"| {asked} | {reported} | {'ok' if good else 'FAIL'} |" for asked, reported, good in self.rows]
        write_whole(path, "\n".join(lines) + "\n")


class Stack(OwnStack):
    """A simulated robot with its servers; this program becomes a node of its ROS master.

    Args:
        output: Folder for what the robot records and for the log.
        arguments: Of the launch file.
    """

    def __init__(self, output: Path, **arguments: str) -> None:
        announce("starting the simulated robot and its action servers", 10)
        super().__init__(output / "stack.log", {"record_dir": str(output), "speed": SPEED, **arguments})
        os.environ["ROS_MASTER_URI"] = self.master_uri

    def join(self, node: str) -> None:
        """Make this program a node when the robot is there: then the master knows whose time is that of ROS."""
        import rospy

        self.wait_for_robot()
        rospy.init_node(node, disable_signals=True)

    def client(self, name: str, action: Any) -> Any:
        """A client of an action server that is there.

        Raises:
            StackFailed: The server did not come up.
        """
        import rospy

        from nao_library_modules.simple_action_client import SimpleActionClient

        client = SimpleActionClient(name, action)
        self.wait_until(lambda: client.wait_for_server(rospy.Duration(0.5)), f"the server {name}", START_LIMIT)
        return client

    def service(self, name: str, kind: Any) -> Any:
        """A service that is there.

        Raises:
            StackFailed: It did not come up.
        """
        import rospy

        def there() -> bool:
            try:
                rospy.wait_for_service(name, 0.5)
            except rospy.ROSException:
                return False
            return True

        self.wait_until(there, f"the service {name}", START_LIMIT)
        return rospy.ServiceProxy(name, kind)


class Film:
    """The film of the simulated robot, drawn while the computer has time for it and else when it ends.

    Args:
        stack: The running stack.
        file: Its name in the output folder.
        size: Pixels each way.
        rate: Pictures a second.
    """

    def __init__(self, stack: Stack, file: str, size: int = 300, rate: float = 10.0) -> None:
        from nao_library_msgs.srv import CaptionFilm, StartFilm, StopFilm

        self._file, self._size, self._rate = file, size, rate
        self._start = stack.service("nao_sim/film/start", StartFilm)
        self._caption = stack.service("nao_sim/film/caption", CaptionFilm)
        self._stop = stack.service("nao_sim/film/stop", StopFilm)

    def start(self) -> None:
        _require(self._start(self._file, VIEW, self._size, self._size, self._rate))

    def caption(self, text: str) -> None:
        _require(self._caption(text))

    def stop(self, table: Table) -> None:
        """Complete it, with a row of the table."""
        announce("drawing the rest of the film", 20)
        film = _require(self._stop())
        report = f"{film.frames} pictures, {film.length.to_sec():.0f} s, with sound"
        table.add(f"film {self._file}", report, film.frames > 0)


def _require(answer: Any) -> Any:
    if not answer.success:
        raise RuntimeError(answer.message)
    return answer


def may_fill(folder: Path, overwrite: bool) -> bool:
    """Make the folder if need be; False, with a line that says why, if it holds something that may not be replaced."""
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.iterdir()) and not overwrite:
        print(f"{folder} is not empty: another folder, or --overwrite")
        return False
    return True


def announce(what: str, seconds: float) -> None:
    """Say what comes that takes more than 3 s, and about how long, s."""
    print(f"{what} (about {seconds:.0f} s)", flush=True)


def loud_time(path: Path) -> float:
    """How long a sound file is loud, s, looked at in tenths of a second."""
    import numpy as np
    import soundfile

    samples, rate = soundfile.read(path, always_2d=True)
    length = rate // 10
    tenths = samples[: len(samples) // length * length, 0].reshape(-1, length)
    return float((np.sqrt((tenths**2).mean(axis=1)) > LOUD).sum()) / 10.0


def count_green_pixels(path: Path) -> int:
    """Pixels of a picture that only a lit green LED has."""
    import numpy as np
    from PIL import Image

    red, green, blue = (np.asarray(Image.open(path).convert("RGB"))[:, :, i].astype(int) for i in range(3))
    return int(((green > 150) & (green > 1.6 * red) & (green > 1.6 * blue)).sum())


def wait_until(ready: Callable[[], bool], limit: float, what: str) -> None:
    """Wait until `ready()`, looking ten times a second: for what the robot tells nobody of, such as its LEDs.

    Raises:
        RuntimeError: It did not become ready within `limit` s.
    """
    give_up = time.monotonic() + limit
    while not ready():
        if time.monotonic() > give_up:
            raise RuntimeError(f"{what} did not become ready within {limit:g} s")
        time.sleep(0.1)
