"""Pictures of the pages, made small: labels as text, each style once, a palette of colours.

matplotlib draws each letter of a plot as an outline. The outlines take most of the file. Here a label is text again,
with the length that matplotlib gave it, so that it fits with any font.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from html import unescape
from xml.etree import ElementTree as ET

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path
from PIL import Image

#: Decimals of a coordinate, in points.
_DECIMALS = 2
#: Colours of a PNG.
_COLOURS = 256
_STYLE = "*{stroke-linejoin:round;stroke-linecap:butt}text{font-family:DejaVu Sans,Verdana,sans-serif;white-space:pre}"
_PLACE = re.compile(r"translate\((\S+) (\S+)\)(?: rotate\((\S+)\))? scale\((\S+) -\S+\)")
#: Attributes that name another element.
_REFERENCES = ("href", "clip-path")
_NAME = re.compile(r"#([\w-]+)")


def small_png(picture: bytes) -> bytes:
    """A PNG with a palette."""
    file = io.BytesIO()
    pixels = Image.open(io.BytesIO(picture)).convert("RGB")
    palette = pixels.quantize(_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    palette.save(file, "png", optimize=True)
    return file.getvalue()


def small_svg(picture: str) -> str:
    """An SVG of matplotlib in a fourth of its size.

    Parameters
    ----------
    picture : str
        The file. A comment before each label has its text; labels with mathematics stay outlines. Coordinates lose the
        digits that differ between machines, and names made from them become letters.
    """
    plain = picture.replace("xlink:href", "href").replace(' xmlns="http://www.w3.org/2000/svg"', "", 1)
    root = ET.fromstring(plain, ET.XMLParser(target=ET.TreeBuilder(insert_comments=True)))
    outlines = {path.get("id", ""): path for path in root.iter("path") if "-" in path.get("id", "")}
    _set_labels(root)
    _prune(root, set(outlines))
    used = [outlines[name] for name in sorted({use.get("href", "")[1:] for use in root.iter("use")} & set(outlines))]
    if used:
        definitions = ET.Element("defs")
        definitions.extend(used)
        root.insert(0, definitions)
    references = " ".join(value for element in root.iter() for key, value in element.items() if key in _REFERENCES)
    names = {name: _letters(number) for number, name in enumerate(dict.fromkeys(_NAME.findall(references)))}
    classes: dict[str, str] = {}
    for element in root.iter():
        _shorten(element, names, classes)
    style = ET.Element("style")
    style.text = _STYLE + "".join(f".{name}{{{rule}}}" for rule, name in classes.items())
    root.insert(0, style)
    root.set("xmlns", "http://www.w3.org/2000/svg")
    return ET.tostring(root, encoding="unicode").replace(" />", "/>") + "\n"


def _is_comment(element: ET.Element) -> bool:
    tag: object = element.tag  # of a comment, the function that makes one
    return tag is ET.Comment


def _set_labels(parent: ET.Element) -> None:
    """Replace groups of outlines by text: that of the comment before the group."""
    comment = ""
    for place, child in enumerate(list(parent)):
        if _is_comment(child):
            comment = unescape((child.text or "")[1:-1])
            continue
        label = _label(child, comment) if comment else None
        if label is None:
            _set_labels(child)
        else:
            parent[place] = label
        comment = ""


def _label(group: ET.Element, text: str) -> ET.Element | None:
    """A label as text; None if it has mathematics, or the group is no label."""
    place = _PLACE.fullmatch(group.get("transform", ""))
    if not place or "$" in text:
        return None
    x, y, angle, scale = place.groups()
    size = 100.0 * float(scale)
    bold = any("Bold" in use.get("href", "") for use in group.iter("use"))
    font = FontProperties(family="DejaVu Sans", size=size, weight="bold" if bold else "normal")
    length = text_to_path.get_text_width_height_descent(text, font, ismath=False)[0]
    label = ET.Element("text", x=x, y=y, textLength=f"{length:.1f}", lengthAdjust="spacingAndGlyphs")
    if angle:
        label.set("transform", f"rotate({angle} {x} {y})")
    label.set("style", f"{group.get('style', '')};font-size:{size:g}px" + ";font-weight:bold" * bold)
    label.text = text
    return label


def _prune(parent: ET.Element, outlines: set[str]) -> None:
    """Remove comments, metadata, outlines and white space; replace groups without attributes by their contents."""
    kept: list[ET.Element] = []
    for child in parent:
        if _is_comment(child) or child.tag in ("metadata", "style") or child.get("id") in outlines:
            continue
        child.tail = None
        if child.tag != "text":
            child.text = None
            _prune(child, outlines)
        if child.tag == "g" and set(child.attrib) <= {"id"}:
            kept.extend(child)
        elif len(child) or child.tag not in ("g", "defs"):
            kept.append(child)
    parent[:] = kept
    parent.text = None


def _letters(number: int) -> str:
    """The name of a number: a to z, aa to zz."""
    first, second = divmod(number, 26)
    return (chr(96 + first) if first else "") + chr(97 + second)


def _shorten(element: ET.Element, names: dict[str, str], classes: dict[str, str]) -> None:
    """Keep the names that are used, write styles as classes and coordinates with few digits."""
    name = element.attrib.pop("id", "")
    if name in names:
        element.set("id", names[name])
    for key in _REFERENCES:
        if key in element.attrib:
            element.set(key, _NAME.sub(lambda found: f"#{names[found[1]]}", element.attrib[key]))
    style = _rounded(re.sub(r"\s*([:;,])\s*", r"\1", element.attrib.pop("style", "").strip("; ")))
    if style:
        element.set("class", classes.setdefault(style, _letters(len(classes))))
    for key in ("x", "y", "width", "height", "transform", "d"):
        if key in element.attrib:
            element.set(key, _rounded(element.attrib[key]))
    if "d" in element.attrib:
        element.set("d", "".join(_path(element.attrib["d"])))


def _rounded(text: str) -> str:
    """Numbers with few decimals; those below 1, among them scales, keep all."""
    return re.sub(r"\d*[1-9]\d*\.\d+", lambda number: f"{round(float(number[0]), _DECIMALS):g}", text)


def _path(data: str) -> Iterator[str]:
    """A path without needless spaces and letters: lines follow a start, and curves a curve, without a letter."""
    last = ""
    for letter, numbers in re.findall(r"([A-Za-z])([^A-Za-z]*)", data):
        again = letter == last != "M" or letter + last == "LM"
        yield (" " if again else letter) + " ".join(numbers.split())
        last = letter
