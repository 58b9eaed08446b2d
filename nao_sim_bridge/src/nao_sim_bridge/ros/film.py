"""Films of the simulated robot as ROS services. Thin over `film_control.py`."""

from __future__ import annotations

import rospy

from nao_library_msgs.srv import (
    CaptionFilm,
    CaptionFilmRequest,
    CaptionFilmResponse,
    StartFilm,
    StartFilmRequest,
    StartFilmResponse,
    StopFilm,
    StopFilmRequest,
    StopFilmResponse,
)
from nao_sim_bridge.ros.services import ERRORS, checked, success
from nao_sim_bridge.server.simulator_server import SimulatorServer


class RosFilm:
    """Begins and ends films.

    ROS API: services `~film/start`, `~film/caption`, `~film/stop` (nao_library_msgs).
    """

    def __init__(self, server: SimulatorServer) -> None:
        self._server = server
        self._services = [
            rospy.Service("~film/start", StartFilm, self._on_start),
            rospy.Service("~film/caption", CaptionFilm, self._on_caption),
            rospy.Service("~film/stop", StopFilm, self._on_stop),
        ]

    def _on_start(self, request: StartFilmRequest) -> StartFilmResponse:
        try:
            checked(request)
            film = self._server.film.start(
                request.file, request.view, request.width, request.height, request.frame_rate
            )
            path = film.result()
        except ERRORS as error:
            return StartFilmResponse(success=False, message=str(error))
        return StartFilmResponse(True, "", path)

    def _on_caption(self, request: CaptionFilmRequest) -> CaptionFilmResponse:
        return CaptionFilmResponse(*success(lambda: self._server.film.caption(checked(request).text)))

    def _on_stop(self, _request: StopFilmRequest) -> StopFilmResponse:
        try:
            film = self._server.film.stop().result()
        except ERRORS as error:
            return StopFilmResponse(success=False, message=str(error))
        return StopFilmResponse(True, "", str(film.path), film.frames, rospy.Duration.from_sec(film.duration))
