"""The stack of a worker: a master that stays, and a simulated robot that is begun again when it was lost."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..processes.own_master import OwnMaster
from ..processes.own_stack import START_LIMIT, OwnStack

NODE = "nao_sweep"
AS_FAST_AS_POSSIBLE = "0"


class WorkerStack:
    """A ROS master, a stack on it, and this process as a node of it: a process has at most one in its life.

    Attributes:
        robot: The `SimulatedRobot`; None while the stack does not run.

    Args:
        launch: Arguments of nao_sim.launch.

    Raises:
        RuntimeError: This process is a ROS node already.
        MasterFailed: The master does not come up.
    """

    def __init__(self, launch: Mapping[str, str]) -> None:
        import rospy

        if rospy.core.is_initialized():
            raise RuntimeError("this process is a ROS node already: sweep with 1 worker or more, or in another process")
        self._folder = Path(tempfile.mkdtemp(prefix="nao_sweep_"))
        self.robot: Any = None
        self._launch = {"speed": AS_FAST_AS_POSSIBLE, "record_dir": str(self._folder), **launch}
        self._stack: OwnStack | None = None
        self._master = OwnMaster(self._folder / "master.log")
        os.environ["ROS_MASTER_URI"] = self._master.uri

    def start(self) -> bool:
        """Start the stack, unless it runs; whether it had to be started. Raises StackFailed if it does not come up."""
        import rospy

        from nao_sim_bridge.testing import SimulatedRobot

        if self.robot is not None:
            return False
        self._stack = OwnStack(self._folder / "stack.log", self._launch, master_uri=self._master.uri)
        self._stack.wait_for_robot()
        if not rospy.core.is_initialized():  # not before the stack has said whose time counts
            rospy.init_node(NODE, argv=[NODE], anonymous=True, disable_rosout=True, disable_signals=True)
        self.robot = SimulatedRobot(limit=START_LIMIT)
        return True

    def drop(self) -> None:
        """End the stack."""
        self.robot = None
        if self._stack is not None:
            self._stack.stop()
            self._stack = None

    def close(self) -> None:
        """End it, and its master; leave nothing on the disk."""
        import rospy

        rospy.signal_shutdown("the sweep is over")
        self.drop()
        self._master.stop()
        shutil.rmtree(self._folder, ignore_errors=True)
