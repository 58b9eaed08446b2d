"""Routes beside the pages for everything live: the robot's model, its meshes, WebSockets. All are behind the guard."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable
from typing import Any

from fastapi import HTTPException, WebSocket, WebSocketDisconnect
from fastapi.responses import FileResponse, Response

from naoqi.errors import NaoError

from ...base.suggestion import did_you_mean
from ..access.guard import session_of
from ..view.background import in_background
from ..view.broadcast import FrameInbox
from ..view.camera_feed import CAMERA_VIEWS
from ..view.live_view import watched_traces
from ..view.robot_model import RobotModel, mesh_path, read_model

DESCRIPTION = "robot_description"
LONGEST_REASON = 120
"""Bytes of the reason of a WebSocket's end, at most; 123 are allowed."""
LOOK_PERIOD = 5.0
"""s between two looks whether whoever has a WebSocket is still logged in."""
NOT_FOUND, LOGGED_OUT, WRONG = 4404, 4403, 4400
CACHED = {"cache-control": "max-age=3600"}


def build_live_routes(console: Any) -> None:
    """Register the routes.

    GET `/console/model?robot=NAME`: its description as JSON; `/console/meshes/PACKAGE/PATH`: meshes of descriptions
    that were asked for. WebSockets `/console/live?robot=NAME` and `/console/camera?robot=NAME&camera=top`: see
    `view/wire.py`.
    """
    meshes: set[str] = set()

    def described(robot: str) -> tuple[RobotModel, str]:
        found = model_of(console, robot)
        return found, json.dumps(found.to_json())

    @console.app.get("/console/model")
    async def model(robot: str = "") -> Response:
        try:
            found, text = await in_background(described, robot)
        except NaoError as error:
            raise HTTPException(404, str(error)) from None
        meshes.update(found.meshes)
        return Response(text, media_type="application/json")

    @console.app.get("/console/meshes/{name:path}")
    async def mesh(name: str) -> FileResponse:
        import rospkg

        try:
            path = await in_background(lambda: mesh_path(name, frozenset(meshes), rospkg.RosPack().get_path))
        except (FileNotFoundError, rospkg.ResourceNotFound) as error:
            raise HTTPException(404, f"no mesh {name}") from error
        return FileResponse(path, media_type="model/stl", headers=CACHED)

    @console.app.websocket("/console/live")
    async def live(socket: WebSocket, robot: str = "") -> None:
        client = await _accepted(console, socket, robot)
        if client is None:
            return
        view = console.views.of(client).live
        inbox = await view.attach()

        async def read() -> None:
            while True:
                text = await socket.receive_text()
                await view.watch(inbox, watched_traces(json.loads(text)))

        try:
            await _serve(console, socket, inbox, read)
        finally:
            await view.detach(inbox)

    @console.app.websocket("/console/camera")
    async def camera(socket: WebSocket, robot: str = "", camera: str = "top") -> None:
        client = await _accepted(console, socket, robot)
        if client is None:
            return
        feed = console.views.of(client).cameras.get(camera)
        if feed is None:
            await _end(socket, NOT_FOUND, f"there is no camera {camera[:20]!r}{did_you_mean(camera, CAMERA_VIEWS)}")
            return
        inbox = await feed.attach()

        async def read() -> None:
            while True:
                await socket.receive_text()

        try:
            await _serve(console, socket, inbox, read)
        finally:
            await feed.detach(inbox)


def model_of(console: Any, name: str) -> RobotModel:
    """The description of a robot. Raises NaoError if there is none, or it will not do."""
    import rospy

    robot = console.robots.robot(name)
    for full in dict.fromkeys((robot.namespace + DESCRIPTION, f"/{DESCRIPTION}")):
        try:
            text = rospy.get_param(full, None)
        except OSError as error:
            raise NaoError(f"the ROS master does not answer: {error}") from error
        if text is not None:
            return read_model(str(text))
    raise NaoError(f"there is no parameter {robot.namespace}{DESCRIPTION}: does the driver run?")


async def _accepted(console: Any, socket: WebSocket, name: str) -> Any:
    """The robot that a WebSocket is about; None if there is none, which the browser was told."""
    await socket.accept()
    try:
        return await in_background(console.robots.robot, name)
    except NaoError as error:
        await _end(socket, NOT_FOUND, str(error))
        return None


async def _serve(console: Any, socket: WebSocket, inbox: FrameInbox, read: Callable[[], Awaitable[None]]) -> None:
    """Send frames and read messages until the browser goes, sends nonsense, or is logged out."""
    session = session_of(socket)

    async def send() -> None:
        while True:
            for frame in await inbox.take():
                await (socket.send_text(frame) if isinstance(frame, str) else socket.send_bytes(frame))

    async def look() -> None:
        while console.sessions.get(session.key) is session:
            await asyncio.sleep(LOOK_PERIOD)
        await _end(socket, LOGGED_OUT, "logged out")

    tasks = [asyncio.ensure_future(task) for task in (send(), read(), look())]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()
    except (WebSocketDisconnect, RuntimeError):
        pass  # the browser has gone; Starlette says so by a RuntimeError to who still sends
    except (NaoError, ValueError) as error:
        await _end(socket, WRONG, str(error))
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _end(socket: WebSocket, code: int, reason: str) -> None:
    await socket.close(code, reason.encode()[:LONGEST_REASON].decode(errors="ignore"))
