"""ALBehavior: what the script of a Choregraphe box inherits, for programs outside of a robot."""

from __future__ import annotations

from typing import Any, Dict

import qi

from .broker import current_broker
from .errors import NaoError
from .module import ALModule


class ALBehavior(ALModule):
    """Base class of the script of a box, served under its name as a module is.

        class MyClass(ALBehavior):
            def onInput_onStart(self):
                self.session().service("ALTextToSpeech").say(self.getParameter("Text"))
                self.onStopped()

    A box has its outputs, its parameters and its timeline from Choregraphe. Here a program calls the inputs itself,
    gives values by `setParameter`, and defines methods for the outputs that the script calls. Nothing calls
    `onLoad` and `onUnload`. What belongs to a box in a running behaviour raises a NaoError.
    """

    def __init__(self, name: str, autoBind: bool = True, brokerRegister: bool = True) -> None:
        """Register the box with the newest broker, as `ALModule`.

        All of its public methods are served, whatever `autoBind` and `brokerRegister` say.

        Raises:
            BrokerError: There is no broker, or the name is taken.
            RobotUnreachable: There is no connection.
        """
        self.__parameters: Dict[str, Any] = {}
        self.behaviorId = 0
        ALModule.__init__(self, name)

    def onLoad(self) -> None:
        """What the box does before it is begun; a subclass says what."""

    def onUnload(self) -> None:
        """What the box does when it is stopped; a subclass says what."""

    def getParameter(self, parameterName: str) -> Any:
        """Value of a parameter that `setParameter` has given; a NaoError when it has none."""
        if parameterName not in self.__parameters:
            known = ", ".join(sorted(self.__parameters)) or "none"
            text = f"box {self.getName()} has no parameter {parameterName!r}; set it by setParameter; known: {known}"
            raise NaoError(text)
        return self.__parameters[parameterName]

    def setParameter(self, parameterName: str, newValue: Any) -> None:
        self.__parameters[parameterName] = newValue

    def session(self) -> qi.Session:
        """The session of the broker: `self.session().service("ALMotion")`."""
        return current_broker().session()

    def log(self, text: Any) -> None:
        """Write into the log of the program; `self.logger` does so with levels."""
        self.logger.info("%s", text)

    def getParentTimeline(self) -> Any:
        """Not outside of a robot, as all that follows: raises a NaoError."""
        raise NaoError(
            f"box {self.getName()} is in no timeline: it runs in a program, outside of a behaviour of Choregraphe; "
            "ALBehaviorManager starts and stops behaviours, ALFrameManager plays timelines"
        )

    def playTimeline(self, *_: Any) -> Any:
        return self.getParentTimeline()

    stopTimeline = gotoAndPlay = gotoAndStop = exitBehavior = playTimeline
    playTimelineParent = stopTimelineParent = gotoAndPlayParent = gotoAndStopParent = exitBehaviorParent = playTimeline
