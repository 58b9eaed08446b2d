"""The recogniser's process: `python -m nao_sim_bridge.hearing.worker FD`.

It talks over the inherited pipe FD in tuples (kind, content). First it sends ("ready", None). Then it answers
("listen", Listening) with ("listening", None) or ("error", text), ("background", samples) likewise, ("hear", (time,
samples)) with ("heard", list of SpeechChange and Recognised), and ("finish", None) likewise. It ends when the pipe is
closed.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, Iterable

import pocketsphinx

from nao_sim_bridge.base.child_process import error_text, pipe_to_parent, serve
from nao_sim_bridge.hearing.decoder import Decoder, EverydaySpeech
from nao_sim_bridge.hearing.listening import Listening, Recognised
from nao_sim_bridge.hearing.pronunciation import Pronouncer
from nao_sim_bridge.hearing.settings import load_recognition
from nao_sim_bridge.hearing.voice_activity import SpeechChange, Utterance, VoiceActivity


class Ear:
    """Cuts what is heard into utterances and recognises each."""

    def __init__(self) -> None:
        self._settings = load_recognition()
        self._pronouncer = Pronouncer(Path(pocketsphinx.get_model_path("en-us/cmudict-en-us.dict")))
        self._activity = VoiceActivity(self._settings)
        self._everyday = EverydaySpeech()
        self._listening = Listening()
        self._decoder = self._decoder_for(self._listening)

    def listen(self, listening: Listening) -> None:
        """Listen for something else from now on, also in an utterance that has begun."""
        if listening.grammars != self._listening.grammars:
            self._decoder = self._decoder_for(listening)
        self._listening = listening
        self._activity.sensitivity = listening.sensitivity

    def background(self, samples: Any) -> None:
        self._activity.get_used_to(samples)

    def hear(self, content: Any) -> list[SpeechChange | Recognised]:
        """Take a block (time in s, samples)."""
        return [self._answer(event) for event in self._activity.hear(*content)]

    def finish(self, _: Any) -> list[SpeechChange | Recognised]:
        """End an utterance that is not over, and forget the background."""
        answers = [self._answer(event) for event in self._activity.finish()]
        self._activity.reset()
        return answers

    def _answer(self, event: SpeechChange | Utterance) -> SpeechChange | Recognised:
        if isinstance(event, SpeechChange):
            return event
        found = self._decoder.recognise(event, self._listening.hypotheses)
        return Recognised(event.start, event.end, tuple(found))

    def _decoder_for(self, listening: Listening) -> Decoder:
        return Decoder(listening.grammars, self._pronouncer, self._settings, self._everyday)


def main(arguments: Iterable[str]) -> int:
    """Serve one pipe until it is closed."""
    (descriptor,) = arguments
    pipe = pipe_to_parent(descriptor)
    try:
        ear = Ear()
    except Exception as error:
        pipe.send(("error", error_text(error)))
        return 1
    pipe.send(("ready", None))
    return serve(pipe, {"listen": ear.listen, "background": ear.background, "hear": ear.hear, "finish": ear.finish})


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
