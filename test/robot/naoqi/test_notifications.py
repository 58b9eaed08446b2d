"""ALNotificationManager: messages of programs for people."""

import pytest
from simulator import PATIENCE

HELLO = {"message": "Hello", "severity": "warning", "removeOnRead": False}


@pytest.fixture
def notifications(robot):
    return robot.ALNotificationManager


def test_notifications_are_pending_until_they_are_removed(robot, notifications):
    added, removed = robot.heard("notificationAdded"), robot.heard("notificationRemoved")
    first, second = notifications.add(HELLO), notifications.add([["message", "World"]])
    assert {added.get(timeout=PATIENCE) for _ in range(2)} == {first, second}
    hello = [["id", first], ["message", "Hello"], ["severity", "warning"], ["removeOnRead", False]]
    world = [["id", second], ["message", "World"], ["severity", "info"], ["removeOnRead", True]]
    assert notifications.notifications() == [hello, world] and notifications.notification(first) == hello
    notifications.remove(first)
    assert removed.get(timeout=PATIENCE) == first and notifications.notifications() == [world]


def test_a_click_on_the_chest_has_them_read_and_those_go_that_are_to(robot, notifications):
    kept, gone = notifications.add(HELLO), notifications.add({"message": "World"})
    removed, said = robot.heard("notificationRemoved"), robot.heard("ALTextToSpeech/CurrentSentence")
    robot.post("NaoSimulation", "touch", "ChestBoard/Button", 0.2)
    robot.advance_until(lambda: not removed.empty(), 20.0, 0.2, "the notification is read")
    assert removed.get() == gone
    assert [dict(entry)["id"] for entry in notifications.notifications()] == [kept]
    sentences = sorted(said.get(timeout=PATIENCE) for _ in range(2))
    assert sentences == ["Hello", "World"]


def test_what_is_no_notification_is_refused(refuses):
    refuses("ALNotificationManager", """
        add('Hello') -> notification is 'Hello', allowed is .*message.*severity.*removeOnRead.*, or these as pairs
        add({}) -> notification is \\{\\}, allowed is .*message
        add({'text': 'Hello'}) -> allowed is .*message.*severity
        add({'message': 'Hello', 'severity': 'loud'}) -> severity is 'loud', allowed is one of info, warning, error
        remove(7) -> unknown notification 7
        notification(7) -> unknown notification 7
    """)  # fmt: skip
