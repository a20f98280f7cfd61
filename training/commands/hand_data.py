"""The arguments by which a user names the hands that a classifier is trained on."""

import argparse

from lightgesture.config.parsers import whole


def add_data_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare them."""
    parser.add_argument(
        "--data",
        metavar="CSV|DIR",
        help="manifest with the columns path and token, and if known a box (x,y,w,h or hx0..hy1), lm, set, side; "
        "or a folder with one folder of hand pictures a class",
    )
    parser.add_argument(
        "--backgrounds",
        action="append",
        default=[],
        metavar="DIR",
        help="pictures without hands: they stand behind altered copies and teach what is no token; repeatable",
    )
    parser.add_argument(
        "--scenes",
        metavar="CSV",
        help="whole pictures with boxes (columns file,x,y,w,h, if known face_boxes and set): what lies beside "
        "the hands teaches what is no token",
    )
    parser.add_argument(
        "--without",
        action="append",
        default=[],
        metavar="SOURCE",
        help="source of the manifest (column set) that is left out; repeatable",
    )
    parser.add_argument(
        "--seed", type=whole, default=0, metavar="N", help="of all that is drawn (default: 0)"
    )
