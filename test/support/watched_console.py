"""The program `nao`, watched: what its event loops should not do goes into a file, a line each.

`watched_console.py REPORT WORDS...`: REPORT is the file; WORDS are those of `nao`.

A callback of a loop may take LONGEST s of the processor, and more by as much as a piece of reference work takes longer
just then, where others share the caches. And it neither opens files, connects sockets, starts programs or sleeps, nor
waits for another thread or for ROS. Imports, each of which happens once, are let be, and the collections of garbage,
which come where they like.
"""

from __future__ import annotations

import asyncio
import gc
import os
import runpy
import sys
import threading
import time
import traceback
from pathlib import Path

LONGEST = 0.05
EVENTS = ("open", "socket.connect", "socket.getaddrinfo", "subprocess.Popen", "time.sleep")
CONSOLE = f"{os.sep}nao_library_modules{os.sep}console{os.sep}"
IMPORT = "<frozen importlib"
NAO = Path(__file__).resolve().parents[2] / "nao_library_modules" / "nodes" / "nao"


def reference():
    """Time of the processor, s, that a piece of work takes just now."""
    began = time.thread_time()
    made = [{str(i): [i, {"place": i}]} for i in range(3000)]
    sorted(made, key=str)
    return time.thread_time() - began


class Watch:
    """Looks at what is done in callbacks of event loops, in all threads."""

    def __init__(self, report):
        self._report = report
        self._inside = threading.local()
        self._quiet = min(reference() for _ in range(20))

    def install(self):
        """From now on."""
        import rospy

        run, wait = asyncio.events.Handle._run, threading.Condition.wait
        proxy, topic = rospy.ServiceProxy.call, rospy.topics.Topic.__init__

        def watched_run(handle):
            self._inside.loop, self._inside.collected = True, 0.0
            began = time.thread_time()
            try:
                run(handle)
            finally:
                self._inside.loop = False
                taken = time.thread_time() - began - self._inside.collected
                if taken > LONGEST and taken > LONGEST * max(reference() for _ in range(3)) / self._quiet:
                    task = getattr(handle._callback, "__self__", None)
                    what = task.get_coro().__qualname__ if isinstance(task, asyncio.Task) else repr(handle)
                    self._tell(f"{1000 * taken:.0f} ms of the processor: {what}")

        def watched(call, what):
            def called(*arguments, **options):
                self._look(what)
                return call(*arguments, **options)

            return called

        def watched_wait(condition, timeout=None):
            if timeout is None or timeout > 0:
                self._look("a wait for another thread")
            return wait(condition, timeout)

        asyncio.events.Handle._run = watched_run
        threading.Condition.wait = watched_wait
        rospy.ServiceProxy.call = watched(proxy, "a service of ROS")
        rospy.topics.Topic.__init__ = watched(topic, "a topic of ROS")
        gc.callbacks.append(self._collect)
        sys.addaudithook(lambda event, _: self._look(event) if event in EVENTS else None)

    def _collect(self, phase, _):
        now = time.thread_time()
        if phase == "start":
            self._inside.began = now
        else:
            self._inside.collected = getattr(self._inside, "collected", 0.0) + now - self._inside.began

    def _look(self, what):
        if not getattr(self._inside, "loop", False):
            return
        self._inside.loop = False  # what is told opens a file itself
        try:
            frames = traceback.extract_stack()
            ours = [frame for frame in frames if CONSOLE in frame.filename]
            if ours and not any(map(_is_harmless, frames)):
                last = [] if frames[-3] in ours else [frames[-3]]  # behind those of this watch
                told = [f"{Path(frame.filename).name}:{frame.lineno} {frame.name}" for frame in last + ours[::-1]]
                self._tell(f"{what}: " + " < ".join(told))
        finally:
            self._inside.loop = True

    def _tell(self, line):
        with open(self._report, "a") as report:
            print(line, file=report)


def _is_harmless(frame):
    """Whether it is an import, or the start of a thread, which waits until that runs."""
    return frame.filename.startswith(IMPORT) or (frame.filename == threading.__file__ and frame.name == "start")


if __name__ == "__main__":
    Watch(sys.argv[1]).install()
    sys.argv = [str(NAO), *sys.argv[2:]]
    runpy.run_path(sys.argv[0], run_name="__main__")
