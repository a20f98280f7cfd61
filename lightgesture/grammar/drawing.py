"""The state graph of a grammar as a picture: states in columns by their distance from idle, signs and words at the
arrows."""

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from lightgesture.errors import UsageError
from lightgesture.fsm import Grammar
from lightgesture.grammar.arrows import Point
from lightgesture.grammar.graph import (
    GAP,
    HAND,
    Graph,
    Placed,
    cell_width,
    lay_out,
    row_height,
)
from lightgesture.grammar.labels import shapes_of
from lightgesture.results.atomic import replacing
from lightgesture.signs.drawings import SIDE, Drawing, load_drawing

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

MAX_STATES: Final = 400
"""Most states that are drawn: nobody could read more."""

SCALE: Final = 2
"""Pixels of a PNG for each of the graph's own."""

HEAD: Final = 9.0
"""Length of an arrow's head, pixels."""


def draw(grammar: Grammar, out: str) -> str:
    """Write the picture of a grammar and tell where. UsageError: the file's suffix or folder, or too many states."""
    suffix = Path(out).suffix.lower()
    if suffix not in (".svg", ".png"):
        raise UsageError(f"{out}: unknown kind of picture; end the name with .svg or .png")
    if len(grammar.table.transitions) > MAX_STATES:
        raise UsageError(f"{grammar.file}: has over {MAX_STATES} states; draw a smaller grammar")
    graph = lay_out(grammar)
    content = to_svg(graph) if suffix == ".svg" else to_png(graph)
    with replacing(Path(out)) as temporary:
        temporary.write_bytes(content)
    return f"{out}: {len(grammar.table.transitions)} states"


def _parts(placed: Placed) -> Iterator[tuple[Point, str | tuple[str, str]]]:
    """What a label is made of: a text and the middle of its left edge, or a drawn hand (token and side) and its upper
    left corner."""
    left, top, _, _ = placed.rect
    top += 2.0
    for row in placed.label:
        x, middle = left + 4.0, top + row_height(row) / 2
        for token, side in shapes_of(row):
            is_drawn = load_drawing(token, side) is not None
            yield ((x, middle - HAND / 2), (token, side)) if is_drawn else ((x + GAP / 2, middle), token)
            x += cell_width(token, side)
        if row.text:
            yield (x + (GAP if row.pair else 0.0), middle), row.text
        top += row_height(row)


def _head(path: Sequence[Point]) -> list[Point]:
    """The triangle at the tip of an arrow."""
    (x, y), (tip_x, tip_y) = path[-2], path[-1]
    angle = math.atan2(y - tip_y, x - tip_x)
    sides = [angle + math.radians(22), angle - math.radians(22)]
    return [path[-1], *((tip_x + HEAD * math.cos(one), tip_y + HEAD * math.sin(one)) for one in sides)]


def to_svg(graph: Graph) -> bytes:
    """The graph as SVG; each hand is drawn once and used where it is shown."""
    from xml.etree import ElementTree

    width, height = graph.size
    root = ElementTree.Element("svg", {"xmlns": "http://www.w3.org/2000/svg"})
    root.attrib |= {"viewBox": f"0 0 {width} {height}", "width": str(width), "height": str(height)}
    definitions = ElementTree.SubElement(root, "defs")
    known: set[tuple[str, str]] = set()

    def add(tag: str, **attributes: float | str) -> ElementTree.Element:
        values = {
            name.replace("_", "-"): f"{value:.1f}" if isinstance(value, float) else str(value)
            for name, value in attributes.items()
        }
        return ElementTree.SubElement(root, tag, values)

    def write(place: Point, text: str, anchor: str) -> None:
        x, y = place
        add("text", x=x, y=y + 4.0, text_anchor=anchor, font_family="monospace", font_size=12.0).text = text

    def use(corner: Point, token: str, side: str) -> None:
        drawing = load_drawing(token, side)
        if drawing is not None and (token, side) not in known:
            known.add((token, side))
            definitions.append(_symbol(drawing, f"{token}-{side}"))
        add("use", href=f"#{token}-{side}", x=corner[0], y=corner[1], width=HAND, height=HAND)

    add("rect", width=width, height=height, fill="white")
    for path in graph.arrows:
        add("polyline", points=_points(path), fill="none", stroke="#555", stroke_width=1.5)
        add("polygon", points=_points(_head(path)), fill="#555")
    for (x, y), radius in graph.circles:
        add("circle", cx=x, cy=y, r=radius, fill="white", stroke="black", stroke_width=1.5)
    for placed in graph.labels:
        x, y, wide, tall = placed.rect
        add("rect", x=x, y=y, width=wide, height=tall, fill="white")
        for place, part in _parts(placed):
            write(place, part, "start") if isinstance(part, str) else use(place, *part)
    for text in graph.texts:
        write(text.middle, text.line, "middle")
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True))


def _symbol(drawing: Drawing, name: str) -> "Element":
    from xml.etree import ElementTree

    symbol = ElementTree.Element("symbol", {"id": name, "viewBox": f"0 0 {SIDE} {SIDE}"})
    for layer in drawing.layers:
        path = "".join("M" + "L".join(f"{x} {y}" for x, y in one) + "Z" for one in layer.polygons)
        ElementTree.SubElement(symbol, "path", {"fill": layer.colour, "fill-rule": "evenodd", "d": path})
    return symbol


def _points(path: Sequence[Point]) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in path)


def to_png(graph: Graph) -> bytes:
    """The graph as PNG, `SCALE` pixels for each of its own."""
    import cv2
    import numpy as np

    from lightgesture.signs.png import draw_hand
    from lightgesture.signs.sheet import HandPicture

    width, height = graph.size
    picture = np.full((height * SCALE, width * SCALE, 3), 255, np.uint8)

    def pixel(point: Point) -> tuple[int, int]:
        return round(point[0] * SCALE), round(point[1] * SCALE)

    def write(place: Point, text: str, is_middle: bool) -> None:
        (wide, _), _ = cv2.getTextSize(text, font, size, 1)
        left = place[0] * SCALE - (wide / 2 if is_middle else 0)
        at = (round(left), round((place[1] + 4.0) * SCALE))
        cv2.putText(picture, text, at, font, size, black, 1, cv2.LINE_AA)

    grey, black, white = (85, 85, 85), (0, 0, 0), (255, 255, 255)
    font, size = cv2.FONT_HERSHEY_SIMPLEX, 0.37 * SCALE
    for path in graph.arrows:
        points = np.array([pixel(point) for point in path], np.int32)
        cv2.polylines(picture, [points], False, grey, SCALE, cv2.LINE_AA)
        cv2.fillPoly(
            picture, [np.array([pixel(point) for point in _head(path)], np.int32)], grey, cv2.LINE_AA
        )
    for middle, radius in graph.circles:
        cv2.circle(picture, pixel(middle), round(radius * SCALE), white, -1, cv2.LINE_AA)
        cv2.circle(picture, pixel(middle), round(radius * SCALE), black, SCALE, cv2.LINE_AA)
    for placed in graph.labels:
        x, y, wide, tall = placed.rect
        cv2.rectangle(picture, pixel((x, y)), pixel((x + wide, y + tall)), white, -1)
        for place, part in _parts(placed):
            if isinstance(part, str):
                write(place, part, is_middle=False)
            else:
                draw_hand(picture, HandPicture(*place, HAND, *part), SCALE)
    for text in graph.texts:
        write(text.middle, text.line, is_middle=True)
    return bytes(cv2.imencode(".png", picture)[1])
