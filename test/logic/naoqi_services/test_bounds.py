"""What one client can have the simulator keep and do: each store refuses by name what is beyond its bound."""

from __future__ import annotations

import itertools
import threading
import time
from unittest.mock import Mock

import pytest

from nao_sim_bridge.base.errors import BadValue, ConfigError, NotAllowed, closest
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task, WorkThreads
from nao_sim_bridge.base.xml_values import parse_xml
from nao_sim_bridge.behaviors.installed import InstalledBehaviors
from nao_sim_bridge.behaviors.steps import Behavior, Joints, JointWay
from nao_sim_bridge.body.touch_gestures import GESTURES, GestureBook
from nao_sim_bridge.control.joints.bezier import Handle, Interpolation, KeyPoint, PackedKeyPoints
from nao_sim_bridge.model.leds_layout import load_leds
from nao_sim_bridge.naoqi.binding.api import module_methods
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.binding.unfinished import Unfinished
from nao_sim_bridge.naoqi.binding.wire_types import fitted
from nao_sim_bridge.naoqi.body.leds import LedNames
from nao_sim_bridge.naoqi.memory.memory import ALMemory
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.sound.microphone_clients import MicrophoneClients
from nao_sim_bridge.naoqi.system.system import ALSystem
from nao_sim_bridge.speech.animations import load_animations
from nao_sim_bridge.speech.tags import TagReader

SIZES = load_sizes()
PATIENCE = 60.0
ATTRIBUTES = " ".join(f'k{number}=""' for number in range(1000))


def few(monkeypatch, group, **limits):
    """Have bounds be small in this test."""
    for key, limit in limits.items():
        monkeypatch.setitem(vars(getattr(SIZES, group)), key, limit)


# --- light groups -------------------------------------------------------------------------------------------------


def test_groups_of_groups_are_expanded_once_and_to_the_devices_of_the_robot_at_most():
    names = LedNames(load_leds())
    names.createGroup("g0", ["AllLeds", "FaceLeds"])
    for depth in range(1, 50):  # each member counted by itself, these would be 2**50
        names.createGroup(f"g{depth}", [f"g{depth - 1}", f"g{depth - 1}"])
    assert names.devices("g49") == names.devices("AllLeds")


def test_a_group_that_changes_changes_those_that_hold_it_and_none_holds_itself():
    names = LedNames(load_leds())
    names.createGroup("inner", ["ChestLeds"])
    names.createGroup("outer", ["inner"])
    names.createGroup("inner", ["LeftFootLeds"])
    assert names.devices("outer") == names.devices("LeftFootLeds")
    with pytest.raises(NaoqiError, match="group 'inner' would hold itself"):
        names.createGroup("inner", ["outer"])
    assert names.devices("outer") == names.devices("LeftFootLeds") and names.listGroup("inner") == ["LeftFootLeds"]


def test_groups_and_their_members_are_bounded():
    names = LedNames(load_leds())
    with pytest.raises(BadValue, match="allowed is 1000 led members at most"):
        names.createGroup("large", ["ChestLeds"] * (SIZES.lists.led_members + 1))
    for number in range(SIZES.lists.led_groups):
        names.createGroup(f"g{number}", ["ChestLeds"])
    with pytest.raises(BadValue, match="allowed is 100 led groups at most"):
        names.createGroup("one more", ["ChestLeds"])
    names.createGroup("g0", ["FaceLeds"])  # one that is there can still be changed


# --- names and calls ----------------------------------------------------------------------------------------------


def test_names_are_bounded_wherever_they_stand_and_texts_are_not():
    name = "x" * (SIZES.call.name_characters + 1)
    group = module_methods("ALLeds")["createGroup"]
    for arguments in ([name, ["ChestLeds"]], ["mine", [name]]):
        with pytest.raises(BadValue, match="allowed is a name of 1000 characters at most"):
            fitted(group, arguments, "ALLeds")
    with pytest.raises(BadValue, match="is 'more than 10000 names', allowed is 10000 at most"):
        fitted(group, ["mine", ["a"] * (SIZES.call.names + 1)], "ALLeds")
    with pytest.raises(BadValue, match="tagsToWords is 'x"):
        fitted(module_methods("ALAnimatedSpeech")["addTagsToWords"], [{name: ["hello"]}], "ALAnimatedSpeech")
    long = ["Test/Key", name * 100]
    assert fitted(module_methods("ALMemory")["insertData"], long, "ALMemory") == long


def test_who_has_too_many_calls_under_way_can_still_end_them(monkeypatch):
    few(monkeypatch, "clients", unfinished_calls=3)
    unfinished, tasks = Unfinished(), [Task("move", 0) for _ in range(3)]
    for task in tasks:
        unfinished.note(task)
    with pytest.raises(NaoqiError, match="3 calls of this module have not ended: 3 at most"):
        unfinished.require_room("moveTo")
    unfinished.require_room("stopMove")
    inner = Task("walk", 0)
    tasks[0].finish(inner)
    with pytest.raises(NaoqiError):  # it has led to another one
        unfinished.require_room("moveTo")
    inner.finish()
    unfinished.require_room("moveTo")


def test_no_hint_is_looked_for_among_long_names_and_of_many_only_some_are_compared():
    assert closest("HeadYa", ["HeadYaw"]) == ["HeadYaw"]
    assert closest("x" * 101, ["x" * 100]) == closest("x" * 100, ["x" * 101]) == []
    assert closest("key 12345", [f"key {number}" for number in range(10000, 20000)])[0] == "key 12345"


