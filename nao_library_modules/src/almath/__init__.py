"""Mathematics of the NAO SDK: poses, positions, rotations, transforms and the functions on them.

Scripts written for the robot maker's `almath` run on this package: names, argument orders and conventions are
the same. Lengths are in m, angles in rad, and three angles stand for R = Rz(wz) Ry(wy) Rx(wx).

Three things differ. Numbers keep the precision of Python instead of being rounded to 32 bits. What cannot be
right (a list of the wrong length, a division by zero, a matrix that is no rotation) raises AlmathError
instead of printing a warning and going on with another value. Plain lists do wherever the SDK wants a
`vectorFloat` or `vectorPosition2D`.
"""

import types

from almath._components import AlmathError
from almath.conversions import (
    crossProduct,
    determinant,
    displacementFromTransform,
    distance,
    distanceSquared,
    dotProduct,
    isOrthogonal,
    isUnitVector,
    norm,
    normalize,
    pinv,
    pose2DFromPosition2D,
    pose2DFromPosition2DInPlace,
    pose2DFromPosition6D,
    pose2DFromPosition6DInPlace,
    pose2DFromTransform,
    pose2DFromTransformInPlace,
    position2DFromPose2D,
    position2DFromPose2DInPlace,
    position2DFromTransform,
    position2DFromTransformInPlace,
    position3DFromPosition6D,
    position3DFromTransform,
    position3DFromTransformInPlace,
    position6DFromPose2D,
    position6DFromPose2DInPlace,
    position6DFromPosition3D,
    position6DFromPosition3DInPlace,
    position6DFromTransform,
    position6DFromTransformInPlace,
    position6DFromVelocity6D,
    quaternionFromRotation3D,
    quaternionFromTransform,
    quaternionPosition3DFromPosition6D,
    rotation3DFromQuaternion,
    rotation3DFromRotation,
    rotation3DFromTransform,
    rotationFromQuaternion,
    rotationFromTransform,
    rotationFromTransformInPlace,
    transformFromDisplacement,
    transformFromPose2D,
    transformFromPose2DInPlace,
    transformFromPosition3D,
    transformFromPosition3DInPlace,
    transformFromPosition6D,
    transformFromQuaternion,
    transformFromRotation,
    transformFromRotation3D,
    transformFromRotationInPlace,
    transformFromRotationPosition3D,
    transpose,
)
from almath.footsteps import (
    areTwoBoxesInCollision,
    avoidFootCollision,
    clipFootWithEllipse,
    computeBox,
    dichotomie,
    getDubinsSolutions,
    intersectionSegment2D,
)
from almath.frames import (
    axisRotationProjection,
    axisRotationProjectionInPlace,
    changeReferencePose2D,
    changeReferencePose2DInPlace,
    changeReferencePosition3D,
    changeReferencePosition3DInPlace,
    changeReferencePosition6D,
    changeReferenceTransform,
    changeReferenceTransposePosition3D,
    changeReferenceTransposePosition3DInPlace,
    changeReferenceTransposePosition6D,
    changeReferenceTransposeTransform,
    changeReferenceTransposeVelocity6D,
    changeReferenceVelocity6D,
    orthogonalSpace,
    position6DFromTransformDiff,
    position6DFromTransformDiffInPlace,
    transformFromRotVec,
    transformFromRotVecInPlace,
    transformLogarithm,
    transformLogarithmInPlace,
    transformMean,
    transformMeanInPlace,
    velocityExponential,
    velocityExponentialInPlace,
)
from almath.positions import (
    Pose2D,
    Position2D,
    Position3D,
    Position6D,
    PositionAndVelocity,
    Velocity3D,
    Velocity6D,
    pose2dDiff,
    pose2DInverse,
    pose2dInvertInPlace,
    vectorFloat,
    vectorPose2D,
    vectorPosition2D,
    vectorPosition6D,
)
from almath.rotations import (
    Displacement,
    Quaternion,
    Rotation,
    Rotation3D,
    Transform,
    TransformAndVelocity6D,
    angleAndAxisRotationFromQuaternion,
    applyRotation,
    normalizeRotation,
    normalizeTransform,
    quaternionFromAngleAndAxisRotation,
    quaternionInverse,
    rotationFrom3DRotation,
    rotationFromAngleDirection,
    rotationFromAxesXY,
    rotationFromAxesXYZ,
    rotationFromAxesXZ,
    rotationFromAxesYZ,
    rotationFromRotX,
    rotationFromRotY,
    rotationFromRotZ,
    transformDiff,
    transformDistance,
    transformDistanceSquared,
    transformFrom3DRotation,
    transformFromPosition,
    transformFromRotX,
    transformFromRotY,
    transformFromRotZ,
    transformInverse,
    transformInvertInPlace,
    transformPreMultiply,
    transformToFloatVector,
)
from almath.tools import (
    AXIS_MASK_ALL,
    AXIS_MASK_NONE,
    AXIS_MASK_PLANEZ,
    AXIS_MASK_ROT,
    AXIS_MASK_VEL,
    AXIS_MASK_WX,
    AXIS_MASK_WY,
    AXIS_MASK_WYWZ,
    AXIS_MASK_WZ,
    AXIS_MASK_X,
    AXIS_MASK_XY,
    AXIS_MASK_Y,
    AXIS_MASK_Z,
    PI,
    PI_2,
    PI_4,
    TO_DEG,
    TO_RAD,
    DigitalFilter,
    PIDController,
    clipData,
    isAxisMask,
    meanAngle,
    modulo2PI,
    modulo2PIInPlace,
    pointMassRotationalInertia,
    weightedMeanAngle,
)

# The SDK has each static method as a function too; scripts use both spellings.
Pose2D_fromPolarCoordinates = Pose2D.fromPolarCoordinates
Position2D_fromPolarCoordinates = Position2D.fromPolarCoordinates
Quaternion_fromAngleAndAxisRotation = Quaternion.fromAngleAndAxisRotation
Rotation_fromQuaternion = Rotation.fromQuaternion
Rotation_fromAngleDirection = Rotation.fromAngleDirection
Rotation_fromRotX = Rotation.fromRotX
Rotation_fromRotXPi = Rotation.fromRotXPi
Rotation_fromRotY = Rotation.fromRotY
Rotation_fromRotYPi = Rotation.fromRotYPi
Rotation_fromRotZ = Rotation.fromRotZ
Rotation_fromRotZPi = Rotation.fromRotZPi
Rotation_fromRotZHalfPi = Rotation.fromRotZHalfPi
Rotation_from3DRotation = Rotation.from3DRotation
Transform_fromRotX = Transform.fromRotX
Transform_fromRotY = Transform.fromRotY
Transform_fromRotZ = Transform.fromRotZ
Transform_from3DRotation = Transform.from3DRotation
Transform_fromPosition = Transform.fromPosition

__all__ = [name for name, value in globals().items() if not (name[0] == "_" or isinstance(value, types.ModuleType))]
