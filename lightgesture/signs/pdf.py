"""Pages as PDF, with the fonts that every reader has, so that none is needed here."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from lightgesture.signs.drawings import SIDE, load_drawing
from lightgesture.signs.sheet import Box, HandPicture, Page, Text

if TYPE_CHECKING:
    from fpdf import FPDF

POINTS_PER_MM = 72.0 / 25.4


def to_pdf(pages: Sequence[Page]) -> bytes:
    """One PDF document. Letters that Western European fonts lack are question marks."""
    from fpdf import FPDF

    document = FPDF(unit="mm", format=(pages[0].width, pages[0].height))
    document.set_auto_page_break(False)
    document.set_creator("lightgesture")
    for page in pages:
        document.add_page(format=(page.width, page.height))
        for item in page.items:
            match item:
                case Box():
                    _draw_box(document, item)
                case Text():
                    _draw_text(document, item)
                case HandPicture():
                    _draw_hand(document, item)
    return bytes(document.output())


def _draw_box(document: "FPDF", box: Box) -> None:
    if box.fill is not None:
        document.set_fill_color(box.fill)
    if box.stroke is not None:
        document.set_draw_color(box.stroke)
        document.set_line_width(box.line)
    style = ("D" if box.stroke is not None else "") + ("F" if box.fill is not None else "")
    if 2 * box.radius >= box.width == box.height:
        document.ellipse(box.x, box.y, box.width, box.height, style=style)
        return
    document.rect(
        box.x,
        box.y,
        box.width,
        box.height,
        style=style,
        round_corners=box.radius > 0,
        corner_radius=box.radius,
    )


def _draw_text(document: "FPDF", text: Text) -> None:
    plain = text.text.encode("latin-1", "replace").decode("latin-1")
    document.set_font("Helvetica", "B" if text.bold else "", text.size * POINTS_PER_MM)
    document.set_text_color(text.colour)
    wide = document.get_string_width(plain)
    x = text.x - {"left": 0.0, "middle": wide / 2, "right": wide}[text.align]
    document.text(x, text.y, plain)


def _draw_hand(document: "FPDF", hand: HandPicture) -> None:
    drawing = load_drawing(hand.token, hand.side, hand.kind)
    if drawing is None:
        return
    scale = hand.size / SIDE
    for layer in drawing.layers:
        with document.new_path() as path:
            path.style.fill_color = layer.colour
            path.style.stroke_color = None
            path.style.intersection_rule = "evenodd"
            for polygon in layer.polygons:
                points = [(hand.x + x * scale, hand.y + y * scale) for x, y in polygon]
                path.move_to(*points[0])
                for point in points[1:]:
                    path.line_to(*point)
                path.close()
