"""What the nodes of ROS 1 and 2 have in common: from parameters to options, and a run of `live` on a topic."""

from collections.abc import Mapping
from typing import Any, Final

from lightgesture.actions.live import run_live
from lightgesture.config.declaring import LIVE
from lightgesture.config.opening import open_pipeline
from lightgesture.config.options import explain
from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import ExitStatus, UsageError
from lightgesture.ros.listener import RosListener, Wire
from lightgesture.ros.source import TopicSource

NAME: Final = "lightgesture"
"""Of the node, unless it is remapped."""
IMAGE: Final = {False: "image/compressed", True: "image"}
"""Topic that is subscribed, unless it is remapped, by whether it brings raw pictures."""

_NO_USE: Final = ("give_up", "insecure", "size")
"""Options of `live` that tell of a source that is no topic."""


def parameter_names() -> tuple[str, ...]:
    """Options of `live` that are parameters of the node too."""
    fields = DecodeSettings.model_fields.items()
    return tuple(
        field.alias or name
        for name, field in fields
        if isinstance(field.json_schema_extra, dict) and LIVE in field.json_schema_extra["only"]  # type: ignore[operator]
        if name not in _NO_USE
    )


def refuse_useless(settings: DecodeSettings) -> None:
    """UsageError: an option was given that says something of a source that is no topic."""
    given = [name for name in _NO_USE if getattr(settings, name) != DecodeSettings.model_fields[name].default]
    if given:
        raise UsageError(f"--{given[0].replace('_', '-')}: of no use for a topic; leave it out")


def settings_with(settings: DecodeSettings, parameters: Mapping[str, Any]) -> DecodeSettings:
    """The options with what the parameters say; those that are None or empty say nothing. UsageError: one is wrong."""
    from pydantic import ValidationError

    given = {name: value for name, value in parameters.items() if value is not None and value != ""}
    kept = settings.model_dump(exclude_unset=True, by_alias=True)
    for hold, other in (("hold", "hold_seconds"), ("hold_seconds", "hold")):
        if hold in given and other not in given:
            kept.pop(other, None)
    try:
        return DecodeSettings.model_validate({**kept, **given})
    except ValidationError as error:
        raise UsageError(explain(error, lambda key: f"parameter {key}")) from None


def check(settings: DecodeSettings) -> None:
    """UsageError: the model, the grammar or another file of the options is wrong."""
    open_pipeline(settings, None, None).close()


def run_topic(settings: DecodeSettings, source: TopicSource, wire: Wire) -> ExitStatus:
    """Decode what comes until the source ends or a signal asks for the end, and publish what comes of it."""
    listener = RosListener(wire, source)
    listener.start()
    try:
        return run_live(source, settings, [listener])
    finally:
        listener.stop()
