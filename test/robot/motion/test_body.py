"""Postures, effectors, gaze, facts and switches of the body."""

import json
import math

import pytest
from goal_functions import motion as f


def answers(result):
    return {entry.function: entry.values for entry in result.results}


def numbers(text):
    return [float(value) for value in text.strip("[]").split(",")]


def test_the_robot_wakes_up_goes_to_a_posture_and_rests_in_one_chain(robot, motion):
    goal = motion.play(
        f("wakeUp"), f("robotIsWakeUp"), f("goToPosture", str_param="StandInit", speed=0.8), f("getPosture"),
        f("getPostureFamily"), f("getPostureList"), f("getPostureFamilyList"), f("setMaxTryNumber", values=[2]),
        f("setAngles", names=["HeadYaw"], angles=[0.5]),
    )  # fmt: skip
    assert goal.state == "succeeded", goal.text
    told = answers(goal.result)
    assert told["robotIsWakeUp"] == ["True"] and len(goal.result.name) == 26
    assert (told["getPosture"], told["getPostureFamily"]) == (["StandInit"], ["Standing"])
    assert {"Stand", "Sit", "Crouch"} <= set(told["getPostureList"]) and "Sitting" in told["getPostureFamilyList"]
    assert set(robot.ALMotion.getStiffnesses("Body")) == {1.0}
    text = motion.refused(f("rest"), f("setAngles", names=["HeadYaw"], angles=[0.5]))
    assert text.startswith("function 2") and "no stiffness in HeadYaw" in text
    assert motion.succeed(f("rest"), f("robotIsWakeUp")).memList == ["False"]
    assert set(robot.ALMotion.getStiffnesses("Body")) == {0.0}


def test_a_posture_that_is_cancelled_or_not_reached_leaves_the_robot_up(stiff_robot, motion, angle):
    goal = motion.send(f("goToPosture", str_param="Crouch", speed=0.3))
    before = angle("LKneePitch")
    stiff_robot.advance_until(lambda: abs(angle("LKneePitch") - before) > 0.05, 10.0)
    assert goal.cancel().state == "preempted"
    stiff_robot.advance(0.3)
    knee = angle("LKneePitch")
    stiff_robot.advance(1.0)
    assert angle("LKneePitch") == pytest.approx(knee, abs=0.03) and stiff_robot.now.torso.position[2] > 0.2
    goal = motion.send(f("goToPosture", str_param="Stand", speed=0.3))
    stiff_robot.advance(0.3)
    stiff_robot.ALRobotPosture.stopMove()
    goal.finish()
    assert goal.state == "aborted"
    assert "the robot did not reach Stand: it is in posture" in goal.text and "of the family" in goal.text
    motion.succeed(f("applyPosture", str_param="Stand", speed=0.5))
    assert stiff_robot.ALRobotPosture.getPosture() == "Stand"


def test_effectors_go_where_they_are_told(stiff_robot, motion):
    place = f("getPosition", names=["LArm"])
    here = numbers(motion.succeed(place).memList[0])

    def moved(function, time=0.0, **fields):
        before = numbers(motion.succeed(place).memList[0])
        motion.succeed(f(function, time, names=["LArm"], **fields))
        after = numbers(motion.succeed(place).memList[0])
        return [b - a for a, b in zip(before[:3], after[:3])]

    back = {"values": here, "times": [1.0]}
    step = [0.03, 0, 0, 0, 0, 0]
    there = moved("positionInterpolation", values=step, times=[1.0], relative=True)
    assert there == pytest.approx([0.03, 0, 0], abs=0.01)
    assert moved("positionInterpolation", **back)[0] == pytest.approx(-0.03, abs=0.01)
    assert moved("changePosition", 1.0, values=step, speed=0.5) == pytest.approx([0.03, 0, 0], abs=0.01)
    assert moved("setPosition", 1.0, values=here, speed=0.5)[0] == pytest.approx(-0.03, abs=0.01)
    transform = numbers(motion.succeed(f("getTransform", names=["LArm"])).memList[0])[:12]
    assert [transform[3], transform[7], transform[11]] == pytest.approx(here[:3], abs=0.005)
    transform[11] += 0.03
    assert moved("transformInterpolation", values=transform, times=[1.0])[2] == pytest.approx(0.03, abs=0.01)
    transform[11] -= 0.03
    assert moved("setTransform", 1.0, values=transform, speed=0.5)[2] == pytest.approx(-0.03, abs=0.01)


def test_the_head_looks_at_points_of_any_frame_and_tells_what_is_missing(stiff_robot, motion, angle):
    robot = stiff_robot
    yaw, pitch, missing = map(float, motion.succeed(f("lookAt", values=[1.0, 1.0, 0.2], stiffness=1.0)).memList)
    assert (yaw, missing) == (pytest.approx(math.pi / 4, abs=1e-3), pytest.approx(0.0, abs=1e-4))
    assert angle("HeadYaw") == pytest.approx(yaw, abs=0.03) and angle("HeadPitch") == pytest.approx(pitch, abs=0.03)
    robot.advance(0.3)
    robot.finish("ALMotion", "moveTo", 0.0, 0.0, 0.7, after=7.0)
    x, y, z, *_, heading = robot.ALMotion.getPosition("Torso", 1, True)
    ahead = [x + math.cos(heading + 0.5), y + math.sin(heading + 0.5), z]
    for frame, values in ((1, ahead), (2, [math.cos(0.5), math.sin(0.5), 0.3])):
        motion.succeed(f("lookAt", values=[1.0, -1.0, 0.0]))
        result = motion.succeed(f("lookAt", values=values, frame=frame, duration=0.8))
        assert float(result.memList[0]) == pytest.approx(0.5, abs=0.04), frame
        assert result.results[0].elapsed.to_sec() == pytest.approx(0.8, abs=0.2)
    lower = motion.succeed(f("lookAt", values=[1.0, 0.0, 0.1], str_param="CameraBottom")).memList[1]
    assert float(motion.succeed(f("lookAt", values=[1.0, 0.0, 0.1])).memList[1]) > float(lower) + 0.5
    assert "a point in front of the head (FRAME_TORSO)" in motion.refused(f("lookAt", values=[0.0, 0.0, 0.12]))


