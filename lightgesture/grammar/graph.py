"""Where the states of a grammar and the words between them are drawn: columns by the distance from idle.

Each state is first reached by one arrow. These arrows make a tree, whose branches have rows of their own, and their
labels stand on the last, level part of them, so that none covers another. For every other arrow the bow and the place
of its label are searched that cover the least.
"""

import math
from dataclasses import dataclass, field
from typing import Final

from lightgesture.fsm import Grammar
from lightgesture.grammar.arrows import Ground, Point, Rect, cubic, on_circle, quadratic
from lightgesture.grammar.labels import Label, Row, labels_of, shapes_of
from lightgesture.signs.drawings import load_drawing

# Sizes in pixels.

RADIUS: Final = 20.0
"""Of a state."""

LETTER: Final = 7.2
"""Width of a letter."""

LINE: Final = 16.0
"""Height of a line of text."""

HAND: Final = 26.0
"""Width and height of a drawn hand."""

GAP: Final = 6.0
"""Between the hands of a label and its word."""

FAN: Final = 56.0
"""Width in which the arrows of a state part."""

PAD: Final = 10.0
"""Round a label and between rows."""

MARGIN: Final = 30.0
"""Round the graph."""

LOOP: Final = 0.8
"""Radius of the arrow from a state to itself, of the state's own."""


@dataclass(frozen=True, slots=True)
class Text:
    """A line of text centred on a point."""

    middle: Point
    line: str


@dataclass(frozen=True, slots=True)
class Placed:
    """A label with the middle of its ground."""

    middle: Point
    label: Label

    @property
    def rect(self) -> Rect:
        """Its ground."""
        width, height = size_of(self.label)
        return self.middle[0] - width / 2, self.middle[1] - height / 2, width, height


@dataclass(frozen=True, slots=True)
class Graph:
    """What is drawn. arrows: paths of points, the tip last. circles: middle, radius. states: the middles, by number."""

    size: tuple[int, int]
    arrows: tuple[tuple[Point, ...], ...]
    circles: tuple[tuple[Point, float], ...]
    texts: tuple[Text, ...]
    labels: tuple[Placed, ...]
    states: tuple[Point, ...]


@dataclass(slots=True)
class _Plan:
    """The graph while it is laid out. edges: state -> next state -> label. children: of the tree."""

    edges: list[dict[int, Label]]
    kinds: dict[int, str]
    depths: list[int] = field(default_factory=list)
    parents: dict[int, int] = field(default_factory=dict)
    places: list[Point] = field(default_factory=list)
    arrows: list[tuple[Point, ...]] = field(default_factory=list)
    labels: list[Placed] = field(default_factory=list)
    texts: list[Text] = field(default_factory=list)


def lay_out(grammar: Grammar) -> Graph:
    """Where everything goes."""
    edges = labels_of(grammar)
    plan = _Plan(edges, {state: form.kind for state, form in grammar.table.accepting.items()})
    _grow_tree(plan)
    _place_states(plan)
    _draw_kinds(plan)
    _draw_tree(plan)
    for state, row in enumerate(plan.edges):
        for target in row:
            if plan.parents.get(target) != state:
                _draw_other(plan, state, target)
    return _finished(plan)


def size_of(label: Label) -> tuple[float, float]:
    """Width and height of a label's ground."""
    widths = [row_width(row) for row in label]
    return max(widths) + 8.0, sum(row_height(row) for row in label) + 4.0


def row_width(row: Row) -> float:
    """Of the drawn hands of a line and its word."""
    hands = sum(cell_width(*shape) for shape in shapes_of(row))
    return hands + LETTER * len(row.text) + (GAP if row.pair else 0.0)


def cell_width(token: str, side: str) -> float:
    """Of a drawn hand, or of the name of one that has no drawing."""
    return HAND if load_drawing(token, side) is not None else max(HAND, LETTER * len(token) + GAP)


def row_height(row: Row) -> float:
    """Of a line of a label."""
    return HAND if row.pair else LINE


def _grow_tree(plan: _Plan) -> None:
    plan.depths = [0] * len(plan.edges)
    waiting = [0]
    for state in waiting:
        for target in plan.edges[state]:
            if target != 0 and target not in plan.parents:
                plan.parents[target] = state
                plan.depths[target] = plan.depths[state] + 1
                waiting.append(target)


def _children(plan: _Plan, state: int) -> list[int]:
    return [target for target in plan.edges[state] if plan.parents.get(target) == state]


def _returns(plan: _Plan, state: int) -> bool:
    """Whether an arrow leads back to the state that it is reached from."""
    return plan.parents.get(state) in plan.edges[state]


def _need(plan: _Plan, state: int) -> tuple[float, float]:
    """Room above and below the middle of a state."""
    parent = plan.parents.get(state)
    half = 0.0 if parent is None else size_of(plan.edges[parent][state])[1] / 2
    above, below = max(RADIUS, half), max(RADIUS, half)
    if state in plan.edges[state]:
        above = max(above, RADIUS * (1 + 2 * LOOP) + size_of(plan.edges[state][state])[1])
    if parent is not None and _returns(plan, state):
        below += size_of(plan.edges[state][parent])[1] + PAD
    if state in plan.kinds and plan.edges[state]:
        below = max(below, RADIUS + LINE)
    beside = [
        size_of(label)[1]
        for target, label in plan.edges[state].items()
        if target != state and plan.depths[target] == plan.depths[state]
    ]
    below = max([below, *(RADIUS + tall + 3 * PAD for tall in beside)])
    return above + PAD, below + PAD


