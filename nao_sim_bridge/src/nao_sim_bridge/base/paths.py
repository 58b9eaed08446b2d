"""Where the data files of this package are: beside the sources, or in the installed share directory."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

PACKAGE = "nao_sim_bridge"


@lru_cache(maxsize=None)
def data_root() -> Path:
    """Directory that holds `config`, `urdf`, `worlds` and `sounds`.

    In a source tree (and in catkin's devel space, which imports from it) this is the package folder two
    levels above the Python package. In an install space rospack knows the share directory.

    Raises:
        FileNotFoundError: If neither place has the data files.
    """
    beside = Path(__file__).resolve().parents[3]
    if (beside / "config").is_dir():
        return beside
    try:
        import rospkg  # optional: only an install space needs it, and only ROS users have one

        share = Path(rospkg.RosPack().get_path(PACKAGE))
    except ImportError:
        share = None
    except rospkg.ResourceNotFound:
        share = None
    if share is not None and (share / "config").is_dir():
        return share
    raise FileNotFoundError(
        f"no data files of {PACKAGE}: looked in {beside} and, if rospkg is there, in the share directory"
    )


def config_file(name: str) -> Path:
    """Path of a file in `config`."""
    return data_root() / "config" / name


def urdf_file(name: str) -> Path:
    """Path of a file in `urdf`."""
    return data_root() / "urdf" / name


def world_directory() -> Path:
    """Directory of the worlds that come with the package."""
    return data_root() / "worlds"


def sounds_directory() -> Path:
    """Directory of the sounds that come with the package, a folder a sound set."""
    return data_root() / "sounds"
