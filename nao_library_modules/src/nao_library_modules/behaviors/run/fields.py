"""What the fields of a BehaviorFunction mean to the functions of behaviours."""

from __future__ import annotations

from typing import List

from ...functions.fields import Annotated, flag, free, number
from ..language.reader import NAME_ALLOWED, require_name
from ..language.servers import NAMES

EITHER = "either a name in str_param or a behavior in text"
EITHER_TO_STORE = "either a behavior, or the server whose last goal is to be stored"


def _require_name_if_any(name: str, value: str) -> None:
    if value.strip():
        require_name(value, name)


_NAME = free("name of the behaviour", allowed=NAME_ALLOWED, check=lambda name, value: require_name(value, name))
_TEXT = free("a behaviour as YAML, instead of the name of one", allowed=EITHER)
_SERVERS = free(
    "servers whose goals are recorded; empty: all",
    allowed=f"the servers are {', '.join(NAMES)}, and others while they run",
    choices=NAMES,
)

Name = Annotated[str, _NAME]
NameOrNone = Annotated[
    str, _NAME.but(help="name of the behaviour; empty: `text` is the behaviour", check=_require_name_if_any)
]
OwnName = Annotated[str, _NAME.but(help="name of a behaviour of one's own")]
StoredName = Annotated[str, _NAME.but(help="name that it is stored under")]
NewName = Annotated[str, _NAME.but(help="the new name")]
CopyName = Annotated[str, _NAME.but(help="name of the copy")]
Text = Annotated[str, _TEXT]
TextToStore = Annotated[
    str, _TEXT.but(help="the behaviour as YAML; empty: the last goal of `server`", allowed=EITHER_TO_STORE)
]
File = Annotated[str, free("file that `text` was read from; errors tell it with their lines")]
Values = Annotated[
    List[str],
    free("values of its parameters; the others have their defaults", allowed="name=value, each one string, each once"),
]
Server = Annotated[str, _SERVERS.but(help="server whose last goal is stored, instead of `text`")]
Servers = Annotated[List[str], _SERVERS]
Length = Annotated[float, number("recording", "length of the recording", zero=": until stopRecording")]
Overwrite = Annotated[bool, flag("whether one of that name in the folder of the user is replaced")]
