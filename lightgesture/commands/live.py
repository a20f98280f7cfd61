"""`lightgesture live`: a camera or a stream to instructions, as they are signed."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    from lightgesture.config.declaring import LIVE
    from lightgesture.config.options import add_options

    parser.add_argument(
        "source",
        metavar="SOURCE",
        help="camera (0, /dev/video0), address (http:// for MJPEG, rtp://0.0.0.0:5600, rtsp://, udp://), file of SDP, "
        "GStreamer pipeline that ends in appsink, or - (standard input: MJPEG, or raw BGR with --size)",
    )
    add_options(parser, LIVE)


def run(args: argparse.Namespace) -> int:
    """Decode until the stream ends for good or a signal comes; 0, or 130 after Ctrl-C."""
    from lightgesture.actions.live import run_live
    from lightgesture.config.options import load_settings
    from lightgesture.console import native_messages_muted

    settings = load_settings(args)
    with native_messages_muted():
        return run_live(args.source, settings)
