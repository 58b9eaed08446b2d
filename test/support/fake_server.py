"""The ROS side of a module without ROS: action server, clock, topics."""

from __future__ import annotations

import threading
from types import SimpleNamespace

from nao_library_modules.clock import WallClock
from naoqi.errors import NaoError


class FakeServer:
    """A SimpleActionServer as far as `execute_cb` sees it."""

    def __init__(self, action, execute, on_preempt):
        self._result_type = type(action().action_result.result)
        self._execute = execute
        self._on_preempt = on_preempt
        self.preempt_requested = False
        self.started = False
        self.feedback = []
        self.end = None
        self.result = None
        self.text = None

    def start(self):
        self.started = True

    def is_preempt_requested(self):
        return self.preempt_requested

    def get_default_result(self):
        return self._result_type()

    def publish_feedback(self, feedback):
        self.feedback.append(feedback)

    def preempt(self):
        self.preempt_requested = True
        self._on_preempt()

    def play(self, goal):
        """Carry a goal out to its end."""
        self.end = None
        self._execute(goal)
        assert self.end is not None, "the goal has no end state"
        self.preempt_requested = False
        return self

    def play_in_background(self, goal):
        thread = threading.Thread(target=self.play, args=(goal,), daemon=True)
        thread.start()
        return thread

    def _set(self, end, result, text):
        self.end, self.result, self.text = end, result, text

    def set_succeeded(self, result, text=""):
        self._set("succeeded", result, text)

    def set_aborted(self, result, text=""):
        self._set("aborted", result, text)

    def set_preempted(self, result, text=""):
        self._set("preempted", result, text)


class NotingClock(WallClock):
    """Wall-clock time; tells when somebody waits, and shortens nothing."""

    def __init__(self):
        self.waits = []
        self.waiting = threading.Event()

    def wait(self, duration, interrupt):
        self.waits.append(duration)
        self.waiting.set()
        return super().wait(duration, interrupt)


class FakeEdge:
    """The ROS side of a module without ROS."""

    namespace = "/robot1/"

    def __init__(self):
        self.clock = NotingClock()
        self.events = []
        self.shutdown_actions = []
        self.reports = {}
        self.frames = {}
        self.services = {}
        self.subscribers = {}
        self.descriptions = {}

    def locate(self, frame):
        if frame not in self.frames:
            raise NaoError(f"the frame {frame} cannot be found")
        return self.frames[frame]

    def frame_prefix(self):
        return "robot1/"

    def action_server(self, name, action, execute, on_preempt):
        return FakeServer(action, execute, on_preempt)

    def event_sink(self):
        return lambda name, value: self.events.append((name, value))

    def publish_diagnostics(self, hardware_id, reports):
        self.reports = reports
        return SimpleNamespace(close=lambda: None)

    def serve(self, name, kind, answer):
        self.services[name] = answer

    def subscribe(self, topic, kind, callback):
        self.subscribers[topic] = callback

    def serve_description(self, name, answer):
        self.descriptions[name] = answer

    def on_shutdown(self, action):
        self.shutdown_actions.append(action)
