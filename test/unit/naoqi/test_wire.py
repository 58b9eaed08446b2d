"""What goes over the wire is plain, and what comes back holds bytes, not bytearrays."""

from __future__ import annotations

import enum

import numpy as np
import pytest

from naoqi import wire


def takes_raw():
    return True


def takes_no_raw():
    return False


class Speed(enum.IntEnum):
    FAST = 3


class Degrees(float):
    pass


def test_plain_arguments_pass_untouched():
    arguments = ("Body", 1, 2.5, True, None)
    assert wire.to_wire(arguments, takes_no_raw) is arguments


@pytest.mark.parametrize(
    "given, sent",
    [
        (np.float32(0.5), 0.5),
        (np.int64(7), 7),
        (np.bool_(True), True),
        (np.str_("Head"), "Head"),
        (np.array([[1.0, 2.0], [3.0, 4.0]]), [[1.0, 2.0], [3.0, 4.0]]),
        ([np.float64(1.5), "a"], [1.5, "a"]),
        ((1, (np.int32(2),)), [1, [2]]),
        (Speed.FAST, 3),
        (Degrees(1.5), 1.5),
        ({"a": np.int8(1)}, {"a": 1}),
        ({"a": 1}.keys(), ["a"]),
        ({"a": 1}.values(), [1]),
        (range(3), [0, 1, 2]),
        (map(float, (1, 2)), [1.0, 2.0]),
        ({4}, [4]),
        (b"text", "text"),
    ],
)
def test_values_become_plain(given, sent):
    (value,) = wire.to_wire((given,), takes_no_raw)
    assert value == sent
    assert type(value) is type(sent)


def test_members_of_converted_lists_are_plain_too():
    ((value, _),) = wire.to_wire(([np.float64(1.5), [np.int8(1)]],), takes_no_raw)
    assert type(value) is float


def test_raw_bytes_go_where_raw_is_declared_and_nowhere_else():
    assert wire.to_wire((b"\xff\x00",), takes_raw) == (b"\xff\x00",)
    with pytest.raises(wire.UnsendableError, match="2 raw bytes"):
        wire.to_wire((b"\xff\x00",), takes_no_raw)


def test_an_unknown_object_is_refused_by_its_type():
    with pytest.raises(wire.UnsendableError, match="type object"):
        wire.to_wire(([object()],), takes_raw)


@pytest.mark.parametrize("value, fault", [([1, 2**63], "64 bits"), ({"a": "\udcff"}, "Unicode")])
def test_what_libqi_refuses_inside_plain_values_is_named(value, fault):
    with pytest.raises(wire.UnsendableError, match=fault):
        wire.check_sendable(value)


def test_the_largest_integers_that_fit_are_sendable():
    wire.check_sendable([2**63 - 1, -(2**63)])


@pytest.mark.parametrize(
    "came, expected",
    [
        (bytearray(b"\x00\xff"), b"\x00\xff"),
        ([320, 240, bytearray(b"\x01")], [320, 240, b"\x01"]),
        ((1, (2, bytearray(b"\x02"))), (1, (2, b"\x02"))),
        ({"left": [bytearray(b"\x03")]}, {"left": [b"\x03"]}),
    ],
)
def test_raw_data_become_bytes_at_every_depth(came, expected):
    value = wire.from_wire(came)
    assert value == expected
    assert "bytearray" not in repr(value)


def test_values_without_raw_data_are_not_copied():
    value = [1.0, "a", None]
    assert wire.from_wire(value) is value
