"""Pictures of the pages: small files that show what matplotlib draws."""

from __future__ import annotations

import io
import re
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from umform.plotting import house_style
from umform_book.pictures import small_png, small_svg

IMAGES = Path(__file__).parents[2] / "docs" / "verification" / "images"
#: Bytes of all pictures of the book.
LIMIT = 4_000_000


def drawn(kind: str, shift: float = 0.0) -> bytes:
    file = io.BytesIO()
    with house_style():
        figure = Figure(figsize=(4.0, 3.0))
        axes = figure.subplots()
        axes.plot([0.0, 1.0 + shift, np.nan, 2.0, 3.0], [1.3675, 1.37, 1.0, 1.38, 1.375], "o-", label="a < b & c")
        axes.set(title="Titles are bold", ylabel="force, N", yticks=[1.3675, 1.38], xscale="symlog")
        axes.legend()
        figure.savefig(file, format=kind, dpi=90, metadata={"Date": None} if kind == "svg" else None)
    return file.getvalue()


def elements(svg: str, name: str) -> list[ET.Element]:
    return list(ET.fromstring(svg).iter(f"{{http://www.w3.org/2000/svg}}{name}"))


def test_labels_are_text_with_all_digits():
    whole = drawn("svg").decode()
    small = small_svg(whole)
    assert len(small) < 0.4 * len(whole)
    labels = {label.text: label for label in elements(small, "text")}
    assert {"a < b & c", "Titles are bold", "force, N", "1.3675", "1.3800"} <= set(labels)
    assert labels["force, N"].get("transform").startswith("rotate(-90 ")
    rules = dict(re.findall(r"\.(\w+)\{(.*?)\}", elements(small, "style")[0].text))
    assert [text for text, label in labels.items() if "bold" in rules[label.get("class")]] == ["Titles are bold"]
    assert 60.0 < float(labels["Titles are bold"].get("textLength")) < 120.0  # 15 letters of 10 points


def test_mathematics_stays_as_outlines():
    small = small_svg(drawn("svg").decode())
    there = {path.get("id") for path in elements(small, "path")} - {None}
    used = {use.get("href")[1:] for use in elements(small, "use")}
    assert "$" not in "".join(label.text for label in elements(small, "text"))
    assert used == there
    assert len(used) > 3  # 1, 0, minus, and the ticks
    assert any("scale(0.015625)" in path.get("transform", "") for path in elements(small, "path"))


def test_a_gap_in_a_line_stays_a_gap():
    paths = [path.get("d") for path in elements(small_svg(drawn("svg").decode()), "path") if path.get("clip-path")]
    (line,) = (path for path in paths if path.count("M") > 1)
    assert re.fullmatch(r"M(\S+ ){3}\S+M(\S+ ){3}\S+", line)


def test_the_last_digits_of_a_machine_are_not_in_the_file():
    assert small_svg(drawn("svg").decode()) == small_svg(drawn("svg", shift=1e-9).decode())
    assert small_svg(drawn("svg").decode()) != small_svg(drawn("svg", shift=1e-1).decode())


def test_a_png_has_a_palette_and_the_same_colours():
    whole = drawn("png")
    small = small_png(whole)
    assert len(small) < 0.6 * len(whole)
    pictures = [np.asarray(Image.open(io.BytesIO(file)).convert("RGB"), float) for file in (whole, small)]
    assert Image.open(io.BytesIO(small)).mode == "P"
    assert np.abs(pictures[0] - pictures[1]).max() <= 24


def test_the_pictures_of_the_book_take_few_megabytes():
    files = [file for file in IMAGES.iterdir() if file.is_file()]
    assert len(files) > 200
    assert sum(file.stat().st_size for file in files) <= LIMIT
