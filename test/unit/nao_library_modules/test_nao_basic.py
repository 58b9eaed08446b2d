"""Goals as chains: progress, ends, preemption, clean-up, a robot that goes away."""

from __future__ import annotations

import threading

import pytest
from genpy import Duration

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_modules.errors import BadGoal, Preempted, UnknownFunction
from nao_library_modules.function_chain import checked_by
from nao_library_modules.launcher import BadLaunchPath
from nao_library_modules.nao_basic import NaoBasic
from nao_library_msgs.msg import LedFunction
from naoqi.errors import RobotUnreachable

LIMIT = 5.0


class Module(NaoBasic):
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


@pytest.fixture
def module(robot, edge):
    return Module(robot=robot, edge=edge)


def chain(*functions, time=0.0):
    messages = [LedFunction(function=f, str_param=p, time=Duration.from_sec(time)) for f, p in functions]
    return NaoLedGoal(messages)


def test_functions_run_in_order_and_their_answers_are_the_result(module):
    server = module.server.play(chain(("say", "one"), ("say", "two")))
    assert (server.end, server.text) == ("succeeded", "")
    assert module.done == ["one", "two"]
    assert [(r.function, r.values) for r in server.result.results] == [("say", ["one"]), ("say", ["two"])]
    assert server.result.memList == ["one", "two"]


def test_feedback_tells_which_function_of_how_many_begins(module):
    feedback = module.server.play(chain(("say", "a"), ("ping", ""))).feedback
    assert [(f.index, f.function, f.count) for f in feedback] == [(0, "say", 2), (1, "ping", 2)]


def test_the_server_waits_after_each_function(module, edge):
    server = module.server.play(chain(("say", "a"), ("say", "b"), time=0.02))
    assert edge.clock.waits == [0.02, 0.02]
    assert all(result.elapsed.to_sec() < 0.02 for result in server.result.results), "waits do not count"


def test_a_chain_with_an_error_runs_nothing(module):
    server = module.server.play(chain(("say", "one"), ("sya", "two")))
    assert server.end == "aborted"
    assert server.text.startswith("function 2 (sya): unknown function 'sya': did you mean 'say'?; known are ")
    assert module.done == []
    assert server.feedback == []
    assert server.result.results == []


def test_an_empty_chain_is_aborted(module):
    server = module.server.play(NaoLedGoal([]))
    assert server.end == "aborted"
    assert "the chain is empty" in server.text


def test_an_error_while_running_keeps_the_results_before_it(module):
    server = module.server.play(chain(("say", "one"), ("fail", "x"), ("say", "three")))
    assert server.end == "aborted"
    assert server.text == "function 2 (fail): field str_param: 'x' is not allowed: something else"
    assert [result.values for result in server.result.results] == [["one"]]
    assert module.done == ["one"]


def test_an_unexpected_error_is_logged_with_its_trace_and_the_server_lives_on(module, caplog):
    server = module.server.play(chain(("crash", "")))
    assert server.end == "aborted"
    assert server.text == "function 1 (crash): KeyError: 'oops'"
    assert "Traceback" in caplog.text
    assert module.server.play(chain(("say", "again"))).end == "succeeded"


def test_an_unexpected_error_in_a_check_names_the_function_and_runs_nothing(module, caplog):
    def check(str_param):
        raise KeyError("oops")

    module.function_table["odd"] = checked_by(check)(lambda str_param: module.say(str_param))
    server = module.server.play(chain(("say", "one"), ("odd", "two")))
    assert (server.end, server.text) == ("aborted", "function 2 (odd): KeyError: 'oops'")
    assert "Traceback" in caplog.text
    assert module.done == []


def test_preemption_ends_a_wait_and_the_function_before_it_counts_as_done(module, edge):
    thread = module.server.play_in_background(chain(("say", "one"), ("say", "two"), time=60.0))
    assert edge.clock.waiting.wait(LIMIT)
    module.server.preempt()
    thread.join(LIMIT)
    assert (module.server.end, module.server.text) == ("preempted", "preempted in function 1 (say)")
    assert [result.values for result in module.server.result.results] == [["one"]]


def test_preemption_ends_a_call_and_cancels_it_on_the_robot(module, robot):
    thread = module.server.play_in_background(chain(("say", "one"), ("last", "")))
    assert robot.leds.started.wait(LIMIT)
    module.server.preempt()
    thread.join(LIMIT)
    assert module.server.end == "preempted"
    assert robot.leds.pending[0].canceled
    assert [result.function for result in module.server.result.results] == ["say"]


def test_a_preemption_that_came_before_the_goal_began_counts(module):
    module.server.preempt_requested = True
    assert module.server.play(chain(("say", "one"))).end == "preempted"
    assert module.done == []


def test_a_preempted_goal_does_not_preempt_the_next_one(module, edge):
    thread = module.server.play_in_background(chain(("say", "one"), time=60.0))
    assert edge.clock.waiting.wait(LIMIT)
    module.server.preempt()
    thread.join(LIMIT)
    assert module.server.play(chain(("say", "two"), time=0.01)).end == "succeeded"


def test_the_end_of_the_node_interrupts_and_cleans_up_before_it_returns(module, edge):
    thread = module.server.play_in_background(chain(("borrow", "a"), time=60.0))
    assert edge.clock.waiting.wait(LIMIT)
    for action in edge.shutdown_actions:
        action()
    assert module.done == ["borrow a", "return a"]
    assert module.server.end == "preempted"
    thread.join(LIMIT)
    assert module.server.play(chain(("say", "late"))).end == "preempted", "no goal begins after the end"


