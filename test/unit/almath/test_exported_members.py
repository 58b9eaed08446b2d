"""The public surface: what `import almath` offers, and that it stands alone."""

import ast
import importlib
import sys
from pathlib import Path

import pytest

import almath

PACKAGE = Path(almath.__file__).parent
MODULES = sorted(path.stem for path in PACKAGE.glob("*.py") if not path.stem.startswith("_"))

# Names that scripts are known to use, in the spelling of the SDK.
KNOWN = """
AXIS_MASK_VEL PI TO_RAD Pose2D Position2D Position3D Position6D PositionAndVelocity Quaternion Rotation
Rotation3D Transform TransformAndVelocity6D Velocity3D Velocity6D Displacement vectorFloat vectorPosition2D
vectorPose2D vectorPosition6D Transform_fromPosition Transform_from3DRotation avoidFootCollision
clipFootWithEllipse distance modulo2PI pose2DInverse pose2dDiff pose2dInvertInPlace position6DFromTransform
rotation3DFromQuaternion rotationFromQuaternion transformFromPosition6D transformFromQuaternion
transformFromRotX transformInverse transformLogarithm transformMean
"""


@pytest.mark.parametrize("name", KNOWN.split())
def test_names_of_the_sdk_are_there(name):
    assert name in almath.__all__
    assert hasattr(almath, name)


@pytest.mark.parametrize("module", MODULES)
def test_each_public_function_and_class_is_exported(module):
    found = importlib.import_module(f"almath.{module}")
    tree = ast.parse(Path(found.__file__).read_text())
    names = [node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))]
    for name in names:
        if not name.startswith("_"):
            assert getattr(almath, name) is getattr(found, name)
            assert name in almath.__all__


def test_exported_names_exist_and_are_listed_once_in_order():
    assert almath.__all__ == sorted(set(almath.__all__))
    for name in almath.__all__:
        assert hasattr(almath, name)


def test_flat_names_are_the_static_methods():
    flat = [name for name in almath.__all__ if "_from" in name]
    assert len(flat) == 18
    for name in flat:
        kind, method = name.split("_")
        assert getattr(almath, name) is getattr(getattr(almath, kind), method)


def test_only_the_standard_library_is_imported():
    for path in PACKAGE.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                roots = {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                roots = {node.module.split(".")[0]}
            else:
                continue
            foreign = roots - {"almath"} - set(getattr(sys, "stdlib_module_names", roots))
            assert not foreign, path.name
