"""Things of the world by the fields of a request."""

import pytest

from nao_library_msgs.srv import PlaceObjectRequest
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.ros.things import entry_of


def test_fields_of_a_request_are_an_entry_of_a_world_file():
    request = PlaceObjectRequest(name="mine", kind="ball", color=[0.0, 0.0, 1.0])
    assert entry_of(request) == {"name": "mine", "position": [0.0, 0.0, 0.0], "ball": 0.03, "color": [0.0, 0.0, 1.0]}


@pytest.mark.parametrize("kind, told", [("bal", "did you mean 'ball'"), ("parts", "one of box, sphere, ball")])
def test_an_unknown_kind_is_told_with_those_that_there_are(kind, told):
    with pytest.raises(BadValue, match=told):
        entry_of(PlaceObjectRequest(name="mine", kind=kind))
