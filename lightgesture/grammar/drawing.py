"""The state graph of a grammar as a picture: states in columns by their distance from idle, words at the arrows."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from lightgesture.errors import UsageError
from lightgesture.fsm import Grammar
from lightgesture.grammar.report import targets
from lightgesture.results.atomic import replacing

Point = tuple[float, float]

MAX_STATES: Final = 400
"""Most states that are drawn: nobody could read more."""


# Sizes in pixels.

RADIUS: Final = 20.0
"""Of a state."""

ROW: Final = 100.0
"""Between the middles of two states of a column."""

GAP: Final = 96.0
"""Between two columns, beside the longest word between them."""

MARGIN: Final = 60.0
"""Round the graph."""

LETTER: Final = 7.2
"""Width of a letter."""

LINE: Final = 14.0
"""Height of a line of text."""

LABEL_LETTERS: Final = 14
"""Letters after which the words at an arrow go to the next line."""


@dataclass(frozen=True, slots=True)
class Text:
    """Lines centred on a point; is_label: on a white ground, over an arrow."""

    middle: Point
    lines: tuple[str, ...]
    is_label: bool = False


@dataclass(frozen=True, slots=True)
class Graph:
    """What is drawn. arrows: paths of points, the tip last. circles: middle and radius."""

    size: tuple[int, int]
    arrows: tuple[tuple[Point, ...], ...]
    circles: tuple[tuple[Point, float], ...]
    texts: tuple[Text, ...]


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


def lay_out(grammar: Grammar) -> Graph:
    """Where everything goes."""
    rows = [targets(row) for row in grammar.table.transitions]
    depths = _depths(rows)
    labels = [{target: _wrap(words, LABEL_LETTERS) for target, words in row.items()} for row in rows]
    places = _places(depths, labels)
    arrows: list[tuple[Point, ...]] = []
    texts: list[Text] = []
    for state, row in enumerate(labels):
        for target, lines in row.items():
            path, middle = _arrow(places[state], places[target], depths[target] - depths[state])
            arrows.append(path)
            texts.append(Text(middle, lines, is_label=True))
    circles = [(place, RADIUS) for place in places]
    for state, form in grammar.table.accepting.items():
        circles.append((places[state], RADIUS - 4.0))
        x, y = places[state]
        beside = RADIUS + LETTER * (len(form.kind) / 2 + 1)
        texts.append(Text((x + beside, y), (form.kind,)))
    texts += [Text(place, (str(state) if state else "idle",)) for state, place in enumerate(places)]
    width = max(x for x, _ in places) + MARGIN * 2.0
    height = max(y for _, y in places) + MARGIN
    return Graph((math.ceil(width), math.ceil(height)), tuple(arrows), tuple(circles), tuple(texts))


def _depths(rows: Sequence[dict[int, list[str]]]) -> list[int]:
    """Fewest words from idle to each state; states are numbered breadth first."""
    depths = [0] * len(rows)
    known = {0}
    for state, row in enumerate(rows):
        for target in row:
            if target not in known:
                known.add(target)
                depths[target] = depths[state] + 1
    return depths


def _places(depths: Sequence[int], labels: Sequence[dict[int, tuple[str, ...]]]) -> list[Point]:
    columns = [
        [state for state, depth in enumerate(depths) if depth == column] for column in range(max(depths) + 1)
    ]
    tallest = max(map(len, columns))
    places: list[Point] = [(0.0, 0.0)] * len(depths)
    x = MARGIN
    for column in columns:
        top = MARGIN + ROW * (tallest - len(column)) / 2
        for order, state in enumerate(column):
            places[state] = (x, top + order * ROW)
        longest = max(
            (len(line) for state in column for lines in labels[state].values() for line in lines), default=0
        )
        x += GAP + longest * LETTER
    return places


def _wrap(words: Sequence[str], letters: int) -> tuple[str, ...]:
    lines = [""]
    for index, word in enumerate(words):
        part = word if index == len(words) - 1 else f"{word}|"
        if lines[-1] and len(lines[-1]) + len(part) > letters:
            lines.append("")
        lines[-1] += part
    return tuple(lines)


def _arrow(start: Point, end: Point, step: int) -> tuple[tuple[Point, ...], Point]:
    """The path from state to state, and where its words go; step: columns to the right."""
    x, y = start
    if start == end:
        loop = [_on_circle((x, y - RADIUS * 1.6), RADIUS * 0.8, 110 + 32 * turn) for turn in range(11)]
        return tuple(loop), (x, y - RADIUS * 2.6)
    bow = 0.0 if step == 1 else 34.0 * (1 if step > 1 else -1)
    across, down = end[0] - x, end[1] - y
    length = math.hypot(across, down)
    normal = (down / length, -across / length)
    top = (x + across / 2 + normal[0] * bow * 2, y + down / 2 + normal[1] * bow * 2)
    curve = [_bezier(start, top, end, part / 24) for part in range(25)]
    outside = [
        point for point in curve if math.dist(point, start) >= RADIUS and math.dist(point, end) >= RADIUS
    ]
    return tuple(outside), (x + across / 2 + normal[0] * bow, y + down / 2 + normal[1] * bow)


def _on_circle(middle: Point, radius: float, degrees: float) -> Point:
    angle = math.radians(degrees)
    return middle[0] + radius * math.cos(angle), middle[1] + radius * math.sin(angle)


def _bezier(start: Point, top: Point, end: Point, part: float) -> Point:
    a, b, c = (1 - part) ** 2, 2 * part * (1 - part), part**2
    return a * start[0] + b * top[0] + c * end[0], a * start[1] + b * top[1] + c * end[1]


def _head(path: Sequence[Point]) -> list[Point]:
    """The triangle at the tip of an arrow."""
    (x, y), (tip_x, tip_y) = path[-2], path[-1]
    angle = math.degrees(math.atan2(y - tip_y, x - tip_x))
    return [path[-1], _on_circle(path[-1], 9.0, angle + 22), _on_circle(path[-1], 9.0, angle - 22)]


def _ground(text: Text) -> tuple[float, float, float, float]:
    """x, y, width and height of the ground of a label."""
    width = max(map(len, text.lines)) * LETTER + 4.0
    height = len(text.lines) * LINE + 2.0
    return text.middle[0] - width / 2, text.middle[1] - height / 2, width, height


def to_svg(graph: Graph) -> bytes:
    """The graph as SVG."""
    from xml.etree import ElementTree

    width, height = graph.size
    root = ElementTree.Element("svg", {"xmlns": "http://www.w3.org/2000/svg"})
    root.attrib |= {"viewBox": f"0 0 {width} {height}", "width": str(width), "height": str(height)}

    def add(tag: str, **attributes: float | str) -> ElementTree.Element:
        values = {
            name.replace("_", "-"): f"{value:.1f}" if isinstance(value, float) else str(value)
            for name, value in attributes.items()
        }
        return ElementTree.SubElement(root, tag, values)

    add("rect", width=width, height=height, fill="white")
    for path in graph.arrows:
        add("polyline", points=_points(path), fill="none", stroke="#555", stroke_width=1.5)
        add("polygon", points=_points(_head(path)), fill="#555")
    for (x, y), radius in graph.circles:
        add("circle", cx=x, cy=y, r=radius, fill="white", stroke="black", stroke_width=1.5)
    for text in graph.texts:
        if text.is_label:
            x, y, wide, tall = _ground(text)
            add("rect", x=x, y=y, width=wide, height=tall, fill="white", fill_opacity="0.85")
        for order, line in enumerate(text.lines):
            y = text.middle[1] + (order - (len(text.lines) - 1) / 2) * LINE + 4.0
            element = add(
                "text", x=text.middle[0], y=y, text_anchor="middle", font_family="monospace", font_size=12.0
            )
            element.text = line
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True))


def _points(path: Sequence[Point]) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in path)


def to_png(graph: Graph, scale: int = 2) -> bytes:
    """The graph as PNG, `scale` pixels for each of its own."""
    import cv2
    import numpy as np

    width, height = graph.size
    picture = np.full((height * scale, width * scale, 3), 255, np.uint8)

    def pixel(point: Point) -> tuple[int, int]:
        return round(point[0] * scale), round(point[1] * scale)

    grey, black, white = (85, 85, 85), (0, 0, 0), (255, 255, 255)
    for path in graph.arrows:
        points = np.array([pixel(point) for point in path], np.int32)
        cv2.polylines(picture, [points], False, grey, scale, cv2.LINE_AA)
        head = np.array([pixel(point) for point in _head(path)], np.int32)
        cv2.fillPoly(picture, [head], grey, cv2.LINE_AA)
    for middle, radius in graph.circles:
        cv2.circle(picture, pixel(middle), round(radius * scale), white, -1, cv2.LINE_AA)
        cv2.circle(picture, pixel(middle), round(radius * scale), black, scale, cv2.LINE_AA)
    font, size = cv2.FONT_HERSHEY_SIMPLEX, 0.37 * scale
    for text in graph.texts:
        if text.is_label:
            x, y, wide, tall = _ground(text)
            cv2.rectangle(picture, pixel((x, y)), pixel((x + wide, y + tall)), white, -1)
        for order, line in enumerate(text.lines):
            (wide, _), _ = cv2.getTextSize(line, font, size, 1)
            y = text.middle[1] + (order - (len(text.lines) - 1) / 2) * LINE + 4.0
            place = (round(text.middle[0] * scale - wide / 2), round(y * scale))
            cv2.putText(picture, line, place, font, size, black, 1, cv2.LINE_AA)
    return bytes(cv2.imencode(".png", picture)[1])
