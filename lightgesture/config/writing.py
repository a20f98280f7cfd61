"""A configuration file with every option, its meaning, and what was chosen."""

import json
import textwrap
from collections.abc import Mapping
from typing import Any, Final

from lightgesture.config.declaring import DECODING
from lightgesture.config.settings import DecodeSettings

WIDTH: Final = 100
"""Letters of a line of comment."""

HEAD: Final = (
    "Options of lightgesture's decoding commands, for --config. What stands on the command line goes first.",
    "A line that begins with #NAME shows what holds without it: take the # away and change the value.",
    "A relative path starts at the folder of this file.",
)


def to_toml(given: Mapping[str, Any]) -> str:
    """The file's text. given: checked values of options, by the names that they have in a file."""
    parts = ["\n".join(f"# {line}" for line in HEAD)]
    for name, field in DecodeSettings.model_fields.items():
        extra: Any = field.json_schema_extra
        commands = [command for command in DECODING if command in extra["only"]]
        if not commands:
            continue
        key = field.alias or name
        text = f"{field.description} [{', '.join(commands)}]"
        lines = [f"# {line}" for line in textwrap.wrap(text, WIDTH, break_on_hyphens=False)]
        if key in given:
            lines.append(f"{key} = {_value(given[key])}")
        elif field.default is None:
            lines.append(f"#{key} = {extra['metavar']}")
        else:
            lines.append(f"#{key} = {_value(field.default)}")
        parts.append("\n".join(lines))
    return "\n\n".join(parts) + "\n"


def _value(value: Any) -> str:
    """As TOML has it, which writes texts, numbers, truth and lists of texts as JSON does."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
