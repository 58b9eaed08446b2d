"""Python packages of nao_library_modules, as catkin asks for them."""

from pathlib import Path

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import find_packages, setup

setup(
    **generate_distutils_setup(
        packages=find_packages("src"),
        py_modules=sorted(path.stem for path in Path("src").glob("*.py")),
        package_dir={"": "src"},
    )
)
