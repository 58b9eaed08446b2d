"""ALLauncher and ALStore: which modules and applications there are, and why nothing is started or fetched."""

import pytest


def test_modules_of_the_robot_and_of_programs_are_listed(robot, listener):
    launcher = robot.ALLauncher
    names = launcher.getGlobalModuleList()
    assert {"ALMotion", "ALMemory", "Listener"} <= set(names)
    assert launcher.isModulePresent("Motion") is True and launcher.isModulePresent("ALCoffee") is False
    assert launcher.launchLocal("ALMotion") == []


@pytest.mark.parametrize("method", ["launchLocal", "launchExecutable", "launchScript", "launchPythonModule"])
def test_nothing_is_started_on_this_computer(robot, method):
    with pytest.raises(RuntimeError, match=f"{method} 'coffee': .* is not run on this computer; start it yourself"):
        robot.ALLauncher.call(method, "coffee")


def test_there_is_no_store(robot, refuses):
    assert robot.ALStore.status() == []
    refuses("ALStore", """
        update() -> there is no store: PackageManager.install takes packages
        stopUpdate() -> nothing is being updated
    """)  # fmt: skip