def _place_states(plan: _Plan) -> None:
    lefts = _columns(plan)
    heights = [0.0] * len(plan.edges)
    lowest = [-math.inf] * (max(plan.depths) + 1)
    end = 0.0

    def move(state: int, by: float) -> None:
        heights[state] += by
        lowest[plan.depths[state]] = max(lowest[plan.depths[state]], heights[state] + _need(plan, state)[1])
        for child in _children(plan, state):
            move(child, by)

    def place(state: int) -> None:
        nonlocal end
        above, below = _need(plan, state)
        before = lowest[plan.depths[state]]
        children = _children(plan, state)
        for child in children:
            place(child)
        if children:
            heights[state] = (heights[children[0]] + heights[children[-1]]) / 2
            lacking = max(before, 0.0) + above - heights[state]
            if lacking > 0:
                move(state, lacking)
        else:
            heights[state] = max(end, before) + above
        end = max(end, heights[state] + below)
        lowest[plan.depths[state]] = max(before, heights[state] + below)

    place(0)
    plan.places = [
        (lefts[depth], MARGIN + height) for depth, height in zip(plan.depths, heights, strict=True)
    ]


def _columns(plan: _Plan) -> list[float]:
    """x of the states of each depth: between two columns there is room for the fan and the widest label."""
    lefts = [MARGIN + RADIUS + LETTER]
    for depth in range(max(plan.depths)):
        widest = max(
            size_of(label)[0]
            for state, row in enumerate(plan.edges)
            for target, label in row.items()
            if plan.depths[state] == depth and plan.parents.get(target) == state
        )
        lefts.append(lefts[-1] + 2 * RADIUS + FAN + widest + 3 * PAD)
    return lefts


def _draw_kinds(plan: _Plan) -> None:
    for state, kind in plan.kinds.items():
        x, y = plan.places[state]
        if plan.edges[state]:
            plan.texts.append(Text((x, y + RADIUS + LINE / 2 + 2.0), kind))
        else:
            plan.texts.append(Text((x + RADIUS + LETTER * (len(kind) / 2 + 1), y), kind))


def _draw_tree(plan: _Plan) -> None:
    for target, state in plan.parents.items():
        (x, y), (end_x, end_y) = plan.places[state], plan.places[target]
        level_x = x + RADIUS + FAN
        bend = [(x + RADIUS, y), (x + RADIUS + FAN * 0.6, y), (level_x - FAN * 0.6, end_y), (level_x, end_y)]
        plan.arrows.append((*cubic(bend), (end_x - RADIUS, end_y)))
        label = plan.edges[state][target]
        wide, tall = size_of(label)
        plan.labels.append(Placed((end_x - RADIUS - 2 * PAD - wide / 2, end_y), label))
        if _returns(plan, target):
            back = plan.edges[target][state]
            low = end_y + max(RADIUS, tall / 2) + size_of(back)[1] / 2 + PAD / 2
            path = [
                (end_x - RADIUS * 0.5, end_y + RADIUS * 0.87),
                (end_x - RADIUS, low),
                (end_x - RADIUS * 2, low),
            ]
            home = [
                (level_x, low),
                (x + RADIUS * 2.5, low),
                (x + RADIUS * 1.8, y + RADIUS * 1.8),
                on_circle(plan.places[state], RADIUS, 55),
            ]
            plan.arrows.append((*quadratic(path), *cubic(home)))
            plan.labels.append(Placed((end_x - RADIUS * 2 - PAD - size_of(back)[0] / 2, low), back))


def _draw_other(plan: _Plan, state: int, target: int) -> None:
    """An arrow that is none of the tree: the bow and the place of the label that cover the least."""
    if plan.parents.get(state) == target and state != target:
        return  # drawn beside the arrow that leads to it
    label = plan.edges[state][target]
    if state == target:
        x, y = plan.places[state]
        plan.arrows.append(
            tuple(
                on_circle((x, y - RADIUS * (0.8 + LOOP)), RADIUS * LOOP, 110 + 32 * turn)
                for turn in range(11)
            )
        )
        wide, tall = size_of(label)
        # To the left where it is wide, for on the right arrows lead away.
        plan.labels.append(
            Placed((x - max(0.0, wide / 2 - RADIUS), y - RADIUS * (0.8 + 2 * LOOP) - tall / 2), label)
        )
        return
    texts = [text_rect(text) for text in plan.texts]
    ground = Ground([*(placed.rect for placed in plan.labels), *texts], plan.places, RADIUS, plan.arrows)
    path, middle = ground.best_arrow(plan.places[state], plan.places[target], size_of(label))
    plan.arrows.append(path)
    plan.labels.append(Placed(middle, label))


def _finished(plan: _Plan) -> Graph:
    circles = [(place, RADIUS) for place in plan.places]
    circles += [(plan.places[state], RADIUS - 4.0) for state in plan.kinds]
    names = [Text(place, str(state) if state else "idle") for state, place in enumerate(plan.places)]
    rects = [*(placed.rect for placed in plan.labels), *map(text_rect, plan.texts)]
    points = [(x + width, y + height) for x, y, width, height in rects]
    points += [point for arrow in plan.arrows for point in arrow]
    points += [(x + RADIUS, y + RADIUS) for x, y in plan.places]
    size = math.ceil(max(x for x, _ in points) + MARGIN), math.ceil(max(y for _, y in points) + MARGIN)
    return Graph(
        size,
        tuple(plan.arrows),
        tuple(circles),
        (*plan.texts, *names),
        tuple(plan.labels),
        tuple(plan.places),
    )


def text_rect(text: Text) -> Rect:
    width = LETTER * len(text.line)
    return text.middle[0] - width / 2, text.middle[1] - LINE / 2, width, LINE
