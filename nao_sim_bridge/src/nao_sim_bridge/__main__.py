"""`python -m nao_sim_bridge`: the simulator without ROS."""

from __future__ import annotations

import faulthandler
import logging
import os
import signal
import sys

from nao_sim_bridge.base.closing import REFUSED, close_all, exit_in_time, wait_for_end
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.server.cli import parse, server_options, tell_ports
from nao_sim_bridge.server.robots_server import open_server


def main() -> int:
    """Run until a signal, a client's shutdown or a failure; returns the exit status."""
    faulthandler.register(signal.SIGUSR1)  # kill -USR1: where every thread is
    arguments = parse("python -m nao_sim_bridge")
    logging.basicConfig(
        level=logging.DEBUG if arguments.verbose else logging.INFO, format="[nao_sim] %(levelname)s %(message)s"
    )
    try:
        server = open_server(server_options(arguments))
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: server.ended.set())
        server.start()
        tell_ports(server, arguments.port_file)
    except (SimulationError, RuntimeError) as error:
        logging.getLogger("nao_sim").error("%s", error)
        return REFUSED
    status = wait_for_end(server)
    exit_in_time()
    close_all(*server.ending())
    return status


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    sys.stderr.flush()
    # Not sys.exit: everything is closed, and libqi's threads may still run when its destructors do, which aborts.
    os._exit(status)
