"""Frames for all open pages: encoded once, and only the newest for a page that is slow. No ROS.

Everything here runs in the event loop.
"""

from __future__ import annotations

import asyncio
from collections.abc import Hashable
from typing import Union

Frame = Union[bytes, str]
MOST_QUEUED = 200
"""Frames of a kind that must not be lost, kept for a page that does not take them; then the oldest go."""


class FrameInbox:
    """What one page has still to be sent."""

    def __init__(self) -> None:
        self._latest: dict[Hashable, Frame] = {}
        self._queued: list[Frame] = []
        self._filled = asyncio.Event()

    def put(self, kind: Hashable, frame: Frame) -> None:
        """Send a frame; one of the same kind that waits is left out."""
        self._latest.pop(kind, None)  # what changed last goes last
        self._latest[kind] = frame
        self._filled.set()

    def add(self, frame: Frame) -> None:
        """Send a frame that no later one replaces."""
        self._queued.append(frame)
        del self._queued[:-MOST_QUEUED]
        self._filled.set()

    def forget(self) -> None:
        """Leave out what was added and waits: it would be read wrongly from now on."""
        self._queued.clear()

    async def take(self) -> list[Frame]:
        """Wait for frames; texts come first, as they say how to read the others."""
        await self._filled.wait()
        self._filled.clear()
        frames = [*self._latest.values(), *self._queued]
        self._latest.clear()
        self._queued.clear()
        return sorted(frames, key=lambda frame: not isinstance(frame, str))


class Broadcast:
    """The pages that look at one thing, and what each was last shown of it."""

    def __init__(self) -> None:
        self._inboxes: set[FrameInbox] = set()
        self._last: dict[Hashable, Frame] = {}

    def __len__(self) -> int:
        return len(self._inboxes)

    def attach(self) -> FrameInbox:
        """One more page looks; it gets the last frame of each kind at once."""
        inbox = FrameInbox()
        for kind, frame in self._last.items():
            inbox.put(kind, frame)
        self._inboxes.add(inbox)
        return inbox

    def detach(self, inbox: FrameInbox) -> None:
        self._inboxes.discard(inbox)
        if not self._inboxes:
            self._last.clear()  # it would be out of date for who comes next

    def put(self, kind: Hashable, frame: Frame) -> None:
        """Show a frame to all pages."""
        self._last[kind] = frame
        for inbox in self._inboxes:
            inbox.put(kind, frame)

    def last(self, kind: Hashable) -> Frame | None:
        return self._last.get(kind)
