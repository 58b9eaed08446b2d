"""ALSpeechRecognition of the simulated robot."""

from __future__ import annotations

import threading
from typing import Any, Callable, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.hearing.grammars.contexts import Context, Contexts
from nao_sim_bridge.hearing.grammars.grammar import Grammar, vocabulary
from nao_sim_bridge.hearing.listening import Hypothesis
from nao_sim_bridge.hearing.recogniser import SpareProcess
from nao_sim_bridge.hearing.settings import load_recognition
from nao_sim_bridge.naoqi.binding.arguments import number, text
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.extractor import Extractor
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.speech.grammar_files import compile_grammar, load_grammar, read_vocabulary
from nao_sim_bridge.naoqi.speech.listening_expression import MODES, ListeningExpression
from nao_sim_bridge.naoqi.speech.recognition_engine import EVENTS, KEYS, NAME, RecognitionEngine

# Name of the grammar that setVocabulary fills, as on the robot.
VOCABULARY = "modifiable_grammar"
# Parameter -> value at the start, least, most.
PARAMETERS: Mapping[str, tuple[float, float, float]] = {"Sensitivity": (0.5, 0.0, 1.0), "NbHypotheses": (1, 1, 20)}


class ALSpeechRecognition:
    """ALSpeechRecognition as the simulated robot offers it, with only NAOqi methods. `spare`: see `Recogniser`."""

    def __init__(
        self, runner: RobotRunner, memory: MemoryStore, files: ClientFiles, spare: SpareProcess | None = None
    ) -> None:
        self._contexts = Contexts()
        self._expression = ListeningExpression(runner)
        self._engine = engine = RecognitionEngine(runner, memory, self._expression.show, self._accepts, spare)
        self._extractor = Extractor(NAME, memory, engine.start, engine.stop, EVENTS, KEYS, by_events=True)
        self._files = files
        self._languages = load_recognition().languages
        self._language = self._languages[0]
        self._lock = threading.Lock()
        self._vocabulary: Grammar | None = None
        self._vocabularies: list[Grammar | None] = []
        self._parameters = {name: value for name, (value, _, _) in PARAMETERS.items()}

    def parts(self) -> list[Any]:
        return [self, self._extractor]

    def close(self) -> None:
        self._engine.close()

    # --- vocabulary -----------------------------------------------------------------------------------------------

    def setVocabulary(self, phrases: Sequence[str], spotting: bool) -> None:
        """Phrases to listen for; with word spotting also inside of longer speech."""
        sizes = load_sizes().vocabulary
        if len(phrases) > sizes.phrases:
            raise BadValue("vocabulary", f"{len(phrases)} phrases", f"{sizes.phrases} at most")
        for phrase in phrases:
            text(phrase, "vocabulary", sizes.phrase_characters)
        grammar = vocabulary(VOCABULARY, phrases, spotting)

        def change() -> None:
            self._vocabulary = grammar

        self._change("the vocabulary", change)

    def setWordListAsVocabulary(self, phrases: Sequence[str]) -> None:
        self.setVocabulary(phrases, False)

    def loadVocabulary(self, name: str) -> None:
        self.setVocabulary(read_vocabulary(self._files.to_read(name)), False)

    # --- engine ---------------------------------------------------------------------------------------------------

    def pause(self, paused: bool) -> None:
        self._engine.pause(paused)

    def setParameter(self, name: str, value: Any) -> None:
        _, least, most = self._parameter(name)
        wanted = number(value, name, least, most)

        def change() -> None:
            self._parameters[name] = wanted

        self._change("", change)

    def getParameter(self, name: str) -> float:
        self._parameter(name)
        return float(self._parameters[name])

    def setLanguage(self, language: str) -> None:
        self._check_language(language)
        self._language = language

    def getLanguage(self) -> str:
        return self._language

    def getAvailableLanguages(self) -> list[str]:
        return list(self._languages)

    # --- expression -----------------------------------------------------------------------------------------------

    def setAudioExpression(self, on: bool) -> None:
        self._expression.audio = on

    def getAudioExpression(self) -> bool:
        return self._expression.audio

    def setVisualExpression(self, on: bool) -> None:
        self._expression.visual = on

    def setVisualExpressionMode(self, mode: int) -> None:
        """Which LEDs show it: 0 none, 1 eyes, 2 ears, 3 both."""
        if mode not in MODES:
            raise BadValue("mode", mode, "0 (none), 1 (eyes), 2 (ears) or 3 (both)")
        self._expression.mode = mode

    # --- contexts -------------------------------------------------------------------------------------------------

    def compile(self, source: str, target: str, language: str) -> None:
        """Check a grammar file (BNF) and write it in the form that `addContext` takes."""
        self._check_language(language)
        compile_grammar(self._files.to_read(source), self._files.to_write(target), language)

    def addContext(self, name: str, context: str) -> None:
        bnf, characters = load_grammar(self._files.to_read(name))
        self._change("contexts", lambda: self._contexts.add(context, bnf, characters))

    def removeContext(self, context: str) -> None:
        self._change("contexts", lambda: self._contexts.remove(context))

    def removeAllContext(self) -> None:
        self._change("contexts", self._contexts.clear)

    def pushContexts(self) -> None:
        def push() -> None:
            most = load_sizes().vocabulary.put_aside
            if len(self._vocabularies) >= most:
                raise NaoqiError(f"contexts are put aside {most} times, which is the most allowed; popContexts first")
            self._contexts.push()
            self._vocabularies.append(self._vocabulary)
            self._vocabulary = None

        self._change("contexts", push)

    def popContexts(self) -> None:
        def pop() -> None:
            self._contexts.pop()
            self._vocabulary = self._vocabularies.pop()

        self._change("contexts", pop)

    def saveContextSet(self, name: str) -> bool:
        with self._lock:
            self._contexts.save(name)
        return True

    def loadContextSet(self, name: str) -> None:
        self._change("contexts", lambda: self._contexts.load(name))

    def eraseContextSet(self, name: str) -> None:
        with self._lock:
            self._contexts.erase(name)

    def activateRule(self, context: str, rule: str) -> None:
        self._change_context(context, lambda c: c.switched(rule, True))

    def deactivateRule(self, context: str, rule: str) -> None:
        self._change_context(context, lambda c: c.switched(rule, False))

    def activateAllRules(self, context: str) -> None:
        self._change_context(context, lambda c: c.all_switched(True))

    def deactivateAllRules(self, context: str) -> None:
        self._change_context(context, lambda c: c.all_switched(False))

    def getRules(self, context: str, kind: str) -> list[str]:
        """Names of the rules of a type: start, active, activatable or slot."""
        with self._lock:
            return self._contexts.get(context).rules(kind)

    def addWordListToSlot(self, context: str, slot: str, words: Sequence[str]) -> None:
        if not words:
            raise BadValue("wordList", words, "at least one word")
        self._change_context(context, lambda c: c.with_slot(slot, words))

    def removeWordListFromSlot(self, context: str, slot: str) -> None:
        self._change_context(context, lambda c: c.with_slot(slot, ()))

    def setContextParam(self, context: str, name: str, value: float) -> None:
        """Change a parameter of a context: ConfidenceThreshold, 0..1, below which it tells nothing."""
        with self._lock:
            self._contexts.put(context, self._contexts.get(context).with_parameter(name, number(value, name)))

    def getContextParam(self, context: str, name: str) -> float:
        with self._lock:
            return self._contexts.get(context).parameter(name)

    def _change_context(self, name: str, change: Callable[[Context], Context]) -> None:
        self._change("contexts", lambda: self._contexts.put(name, change(self._contexts.get(name))))

    def _change(self, what: str, change: Callable[[], None]) -> None:
        """Change what is listened for; when it cannot be listened for, everything stays as it was.

        `what` names what is changed, for the error while the engine listens; empty where it may be changed then, too.
        """
        with self._lock:
            if what:
                self._engine.check_paused(what)
            before = (self._contexts.state(), self._vocabulary, list(self._vocabularies), dict(self._parameters))
            try:
                change()
                own = [self._vocabulary] if self._vocabulary is not None else []
                self._engine.listen_for([*own, *self._contexts.grammars()], self._parameters)
            except Exception:
                contexts, self._vocabulary, self._vocabularies, self._parameters = before
                self._contexts.restore(contexts)
                raise

    def _accepts(self, hypothesis: Hypothesis) -> bool:
        return hypothesis.confidence >= self._contexts.threshold(hypothesis.grammar)

    def _check_language(self, language: str) -> None:
        if language not in self._languages:
            raise BadValue("language", language, f"{', '.join(self._languages)}: no other language is installed")

    def _parameter(self, name: str) -> tuple[float, float, float]:
        if name not in PARAMETERS:
            raise UnknownName(f"parameter (there are {', '.join(PARAMETERS)})", name, PARAMETERS)
        return PARAMETERS[name]
