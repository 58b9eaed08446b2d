"""What a simulator reads when it starts: nothing that only some of its users need."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import nao_sim_bridge

START = """
import os, sys
from pathlib import Path
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.simulator_server import SimulatorServer

server = SimulatorServer(ServerOptions(record_dir=Path(sys.argv[1]), port=0))
server.start()
server.stop()
print("read:", *sys.modules, flush=True)
os._exit(0)
"""
LIMIT = 60.0
PACKAGE = Path(nao_sim_bridge.__file__).parent
MADE_LATER = re.compile(r'"((?:\w+\.)+\w+):[\w{}]+"')
"""How our code names what it imports when it needs it; see `nao_sim_bridge.base.imports`."""


def test_a_start_reads_no_code_that_is_read_when_first_needed(tmp_path):
    sources = "".join(path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py"))
    later = {f"nao_sim_bridge.{name}" for name in MADE_LATER.findall(sources)}
    assert "nao_sim_bridge.naoqi.navigation.navigation" in later and "nao_sim_bridge.naoqi.users.users" in later
    start = [sys.executable, "-c", START, str(tmp_path)]
    told = subprocess.run(start, stdout=subprocess.PIPE, text=True, check=True, timeout=LIMIT)
    read = set(told.stdout.rpartition("read:")[2].split())
    assert "nao_sim_bridge.naoqi.motion.walking" in read
    seldom = {"nao_sim_bridge.speech.gesture_families", "cv2", "PIL.Image", "av", "soundfile"}
    assert sorted(read & (later | seldom)) == []
