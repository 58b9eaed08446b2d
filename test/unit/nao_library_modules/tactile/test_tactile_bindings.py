"""Behaviours that a touch starts."""

from __future__ import annotations

from nao_library_msgs.msg import TactileFunction

HELLO = TactileFunction(function="onTouch", sensors=["head"], behavior="hello", parameters=["text=Hi"])


def f(function, **fields):
    return TactileFunction(function=function, **fields)


def test_a_touch_starts_its_behaviour_each_time(succeed, skin, runner):
    result = succeed(HELLO)
    assert result.memList == ["hello"] and result.bindings[0].sensors == ["front head", "middle head", "rear head"]
    for _ in range(2):
        skin.touch(True, "front head")
        runner.wait()
        skin.touch(False, "front head")
        runner.ends[-1]("succeeded", "")
    assert runner.runs == [("hello", ["text=Hi"])] * 2
    (binding,) = succeed(f("listOnTouch")).bindings
    assert (binding.runs, binding.running, binding.last) == (2, False, "succeeded")


def test_touches_while_it_runs_and_cools_down_do_not_count(succeed, skin, runner):
    succeed(
        f("onTouch", sensors=["chest"], behavior="bow", cooldown=1000.0), f("onTouch", sensors=["head"], behavior="nod")
    )
    skin.touch(True, "chest")
    runner.wait()
    skin.touch(False, "chest")
    skin.touch(True, "chest")  # it still runs
    skin.touch(False, "chest")
    runner.ends[0]("succeeded", "")
    skin.touch(True, "chest")  # it has just ended
    skin.touch(True, "front head")  # touches are followed in their order: this one is the last
    runner.wait()
    assert [name for name, _ in runner.runs] == ["bow", "nod"]


def test_a_binding_that_is_removed_starts_nothing(succeed, skin, runner):
    succeed(HELLO, f("onTouch", str_param="left", sensors=["left bumper"], behavior="nod"))
    assert succeed(f("removeOnTouch", str_param="hello"), f("listOnTouch")).memList == ["left"]
    skin.touch(True, "front head")
    skin.touch(True, "left bumper")
    runner.wait()
    assert runner.runs == [("nod", [])]
    succeed(f("removeOnTouch"))
    assert succeed(f("listOnTouch")).memList == [] and skin.idle()


def test_a_chain_can_remove_what_it_has_bound(succeed, skin):
    assert succeed(HELLO, f("removeOnTouch", str_param="hello"), f("listOnTouch")).memList == ["hello"]
    assert skin.idle()


def test_one_of_the_same_name_is_replaced(succeed, skin, runner):
    succeed(HELLO, f("onTouch", str_param="hello", sensors=["head"], behavior="bow"))
    skin.touch(True, "rear head")
    runner.wait()
    assert runner.runs == [("bow", [])]


def test_a_hold_starts_when_it_is_long_enough(succeed, skin, runner):
    succeed(f("onTouch", sensors=["right hand"], touch="hold", duration=0.05, behavior="nod"))
    skin.touch(True, "right hand back")
    runner.wait()
    assert runner.runs == [("nod", [])]


def test_a_behaviour_that_cannot_run_is_told(succeed, skin, runner):
    runner.broken = True
    succeed(HELLO)
    skin.touch(True, "front head")
    runner.wait()
    skin.touch(False, "front head")
    runner.broken = False
    skin.touch(True, "front head")  # it can be tried again
    runner.wait()
    assert runner.runs == [("hello", ["text=Hi"])]
    (binding,) = succeed(f("listOnTouch")).bindings
    assert (binding.runs, binding.last, binding.text) == (2, "rejected", "there is no server")


def test_bindings_outlive_a_robot_that_comes_back(succeed, robot, skin, runner):
    succeed(HELLO)
    robot.memory.signals.clear()  # a robot that was switched off knows nobody
    robot.connection.become("lost", "gone")
    robot.connection.become("connected")
    skin.touch(True, "front head")
    runner.wait()
    assert runner.runs == [("hello", ["text=Hi"])]


def test_the_end_of_the_server_ends_everything(succeed, skin, runner, tactile):
    succeed(HELLO)
    tactile.shut_down()
    assert runner.closed and skin.idle()
