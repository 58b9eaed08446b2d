"""The rows of the table, one file each. A new one is a class in a file of its own and an entry here."""

from __future__ import annotations

from ..row import Row
from .behaviors import BehaviorOverhead
from .cameras import CameraFrame, CameraRate, PhysicsWithCameras
from .chained_functions import ChainedFunctions
from .goal_round_trip import GoalRoundTrip
from .hearing_tick import HearingTick
from .memory import Memory
from .motion_latency import MotionStart, MotionStop
from .moving_tick import MovingTick
from .physics_tick import PhysicsTick
from .plans import ParOfHundred, PerformOverhead
from .proxy_call import ProxyCall
from .real_time_factor import RealTimeFactor
from .robots_tick import RobotsTick
from .sound import PhysicsWithSound, RecognitionSpeed
from .speech import SpeechStart, SpeechStop
from .touch import TouchEvent
from .walking_real_time_factor import WalkingRealTimeFactor
from .walking_tick import WalkController, WalkingTick

# Those that compute come first, while nothing else runs yet.
ROWS: tuple[Row, ...] = (
    PhysicsTick(),
    MovingTick(),
    WalkingTick(),
    WalkController(),
    HearingTick(),
    RobotsTick("three_robots_tick", "tick of three robots in one world"),
    RobotsTick("three_robots_walking", "tick of three robots that walk", "--walking"),
    CameraFrame("camera_frame", "320x240"),
    CameraFrame("camera_frame_vga", "640x480"),
    RealTimeFactor(),
    WalkingRealTimeFactor(),
    RecognitionSpeed(),
    PhysicsWithSound(),
    CameraRate(),
    PhysicsWithCameras(),
    ProxyCall(),
    GoalRoundTrip(),
    ChainedFunctions(),
    PerformOverhead(),
    ParOfHundred(),
    MotionStart(),
    MotionStop(),
    BehaviorOverhead(),
    TouchEvent(),
    SpeechStart(),
    SpeechStop(),
    Memory(),
)
