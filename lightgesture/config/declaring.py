"""What an option of the decoding commands says of itself, and the commands that may have it."""

from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

DECODE = "decode"
RECOGNIZE = "recognize"
LIVE = "live"
CALIBRATE = "calibrate"
PRACTICE = "practice"
DECODING = (DECODE, RECOGNIZE, LIVE, PRACTICE)
STREAMS = (DECODE, LIVE, PRACTICE)
"""The commands whose pictures follow each other in time."""


class Options(BaseModel):
    """A part of the options: unknown ones are refused, and none changes."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def option(
    default: Any,
    text: str,
    metavar: str | None = None,
    *,
    only: tuple[str, ...] = DECODING,
    kind: Literal["path", ""] = "",
    may_stand_alone: bool = False,
    changes_results: bool = True,
    **checks: Any,
) -> Any:
    """A field that is an option too.

    only: the commands that have it. kind: "path" of a file or a folder. may_stand_alone: on the command line it is the
    first word of `metavar` where none follows. changes_results: whether what `decode` writes into its folder of results
    depends on it.
    """
    extra: Any = {
        "metavar": metavar,
        "only": only,
        "kind": kind,
        "may_stand_alone": may_stand_alone,
        "changes_results": changes_results,
    }
    return Field(default=default, description=text, json_schema_extra=extra, **checks)
