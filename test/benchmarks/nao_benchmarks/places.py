"""Where the programs are that the benchmarks start."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PROGRAMS = Path(__file__).resolve().parent / "programs"
SIMULATOR_NODE = ROOT / "nao_sim_bridge" / "nodes" / "nao_sim"
NODES = ROOT / "nao_library_modules" / "nodes"
