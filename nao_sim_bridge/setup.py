"""Python packages of nao_sim_bridge and their data, for catkin and for pip."""

from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

HERE = Path(__file__).resolve().parent
PACKAGE = HERE / "src" / "nao_sim_bridge"

setup(
    name="nao_sim_bridge",
    version=ElementTree.parse(HERE / "package.xml").findtext("version"),
    packages=find_packages("src"),
    package_dir={"": "src"},
    package_data={
        "nao_sim_bridge": [
            str(path.relative_to(PACKAGE))
            for folder in ("config", "worlds", "sounds", "robot_files")
            for path in sorted((PACKAGE / folder).rglob("*"))
            if path.is_file()
        ]
    },
)
