import gzip
import re
from base64 import b64decode
from html.parser import HTMLParser
from importlib.resources import files

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.plotting import inline_svg, plot_shape
from umform.processes import FreeBending, free_bending
from umform.report.page import write_report
from umform.report.symmetry import mirrors
from umform.results.shape import Shape


@pytest.fixture(scope="module")
def result():
    return free_bending(FreeBending(mesh=(8, 1), steps=10, stroke=3.0), progress=False).result


@pytest.fixture(scope="module")
def page(result, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "bending.html"
    assert result.report(path) == path
    return path.read_text(encoding="utf-8")


class Balance(HTMLParser):
    """Elements that are opened and not closed."""

    def __init__(self):
        super().__init__()
        self.open = []

    def handle_starttag(self, tag, attrs):
        if tag not in ("meta", "br", "input"):
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        pass

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_page_is_well_formed(page):
    reader = Balance()
    reader.feed(page)
    assert reader.open == []


def test_page_loads_nothing(page):
    assert "http://" not in page
    assert "https://" not in page
    assert not re.search(r"<(link|img|iframe)\b|<script[^>]*\bsrc|@import|url\((?!#)|\bfetch\(|import\(", page)
    assert "default-src 'none'" in page


def test_the_library_has_no_address_but_the_name_of_a_namespace():
    packed = files("umform.report").joinpath("assets", "three", "three.min.js.gz").read_bytes()
    library = gzip.decompress(packed).decode()
    assert set(re.findall(r"https?://[\w./]*", library)) == {"http://www.w3.org/1999/xhtml"}
    assert "MIT" in files("umform.report").joinpath("assets", "three", "LICENSE").read_text(encoding="utf-8")


def test_the_file_in_the_page_is_that_of_the_result(page, result, tmp_path):
    (coded,) = re.findall(r'href="data:text/csv;base64,([^"]*)"', page)
    assert b64decode(coded) == result.write(tmp_path / "h.csv").read_bytes()


def test_deck_and_events_are_shown(result, tmp_path):
    result.events.append("step 1, time 0.5000: contact is lost")
    path = write_report(result, tmp_path / "r.html", deck="[model]\nelement = '<ANS>'")
    result.events.pop()
    page = path.read_text(encoding="utf-8")
    assert "element = &#x27;&lt;ANS&gt;&#x27;" in page
    assert "contact is lost" in page


def test_many_faces_are_pixels(result):
    """A still of a large mesh stays small."""
    fine = uf.mesh.strip(10, 10, 0.1, (80, 80))
    shape = Shape.displaced(fine, np.zeros_like(fine.points))
    svg = inline_svg(plot_shape(shape))
    assert "data:image/png" in svg
    assert len(svg) < 200_000


def test_page_shows_what_belongs_in_it(page, result):
    assert page.count("<svg") == 3  # two stills and the curves with a cursor
    for word in ("ANS3DEAS", "punch force", "cylinder:", "penalty 100", uf.__version__, "numpy", "end of step 2"):
        assert word in page
    assert f"{result['punch_force'].min():.6g}" in page


def test_words_of_the_user_are_escaped(result, tmp_path):
    result.warnings.append("a < b & <script>")
    path = result.report(tmp_path / "r.html")
    result.warnings.pop()
    assert "a &lt; b &amp; &lt;script&gt;" in path.read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["a.txt", "a", "a.html.gz"])
def test_other_names_are_refused(name, result, tmp_path):
    with pytest.raises(InvalidValue, match="html"):
        result.report(tmp_path / name)
    with pytest.raises(InvalidValue, match="is its text"):
        result.report(tmp_path / "a.html", deck=tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_title_is_the_heading_and_the_material_has_six_digits(result, tmp_path):
    page = write_report(result, tmp_path / "r.html", title="A strip & a <cylinder>").read_text(encoding="utf-8")
    assert "<h1>A strip &amp; a &lt;cylinder&gt;</h1>" in page
    assert "ANS3DEAS: 8 elements" in page
    assert "J2: E = 210002, nu = 0.299998, yield stress 160, perfectly plastic" in page
    assert "kappa=" not in page


def test_the_material_note_and_the_modelled_part_are_said(result, tmp_path):
    page = write_report(result, tmp_path / "r.html", note="DC04: from <a standard>").read_text(encoding="utf-8")
    assert "DC04: from &lt;a standard&gt;" in page
    half = "Half of the sheet is computed, by symmetry: forces and works of the whole are 2 times those here." in page
    assert half == (len(mirrors(result.model)) == 1)


def test_first_screen_has_the_picture_the_key_numbers_and_the_first_warning(result, tmp_path):
    result.warnings.append("the sheet tears: " + 30 * "long words ")
    page = result.report(tmp_path / "r.html").read_text(encoding="utf-8")
    result.warnings.pop()
    first = page[: page.index('id="warnings"')]
    assert "the sheet tears" in first
    assert " …" in first
    assert 'class="cards"' in first
    assert 'id="shape-canvas"' in first
    for label in ("largest punch force", "largest thinning", "largest plastic strain"):
        assert f"<dt>{label}</dt>" in first
    assert first.count("of this mesh") >= 4


def test_a_report_has_no_objects_of_python_no_long_digits_and_no_none(page):
    text = re.sub(r"<script.*?</script>|<style.*?</style>|href=\"[^\"]*\"|<svg.*?</svg>", " ", page, flags=re.DOTALL)
    words = re.sub(r"<[^>]+>", " ", text)
    assert not re.search(r"\bNone\b|\bTrue\b|\bFalse\b|\w+\(\w+=|<\w+ object|np\.float", words)
    assert not re.search(r"[1-9](?:\.?\d){8,}", words)
