import re
from html.parser import HTMLParser

import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.processes import FreeBending, free_bending


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
        if tag not in ("meta", "br"):
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
    assert not re.search(r"<(script|link|img|iframe)\b|@import|url\((?!#)", page)


def test_page_shows_what_belongs_in_it(page, result):
    assert page.count("<svg") == 2
    for word in ("ANS3DEAS", "punch_force", "Cylinder", "penalty 100", uf.__version__, "numpy", "end of step 2"):
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
    assert list(tmp_path.iterdir()) == []
