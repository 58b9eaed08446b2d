"""Handles of ALVideoDevice, and clients that have gone."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.vision.video_device_subscribers import IDLE, MOST, SOON_IDLE, VideoSubscribers, View
from nao_sim_bridge.sim.cameras.cameras import Cameras
from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.model import load_model

TOP, BOTTOM = View(0, 1, 11), View(1, 0, 13)


class Clock:
    now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def cameras():
    made = Cameras(load_model(), 1 / 120, SimpleNamespace(close=lambda: None), lambda _: None)
    yield made
    made.close()


@pytest.fixture
def subscribers(cameras, clock):
    return VideoSubscribers(cameras, clock)


def add(subscribers, name="looker", *views):
    return subscribers.add(name, views or [TOP], 15, len(views) > 1)


def test_handles_are_numbered_by_name(subscribers):
    assert [add(subscribers), add(subscribers), add(subscribers, "other")] == ["looker_0", "looker_1", "other_0"]
    subscribers.remove("looker_0")
    assert add(subscribers) == "looker_0"
    assert sorted(subscribers.handles()) == ["looker_0", "looker_1", "other_0"]


def test_a_name_can_be_used_six_times(subscribers):
    for _ in range(6):
        add(subscribers)
    with pytest.raises(BadValue, match="name is 'looker', allowed is another one: 6 subscribers have this one"):
        add(subscribers)
    assert len(subscribers.handles()) == 6


def test_there_is_an_end_to_subscribers(subscribers):
    for index in range(MOST):
        add(subscribers, f"looker{index}")
    with pytest.raises(BadValue, match=f"subscribers is {MOST + 1}, allowed is at most {MOST}"):
        add(subscribers, "one more")


def test_who_is_not_heard_of_is_taken_from_the_cameras(subscribers, cameras, clock):
    gone, alive = add(subscribers, "gone"), add(subscribers, "alive")
    clock.now += IDLE - 1.0
    subscribers.get(alive)
    clock.now += 2.0
    assert subscribers.handles() == [alive]
    assert [stream.name for stream in cameras.streams] == [alive]
    assert gone not in subscribers.handles()


def test_who_comes_back_finds_everything_as_it_was(subscribers, cameras, clock):
    handle = add(subscribers, "sleeper", TOP, BOTTOM)
    clock.now += IDLE + 1.0
    assert subscribers.handles() == [] and cameras.streams == ()
    back = subscribers.get(handle)
    assert back.views == (TOP, BOTTOM) and back.fps == 15
    assert [stream.camera for stream in cameras.streams] == [0, 1]


def test_a_client_that_crashes_again_and_again_does_not_run_out_of_handles(subscribers, clock):
    for _ in range(20):
        add(subscribers)
        clock.now += SOON_IDLE
    assert len(subscribers.handles()) == 6


def test_a_handle_given_to_somebody_else_is_theirs(subscribers, clock):
    first = add(subscribers)
    clock.now += IDLE + 1.0
    handles = [add(subscribers) for _ in range(6)]
    assert handles[-1] == first and handles[0] != first
    subscribers.remove(first)
    with pytest.raises(NaoqiError, match="'looker_0' is not subscribed; subscribed is 'looker_1'"):
        subscribers.get(first)


def test_who_waits_for_a_frame_is_alive(subscribers, clock):
    handle = add(subscribers)
    task = subscribers.ask(handle, "getImageRemote", list)
    clock.now += 10 * IDLE
    assert subscribers.handles() == [handle]
    task.request_kill()
    assert task.killed
    clock.now += IDLE + 1.0
    assert subscribers.handles() == []


def test_calls_that_are_too_many_are_refused_and_leave_nothing_behind(subscribers, cameras, clock):
    handle = add(subscribers, "flood", TOP, BOTTOM)
    cameras.streams[1].ask(lambda _: None)  # so that it is the second camera that refuses
    waiting = [subscribers.ask(handle, "getImagesRemote", list) for _ in range(31)]
    for _ in range(50):
        refused = subscribers.ask(handle, "getImagesRemote", list)
        with pytest.raises(BadValue, match="calls that wait for a frame is 33, allowed is at most 32"):
            refused.result(0)
    assert not any(task.finished for task in waiting)
    for task in waiting:
        task.request_kill()
    clock.now += IDLE + 1.0
    assert subscribers.handles() == []


def test_all_of_a_name(subscribers, clock):
    for _ in range(3):
        add(subscribers)
    other = add(subscribers, "looker_2")
    clock.now += IDLE + 1.0
    subscribers.get("looker_1")
    assert subscribers.remove_all("looker") == 1
    assert subscribers.handles() == []
    assert subscribers.get(other).name == "looker_2"
    with pytest.raises(NaoqiError, match="'looker_0' is not subscribed"):
        subscribers.get("looker_0")


@pytest.mark.parametrize(
    "views, fps, text",
    [
        ([], 15, "cameraIndexes is"),
        ([TOP, View(0, 2, 11)], 15, r"cameraIndexes is \[0, 0\], allowed is different cameras"),
        ([View(2, 1, 11)], 15, "camera is 2"),
        ([TOP, View(1, 4, 11)], 15, "resolution is 4"),
        ([View(0, 1, 17)], 15, "needs a depth camera"),
        ([TOP], 0, "fps is 0, allowed is 1 to 30"),
        ([TOP], 31, "fps is 31"),
    ],
)
def test_what_the_cameras_cannot_do_leaves_nobody_behind(subscribers, cameras, views, fps, text):
    with pytest.raises(BadValue, match=text):
        subscribers.add("looker", views, fps, len(views) > 1)
    assert subscribers.handles() == [] and cameras.streams == ()


def test_a_change_that_cannot_be_changes_nothing(subscribers, cameras):
    handle = add(subscribers, "looker", TOP, BOTTOM)
    with pytest.raises(BadValue, match="colorSpace is 99"):
        subscribers.change(handle, [View(0, 2, 13), View(1, 2, 99)])
    assert subscribers.get(handle).views == (TOP, BOTTOM)
    assert [stream.resolution for stream in cameras.streams] == [1, 0]
    subscribers.change(handle, [View(1, 2, 13), View(0, 4, 0)], 30)
    assert [(s.camera, s.resolution, s.color_space, s.fps) for s in cameras.streams] == [(1, 2, 13, 30), (0, 4, 0, 30)]