def test_work_is_done_by_a_few_threads_and_the_rest_waits():
    gate, threads = threading.Event(), WorkThreads("test", 2)
    tasks = [threads.work_out("wait", lambda: gate.wait(PATIENCE)) for _ in range(20)]
    assert sum(thread.name == "test" for thread in threading.enumerate()) <= 2
    gate.set()
    assert [task.result(PATIENCE) for task in tasks] == [True] * 20


def test_mappings_take_no_thread_each_and_their_number_is_bounded(monkeypatch):
    few(monkeypatch, "clients", mapping_calls=30, threads=2)
    gate, broker = threading.Event(), Mock()
    broker.service.side_effect = lambda name: gate.wait(PATIENCE) and Mock(spec=[])
    memory = ALMemory(MemoryStore(time.time), broker)
    before = threading.active_count()
    tasks = [memory.addMapping(f"Service{number}", "signal", "Event") for number in range(30)]
    assert threading.active_count() <= before + 2
    with pytest.raises(BadValue, match="calls of addMapping that have not ended is 31, allowed is at most 30"):
        memory.addMapping("Service", "signal", "Event")
    gate.set()
    for task in tasks:
        with pytest.raises(NaoqiError, match="has no signal 'signal'"):
            task.result(PATIENCE)


# --- behaviours ---------------------------------------------------------------------------------------------------


def dance(keys):
    point = KeyPoint(1.0, 0.5, Handle(Interpolation.BEZIER, -0.1, 0.2), Handle(Interpolation.BEZIER, 0.1, 0.0))
    return Joints({"HeadYaw": JointWay(PackedKeyPoints([point] * keys), curved=True)})


def test_key_points_are_kept_in_few_bytes_and_come_back_as_they_were():
    points = [KeyPoint(0.5, -0.25), KeyPoint(1.0, 0.5, Handle(Interpolation.SMOOTH, -0.1, 0.2), Handle(time=0.3))]
    packed = PackedKeyPoints(points)
    assert list(packed) == points and packed[-1] == points[-1] and packed[:1] == (points[0],)
    assert packed == PackedKeyPoints(points) and packed.nbytes == 128


def test_behaviours_of_clients_have_a_memory_together_and_what_is_removed_makes_room(monkeypatch):
    few(monkeypatch, "behaviors", bytes=150_000)
    installed = InstalledBehaviors(load_animations())
    installed.install([Behavior("mine/one", dance(1000))])
    installed.hold("/FrameManager/1", dance(1000))
    with pytest.raises(NotAllowed, match="behaviors of clients would take 19.* bytes, 150000 at most"):
        installed.install([Behavior("mine/two", dance(1000))])
    assert not installed.knows("mine/two")
    installed.release(["/FrameManager/1"])
    installed.install([Behavior("mine/two", dance(1000))])


@pytest.mark.parametrize(
    "content",
    [
        "<a>" + "<b/>" * SIZES.xml.elements + "</a>",
        "<a>"
        + ("<b " + " ".join(f'k{i}=""' for i in range(1000)) + "/>") * (SIZES.xml.attributes // 1000 + 1)
        + "</a>",
        "<a>" * (SIZES.xml.levels + 1) + "</a>" * (SIZES.xml.levels + 1),
    ],
)
def test_xml_is_counted_while_it_is_read(content):
    with pytest.raises(ConfigError, match="elements, .* attributes and .* levels that are allowed"):
        parse_xml(content.encode(), "file")


# --- single stores ------------------------------------------------------------------------------------------------


def test_words_and_tags_of_clients_are_bounded_and_forgotten_words_make_room(monkeypatch):
    few(monkeypatch, "speech", words=3, tags=1)
    library = load_animations()
    library.add_words("ahoy", ["alpha", "beta", "gamma", "ALPHA"])
    with pytest.raises(NotAllowed, match="clients would have 4 words with tags: 3 at most"):
        library.add_words("ahoy", ["delta"])
    library.forget_words()
    library.add_words("ahoy", ["delta"])
    bow, hey = "animations/Stand/Gestures/BowShort_1", "animations/Stand/Gestures/Hey_1"
    library.add_tag("ahoy", [bow, bow])
    library.add_tag("ahoy", [bow])
    with pytest.raises(NotAllowed, match="2 tags of animations: 1 at most"):
        library.add_tag("ahoy", [hey])


def test_gestures_on_the_head_are_bounded():
    book, touched = GestureBook(), [f"{number:03b}" for number in range(1, 8)]
    with pytest.raises(BadValue, match="allowed is 100 gestures at most"):
        for first, second, third in itertools.product(touched, touched, touched):
            book.add(["000", first, "000", second, "000", third, "000"])
    assert len(book.all()) == len(GESTURES) + SIZES.lists.gestures


def test_client_preferences_are_bounded_and_those_of_who_has_gone_are_forgotten():
    clients = MicrophoneClients(Mock(), Mock())
    for number in range(SIZES.clients.microphones):
        clients.prefer(f"Module{number}", Mock())
    with pytest.raises(NaoqiError, match="50 modules have client preferences, which is the most allowed"):
        clients.prefer("Another", Mock())
    clients.gone("Module0")
    clients.prefer("Another", Mock())


def test_the_name_of_the_robot_is_that_of_a_computer():
    system = ALSystem(Mock(), Mock(), Mock())
    assert system.setRobotName("n" * 63)
    with pytest.raises(BadValue, match="63 characters at most"):
        system.setRobotName("n" * 64)


def test_tags_that_are_left_out_are_told_of_no_more_when_they_are_many():
    told = []
    reader = TagReader(told.append)
    for number in range(300):
        reader.leave_out(f"tag{number}", "nobody knows it")
    assert len(told) == 100