def test_facts_of_the_robot(robot, motion):
    told = answers(
        motion.succeed(
            f("getBodyNames", names=["Head"]), f("getMass"), f("getCOM"), f("getLimits", names=["HeadYaw"]),
            f("getRobotConfig"), f("getSummary"), f("getTaskList"), f("getSensorNames"), f("getMotionCycleTime"),
            f("areResourcesAvailable", names=["Head"]), f("getSupportPolygon", frame=2),
        )
    )  # fmt: skip
    assert told["getBodyNames"] == ["HeadYaw", "HeadPitch"]
    assert float(told["getMass"][0]) == pytest.approx(5.3, abs=0.6)
    assert len(numbers(told["getCOM"][0])) == 3 and len(told["getSupportPolygon"]) >= 4
    assert numbers(told["getLimits"][0])[:2] == pytest.approx([-2.0857, 2.0857], abs=1e-3)
    assert "HeadYaw" in told["getSummary"][0] and told["getTaskList"] == []
    assert any("Bumper" in name for name in told["getSensorNames"]) and float(told["getMotionCycleTime"][0]) > 0
    assert told["areResourcesAvailable"] == ["True"] and told["getRobotConfig"]


def test_tasks_of_others_are_told_and_ended(stiff_robot, motion):
    for how in ("killTask", "killTasksUsingResources", "killAll"):
        task = stiff_robot.post("ALMotion", "angleInterpolation", "HeadYaw", 1.0, 5.0, True)
        stiff_robot.advance(0.3)
        (entry,) = motion.succeed(f("getTaskList")).memList
        name, number, *_ = json.loads(entry)
        assert "angleInterpolation" in name
        assert motion.succeed(f("areResourcesAvailable", names=["Head"])).memList == ["False"]
        fields = {"killTask": {"values": [number]}, "killTasksUsingResources": {"names": ["Head"]}, "killAll": {}}[how]
        motion.succeed(f(how, **fields))
        stiff_robot.advance(0.1)
        stiff_robot.answer(task)
        assert motion.succeed(f("getTaskList")).memList == []


SWITCHES = [
    ("SmartStiffness", []), ("FallManager", []), ("PushRecovery", []), ("DiagnosisEffect", []),
    ("Breath", ["LArm", "Head"]), ("IdlePosture", ["Body"]), ("CollisionProtection", ["LArm", "RArm"]),
    ("ExternalCollisionProtection", ["Move", "LArm"]),
]  # fmt: skip


def test_switches_are_set_and_told(robot, motion):
    for what, names in SWITCHES:
        for enable in (False, True, False):
            if what == "FallManager" and not enable:
                continue  # NAOqi allows that only where its owner has, in its settings
            switch = f(f"set{what}Enabled", names=names, enable=enable)
            result = motion.succeed(switch, f(f"get{what}Enabled", names=names))
            assert result.results[-1].values == [str(enable)] * max(len(names), 1), what
        if names:
            assert getattr(robot.ALMotion, f"get{what}Enabled")(names[0]) is False


def test_breath_whole_body_and_collisions(stiff_robot, motion, angle):
    result = motion.succeed(
        f("setBreathConfig", texts=["Bpm", "Amplitude"], values=[20, 0.3]), f("getBreathConfig"),
        f("isCollision", names=["LArm"]),
    )  # fmt: skip
    assert dict(json.loads(pair) for pair in result.results[1].values) == {"Bpm": 20.0, "Amplitude": pytest.approx(0.3)}
    assert result.results[2].values == ["none"]
    motion.succeed(
        f("goToPosture", str_param="StandInit"),
        f("wbEnable", enable=True),
        f("wbFootState", texts=["Fixed"], str_param="Legs"),
    )
    told = answers(
        motion.succeed(
            f("wbGoToBalance", str_param="LLeg", duration=3.0),
            f("getCOM", frame=2),
            f("wbEnableBalanceConstraint", enable=True, str_param="Legs"),
            f("wbEnableEffectorControl", names=["Head"], enable=True),
            f("wbSetEffectorControl", 1.0, names=["Head"], values=[0.0, 0.0, 0.4]),
            f("wbEnableEffectorOptimization", names=["Head"], enable=False),
            f("wbEnableEffectorControl", names=["Head"], enable=False),
            f("wbEnable", enable=False),
        )
    )
    assert told["wbGoToBalance"] == ["True"] and numbers(told["getCOM"][0])[1] > 0.03
    assert angle("HeadYaw") > 0.2
