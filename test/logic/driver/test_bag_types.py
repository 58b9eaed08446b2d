"""Bags of the older stack, converted to the types of this library and back."""

import json
from contextlib import suppress

import pytest
import rosbag
from click.testing import CliRunner
from genpy import Time
from std_msgs.msg import String

from nao_library_actions.msg import JointTrajectoryActionFeedback
from nao_library_modules.cli.app import nao
from nao_library_modules.ros.bag_types import convert_bag, read_bag
from nao_library_modules.ros.driver_types import as_theirs
from nao_library_modules.ros.type_names import OURS, THEIRS
from nao_library_msgs.msg import Bumper, JointAnglesWithSpeed, TactileTouch
from naoqi.errors import NaoError


def feedback(kind):
    message = kind()
    message.status.goal_id.id = "goal 1"
    return message


def named(kind, name):
    """A class with the fields of another one and a name of its own."""
    package, word = name.split("/")
    text = kind._full_text.replace(kind._type.split("/")[0] + "/", f"{package}/")
    made = type(word, (kind,), {"_type": name, "_full_text": text, "__slots__": ()})
    made.__slots__ = kind.__slots__
    return made


@pytest.fixture
def old(tmp_path):
    """A bag as nao_robot's driver leaves it, compressed, with a topic of somebody else."""
    path = tmp_path / "old.bag"
    bumper = as_theirs(Bumper)
    with rosbag.Bag(str(path), "w", compression="bz2") as bag:
        for second in (1, 2):
            angles = as_theirs(JointAnglesWithSpeed)(joint_names=["HeadYaw"], joint_angles=[0.25], speed=0.5)
            bag.write("joint_angles", angles, Time(second))
        header = {"topic": "bumper", "type": bumper._type, "md5sum": bumper._md5sum, "callerid": "/nao_tactile"}
        header.update(message_definition=bumper._full_text, latching="1")
        bag.write("bumper", bumper(bumper=1, state=1), Time(3), connection_header=header)
        bag.write("joint_trajectory/feedback", feedback(as_theirs(JointTrajectoryActionFeedback)), Time(4))
        bag.write("speech", String("hello"), Time(5))
    return path


def crafted(path, made):
    """A bag whose definition makes a file where it is turned into Python: the name of a constant is a program."""
    text = f'string [open("{made}", "w")][:]=1\nstring data\n'
    header = {"topic": "t", "type": "crafted_msgs/Text", "md5sum": "5" * 32, "message_definition": text}
    message = (header["type"], b"\1\0\0\0x", header["md5sum"], named(String, header["type"]))
    with rosbag.Bag(str(path), "w") as bag:
        bag.write("t", message, Time(1), raw=True, connection_header=header)
    return path


def types_in(path):
    with rosbag.Bag(str(path)) as bag:
        return {topic: about.msg_type for topic, about in bag.get_type_and_topic_info().topics.items()}


def content(path):
    with rosbag.Bag(str(path)) as bag:
        return [(topic, raw[1], time.to_sec()) for topic, raw, time in bag.read_messages(raw=True)]


def test_an_old_bag_gets_our_types_and_keeps_bytes_times_publishers_and_compression(old, tmp_path):
    new, other = tmp_path / "new.bag", tmp_path / "new.bag.part"
    other.write_text("somebody's")
    done = convert_bag(old, new, OURS)
    assert {path.name for path in tmp_path.iterdir()} == {"old.bag", "new.bag", "new.bag.part"}
    assert dict(done.renamed) == {"naoqi_bridge_msgs/JointAnglesWithSpeed": 2, "naoqi_bridge_msgs/Bumper": 1}
    assert dict(done.refilled) == {"naoqi_bridge_msgs/JointTrajectoryActionFeedback": 1}
    assert dict(done.kept) == {"std_msgs/String": 1} and not done.foreign
    assert types_in(new) == {
        "joint_angles": "nao_library_msgs/JointAnglesWithSpeed",
        "bumper": "nao_library_msgs/Bumper",
        "joint_trajectory/feedback": "nao_library_actions/JointTrajectoryActionFeedback",
        "speech": "std_msgs/String",
    }
    before, after = content(old), content(new)
    assert [entry for entry in after if "feedback" not in entry[0]] == [e for e in before if "feedback" not in e[0]]
    with rosbag.Bag(str(new)) as bag:
        assert bag.get_compression_info().compression == "bz2"
        headers = {c.topic: c.header for c in bag._get_connections()}
        assert (headers["bumper"]["callerid"], headers["bumper"]["latching"]) == (b"/nao_tactile", b"1")
        (_, message, _), *_ = bag.read_messages(topics=["joint_trajectory/feedback"])
    assert message.status.goal_id.id == "goal 1" and message.feedback.joint_names == []


