"""A page as SVG, of plain shapes, without anything from elsewhere."""

from xml.etree import ElementTree

from lightgesture.signs.drawings import SIDE, load_drawing
from lightgesture.signs.sheet import Box, HandPicture, Page, Text

_ANCHORS = {"left": "start", "middle": "middle", "right": "end"}


def to_svg(page: Page) -> bytes:
    """The page as an SVG document whose user unit is a millimetre."""
    root = ElementTree.Element(
        "svg",
        {
            "xmlns": "http://www.w3.org/2000/svg",
            "viewBox": f"0 0 {page.width:g} {page.height:g}",
            "width": f"{page.width:g}mm",
            "height": f"{page.height:g}mm",
            "font-family": "Helvetica, Arial, sans-serif",
        },
    )
    for item in page.items:
        match item:
            case Box():
                _add_box(root, item)
            case Text():
                _add_text(root, item)
            case HandPicture():
                _add_hand(root, item)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True))


def _add_box(root: ElementTree.Element, box: Box) -> None:
    attributes = {name: f"{getattr(box, name):.2f}" for name in ("x", "y", "width", "height")}
    attributes |= {"fill": box.fill or "none", "rx": f"{box.radius:.2f}"}
    if box.stroke is not None:
        attributes |= {"stroke": box.stroke, "stroke-width": f"{box.line:g}"}
    ElementTree.SubElement(root, "rect", attributes)


def _add_text(root: ElementTree.Element, text: Text) -> None:
    attributes = {
        "x": f"{text.x:.2f}",
        "y": f"{text.y:.2f}",
        "font-size": f"{text.size:.2f}",
        "fill": text.colour,
    }
    if text.bold:
        attributes["font-weight"] = "bold"
    if text.align != "left":
        attributes["text-anchor"] = _ANCHORS[text.align]
    ElementTree.SubElement(root, "text", attributes).text = "".join(
        sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in text.text
    )


def _add_hand(root: ElementTree.Element, hand: HandPicture) -> None:
    drawing = load_drawing(hand.token, hand.side, hand.kind)
    if drawing is None:
        return
    scale = hand.size / SIDE
    group = ElementTree.SubElement(
        root, "g", {"transform": f"translate({hand.x:.2f} {hand.y:.2f}) scale({scale:.5f})"}
    )
    for layer in drawing.layers:
        path = "".join("M" + "L".join(f"{x} {y}" for x, y in one) + "Z" for one in layer.polygons)
        ElementTree.SubElement(group, "path", {"fill": layer.colour, "fill-rule": "evenodd", "d": path})
