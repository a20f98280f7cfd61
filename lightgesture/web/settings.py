"""How the page is served."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class WebSettings:
    """Limits of the server.

    pictures_per_s: most pictures that a browser gets, 1 to 60. Each is drawn and encoded once for all, and only while
        somebody looks; more take time from the decoder on a small board.
    picture_width: widest picture that is sent, pixels; wider ones are reduced.
    jpeg_quality: 1 to 100.
    updates_per_s: most updates of the sentence and the state that a browser gets.
    entries: instructions, rejections and notices that are kept for who comes later.
    viewers: browsers that get pictures at a time. listeners: those that get updates. connections: of any kind.
        Beyond these a browser is told to come again later.
    client_timeout_s: a browser that takes nothing for so long is left.
    beat_s: longest time without a word to a browser, by which one that has gone is noticed.
    send_buffer: bytes that may wait in the system for a browser: what lies there is old by the time it is seen.
    """

    pictures_per_s: float = 15.0
    picture_width: int = 960
    jpeg_quality: int = 75
    updates_per_s: float = 10.0
    entries: int = 200
    viewers: int = 4
    listeners: int = 8
    connections: int = 24
    client_timeout_s: float = 10.0
    beat_s: float = 2.0
    send_buffer: int = 128 * 1024
