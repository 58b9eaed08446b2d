"""Types that other nodes name: looked up among the messages that are built here, and nowhere else."""

import inspect
import sys
from types import SimpleNamespace

import pytest

from nao_library_modules.base.errors import BadGoal
from nao_library_modules.functions.chain import OF_THE_SERVER
from nao_library_modules.functions.memory_functions import MemoryFunctions
from nao_library_modules.functions.server_types import ACTIONS, described_type, installed_message, server_type
from nao_library_msgs.msg import LedFunction


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
    with pytest.raises(BadGoal, match="not known to this process"):
        described_type("greet", SimpleNamespace(action=name, message=name))


@pytest.mark.parametrize("name", ACTIONS)
def test_all_fields_of_a_message_are_never_taken_for_the_parameters_of_a_function(name):
    server = server_type(name)
    fields = set(server.function.__slots__) - OF_THE_SERVER
    for function in {**MemoryFunctions.functions, **server.module.declared_functions()}.values():
        with pytest.raises(TypeError):
            inspect.signature(function).bind("self", *fields)
