"""The mouth: speaks one text after the other through the loudspeakers. Simulation thread only."""

from __future__ import annotations

import logging
from collections import deque
from dataclasses import dataclass, field
from typing import Any, Callable, Sequence

from nao_sim_bridge.base.errors import SimulationStopped
from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.speech.clips import Clip, Mark, SpokenWord, Style
from nao_sim_bridge.speech.sentences import Item, Sentence
from nao_sim_bridge.speech.studio import Pending, Studio
from nao_sim_bridge.speech.tags import Bookmark, Gate

log = logging.getLogger("nao_sim.speech")

# How many sentences of a text are made ahead of the one that sounds.
AHEAD = 2
# How long before a sentence ends the next one has to be there when time runs faster than the wall clock, s.
LOOK_AHEAD = 0.1
KINDS = ("enqueued", "started", "sentence", "word", "bookmark", "done", "stopped", "thrown")
ENQUEUED, STARTED, SENTENCE, WORD, BOOKMARK, DONE, STOPPED, THROWN = KINDS


@dataclass(frozen=True)
class SpeechEvent:
    """Something that happens while the robot speaks, told at the simulated time it happens.

    By its kind, one of `KINDS`, a text is enqueued and started, has sentences, words and bookmarks, and is at last
    done, stopped, or thrown because it cannot be said. The value is the `Clip` of the sentence, the `SpokenWord` or the
    number of the bookmark.
    """

    kind: str
    task_id: int
    value: Any = None


@dataclass(eq=False)
class _Talk:
    """A text in the queue."""

    task: Task
    items: Sequence[Item]
    style: Style
    orders: dict[int, Pending] = field(default_factory=dict)
    next: int = 0
    # What is waited for: the end of a sentence, or of what a gate has begun.
    until: Task | None = None
    playing: Any = None
    started: bool = False


class Speaker:
    """Speaks texts, the first come first; listeners are called with every `SpeechEvent`."""

    def __init__(self, simulation: Any, studio: Studio) -> None:
        self.listeners: list[Callable[[SpeechEvent], None]] = []
        self._simulation = simulation
        self._studio = studio
        self._talks: deque[_Talk] = deque()
        simulation.after_tick.append(self._tick)
        simulation.holds.append(self.waits_for_sound)
        simulation.after_reset.append(self.stop_all)
        studio.released = lambda: simulation.wake()

    def say(self, items: Sequence[Item], style: Style, name: str = "say") -> Task:
        """Speak the sentences of `Studio.read` when all that were asked for before have been spoken.

        The task has the NAOqi name of the call and ends with the last sound; killing it is silence at once.
        """
        talk = _Talk(self._simulation.task_ids.make(name, on_kill=self._drop), items, style)
        self._talks.append(talk)
        self._order_ahead(talk)
        self._tell(talk, ENQUEUED)
        return talk.task

    def stop_all(self) -> None:
        """Silence at once, also of the texts that wait for their turn."""
        for talk in reversed(list(self._talks)):
            talk.task.kill()

    @property
    def speaking(self) -> bool:
        """Whether a text is spoken or waits for its turn."""
        return bool(self._talks)

    def waits_for_sound(self) -> bool:
        """Whether the next sentence is due, or will be in a moment, and is not made yet; simulation thread.

        It looks ahead: whether a sentence begins right behind another one must not depend on who is quicker.
        """
        if not self._talks:
            return False
        playing = self._talks[0].playing
        if playing is not None and not playing.ended:
            end = playing.end_frame
            if end is None or end / RATE - self._simulation.time > LOOK_AHEAD:
                return False
        order = self._next_order()
        return order is not None and not order.ready

    def close(self) -> None:
        """The simulation has ended: everybody who waits gets an error."""
        while self._talks:
            talk = self._talks.popleft()
            talk.task.finish(error=SimulationStopped("the simulation has stopped"))

    # --- inside ---------------------------------------------------------------------------------------------------

    def _tick(self, _: Any = None) -> None:
        """Do everything that is due now."""
        while self._talks:
            talk = self._talks[0]
            if talk.until is not None:
                if not talk.until.finished:
                    return
                interrupted = talk.playing is not None and talk.until.killed
                talk.until = talk.playing = None
                if interrupted:  # somebody has silenced the loudspeakers: the robot was reset
                    self.stop_all()
                    return
            if talk.next >= len(talk.items):
                self._finish(talk)
            elif not self._begin(talk, talk.items[talk.next]):
                return

    def _begin(self, talk: _Talk, item: Item) -> bool:
        """Begin with the next item; False when it is not there yet."""
        if isinstance(item, Gate):
            talk.next += 1
            self._start(talk)
            talk.until = item.action()
            return True
        order = talk.orders[talk.next]
        if not order.ready:
            return False
        if order.clip is None:
            self._fail(talk, order)
            return True
        del talk.orders[talk.next]
        talk.next += 1
        self._order_ahead(talk)
        self._start(talk)
        self._play(talk, order.clip)
        return True

    def _play(self, talk: _Talk, clip: Clip) -> None:
        log.info("says: %s", clip.text)
        self._tell(talk, SENTENCE, clip)
        marks = [(time, lambda mark=mark: self._pass(talk, mark)) for time, mark in clip.marks]
        loudspeakers = self._simulation.sound.loudspeakers
        talk.playing = loudspeakers.play(clip.sound, talk.task.name, volume=talk.style.volume, marks=marks)
        talk.until = talk.playing.task

    def _pass(self, talk: _Talk, mark: Mark) -> None:
        """The voice comes to a mark."""
        if isinstance(mark, SpokenWord):
            self._tell(talk, WORD, mark)
        elif isinstance(mark, Bookmark):
            self._tell(talk, BOOKMARK, mark.number)
        else:
            mark.action()

    def _start(self, talk: _Talk) -> None:
        if not talk.started:
            talk.started = True
            self._tell(talk, STARTED)

    def _finish(self, talk: _Talk) -> None:
        self._start(talk)
        self._talks.popleft()
        self._tell(talk, DONE)
        talk.task.finish()

    def _fail(self, talk: _Talk, order: Pending) -> None:
        self._talks.popleft()
        self._forget_orders(talk)
        log.error("cannot speak: %s", order.error)
        self._tell(talk, THROWN)
        talk.task.finish(error=order.error)

    def _drop(self, task: Task) -> None:
        """A text is killed: silence."""
        talk = next((talk for talk in self._talks if talk.task is task), None)
        if talk is None:
            return
        self._talks.remove(talk)
        self._forget_orders(talk)
        if talk.until is not None:
            talk.until.kill()
        talk.until = talk.playing = None  # they keep the talk, and it would keep them
        self._tell(talk, STOPPED)

    def _next_order(self) -> Pending | None:
        """The sentence that will be spoken next, of this text or of one behind it."""
        for talk in self._talks:
            if talk.orders:
                return talk.orders[min(talk.orders)]
        return None

    def _order_ahead(self, talk: _Talk) -> None:
        for number in range(talk.next, min(talk.next + AHEAD, len(talk.items))):
            item = talk.items[number]
            if number not in talk.orders and isinstance(item, Sentence):
                talk.orders[number] = self._studio.order(item, talk.style)

    def _forget_orders(self, talk: _Talk) -> None:
        for order in talk.orders.values():
            order.wanted = False

    def _tell(self, talk: _Talk, kind: str, value: Any = None) -> None:
        event = SpeechEvent(kind, talk.task.task_id, value)
        for listener in self.listeners:
            listener(event)
