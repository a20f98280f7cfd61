"""Parameters by MAVLink: asked for by name, set, and believed when the vehicle says so."""

import math
from typing import Any, Final

from lightgesture.sinks.mavlink_jobs import Repeated, Talk

_REAL32: Final = 9
"""MAV_PARAM_TYPE of a parameter that was never read."""

_BY_NAME: Final = -1


class ParameterJob(Repeated):
    """Reads a parameter, or with `value` sets it and awaits that value. kind_of_value: MAV_PARAM_TYPE of each name that
    was read."""

    def __init__(self, talk: Talk, name: str, kinds: dict[str, int], value: float | None = None) -> None:
        super().__init__(talk)
        self._name, self._kinds, self._value = name, kinds, value
        self._seen: float | None = None

    @property
    def kind(self) -> tuple[object, ...]:
        return "parameter", self._name

    def message(self) -> Any:
        """PARAM_REQUEST_READ or PARAM_SET."""
        talk, name = self.talk, self._name.encode("ascii")
        if self._value is None:
            return talk.dialect.MAVLink_param_request_read_message(
                talk.peer.system, talk.peer.target, name, _BY_NAME
            )
        kind = self._kinds.get(self._name, _REAL32)
        return talk.dialect.MAVLink_param_set_message(
            talk.peer.system, talk.peer.target, name, self._value, kind
        )

    def note(self, message: Any, now_s: float) -> None:  # noqa: ARG002 - those of its base
        """Heed PARAM_VALUE of this parameter, and PARAM_ERROR."""
        if self.is_done or not self.sent or not self.talk.is_from(message, self.talk.peer.target):
            return
        kind = message.get_type()
        if kind not in ("PARAM_VALUE", "PARAM_ERROR") or message.param_id.rstrip("\0") != self._name:
            return
        if kind == "PARAM_ERROR":
            self.reply.refuse("the vehicle has no such parameter, or does not let it be changed")
            return
        if not math.isfinite(message.param_value):
            self.reply.refuse("the vehicle says that it is no number")
            return
        self._seen = seen = float(message.param_value)
        self._kinds[self._name] = message.param_type
        # Single precision on the way; a value that is cut to a whole number comes back as another one.
        if self._value is None or math.isclose(seen, self._value, rel_tol=1e-6, abs_tol=1e-6):
            self.reply.accept(value=seen)

    def give_up(self) -> None:
        """Nothing came, or never the value that was set."""
        if self._seen is None:
            self.reply.refuse("no answer; the vehicle may not have such a parameter")
        else:
            self.reply.refuse(f"is {self._seen:g} after it was set to {self._value:g}")
