"""How the live loop waits and beats."""

from dataclasses import dataclass, field

from lightgesture.backoff import BackoffSettings


@dataclass(frozen=True, slots=True)
class LiveSettings:
    """Times of the live loop, all in seconds and above 0.

    heartbeat_s: from one heartbeat record to the next. poll_s: longest wait for a picture, and so how late a signal to
    stop is heeded. breath_s: pause before each picture in which the other threads get the core; without it records are
    some milliseconds older where the core is busy. silence_s: without a picture for so long, one message says so.
    hold_s: for how long a sign is held, unless the user or a grammar of the user's says otherwise.
    stop_s: how long the end waits for the thread that reads; a camera driver that does not return is left to the
    system. reconnect: waits between tries to open the source again.
    """

    heartbeat_s: float = 1.0
    poll_s: float = 0.1
    silence_s: float = 5.0
    breath_s: float = 0.001
    hold_s: float = 0.5
    stop_s: float = 1.0
    reconnect: BackoffSettings = field(default_factory=BackoffSettings)
