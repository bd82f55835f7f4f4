"""The version stands in one place; what cites it agrees."""

from importlib import metadata
from pathlib import Path

import umform

ROOT = Path(__file__).parents[2]


def test_the_citation_and_the_installed_package_have_the_version_of_the_code():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {umform.__version__}\n" in citation
    assert metadata.version("umform") == umform.__version__
    assert 'dynamic = ["version"]' in (ROOT / "pyproject.toml").read_text(encoding="utf-8")
