"""Names of types in the older packages: the table, what is installed, and classes that go by these names."""

import ast
import sys
from io import BytesIO
from pathlib import Path

import pytest
from older_packages import make_older_packages

from nao_library_actions import msg as actions
from nao_library_modules.ros import driver_types
from nao_library_modules.ros import type_names as names_of_types
from nao_library_modules.ros.driver_types import as_theirs, spoken
from nao_library_modules.ros.type_names import AUTO, OURS, THEIRS, Choice, choose, generated, main, type_names
from nao_library_msgs import msg, srv
from naoqi.errors import NaoError

PACKAGE = Path(__file__).resolve().parents[3] / "nao_library_modules"
MAKERS = {"Publisher", "Subscriber", "Service", "ActionClient", "SimpleActionClient", "ActionServer"}
OLDER = ("naoqi_bridge_msgs", "humanoid_nav_msgs", "nao_interaction_msgs")


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    return make_older_packages(tmp_path_factory.mktemp("older"))


def forget():
    for name in [name for name in sys.modules if name.partition(".")[0] in OLDER]:
        del sys.modules[name]


@pytest.fixture
def installed(packages, monkeypatch):
    """The older packages as a sourced workspace has them."""
    forget()
    monkeypatch.syspath_prepend(str(packages))
    driver_types._not_here.cache_clear()
    monkeypatch.setattr(driver_types, "_own_choice", lambda: THEIRS)
    yield packages
    driver_types._not_here.cache_clear()
    forget()


def carried(message, kind):
    """A message of a class as what another class reads of its bytes."""
    buffer = BytesIO()
    message.serialize(buffer)
    return kind().deserialize(buffer.getvalue())


def test_our_definitions_under_the_older_names_have_the_sums_of_the_table(installed):
    assert names_of_types.installed() == dict(type_names().sums)
    assert len(type_names().sums) == 176


def test_auto_speaks_what_is_installed_and_names_may_be_asked_for(installed):
    told = f"messages: types of the driver have the names of {', '.join(OLDER)}; messages:=nao_library keeps those of "
    told += "nao_library_msgs"
    assert choose(AUTO) == choose(THEIRS) == Choice(THEIRS, told)
    assert choose(OURS) == Choice(OURS)


def test_without_the_packages_auto_is_ours_and_their_names_are_refused(monkeypatch, capsys):
    monkeypatch.setattr(names_of_types, "generated", lambda package: [])
    assert choose(AUTO) == Choice(OURS)
    assert main([AUTO]) == 0 and capsys.readouterr().out == OURS
    with pytest.raises(NaoError, match="naoqi_bridge_msgs cannot be imported.* say nao_lib"):
        choose(THEIRS)
    assert main([THEIRS]) == 1 and "cannot be imported" in capsys.readouterr().err
    with pytest.raises(NaoError, match="'naoqi': it is auto, nao_library or naoqi_bridge"):
        choose("naoqi")


@pytest.fixture
def changed(installed):
    """Changes a file of the generated packages, and puts it back."""
    before = {}

    def change(name, *replaced):
        file = installed / name
        before[file] = file.read_text()
        file.write_text(before[file].replace(*replaced))

    yield change
    for file, text in before.items():
        file.write_text(text)


def test_of_one_package_the_names_are_spoken_and_the_others_are_told(installed, monkeypatch, capsys):
    """The types whose fields are others decide: without them a name is all that there is to gain."""
    there = {"naoqi_bridge_msgs"}
    monkeypatch.setattr(names_of_types, "generated", lambda package: generated(package) if package in there else [])
    for wanted in (AUTO, THEIRS):
        chosen = choose(wanted)
        assert chosen.names == THEIRS and not chosen.problem
        assert "but for all of humanoid_nav_msgs, all of nao_interaction_msgs, not on this computer;" in chosen.told
    assert spoken(msg.Bumper)._type == "naoqi_bridge_msgs/Bumper" and spoken(msg.StepTarget) is msg.StepTarget
    there = {"humanoid_nav_msgs"}
    assert main([AUTO]) == 0
    output = capsys.readouterr()
    assert output.out == OURS and "keeps the types of nao_library_msgs, for naoqi_bridge_msgs cannot be" in output.err


def test_what_a_package_of_another_version_lacks_or_has_otherwise_keeps_its_name(changed):
    wanted = type_names().sums["naoqi_bridge_msgs/Bumper"]
    changed("naoqi_bridge_msgs/msg/_Bumper.py", wanted, "0" * 32)
    changed("naoqi_bridge_msgs/srv/_GetFloat.py", "naoqi_bridge_msgs/GetFloat", "naoqi_bridge_msgs/Other")
    chosen = choose(THEIRS)
    assert chosen.names == THEIRS and "but for naoqi_bridge_msgs/GetFloat, not on this computer;" in chosen.told
    assert chosen.problem.startswith(f"naoqi_bridge_msgs/Bumper has md5 sum {'0' * 32} instead of {wanted}: clients")
    assert spoken(msg.Bumper) is msg.Bumper and spoken(msg.HeadTouch)._type == "naoqi_bridge_msgs/HeadTouch"


