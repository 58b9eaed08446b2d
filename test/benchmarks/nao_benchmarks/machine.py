"""What a reader must know of the machine to judge the figures."""

from __future__ import annotations

import os
import platform
from pathlib import Path


def processor(cpuinfo: str) -> str:
    """Name of the processor from the text of /proc/cpuinfo, or what the platform calls it."""
    for line in cpuinfo.splitlines():
        key, _, value = line.partition(":")
        if key.strip() == "model name" and value.strip():
            return value.strip()
    return platform.machine() or "unknown processor"


def describe() -> dict[str, object]:
    """Processor, cores this process may use, load of the last minute, system and interpreter."""
    path = Path("/proc/cpuinfo")
    return {
        "processor": processor(path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""),
        "cores": len(os.sched_getaffinity(0)),
        "load": round(os.getloadavg()[0], 2),
        "system": f"{platform.system()} {platform.release()}",
        "python": platform.python_version(),
    }
