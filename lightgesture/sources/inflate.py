"""What the chunks and messages of bags are compressed by: bzip2, LZ4, Zstandard."""

import sys
from importlib import import_module
from typing import Any


def inflate(content: bytes, compression: str) -> bytes:
    """What was compressed, as much of it as can be had. Nothing of a kind that is not known here."""
    whole = b""
    try:
        decompress = _decompressor(compression)
        for start in range(0, len(content), 1 << 16):  # in pieces, so that what is before damage is kept
            whole += decompress(content[start : start + (1 << 16)])
    except (OSError, EOFError, RuntimeError, ValueError):
        pass
    except Exception as error:  # zstd and lz4 have errors of their own
        if type(error).__module__.split(".")[0] not in ("backports", "compression", "lz4", "_zstd"):
            raise
    return whole


def _decompressor(compression: str) -> Any:
    if compression in ("", "none"):
        return bytes
    if compression == "bz2":
        return import_module("bz2").BZ2Decompressor().decompress
    if compression == "lz4":
        return import_module("lz4.frame").LZ4FrameDecompressor().decompress
    if compression == "zstd":
        package = "compression" if sys.version_info >= (3, 14) else "backports"
        return import_module(f"{package}.zstd").ZstdDecompressor().decompress
    return _nothing


def _nothing(_: bytes) -> bytes:
    return b""
