"""The node interface of a module without a ROS master: action server, clock, topics as lists."""

from __future__ import annotations

from types import SimpleNamespace

from nao_library_modules.core.waiting import WallClock
from naoqi.errors import NaoError


class ActionServer:
    """A SimpleActionServer as far as `execute_cb` sees it."""

    def __init__(self, action, execute, on_preempt):
        self._result_type = type(action().action_result.result)
        self.execute = execute
        self._on_preempt = on_preempt
        self.preempt_requested = False
        self.started = False
        self.feedback = []
        self.end = self.result = self.text = None

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

    def _set(self, end, result, text):
        self.end, self.result, self.text = end, result, text

    def set_succeeded(self, result, text=""):
        self._set("succeeded", result, text)

    def set_aborted(self, result, text=""):
        self._set("aborted", result, text)

    def set_preempted(self, result, text=""):
        self._set("preempted", result, text)


class RecordedNode:
    """What a module has of a ROS node, for a test to look at.

    Attributes:
        events: (name, value) of what went to `memory_events`.
        frames: Frame of /tf -> Place, for `locate`.
        services, subscribers, descriptions: By name, the callbacks.
        parameters: Of the node, by name.
    """

    namespace = "/robot1/"

    def __init__(self, clock=None):
        self.clock = clock or WallClock()
        self.events = []
        self.shutdown_actions = []
        self.reports = {}
        self.frames = {}
        self.services = {}
        self.subscribers = {}
        self.descriptions = {}
        self.parameters = {}

    def locate(self, frame):
        if frame not in self.frames:
            raise NaoError(f"the frame {frame} cannot be found")
        return self.frames[frame]

    def driver(self):
        """No driver: everything goes to the robot."""

    def frame_prefix(self):
        return "robot1/"

    def action_server(self, name, action, execute, on_preempt):
        return ActionServer(action, execute, on_preempt)

    def seconds(self, name, default):
        return self.parameters.get(name, default)

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

    def kept(self):
        return SimpleNamespace(load=lambda form: None, save=lambda value: None, forget=lambda: None)

    def on_shutdown(self, action):
        self.shutdown_actions.append(action)
