"""Questions about a name or number that the robot does not have: refused, or answered as NAOqi documents it."""

import re
from contextlib import suppress

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.naoqi.binding.api import FILE, older_tables
from nao_sim_bridge.naoqi.binding.binding import published_methods

NAME, NUMBER = "NoSuchThing", 987654
VALUES = {"string": NAME, "int": NUMBER, "float": 0.5, "bool": False, "list<string>": [NAME], "list<int>": [NUMBER]}
QUESTION = re.compile(r"(get|is|are|doUsers|does|has|find)[A-Z]|get$|has$|package")
ANSWERED = {
    "ALAudioDevice.getParameter": -1,
    "ALAudioPlayer.isSoundSetFileInstalled": False,
    "ALAudioPlayer.isSoundSetInstalled": False,
    "ALAudioPlayer.isSoundSetLoaded": False,
    "ALAutonomousLife.getFocusHistory": [],  # of so many entries at most
    "ALAutonomousLife.getLaunchpadPluginsForGroup": [],
    "ALAutonomousLife.getStateHistory": [("disabled", 0)],  # as many as there are
    "ALBehaviorManager.getBehaviorsByTag": [],
    "ALBehaviorManager.isBehaviorInstalled": False,
    "ALBehaviorManager.isBehaviorPresent": False,
    "ALLauncher.isModulePresent": False,
    "ALMemory.getDataList": [],  # a part of names
    "ALMemory.getExtractorEvent": [],
    "ALMemory.getSubscribers": [],
    "ALPreferenceManager.getValue": None,
    "ALPreferenceManager.getValueList": [],
    "ALTactileGesture.getGesture": None,
    "ALTactileGesture.getSequence": [],
    "ALUserSession.areUserSessionsOpen": False,
    "ALUserSession.areUsersPermanent": False,
    "ALUserSession.doUsersExist": False,
    "ALUserSession.doesBindingExist": False,
    "ALUserSession.doesBindingSourceExist": False,
    "ALUserSession.doesUserDataSourceExist": False,
    "ALUserSession.doesUserExist": False,
    "ALUserSession.getPpidFromUsid": -1,
    "ALUserSession.getUsidFromPpid": -1,
    "ALUserSession.isUserPermanent": False,
    "ALUserSession.isUserSessionOpen": False,
    "PackageManager.hasPackage": False,
}
"""What is answered for what is not there: whether it is, what there is of it, or a number that stands for nothing."""


def questions():
    """Module, method and arguments that name nothing."""
    for module in sorted({*read_json(config_file(FILE)), *older_tables()["modules"]}):
        for name, method in {} if module.startswith("_") else published_methods(module).items():
            for overload in method.overloads if QUESTION.match(name) else ():
                if {"string", "int", "list<string>", "list<int>", "ALValue"} & set(overload.types):
                    yield module, name, [VALUES.get(kind, NAME) for kind in overload.types]


def test_what_is_not_there_is_refused_or_answered_as_documented(robot):
    found = {}
    for module, name, arguments in questions():
        if name == "getDataOnChange" or module in ("ALKnowledge", "DCM"):  # it waits; patterns; ms that may be any
            continue
        with suppress(RuntimeError):
            found[f"{module}.{name}"] = getattr(robot, module).call(name, *arguments)
    assert found == ANSWERED


def test_a_configuration_of_a_navigation_is_looked_at_wherever_it_stands(robot, refuses):
    refuses("ALNavigation", """
        navigateTo(0.1, 0.0, 0.0, 'fast') -> pairs such as
        navigateTo(0.1, 0.0, 'fast') -> theta is 'fast'
        navigateTo(0.1, 0.0, [['Fast', 1.0]]) -> unknown
    """)  # fmt: skip
