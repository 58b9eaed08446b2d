"""Photos and films put together: what they need, and what has to be ended in the end."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.cameras import photo_capture, video_recorder
from nao_sim_bridge.naoqi.cameras.photo_capture_series import Photographer
from nao_sim_bridge.naoqi.cameras.video_recorder_recording import VideoRecorder


class PictureModules:
    """ALPhotoCapture and ALVideoRecorder of one robot.

    Attributes:
        photographer: Takes photos.
        recorder: Records films.

    Args:
        simulation: Whose cameras these are.
        runner: Its thread.
        files: Where clients may have files written to.
    """

    def __init__(self, simulation: Simulation, runner: SimulationRunner, files: ClientFiles) -> None:
        cameras = simulation.cameras
        self.photographer = Photographer(cameras, photo_capture.NAME)
        self.recorder = VideoRecorder(cameras, runner, cameras.tables, video_recorder.NAME)
        self._photos = photo_capture.ALPhotoCapture(self.photographer, files, cameras.tables)
        self._films = video_recorder.ALVideoRecorder(self.recorder, files, cameras.tables)

    def modules(self) -> dict[str, list[Any]]:
        """The modules by name, as `Service` wants them."""
        return {photo_capture.NAME: [self._photos], video_recorder.NAME: [self._films]}

    def closing(self) -> list[Callable[[], None]]:
        """Steps that take no more photos and complete the film that is recorded; blocking."""
        # Photos first: the last frames of the film need not wait for them.
        return [self.photographer.close, self.recorder.close]
