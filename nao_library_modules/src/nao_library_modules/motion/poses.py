"""Poses by name: from Choregraphe's pose libraries in the folder of motions, and the ones that come with us."""

from __future__ import annotations

from collections.abc import Container
from pathlib import Path

from naoqi.errors import NaoError

from ..base.errors import BadGoal
from ..base.paths import config_file
from ..base.suggestion import did_you_mean
from ..nao.xap import read_poses

SUFFIX = ".xap"
OURS = "poses.xap"
SEPARATOR = ":"


class NamedPoses:
    """Finds poses by name.

    A pose is named as in its file (`Wave`), or, when several files know the name, with the file (`mine.xap:Wave`).
    `folder`: where the user's pose libraries (.xap) are.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def find(self, name: str, joints: Container[str]) -> dict[str, float]:
        """Joint -> angle in rad of a pose, as far as the robot has the joints.

        Raises BadGoal if there is no such pose or file, or the file is broken.
        """
        file, separator, pose = name.strip().rpartition(SEPARATOR)
        poses = self._of_file(file) if separator else self._all()
        if pose not in poses:
            problem = f"there is no pose {pose!r}{did_you_mean(pose, poses)}"
            raise BadGoal("str_param", name, f"one of {', '.join(poses)}", problem=problem)
        return {joint: angle for joint, angle in poses[pose].items() if joint in joints}

    def names(self) -> list[str]:
        return list(self._all())

    def _files(self) -> dict[str, Path]:
        files = {OURS: config_file(OURS)}
        if self._folder.is_dir():
            files.update({path.name: path for path in sorted(self._folder.glob(f"*{SUFFIX}"))})
        return files

    def _of_file(self, file: str) -> dict[str, dict[str, float]]:
        files = self._files()
        if file not in files:
            allowed = f"one of {', '.join(files)}{did_you_mean(file, files)}"
            raise BadGoal("str_param", file, allowed, problem=f"no pose library {file!r} in {self._folder}")
        return self._read(files[file])

    def _all(self) -> dict[str, dict[str, float]]:
        poses: dict[str, dict[str, float]] = {}
        for path in self._files().values():
            poses.update(self._read(path))
        return poses

    @staticmethod
    def _read(path: Path) -> dict[str, dict[str, float]]:
        try:
            return read_poses(path)
        except NaoError as error:
            raise BadGoal("str_param", path.name, "a pose library of Choregraphe", problem=str(error)) from error
