"""All messages that a form can lead to before a run are there in German, and none that the code does not have."""

import ast
import json
import re
from importlib.resources import files
from pathlib import Path

import umform
from umform import errors
from umform.bench.choices import Choices, FlatChoices, Measured, TableChoices
from umform.bench.form import form_fields
from umform.processes.air_bending.goal import Goal
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.outside import OutsideBend
from umform.processes.bend_sequence.spec import Bend, BendSequence
from umform.processes.draw.cup import Cup
from umform.processes.draw.u_bend import UBend
from umform.processes.hemming import Hemming
from umform.spec import parameters

SOURCE = Path(umform.__file__).parent
#: Code that a form can lead to, before a run.
ROOMS = (
    "bench",
    "processes/air_bending",
    "processes/bend_sequence",
    "processes/draw",
    "processes/hemming",
    "sheet_metals",
    "flat_pattern",
)
FILES = (
    "processes/rules.py",
    "spec/types.py",
    "surfaces/dxf.py",
    "surfaces/chains.py",
    "surfaces/profile.py",
    "surfaces/segments.py",
    "surfaces/crossings.py",
    "surfaces/cad/read_solid.py",
)
#: What makes messages of its arguments, beside the classes of errors.
MAKERS = {
    "refusal",
    "_refuse",
    "_unfit",
    "unfit",
    "Rule",
    "length",
    "About",
    "unreachable",
    "gone",
    "_level",
    "DiskFull",
    "NoAnswer",
}
#: What the form asks for.
SPECS = (
    *(AirBending, Bend, BendSequence, OutsideBend, Choices, FlatChoices, Goal, Hemming, Measured, TableChoices),
    *(Cup, UBend),
)
PARTS = ("what", "cause", "remedy")
GERMAN = json.loads(files("umform.bench").joinpath("page", "messages.de.json").read_text(encoding="utf-8"))
#: What no form can lead to: files of curves and tables, several sheets, the Python interface, the start of the server.
ELSEWHERE = (
    "sheet_metals/curve_fit.py",
    "sheet_metals/flow_curve.py",
    "sheet_metals/least_squares.py",
    "sheet_metals/directional_fit.py",
    "processes/air_bending/problem.py",
    "processes/air_bending/foil.py",
    "processes/air_bending/stack.py",
    "processes/air_bending/usual_tools.py",
    "processes/bend_sequence/form.py",
    "processes/draw/drawn.py",
    "processes/draw/two_meshes.py",
    "bench/server.py",
    "flat_pattern/allowance.py",
    "flat_pattern/developed.py",
    "flat_pattern/drawing.py",
    "flat_pattern/net/",
    "flat_pattern/one_step/",
)
#: Beginnings of what is said of parameters, or only Python users can cause: drawn tools, the interface of profiles.
PYTHON = (
    *("0.05 to 0.2 for", "a drawn tool is", "a path or a Profile"),
    *("a profile needs", "an empty list", "give lines and arcs", "an open profile", "it goes on", "close it:"),
    *("the solid of", "a closed section", "solid=", "another name of the unit", "the unit of the model"),
    *("bottoming=True;", "let each segment", "a J2 or a Metal", "AirBending(", "read_{}(", "umform "),
    *("nothing says how", "neither a metal nor", 'metal="DC04" for'),
)


def messages():
    """Templates of what, cause and remedy, with the file of each."""
    names = {
        name for name, kind in vars(errors).items() if isinstance(kind, type) and issubclass(kind, errors.UmformError)
    }
    paths = [path for room in ROOMS for path in (SOURCE / room).rglob("*.py")] + [SOURCE / name for name in FILES]
    found = {}
    for path in paths:
        for call in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(call, ast.Call) and _name(call.func) in names | MAKERS:
                texts = [*call.args, *(word.value for word in call.keywords if word.arg in PARTS)]
                for text in texts:
                    template = _template(text)
                    if template and " " in template:
                        found.setdefault(template, path.relative_to(SOURCE).as_posix())
    return found


def of_specs():
    """What is said of the parameters: templates without their numbers."""
    found = set()
    for parameter in (one for spec in SPECS for one in parameters(spec).values()):
        if parameter.kinds[0].type in (float, int):
            texts = {f"the {parameter.noun}", parameter.must_be, parameter.remedy.removesuffix("; or leave it out")}
            found |= {re.sub(r"(?<![\w.])-?\d[\d.e-]*(?!\w)", "{}", text) for text in texts}
    return found | {"{} must be {}", "{}; or leave it out"}


def of_fields():
    """Label and sentence of each field of the form."""
    records = [one.record() for one in form_fields().values()]
    rows = ("bends", "outside")
    return {one[part] for one in records if one["kind"] not in rows for part in ("label", "help")} - {""}


def _name(func):
    return func.id if isinstance(func, ast.Name) else getattr(func, "attr", "")


def _template(node):
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
    return None


def test_all_messages_of_the_form_are_german_too():
    found = messages()
    assert len(found) > 200
    missing = {
        text: place
        for text, place in found.items()
        if text not in GERMAN and not place.startswith(ELSEWHERE) and not text.startswith(PYTHON)
    }
    assert missing == {}


def test_all_that_is_said_of_parameters_is_german_too():
    plain = {re.sub(r"(?<![\w.])-?\d[\d.e-]*(?!\w)", "{}", text) for text in GERMAN}
    assert of_specs() - plain == set()


def test_labels_and_texts_of_the_fields_are_german_too():
    assert of_fields() - GERMAN.keys() == set()


def test_translations_fill_in_what_the_messages_do():
    for english, german in GERMAN.items():
        assert german and english.count("{}") >= german.count("{}"), english
        assert english == german or not re.search(r"\b(the|and|with)\b", german), german


def test_translated_messages_are_those_of_the_code():
    code = "".join(path.read_text(encoding="utf-8") for path in SOURCE.rglob("*.py"))
    code = re.sub(r'"\s*\n\s*f?"', "", code)  # texts over several lines
    pieces = {piece for text in GERMAN.keys() - of_specs() - of_fields() for piece in text.split("{}")}
    assert {piece for piece in pieces if json.dumps(piece)[1:-1] not in code and piece not in code} == set()
