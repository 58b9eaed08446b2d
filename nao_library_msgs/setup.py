"""The Python package of nao_library_msgs, as catkin asks for it."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["nao_library_msgs"], package_dir={"": "src"}))
