"""Everything that reads what somebody else wrote, as a table: name, what it is fed, and what a line of its seed looks
like. Each target takes bytes and raises nothing but the project's own errors (`scratch.REFUSALS`)."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from . import binaries, streams, texts

CORPUS = Path(__file__).resolve().parent / "corpus"
"""A folder for each target with a few small inputs, which the quick tests replay."""

Shape = Literal["bytes", "text", "toml", "json", "lines"]
"""What hypothesis makes of a seed: changed bytes; or changed values, written anew as TOML, JSON or lines of JSON."""


@dataclass(frozen=True, slots=True)
class Target:
    """run: takes one input. reads: what it stands for. shape: how hypothesis changes seeds."""

    run: Callable[[bytes], None]
    reads: str
    shape: Shape = "bytes"


TARGETS = {
    "grammar": Target(texts.grammar, "grammar file", "toml"),
    "config": Target(texts.config, "configuration", "toml"),
    "vehicle": Target(texts.vehicle, "profile of a vehicle", "toml"),
    "map": Target(texts.mavlink_map, "map of MAVLink messages", "toml"),
    "scene": Target(texts.scene, "scene of `synth`", "toml"),
    "profile": Target(texts.profile, "colour profile", "json"),
    "shapes": Target(texts.shapes, "shapes of motions", "json"),
    "card": Target(texts.card, "card of a model", "json"),
    "study": Target(texts.study, "results of a study", "json"),
    "records": Target(texts.records, "recording for `grammar explain`", "lines"),
    "pairs": Target(texts.pairs, "pairs and sentences of the command line", "text"),
    "description": Target(texts.description, "description of a stream (SDP)", "text"),
    "table": Target(texts.table, "CSV table with columns", "text"),
    "manifest": Target(texts.manifest, "manifest of a folder of results", "json"),
    "dives": Target(texts.dives, "tables of results", "text"),
    "export": Target(texts.export_manifest, "manifest of an export", "json"),
    "archive": Target(binaries.archive, "model archive (.npz), its zip"),
    "member": Target(binaries.member, "array in a model archive"),
    "svm": Target(binaries.svm_header, "header of an SVM", "json"),
    "cnn": Target(binaries.cnn_header, "header of a CNN", "json"),
    "layout": Target(binaries.layout, "layout of a net", "json"),
    "tflite": Target(binaries.tflite, ".tflite file of a net"),
    "selector": Target(binaries.selector, "trees of a selector"),
    "picture": Target(binaries.picture, "picture file"),
    "tags": Target(binaries.tags, "picture with tags"),
    "video": Target(binaries.video, "video file, its container and codec"),
    "bag": Target(binaries.bag, "bag of ROS 1, MCAP"),
    "message": Target(binaries.message, "message of a bag"),
    "packets": Target(binaries.packets, "packets of H.264"),
    "mjpeg": Target(streams.mjpeg, "stream of JPEG files"),
    "camera": Target(streams.camera, "answer of a camera over HTTP"),
    "mavlink": Target(streams.mavlink, "bytes on a MAVLink link"),
    "messages": Target(streams.mavlink_messages, "whole MAVLink messages"),
    "request": Target(streams.request, "request to the web page"),
}


def seeds(name: str) -> list[bytes]:
    """The kept inputs of a target, the smallest first."""
    files = sorted((CORPUS / name).glob("*"), key=lambda file: (file.stat().st_size, file.name))
    return [file.read_bytes() for file in files]