def test_types_with_other_fields_go_by_what_the_driver_says_and_are_refused_in_another_version(changed):
    empty = type_names().sums["naoqi_bridge_msgs/JointTrajectoryFeedback"]
    changed("naoqi_bridge_msgs/msg/_JointTrajectoryFeedback.py", empty, "0" * 32)
    changed("naoqi_bridge_msgs/msg/_JointTrajectoryAction.py", "/JointTrajectoryAction", "/OtherAction")
    with pytest.raises(NaoError, match=f"JointTrajectoryFeedback has md5 sum {'0' * 32} instead of {empty}: another"):
        choose(THEIRS)
    assert choose(AUTO).names == OURS
    assert spoken(actions.JointTrajectoryAction)._type == "naoqi_bridge_msgs/JointTrajectoryAction"


def test_the_topic_of_the_head_has_the_type_that_nao_robot_gives_it(installed):
    """nao_robot renamed the type and kept the topic."""
    assert as_theirs(msg.TactileTouch)._type == "naoqi_bridge_msgs/HeadTouch"
    assert type_names().ours["naoqi_bridge_msgs/HeadTouch"] == "nao_library_msgs/HeadTouch"


def test_a_message_by_the_older_name_is_read_by_their_class_and_theirs_by_it(installed):
    from naoqi_bridge_msgs.msg import JointAnglesWithSpeed

    ours = msg.JointAnglesWithSpeed(joint_names=["HeadYaw"], joint_angles=[0.5], speed=0.2)
    spoken = as_theirs(msg.JointAnglesWithSpeed)
    assert (spoken._type, spoken._md5sum) == (JointAnglesWithSpeed._type, JointAnglesWithSpeed._md5sum)
    theirs = carried(ours, JointAnglesWithSpeed)
    assert theirs.joint_names == ["HeadYaw"] and theirs.speed == pytest.approx(0.2)
    back = carried(theirs, spoken)
    assert isinstance(back, msg.JointAnglesWithSpeed) and back.joint_angles == pytest.approx([0.5])
    assert spoken(speed=0.3).speed == 0.3 and spoken(relative=1) != spoken()


def test_the_definition_that_goes_with_it_names_their_types_all_the_way_down(installed):
    from genpy.dynamic import generate_dynamic
    from humanoid_nav_msgs.msg import ExecFootstepsActionGoal

    text = as_theirs(actions.ExecFootstepsActionGoal)._full_text
    assert "nao_library" not in text
    rebuilt = generate_dynamic(ExecFootstepsActionGoal._type, text)
    assert rebuilt[ExecFootstepsActionGoal._type]._md5sum == ExecFootstepsActionGoal._md5sum
    assert "humanoid_nav_msgs/StepTarget" in rebuilt


def test_an_action_has_their_topics_and_keeps_our_goal(installed):
    action = as_theirs(actions.BodyPoseAction)()
    assert [part._type for part in (action.action_goal, action.action_result, action.action_feedback)] == [
        f"naoqi_bridge_msgs/BodyPoseAction{part}" for part in ("Goal", "Result", "Feedback")
    ]
    assert isinstance(action.action_goal.goal, actions.BodyPoseGoal)


def test_feedback_with_other_fields_goes_out_without_ours(installed):
    from naoqi_bridge_msgs.msg import JointTrajectoryActionFeedback

    spoken = type(as_theirs(actions.JointTrajectoryAction)().action_feedback)
    assert (spoken._type, spoken._md5sum) == (
        JointTrajectoryActionFeedback._type,
        JointTrajectoryActionFeedback._md5sum,
    )
    message = spoken(feedback=actions.JointTrajectoryFeedback(joint_names=["HeadYaw"]))
    message.status.goal_id.id = "g"
    assert carried(message, JointTrajectoryActionFeedback).status.goal_id.id == "g"


def test_a_service_keeps_its_halves():
    spoken = as_theirs(srv.CmdPoseService)
    assert (spoken._type, spoken._md5sum) == ("naoqi_bridge_msgs/CmdPoseService", srv.CmdPoseService._md5sum)
    assert spoken._response_class is srv.CmdPoseService._response_class


def made_past_the_choice(source):
    """Lines of a program where a topic, a service or an action is made with a type of the table as it is."""
    words = {name.partition("/")[2] for name in type_names().theirs}
    for call in ast.walk(ast.parse(source)):
        if isinstance(call, ast.Call) and getattr(call.func, "attr", getattr(call.func, "id", "")) in MAKERS:
            given = [*call.args, *(keyword.value for keyword in call.keywords)]
            if any(getattr(value, "attr", getattr(value, "id", "")) in words for value in given):
                yield call.lineno


def test_every_topic_and_action_of_a_type_with_two_names_follows_the_choice():
    assert list(made_past_the_choice("rospy.Publisher('bumper', Bumper)\nrospy.Publisher('x', spoken(Bumper))")) == [1]
    files = [*(PACKAGE / "src").rglob("*.py"), *(PACKAGE / "examples").rglob("*.py")]
    assert len(files) > 300
    wrong = [f"{file.relative_to(PACKAGE)}:{line}" for file in files for line in made_past_the_choice(file.read_text())]
    assert not wrong, "\n".join(wrong)
