#!/usr/bin/env python3
"""Algorithms 5.5 to 5.13 of the thesis, as they are printed, one after the other; 5.14 is ../abstract_plan.py.

Needs a running robot, for example `roslaunch nao_library nao_sim.launch`.
"""

# ruff: noqa: D103, N802, N803, N806

import rospy

from nao_library_modules.process_modules import (
    ManipulationProcessModule,
    NavigationProcessModule,
    Position,
    SpeechProcessModule,
    action,
    an,
    def_top_level_plan,
    do,
    par,
    stop_process_modules,
)
from nao_library_modules.process_modules.algorithms import (
    callAction,
    callGoal,
    createCloseLeftGripperMsg,
    createCloseRightGripperMsg,
    createMoveHeadMsg,
    createMoveLeftArmMsg,
    createMoveRightArmMsg,
    createOpenLeftGripperMsg,
    createOpenRightGripperMsg,
    createROSnode,
    createStablePositionMsg,
    createWalkingMsg,
    makeActionClient,
    resolve,
    runThread,
    waitingForServer,
)
from nao_library_modules.process_modules.plan_runner import wake_up


@def_top_level_plan
def StartProcessModules():  # 5.5
    par(
        do(runThread, ManipulationProcessModule),
        do(runThread, NavigationProcessModule),
        do(runThread, SpeechProcessModule),
    )


def ProcessModule(ActionDesignator):  # 5.6; the loop is that of the thread
    ResolvedDesignator = resolve(ActionDesignator)
    callAction(ResolvedDesignator)


def closeGripper(Side):  # 5.7
    NaoActionClient = makeActionClient("/jointTrajectory", "JointTrajectoryAction")
    waitingForServer(NaoActionClient)
    if Side == "right":
        Goal = createCloseRightGripperMsg()
    else:
        Goal = createCloseLeftGripperMsg()
    callGoal(NaoActionClient, Goal)


def openGripper(Side):  # 5.8
    NaoActionClient = makeActionClient("/jointTrajectory", "JointTrajectoryAction")
    waitingForServer(NaoActionClient)
    if Side == "right":
        Goal = createOpenRightGripperMsg()
    else:
        Goal = createOpenLeftGripperMsg()
    callGoal(NaoActionClient, Goal)


def moveHead(X, Y):  # 5.9
    NaoActionClient = makeActionClient("/jointTrajectory", "JointTrajectoryAction")
    waitingForServer(NaoActionClient)
    Goal = createMoveHeadMsg(X, Y)
    callGoal(NaoActionClient, Goal)


def moveArm(Target, Side):  # 5.10
    NaoActionClient = makeActionClient("/jointTrajectory", "JointTrajectoryAction")
    waitingForServer(NaoActionClient)
    if Side == "right":
        Goal = createMoveRightArmMsg(Target)
    else:
        Goal = createMoveLeftArmMsg(Target)
    callGoal(NaoActionClient, Goal)


def goStable():  # 5.11
    NaoActionClient = makeActionClient("/jointTrajectory", "JointTrajectoryAction")
    waitingForServer(NaoActionClient)
    Goal = createStablePositionMsg()
    callGoal(NaoActionClient, Goal)


def walkTo(Target):  # 5.12, which calls it Target and Position
    NaoActionClient = makeActionClient("/walkTarget", "MoveBaseAction")
    waitingForServer(NaoActionClient)
    Goal = createWalkingMsg(Target)
    callGoal(NaoActionClient, Goal)


def textToSpeech(Sentence):  # 5.13
    NaoROSnode = createROSnode()
    Topic = "/speech"
    NaoROSnode.publish(Sentence, Topic)


rospy.init_node("algorithms_of_the_thesis")
wake_up()
StartProcessModules()
ProcessModule(an(action, type="opening", gripper="left"))
goStable()
walkTo(Position(0.2, 0.0))
closeGripper("left")
openGripper("right")
moveHead(2, 1)
moveArm((0.16, -0.13, 0.08), "right")
textToSpeech("This is the end.")
stop_process_modules()
print("done")
