"""Live decoding: the newest picture of a stream through the pipeline, records to sinks, pictures to listeners."""

from lightgesture.live.listener import Listener
from lightgesture.live.loop import LiveLoop
from lightgesture.live.mailbox import Mailbox, Snapshot
from lightgesture.live.reader import Reader
from lightgesture.live.settings import LiveSettings

__all__ = ["Listener", "LiveLoop", "LiveSettings", "Mailbox", "Reader", "Snapshot"]
