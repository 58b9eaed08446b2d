"""Where the configuration files of this package are."""

from __future__ import annotations

import os
from pathlib import Path

PACKAGE = "nao_library_modules"


def config_file(name: str) -> Path:
    """Path of a file or folder in `config`: beside the sources, or in the share directory of an installation.

    Raises FileNotFoundError if it is in neither place.
    """
    beside = Path(__file__).resolve().parents[3] / "config" / name
    if beside.exists():
        return beside
    import rospkg  # only an installation gets here, and it has ROS

    try:
        installed = Path(rospkg.RosPack().get_path(PACKAGE)) / "config" / name
    except rospkg.ResourceNotFound:
        installed = None
    if installed is not None and installed.exists():
        return installed
    raise FileNotFoundError(f"no configuration file {name}: looked beside the sources and in package {PACKAGE}")


def ros_home() -> Path:
    """The folder of what ROS and its programs keep for a user."""
    return Path(os.environ.get("ROS_HOME") or Path.home() / ".ros")
