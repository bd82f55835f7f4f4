"""The files of the page: modules that parse, types that fit, texts in both languages, no other server."""

import json
import re
import shutil
import subprocess
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from types import SimpleNamespace

import pytest

from umform.processes.air_bending import AirBending
from umform.processes.air_bending.remarks import coarse_mesh, remarks
from umform.results.quantity import Band, Quantity

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


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node to run JavaScript")
def test_quantities_are_shown_as_in_the_terminal():
    one = Quantity("height", "mm", 2, value=12.3456)
    bare = replace(one, decimals=None, value=0.00275849)
    shown = [
        one,
        replace(one, band=Band(0.00213, "mesh")),
        replace(one, band=Band(0.123, "mesh", middle=11.0)),
        bare,
        replace(bare, band=Band(0.00012, "mesh")),
    ]
    script = "const [module, given] = process.argv.slice(1); import(module).then(({ numberText, errorText }) => "
    script += "console.log(JSON.stringify(JSON.parse(given).map((one) => [numberText(one), errorText(one)]))));"
    arguments = [(PAGE / "quantities.js").as_uri(), json.dumps([quantity.record() for quantity in shown])]
    command = ["node", "--experimental-default-type=module", "--no-warnings", "-e", script, *arguments]
    page = json.loads(subprocess.run(command, check=True, timeout=60, capture_output=True, text=True).stdout)
    assert page == [[q.text, "" if q.band is None else q.error_text] for q in shown]


def read_in_the_page(texts, language):
    """Numbers of texts as the page reads them: a value, or the kind of mistake."""
    script = "const [module, language, texts] = process.argv.slice(1);"
    script += "import(module).then(({ read }) => console.log(JSON.stringify(JSON.parse(texts).map((text) => {"
    script += "const found = read(text, language); return found.problem || [found.value, found.other]; }))));"
    arguments = [(PAGE / "decimals.js").as_uri(), language, json.dumps(texts)]
    command = ["node", "--experimental-default-type=module", "--no-warnings", "-e", script, *arguments]
    return json.loads(subprocess.run(command, check=True, timeout=60, capture_output=True, text=True).stdout)


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node to run JavaScript")
def test_numbers_are_read_with_either_sign_and_never_guessed():
    same = {"12": 12.0, " 12 ": 12.0, "-5": -5.0, "\u22125": -5.0, "1e-3": 1e-3, "": None}
    wrong = ["1.250,5", "1,250.5", "1,2,3", "1.2.3", "1 250", "12mm", "twelve", "1'250", ".", "--1", "0x10", "Infinity"]
    for language in ("en", "de"):
        assert read_in_the_page(list(same), language) == [[value, False] for value in same.values()]
        assert read_in_the_page(wrong, language) == ["unreadable"] * len(wrong)
    texts = ["12,5", "12.5", ",5", "0,125", "0.125", "1,250", "1.250", "1,25", "1234,567"]
    values = [12.5, 12.5, 0.5, 0.125, 0.125, 1.25, 1.25, 1.25, 1234.567]
    for language, sign in (("en", "."), ("de", ",")):
        wanted = [[value, sign not in text] for text, value in zip(texts, values, strict=True)]
        wanted[5 if language == "en" else 6] = "ambiguous"  # three decimals, or thousands
        assert read_in_the_page(texts, language) == wanted


#: A page with the German texts; then what follows.
_GERMAN = """
const [folder, given] = process.argv.slice(1), fs = require("fs");
globalThis.fetch = async (path) => ({ json: async () => JSON.parse(fs.readFileSync(folder + path.slice(7), "utf8")) });
globalThis.document = { documentElement: {}, getElementById: () => ({}), querySelectorAll: () => [] };
const load = (name) => import("file://" + folder + name);
load("/texts.js").then(async ({ loadTexts }) => {
  await loadTexts("de");
"""


def in_german(body, given):
    """What a program of the page returns in German."""
    script = f"{_GERMAN} console.log(JSON.stringify(await (async () => {{ {body} }})())); }});"
    arguments = [str(PAGE), json.dumps(given)]
    command = ["node", "--experimental-default-type=module", "--input-type=commonjs", "--no-warnings", "-e", script]
    return json.loads(subprocess.run([*command, *arguments], check=True, timeout=60, capture_output=True).stdout)


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node to run JavaScript")
def test_a_message_with_a_list_is_german_as_a_whole():
    (said,) = coarse_mesh(AirBending(layers=1, elements_per_thickness=1.0))
    text = in_german("const { message } = await load('/messages.js'); return message(JSON.parse(given));", said)
    assert "Elemente je Dicke 1 (Vorgabe 3), Lagen 1 (Vorgabe 2); nur zum Ausprobieren" in text


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node to run JavaScript")
def test_remarks_on_a_bend_are_german():
    measures = SimpleNamespace(outer_strain=0.5, largest_force=50.0, force=40.0)
    body = "const { message } = await load('/messages.js'); return JSON.parse(given).map(message);"
    force, strain = in_german(body, remarks(AirBending(), measures))
    assert "% unter der Faustformel" in force and strain.startswith("die Randdehnung 0,50 übersteigt die 0,22")


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node to run JavaScript")
def test_names_in_german_messages_keep_their_points():
    body = "const { message } = await load('/messages.js'); return JSON.parse(given).map(message);"
    said = in_german(body, [f"{name}; or leave it out" for name in ("at least 0.25", "part-2.5.step", "steps.0.to")])
    assert [text.split(";")[0] for text in said] == ["at least 0,25", "part-2.5.step", "steps.0.to"]


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node to run JavaScript")
def test_labels_of_stages_of_bends_and_of_decks_are_german():
    body = "const { labelOf } = await load('/quantities.js');"
    body += "return JSON.parse(given).map((name) => labelOf({ name, label: name }, 'hem'));"
    names = {
        "height": "Höhe",
        "flattening: drift of the energies": "Zudrücken: Drift der Energien",
        "first bend: penetration of table": "Erste Biegung: Eindringung: table",
        "bend 2: angle": "Biegung 2: Schenkel zum Grundblech",
        "sheet2_loaded_angle": "Blech 2: Winkel unter Last",
        "flange 1": "Schenkel 1, außen",
        "largest punch force": "Größte Kraft: Stempel",
        "own: measure": "own: measure",
    }
    assert dict(zip(names, in_german(body, list(names)), strict=True)) == names
