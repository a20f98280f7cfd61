"""Records out of a live stream: each sink in a thread of its own, so that none delays the decoder or another."""

from lightgesture.sinks.outbox import Outbox, OutboxSettings
from lightgesture.sinks.registry import make_sinks
from lightgesture.sinks.types import RecordError, Sink, SinkError, SinkGoneError

__all__ = ["Outbox", "OutboxSettings", "RecordError", "Sink", "SinkError", "SinkGoneError", "make_sinks"]