def test_there_and_back_is_the_same_bag(old, tmp_path):
    ours, back = tmp_path / "ours.bag", tmp_path / "back.bag"
    convert_bag(old, ours, OURS)
    done = convert_bag(ours, back, THEIRS)
    assert sum(done.renamed.values()) == 3 and sum(done.refilled.values()) == 1
    assert content(back) == content(old) and types_in(back) == types_in(old)


def test_a_type_of_that_name_with_other_fields_stays_as_it_is_and_is_told(tmp_path):
    stranger = named(String, "naoqi_bridge_msgs/Bumper")
    with rosbag.Bag(str(tmp_path / "old.bag"), "w") as bag:
        bag.write("bumper", stranger("left"), Time(1))
    done = convert_bag(tmp_path / "old.bag", tmp_path / "new.bag", OURS)
    assert dict(done.foreign) == {f"naoqi_bridge_msgs/Bumper ({String._md5sum})": 1}
    assert types_in(tmp_path / "new.bag") == {"bumper": "naoqi_bridge_msgs/Bumper"}


def test_types_of_nao_msgs_are_renamed_where_their_sums_agree(tmp_path):
    angles = named(JointAnglesWithSpeed, "nao_msgs/JointAnglesWithSpeed")
    touch, stranger = named(TactileTouch, "nao_msgs/TactileTouch"), named(String, "nao_msgs/Bumper")
    fewer = named(Bumper, "naoqi_msgs/Bumper")
    fewer._md5sum = "4d423b2a165337e812d1b5a1cbab6b8d"  # it had no constant for the bumper at Pepper's back
    reported = named(as_theirs(JointTrajectoryActionFeedback), "nao_msgs/JointTrajectoryActionFeedback")
    with rosbag.Bag(str(tmp_path / "old.bag"), "w") as bag:
        bag.write("joint_angles", angles(joint_names=["HeadYaw"]), Time(1))
        bag.write("tactile_touch", touch(button=2), Time(2))
        bag.write("bumper", stranger("left"), Time(3))
        bag.write("foot", fewer(bumper=1, state=1), Time(3))
        bag.write("joint_trajectory/feedback", feedback(reported), Time(4))
    done = convert_bag(tmp_path / "old.bag", tmp_path / "ours.bag", OURS)
    assert set(done.renamed) == {"nao_msgs/JointAnglesWithSpeed", "nao_msgs/TactileTouch", "naoqi_msgs/Bumper"}
    assert set(done.foreign) == {f"nao_msgs/Bumper ({String._md5sum})"}
    assert set(done.refilled) == {"nao_msgs/JointTrajectoryActionFeedback"}
    convert_bag(tmp_path / "old.bag", tmp_path / "theirs.bag", THEIRS)
    assert types_in(tmp_path / "theirs.bag") == {
        "joint_angles": "naoqi_bridge_msgs/JointAnglesWithSpeed",
        "tactile_touch": "naoqi_bridge_msgs/HeadTouch",
        "bumper": "nao_msgs/Bumper",
        "foot": "naoqi_bridge_msgs/Bumper",
        "joint_trajectory/feedback": "naoqi_bridge_msgs/JointTrajectoryActionFeedback",
    }


