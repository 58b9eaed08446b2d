"""A launched node whose name another node takes, as a module of one's own does: it comes back when that one has ended.

The master shuts a node down when another one registers under its name. A node that roslaunch started then begins anew
as a process, and waits there, without a connection to anything, until the name is free.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
import xmlrpc.client

import rosgraph
import rospy

from .master_watch import GONE

LAUNCHED = "__log:="
"""How an argument begins that roslaunch gives to its nodes, and nobody else does."""
TAKEN = "new node registered with same name"
"""What the master tells a node whose name was taken."""
WAITING = "NAO_LIBRARY_NAME_TAKEN"
"""Variable with the name that the process waits for."""
PARAMETERS = "NAO_LIBRARY_PARAMETERS"
"""Variable with the node's private parameters, as JSON: who took the name may have brought others along."""
PERIOD = 1.0
"""s between two looks whether the name is free."""
CLOSE_LIMIT = 10.0
"""s that a module has to close."""


def wait_for_name() -> str:
    """Wait until the name is free that another node took from this one, and set the parameters that this one had.

    Returns the name; empty, at once, if none was taken.
    """
    name = os.environ.pop(WAITING, "")
    while name and in_use(name):
        time.sleep(PERIOD)
    parameters = json.loads(os.environ.pop(PARAMETERS, "{}"))
    if parameters:
        rosgraph.Master(name).setParam(name, parameters)
    return name


def in_use(name: str) -> bool:
    """Whether a node of that name runs; without a master nobody can tell, and the wait goes on."""
    try:
        uri = rosgraph.Master(f"{name}_waiting").lookupNode(name)
    except rosgraph.MasterError:
        return False
    except GONE:
        return True
    try:
        xmlrpc.client.ServerProxy(uri).getPid(name)
    except ConnectionRefusedError:  # it died without a word
        return False
    except GONE:
        pass
    return True


class NodePlace:
    """Looks after the name of this node; made after its module, which is closed before the node begins anew."""

    def __init__(self) -> None:
        self._taken = False
        self._parameters = rospy.get_param("~", {})
        self._closed = threading.Event()
        if any(argument.startswith(LAUNCHED) for argument in sys.argv):
            rospy.core.add_preshutdown_hook(self._on_shutdown)
            rospy.on_shutdown(self._closed.set)

    def _on_shutdown(self, reason: str) -> None:
        self._taken = TAKEN in reason
        if self._taken:
            # Not to /rosout: its first message asks the master for a parameter, which would take the name back.
            text = f"another node took the name {rospy.get_name()}: this one comes back when that one has ended"
            print(text, file=sys.stderr, flush=True)

    def come_back(self) -> None:
        """Begin anew if the name was taken: then this does not return."""
        if not self._taken:
            return
        self._closed.wait(CLOSE_LIMIT)
        os.environ[WAITING] = rospy.get_name()
        os.environ[PARAMETERS] = json.dumps(self._parameters)
        sys.stdout.flush()
        sys.stderr.flush()
        os.closerange(3, os.sysconf("SC_OPEN_MAX"))  # connections of libqi would outlive the process's old self
        os.execv(sys.executable, [sys.executable, *sys.argv])  # noqa: S606  itself
