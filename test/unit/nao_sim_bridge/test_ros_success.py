"""ROS services that tell whether what they began came to its end."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
import rospy
from std_srvs.srv import SetBool, SetBoolRequest, SetBoolResponse

from nao_sim_bridge.ros_success import success_service
from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.tasks import Task


@dataclass
class Answer:
    """An answer with its fields in another order, and one more."""

    message: str = ""
    count: int = 7
    success: bool = False


@pytest.fixture
def offered(monkeypatch):
    """Name -> class and handler of the services that were offered."""
    services = {}
    monkeypatch.setattr(rospy, "Service", lambda name, kind, handler: services.update({name: (kind, handler)}))
    return services


def ended(request):
    task = Task("glide", 1)
    task.finish(None, None if request.data else BadValue("data", False, "true"))
    return task


def test_the_answer_is_filled_by_name(offered):
    success_service("~go", SetBool, Answer, ended, "stopped")
    kind, handle = offered["~go"]
    assert kind is SetBool
    assert handle(SetBoolRequest(True)) == Answer("", 7, True)
    assert handle(SetBoolRequest(False)) == Answer(str(BadValue("data", False, "true")), 7, False)


def test_answers_are_messages_of_ros(offered):
    success_service("~go", SetBool, SetBoolResponse, ended, "stopped")
    assert offered["~go"][1](SetBoolRequest(True)) == SetBoolResponse(success=True, message="")
