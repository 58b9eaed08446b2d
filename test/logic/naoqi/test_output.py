"""What libqi writes of itself, which must not stand among what a program writes."""

import subprocess
import sys

import pytest

PROGRAM = """
import qi
{}
qi.logging.Logger("qi.eventloop").info("one thread more")
qi.logging.Logger("of.a.program").info("hello")
"""


@pytest.mark.parametrize(
    "begin",
    [
        "from naoqi.session import Live; Live()",
        "from nao_sim_bridge.server.broker import Broker; Broker()",
    ],
)
def test_news_of_the_threads_of_libqi_are_not_written(begin):
    done = subprocess.run([sys.executable, "-c", PROGRAM.format(begin)], capture_output=True, text=True, timeout=60)
    assert "hello" in done.stdout and "one thread more" not in done.stdout, done.stderr
