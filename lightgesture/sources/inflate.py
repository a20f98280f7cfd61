"""What the chunks and messages of bags are compressed by: bzip2, LZ4, Zstandard."""

import sys
from importlib import import_module
from typing import Any, Final

LARGEST: Final = 256 << 20
"""Bytes that a chunk or a message may unpack to; what goes beyond is left out. Recorders write a megabyte or a few."""

_PIECE: Final = 1 << 16


def inflate(content: bytes, compression: str) -> bytes:
    """What was compressed, as much of it as can be had and `LARGEST` allows. Nothing of a kind that is not known
    here."""
    whole = bytearray()
    try:
        decompress = _decompressor(compression)
        for start in range(0, len(content), _PIECE):  # in pieces, so that what is before damage is kept
            whole += decompress(content[start : start + _PIECE], LARGEST - len(whole))
            if len(whole) >= LARGEST:
                break
    except (OSError, EOFError, RuntimeError, ValueError):
        pass
    except Exception as error:  # zstd and lz4 have errors of their own
        if type(error).__module__.split(".")[0] not in ("backports", "compression", "lz4", "_zstd"):
            raise
    return bytes(whole)


def inflate_whole(content: bytes, compression: str) -> bytes:
    """The same; ValueError where that is more than `LARGEST`."""
    whole = inflate(content, compression)
    if len(whole) >= LARGEST:
        raise ValueError(f"a chunk unpacks to {LARGEST} bytes or more")
    return whole


def _decompressor(compression: str) -> Any:
    if compression in ("", "none"):
        return _as_it_is
    if compression == "bz2":
        return import_module("bz2").BZ2Decompressor().decompress
    if compression == "lz4":
        return import_module("lz4.frame").LZ4FrameDecompressor().decompress
    if compression == "zstd":
        package = "compression" if sys.version_info >= (3, 14) else "backports"
        return import_module(f"{package}.zstd").ZstdDecompressor().decompress
    return _nothing


def _as_it_is(content: bytes, most_bytes: int) -> bytes:
    return content[:most_bytes]


def _nothing(_content: bytes, _most_bytes: int) -> bytes:
    return b""
