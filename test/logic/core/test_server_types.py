"""Types that other nodes name: looked up among the messages that are built here, and nowhere else."""

import inspect
import sys
from types import SimpleNamespace

import pytest
import rospy
from actionlib.msg import TestAction

from nao_library_modules.core.chain import OF_THE_SERVER
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.memory_functions import MemoryFunctions
from nao_library_modules.core.server_types import (
    ACTIONS,
    described_type,
    installed_message,
    names_of,
    require_fields,
    server_type,
    servers_among,
)
from nao_library_modules.nao_basic import NaoBasic
from nao_library_msgs.msg import LedFunction
from naoqi.errors import NaoError


def test_a_message_is_known_by_its_name_where_it_is_built():
    assert installed_message("nao_library_msgs/LedFunction") is LedFunction
    assert installed_message("std_msgs/Header")._type == "std_msgs/Header"


@pytest.mark.parametrize(
    "name", ["greeter/Text", "greeter.msg/Text", "greeter.parts/Text", "../greeter/Text", "std_msgs/X", ""]
)
def test_a_name_imports_no_module_that_is_no_message(name, tmp_path, monkeypatch):
    (tmp_path / "greeter/parts").mkdir(parents=True)
    for file in ("greeter/__init__.py", "greeter/msg.py", "greeter/parts/__init__.py"):
        (tmp_path / file).write_text("raise SystemExit('a name has run a module')\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert installed_message(name) is None and "greeter" not in sys.modules
    monkeypatch.setattr(sys, "argv", ["/opt/nao_behavior_server"])
    monkeypatch.setattr(rospy.core, "is_initialized", lambda: False)
    with pytest.raises(BadGoal, match="nao_behavior_server does not find the messages of greet.*start it again"):
        described_type("greet", SimpleNamespace(action=name, message=name))


@pytest.mark.parametrize("name", ACTIONS)
def test_all_fields_of_a_message_are_never_taken_for_the_parameters_of_a_function(name):
    server = server_type(name)
    fields = set(server.function.__slots__) - OF_THE_SERVER
    for function in {**MemoryFunctions.functions, **server.module.declared_functions()}.values():
        with pytest.raises(TypeError):
            inspect.signature(function).bind("self", *fields)


def test_an_action_of_a_users_own_that_lacks_fields_is_refused_with_all_of_them():
    for name in ACTIONS:
        require_fields(server_type(name).action)
    with pytest.raises(
        NaoError, match="TestAction lacks functions in its goal, .* results in its result, index in its"
    ):
        require_fields(TestAction)


def test_each_module_has_an_action_and_a_function_message_of_its_own_and_inherits_nao_basic():
    servers = [server_type(name) for name in ACTIONS]
    for kind, package in (("action", "nao_library_actions"), ("function", "nao_library_msgs")):
        names = {getattr(server, kind)._type for server in servers}
        assert len(names) == len(servers) and {name.partition("/")[0] for name in names} == {package}
    for module in (server.module for server in servers):
        assert issubclass(module, NaoBasic) and module is not NaoBasic
        assert list(inspect.signature(module).parameters)[:4] == ["ip", "port", "autostart", "launchpath"]


def test_a_server_that_is_found_by_two_names_is_one_server():
    services = [f"/nao1/{name}/{word}" for name in names_of("nao_audio_out") for word in ("describe", "check")]
    assert "/nao1/NaoAudioOut/describe" in services and servers_among(services) == ["/nao1/nao_audio_out"]
