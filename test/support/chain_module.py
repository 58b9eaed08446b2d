"""A module of functions that say what they did, for tests of NaoBasic, and goals for it."""

from __future__ import annotations

import threading

from genpy import Duration

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_modules.errors import BadGoal
from nao_library_modules.nao_basic import NaoBasic
from nao_library_msgs.msg import LedFunction


class ChainModule(NaoBasic):
    """A module whose functions say what they did."""

    def __init__(self, **options):
        super().__init__("10.0.0.7", 9559, **options)
        self.done = []
        self.started = threading.Event()
        self.function_table.update(
            say=self.say,
            fail=self.fail,
            crash=self.crash,
            last=self.last,
            borrow=self.borrow,
            nested=self.nested,
        )
        self.serve("Module", NaoLedAction)

    def say(self, str_param):
        self.done.append(str_param)
        return str_param

    def fail(self, str_param):
        raise BadGoal("str_param", str_param, "something else")

    def crash(self):
        raise KeyError("oops")

    def last(self):
        """A robot method that lasts until it is cancelled."""
        self.started.set()
        self.call(self.robot.proxy("ALLeds"), "rasta", 60.0)

    def borrow(self, str_param):
        """Something to be given back."""
        self.done.append(f"borrow {str_param}")
        self.after_wait(lambda: self.done.append(f"return {str_param}"))

    def nested(self):
        self.borrow("outer")
        self.run("borrow", ["inner"], 0.0)
        self.done.append("nested done")


def chain(*functions, time=0.0):
    messages = [LedFunction(function=f, str_param=p, time=Duration.from_sec(time)) for f, p in functions]
    return NaoLedGoal(messages)
