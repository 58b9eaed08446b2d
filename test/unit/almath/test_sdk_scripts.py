"""Passages as they stand in scripts for a robot, with lists as ALMotion returns them."""

import math

import almath
import motion
import vision_definitions


def test_displacement_of_the_robot_between_two_odometry_readings():
    start = almath.Pose2D([1.0, 0.5, math.pi - 0.1])
    end = almath.Pose2D([0.9, 0.5, -math.pi + 0.1])
    move = almath.pose2DInverse(start) * end
    move.theta = almath.modulo2PI(move.theta)
    assert move.isNear(almath.Pose2D(0.1 * math.cos(0.1), 0.1 * math.sin(0.1), 0.2), 1e-9)


def test_hand_is_moved_five_centimetres_to_the_right_of_where_it_is():
    current = [1.0, 0.0, 0.0, 0.2, 0.0, 1.0, 0.0, 0.1, 0.0, 0.0, 1.0, 0.3, 0.0, 0.0, 0.0, 1.0]
    target = almath.Transform(current)
    target.r2_c4 -= 0.05
    path = list(target.toVector())
    assert path == current[:7] + [0.1 - 0.05] + current[8:]
    assert isinstance(path[0], float)


def test_torso_is_lowered_in_its_own_frame():
    torso = almath.Transform(
        almath.vectorFloat(almath.Transform.fromPosition(0.0, 0.0, 0.31, 0.0, 0.1, 0.0).toVector())
    )
    target = torso * almath.Transform(0.0, -0.06, -0.03)
    assert abs(target.r3_c4 - (0.31 - 0.03 * math.cos(0.1))) < 1e-12
    assert target.r2_c4 == -0.06


def test_landmark_seen_by_the_camera_is_placed_in_the_frame_of_the_robot():
    camera = almath.Transform.fromPosition(0.06, 0.0, 0.48, 0.0, 0.2, 0.0)
    alpha, beta, angular_size, size = 0.1, -0.2, 0.15, 0.06
    distance = size / (2.0 * math.tan(angular_size / 2.0))
    towards = almath.Transform_from3DRotation(0, beta, alpha)
    landmark = almath.Transform(camera.toVector()) * towards * almath.Transform(distance, 0, 0)
    straight = math.hypot(landmark.r1_c4 - 0.06, landmark.r2_c4, landmark.r3_c4 - 0.48)
    assert math.isclose(straight, distance)
    # Pitch of the head and elevation of the mark cancel out; what is left is the way to the left.
    assert abs(landmark.r3_c4 - 0.48) < 0.01
    assert math.isclose(landmark.r2_c4, distance * math.cos(beta) * math.sin(alpha))


def test_footstep_is_clipped_before_it_is_sent():
    left = [almath.Pose2D(0.11, 0.050, 0), almath.Pose2D(0.11, -0.038, 0), almath.Pose2D(-0.047, -0.038, 0)]
    left.append(almath.Pose2D(-0.047, 0.050, 0.0))
    right = [almath.Pose2D(pose.x, -pose.y, 0.0) for pose in left]
    step = almath.Pose2D(0.09, 0.30, -0.6)
    step.y -= 0.05
    almath.clipFootWithEllipse(0.04, 0.06, step)
    step.y += 0.05
    assert math.isclose((step.x / 0.04) ** 2 + ((step.y - 0.05) / 0.06) ** 2, 1.0)
    reached = almath.Pose2D(step)
    assert almath.avoidFootCollision(left, right, False, step) is True
    assert (step.x, step.y) == (reached.x, reached.y)
    assert -0.6 < step.theta < 0.0


def test_masks_frames_and_cameras_are_the_integers_that_calls_take():
    arguments = [motion.FRAME_ROBOT, almath.AXIS_MASK_VEL, motion.AXIS_MASK_ALL - motion.AXIS_MASK_WZ]
    arguments += [vision_definitions.kTopCamera, vision_definitions.kVGA, vision_definitions.kBGRColorSpace]
    assert arguments == [2, 7, 31, 0, 2, 13]
    assert all(type(argument) is int for argument in arguments)
    assert math.isclose(90.0 * motion.TO_RAD, almath.PI_2)
