"""The rows of the table, one file each. A new one is a class in a file of its own and an entry here."""

from __future__ import annotations

from ..row import Row
from .behaviors import BehaviorOverhead
from .cameras import CameraFrame, CameraRate, PhysicsWithCameras
from .chained_functions import ChainedFunctions
from .console import CONSOLE
from .goal_round_trip import GoalRoundTrip
from .library import LIBRARY
from .memory import Memory
from .motion_latency import MotionStart, MotionStop
from .plans import ParOfHundred, PerformOverhead
from .proxy_call import ProxyCall
from .real_time_factor import RealTimeFactor, WalkingRealTimeFactor
from .sound import PhysicsWithSound, RecognitionSpeed
from .speech import SPEECH
from .startup import Startup
from .ticks import TICKS
from .touch import TouchEvent

# Those that compute come first, while nothing else runs yet.
ROWS: tuple[Row, ...] = (
    *TICKS,
    *LIBRARY,
    CameraFrame("camera_frame", "320x240"),
    CameraFrame("camera_frame_vga", "640x480"),
    RealTimeFactor(),
    WalkingRealTimeFactor(),
    RecognitionSpeed(),
    PhysicsWithSound(),
    CameraRate(),
    PhysicsWithCameras(),
    Startup(),
    ProxyCall(),
    GoalRoundTrip(),
    ChainedFunctions(),
    PerformOverhead(),
    ParOfHundred(),
    MotionStart(),
    MotionStop(),
    BehaviorOverhead(),
    TouchEvent(),
    *SPEECH,
    *CONSOLE,
    Memory(),
)
