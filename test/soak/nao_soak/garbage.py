"""Bytes that are no message, sent to the topics of the action servers by somebody who claims that they are.

A node of its own: a server may hang up on it, and must not on anybody else.
"""

from __future__ import annotations

import random
import sys
from io import BytesIO
from typing import Any

import rospy

from nao_library_modules.core.server_types import server_type

PERIOD = 1.0
"""s from one to the next."""


class Garbage:
    """Publishes random bytes as goals of a server.

    Args:
        server: Its name.
        seed: Where chance comes from.
    """

    def __init__(self, server: str, seed: int) -> None:
        self._random = random.Random(f"garbage {server} {seed}")
        kind = type(server_type(server).action().action_goal)
        self._publisher = rospy.Publisher(f"{server}/goal", _claiming_to_be(kind), queue_size=5)
        self._whole = BytesIO()
        kind().serialize(self._whole)

    def send(self) -> None:
        """Send random bytes, or a message that was cut off or changed in places."""
        chance = self._random
        whole = bytearray(self._whole.getvalue())
        for _ in range(chance.choice((0, 1, 5))):
            whole[chance.randrange(len(whole))] = chance.randrange(256)
        cut = whole[: chance.randrange(len(whole))]
        noise = bytes(chance.randrange(256) for _ in range(chance.choice((0, 3, 64, 4000))))
        message = self._publisher.data_class()
        message.data = chance.choice((noise, bytes(cut), bytes(whole)))
        self._publisher.publish(message)


def _claiming_to_be(kind: Any) -> type:
    """A message type that says it is `kind`, and sends whatever bytes it has."""

    class Claimed(rospy.AnyMsg):
        _type, _md5sum, _full_text = kind._type, kind._md5sum, kind._full_text
        __slots__ = ("data",)
        _slot_types = ("char[]",)

        def __init__(self) -> None:
            super().__init__()
            self.data = b""

        def serialize(self, buffer: Any) -> None:
            buffer.write(self.data)

    return Claimed


def main(seed: int, servers: list[str]) -> None:
    """Send garbage to servers until the end of the node."""
    rospy.init_node("soak_garbage", anonymous=True)
    senders = [Garbage(server, seed) for server in servers]
    while not rospy.is_shutdown():
        for sender in senders:
            sender.send()
        rospy.sleep(PERIOD)


if __name__ == "__main__":
    try:
        main(int(sys.argv[1]), sys.argv[2:])
    except rospy.ROSInterruptException:
        sys.exit(0)