def test_what_cannot_be_read_or_written_is_refused_and_leaves_nothing(old, tmp_path):
    (tmp_path / "text.bag").write_text("no bag")
    for source, target, problem in (
        (tmp_path / "text.bag", tmp_path / "new.bag", "text.bag cannot be converted"),
        (old, old, "is there already"),
        (tmp_path / "none.bag", tmp_path / "new.bag", "none.bag cannot be converted"),
    ):
        with pytest.raises(NaoError, match=problem):
            convert_bag(source, target, OURS)
    with pytest.raises(NaoError, match="is the bag itself"):
        convert_bag(old, old, OURS, overwrite=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["old.bag", "text.bag"]


def test_definitions_in_a_bag_are_copied_and_never_run(tmp_path):
    bag, new, made = crafted(tmp_path / "old.bag", tmp_path / "made"), tmp_path / "new.bag", tmp_path / "made"
    done = convert_bag(bag, new, OURS)
    assert dict(done.kept) == {"crafted_msgs/Text": 1} and not made.exists()
    assert types_in(new) == {"t": "crafted_msgs/Text"} and b'open("' in new.read_bytes()
    with rosbag.Bag(str(new)) as as_rosbag_does:
        list(as_rosbag_does.read_messages(raw=True))
    assert made.exists(), "the bag of this test does no harm: it proves nothing"


def test_messages_are_read_by_the_classes_that_are_here_and_never_by_those_of_a_bag(old, tmp_path):
    assert [(time.to_sec(), message.data) for time, message in read_bag(old, "speech", String)] == [(5.0, "hello")]
    one, other = (read_bag(old, topic, kind) for topic, kind in (("speech", String), ("bumper", as_theirs(Bumper))))
    own_way = rosbag.bag._get_message_type
    assert (next(one)[1].data, next(other)[1].bumper) == ("hello", 1) and rosbag.bag._get_message_type is own_way
    made = tmp_path / "made"
    with pytest.raises(NaoError, match=r"t of .* is of crafted_msgs/Text .*, not of std_msgs/String as it is here"):
        list(read_bag(crafted(tmp_path / "crafted.bag", made), "t", String))
    assert not made.exists()


def test_a_damaged_bag_is_refused_in_words(old, tmp_path):
    content = old.read_bytes()
    for place in range(100, len(content), 101):
        (tmp_path / "damaged.bag").write_bytes(content[:place] + bytes([content[place] ^ 0x5A]) + content[place + 1 :])
        with suppress(NaoError):
            convert_bag(tmp_path / "damaged.bag", tmp_path / "new.bag", OURS, overwrite=True)


def test_a_topic_of_two_types_is_refused_with_what_to_do(tmp_path):
    path = tmp_path / "old.bag"
    with rosbag.Bag(str(path), "w") as bag:
        bag.write("t", String("x"), Time(1))
        del bag._topic_connections["t"]  # as when two nodes publish: rosbag itself cannot write that
        bag.write("t", Bumper(), Time(2))
    with pytest.raises(NaoError, match="t has messages of std_msgs/String and of nao_library_msgs/Bumper: "):
        convert_bag(path, tmp_path / "new.bag", THEIRS)


def test_the_command_tells_how_many_messages_have_other_names(old, tmp_path):
    run = CliRunner().invoke(nao, ["bag", "convert", str(old), str(tmp_path / "new.bag"), "--json"])
    assert run.exit_code == 0, run.output
    assert json.loads(run.output)["renamed"]["naoqi_bridge_msgs/JointAnglesWithSpeed"] == 2
    run = CliRunner().invoke(nao, ["bag", "convert", str(tmp_path / "new.bag"), str(tmp_path / "more.bag")])
    assert run.exit_code == 0 and "nothing had to be renamed" in run.output
    run = CliRunner().invoke(nao, ["bag", "convert", str(old), str(tmp_path / "new.bag")])
    assert run.exit_code == 1 and "--overwrite" in run.output