def test_what_was_borrowed_is_returned_after_the_wait(module):
    module.server.play(chain(("borrow", "a"), ("say", "next")))
    assert module.done == ["borrow a", "return a", "next"]


def test_what_was_borrowed_is_returned_when_the_function_fails(module):
    def borrow_and_fail():
        module.borrow("a")
        raise BadGoal("lights", [], "some")

    module.function_table["try"] = borrow_and_fail
    assert module.server.play(chain(("try", ""))).end == "aborted"
    assert module.done == ["borrow a", "return a"]


def test_a_function_may_run_another_one_each_with_its_own_clean_up(module):
    module.server.play(chain(("nested", "")))
    assert module.done == ["borrow outer", "borrow inner", "return inner", "nested done", "return outer"]


def test_clean_up_that_fails_aborts_a_goal_that_went_well(module):
    def borrow():
        def give_back():
            raise RobotUnreachable("10.0.0.7", 9559, "gone")

        module.after_wait(give_back)

    module.function_table["try"] = borrow
    server = module.server.play(chain(("try", "")))
    assert server.end == "aborted"
    assert server.text == "function 1 (try): NAOqi at 10.0.0.7:9559: gone."


def test_clean_up_that_fails_does_not_hide_the_first_error(module, caplog):
    def fail_twice():
        def give_back():
            raise RobotUnreachable("10.0.0.7", 9559, "gone")

        module.after_wait(give_back)
        raise BadGoal("lights", [], "some")

    module.function_table["try"] = fail_twice
    assert module.server.play(chain(("try", ""))).text.startswith("function 1 (try): field lights")
    assert "clean-up failed: NAOqi at 10.0.0.7:9559: gone." in caplog.text


def test_after_wait_outside_of_a_function_is_a_mistake(module):
    with pytest.raises(RuntimeError, match="after_wait"):
        module.after_wait(lambda: None)


def test_a_robot_that_goes_away_ends_a_goal_that_only_waits(module, robot, edge):
    thread = module.server.play_in_background(chain(("say", "one"), time=60.0))
    assert edge.clock.waiting.wait(LIMIT)
    robot.connection.become("lost", "no heartbeat")
    thread.join(LIMIT)
    assert module.server.end == "aborted"
    assert module.server.text == "function 1 (say): the robot at 10.0.0.7:9559 went away: no heartbeat"
    robot.connection.become("connected")
    assert module.server.play(chain(("say", "two"))).end == "succeeded"


def test_events_are_subscribed_again_after_a_reconnection(module, robot, edge):
    module.server.play(chain(("subscribeToEvent", "A")))
    robot.connection.become("connected")  # the first connection
    robot.connection.become("lost", "gone")
    robot.memory.signals.clear()
    renewed = threading.Event()
    module.events.renew = lambda renew=module.events.renew: (renew(), renewed.set())
    robot.connection.become("connected")
    assert renewed.wait(LIMIT)
    robot.memory.signals["A"](1)
    assert edge.events == [("A", 1)]


def test_run_calls_a_function_by_name_with_a_list_of_arguments(module):
    assert module.run("say", ["hello"], Duration.from_sec(0.0)) == "hello"
    with pytest.raises(UnknownFunction):
        module.run("sya", [], 0.0)


def test_a_function_is_one_key_value_pair(module):
    module.function_table["shout"] = lambda str_param: str_param.upper()
    assert module.server.play(chain(("shout", "hey"))).result.memList == ["HEY"]


def test_waiting_is_interrupted_outside_of_goals_too(module):
    module.interrupt.trigger()
    with pytest.raises(Preempted):
        module.wait(60.0)


def test_autostart_needs_a_launch_file(robot, edge):
    with pytest.raises(BadLaunchPath):
        NaoBasic("10.0.0.7", 9559, autostart=True, launchpath=("nao_library", "no.launch"), robot=robot, edge=edge)


def test_reports_are_there_for_the_diagnostics(module, edge):
    module.server.play(chain(("sya", "")))
    reports = {name: report() for name, report in edge.reports.items()}
    assert reports["Module robot"].message == "connected"
    assert reports["Module goals"].values["aborted"] == "1"


class FakeSupervisor:
    def __init__(self, *arguments):
        self.arguments = arguments
        self.done = []

    def start(self):
        self.done.append("start")

    def stop(self):
        self.done.append("stop")


def test_autostart_starts_the_launch_file_for_the_robot_and_the_end_of_the_node_stops_it(robot, edge, monkeypatch):
    monkeypatch.setattr("nao_library_modules.nao_basic.launch_supervisor", FakeSupervisor)
    path = ("nao_library", "nao.launch")
    module = NaoBasic("10.0.0.7", 9560, autostart=True, launchpath=path, robot=robot, edge=edge)
    supervisor = module._launch
    assert supervisor.arguments == (path, "10.0.0.7", 9560, "/robot1/")
    assert supervisor.done == ["start"]
    for action in edge.shutdown_actions:
        action()
    assert supervisor.done == ["start", "stop"]


def test_without_autostart_the_launch_file_is_left_alone_until_asked_for(robot, edge, monkeypatch):
    monkeypatch.setattr("nao_library_modules.nao_basic.launch_supervisor", FakeSupervisor)
    module = NaoBasic("10.0.0.7", 9559, launchpath=("nao_library", "nao.launch"), robot=robot, edge=edge)
    module.stop_launch()
    assert module._launch is None
    module.start_launch()
    module.stop_launch()
    assert module._launch.done == ["start", "stop"]
