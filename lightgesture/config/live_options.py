"""Options that tell who hears of the instructions of a live stream, and what carries them out."""

from lightgesture.config.declaring import LIVE, PRACTICE, Options, option


class LiveOptions(Options):
    """Who hears of the instructions of a live stream, and what carries them out."""

    udp: list[str] = option(
        [], "send the records as JSON datagrams too (repeatable)", "HOST:PORT", only=(LIVE,)
    )
    mavlink: list[str] = option(
        [],
        "send heartbeats and instructions by MAVLink, as to udpout:127.0.0.1:14550 (repeatable)",
        "LINK",
        only=(LIVE,),
    )
    mavlink_map: str | None = option(
        None,
        "values and commands that instructions send by MAVLink (default: none)",
        "FILE",
        kind="path",
        only=(LIVE,),
    )
    mavlink_system: int | None = option(
        None,
        "number of the vehicle on the MAVLink links, 1 to 255 (default: that of the one autopilot that is heard)",
        "N",
        only=(LIVE,),
        ge=1,
        le=255,
    )
    obey: str | None = option(
        None,
        "carry the instructions out on the vehicle of the first --mavlink, as this profile says: ardusub, manual or a"
        " file (default: nothing is carried out)",
        "FILE",
        kind="path",
        only=(LIVE,),
        min_length=1,
    )
    answer: list[str] = option(
        [],
        "answer the diver: by a lamp, lamp:GREEN,ORANGE,RED (pins, BCM numbers), or by the vehicle's motion, motion"
        " (repeatable)",
        "SINK",
        only=(LIVE,),
    )
    hook: list[str] = option(
        [],
        "run a command for each instruction, its record as JSON on standard input (repeatable)",
        "COMMAND",
        only=(LIVE,),
    )
    web: int | None = option(
        None,
        "serve a page with the annotated picture and the instructions",
        "PORT",
        only=(LIVE, PRACTICE),
        ge=1,
        le=65535,
    )
    web_host: str = option(
        "127.0.0.1",
        "address that the page is served on; 0.0.0.0 lets the whole network look",
        "HOST",
        only=(LIVE, PRACTICE),
        min_length=1,
    )
    web_token: str | None = option(
        None,
        "what browsers must name where the page is served to the network, 8 to 128 letters, digits, - or _ (default: a"
        " new one at each start, printed with the page's address); none: whoever reaches it may look",
        "TOKEN",
        only=(LIVE, PRACTICE),
        pattern=r"^(none|[A-Za-z0-9_-]{8,128})$",
    )
    web_blueos: bool = option(
        False,
        "serve the page as an extension of BlueOS: listed and shown by it, under any name that ends in .local",
        only=(LIVE,),
    )
