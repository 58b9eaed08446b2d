"""The simulator below roslaunch: its port is kept and told again, and one that never comes up ends the launch file."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_sim_bridge.ros import bound_ports, launched


class Parameters(dict):
    """Those of a master, as `rosgraph.Master` and rospy have them."""

    def getParam(self, name):  # noqa: N802  theirs
        if name not in self:
            raise launched.rosgraph.MasterError(name)
        return self[name]

    def setParam(self, name, value):  # noqa: N802
        self[name] = value


@pytest.fixture
def parameters(monkeypatch):
    known = Parameters()
    for name in ("get_param", "get_param_cached"):
        monkeypatch.setattr(bound_ports.rospy, name, known.get)
    monkeypatch.setattr(bound_ports.rospy, "set_param", known.setParam)
    monkeypatch.setattr(launched.rosgraph, "Master", lambda _: known)
    monkeypatch.setattr(launched.sys, "argv", ["nao_sim", "__name:=nao_sim", "__log:=/tmp/nao_sim.log"])
    return known


def test_the_ports_are_told_again_when_another_launch_file_has_set_them_to_0(parameters, monkeypatch):
    now = [10.0]
    monkeypatch.setattr(bound_ports, "time", SimpleNamespace(monotonic=lambda: now[0]))
    told = {"nao1/nao_sim/bound_port": 40001, "nao2/nao_sim/bound_port": 40002}
    ports = bound_ports.BoundPorts({"nao1": 40001, "nao2": 40002})
    assert dict(parameters) == told
    parameters["nao2/nao_sim/bound_port"] = 0
    ports.tick()
    assert parameters["nao2/nao_sim/bound_port"] == 0  # it looks once a second
    now[0] += bound_ports.PERIOD
    ports.tick()
    assert dict(parameters) == told
    assert bound_ports.ports_before(2) == (40001, 40002) and bound_ports.ports_before(3)[2] == 0


def test_a_master_that_is_away_ends_no_robot(parameters, monkeypatch):
    def away(*_):
        raise ConnectionRefusedError

    monkeypatch.setattr(bound_ports.rospy, "get_param_cached", away)
    bound_ports.BoundPorts({"": 40001})


def test_a_simulator_that_ends_again_and_again_before_it_is_ready_ends_its_launch_file(parameters, monkeypatch):
    ends = []
    monkeypatch.setattr(launched, "end_launch", ends.append)
    launched.count_start()
    assert parameters == {}  # a launch file that does not ask for it
    parameters["/nao_sim/starts"] = 0
    for _ in range(launched.TRIES):
        launched.count_start()
    launched.note_ready()
    for _ in range(launched.TRIES):
        launched.count_start()
    assert ends == []
    launched.count_start()
    assert ends == ["the simulator has ended 3 times before it was ready, see above"]
