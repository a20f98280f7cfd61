"""Records out of a live stream: each sink in a thread of its own, so that none delays the decoder or another."""

from lightgesture.sinks.outbox import Outbox, RecordError, Sink, SinkError, SinkGoneError
from lightgesture.sinks.registry import make_answers, make_sinks

__all__ = ["Outbox", "RecordError", "Sink", "SinkError", "SinkGoneError", "make_answers", "make_sinks"]
