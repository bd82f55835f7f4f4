"""The files of the page: modules that parse, types that fit, texts in both languages, no other server."""

import json
import re
import shutil
import subprocess
from importlib.resources import files
from pathlib import Path

import pytest

PAGE = Path(str(files("umform.bench").joinpath("page")))


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node to parse JavaScript")
def test_modules_can_be_parsed():
    parse = "const vm = require('vm'), fs = require('fs');"
    parse += "for (const file of process.argv.slice(1)) new vm.SourceTextModule(fs.readFileSync(file, 'utf8'));"
    modules = [str(path) for path in PAGE.iterdir() if path.name.endswith(".js")]
    assert len(modules) > 8
    subprocess.run(
        ["node", "--experimental-vm-modules", "--no-warnings", "-e", parse, *modules], check=True, timeout=60
    )


def test_both_languages_have_all_texts():
    english, german = (json.loads(PAGE.joinpath(f"{name}.json").read_text(encoding="utf-8")) for name in ("en", "de"))
    assert english.keys() == german.keys()
    for key, text in english.items():
        assert set(re.findall(r"\{(\w+)\}", text)) == set(re.findall(r"\{(\w+)\}", german[key])), key


def test_texts_that_the_page_asks_for_are_there():
    english = json.loads(PAGE.joinpath("en.json").read_text(encoding="utf-8"))
    sources = [path.read_text(encoding="utf-8") for path in PAGE.iterdir() if path.name.endswith((".js", ".html"))]
    asked = {key for text in sources for key in re.findall(r"""(?:\bt\(|data-t(?:-label)?=)["']([\w.]+)["']""", text)}
    assert len(asked) > 40 and asked <= english.keys()


def test_page_names_no_other_server():
    for path in PAGE.iterdir():
        text = path.read_text(encoding="utf-8")
        assert not re.findall(r"https?://(?!www\.w3\.org/)", text), path.name
