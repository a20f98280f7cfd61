"""Live decoding: the newest picture of a stream through the pipeline, records to sinks, pictures to listeners."""

from lightgesture.live.loop import Listener, LiveLoop
from lightgesture.live.reader import Mailbox, Reader, Report, Snapshot

__all__ = ["Listener", "LiveLoop", "Mailbox", "Reader", "Report", "Snapshot"]
