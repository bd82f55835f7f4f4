"""The drawing is read again by ezdxf, and by FreeCAD where it is installed."""

from __future__ import annotations

import json
import math
import shutil
import subprocess

import ezdxf
import numpy as np
import pytest
from brackets import BRACKETS

from umform.flat_pattern.drawing import LAYERS, svg, write_dxf
from umform.surfaces.segments import Arc

UNFOLDED = [name for name, bracket in BRACKETS.items() if not bracket.refused]


@pytest.fixture(scope="session")
def dxf(pattern, tmp_path_factory):
    """DXF files of all patterns by the names of the brackets."""
    folder = tmp_path_factory.mktemp("dxf")
    files = {name: folder / f"{name.replace(' ', '-')}.dxf" for name in UNFOLDED}
    for name, path in files.items():
        write_dxf(path, pattern(name))
    return files


@pytest.mark.parametrize("name", UNFOLDED)
def test_ezdxf_reads_what_was_written(pattern, dxf, name):
    made, drawing = pattern(name), ezdxf.readfile(dxf[name])
    assert not drawing.audit().has_errors
    assert drawing.units == 4
    assert LAYERS.keys() <= {layer.dxf.name for layer in drawing.layers}
    by_layer = {layer: drawing.modelspace().query(f'*[layer=="{layer}"]') for layer in LAYERS}
    (outer,) = by_layer["CONTOUR"]
    assert _area(outer) == pytest.approx(made.outer.area, rel=1e-9)
    assert sorted(map(_area, by_layer["HOLES"])) == pytest.approx(sorted(hole.area for hole in made.holes), rel=1e-9)
    lines = [*by_layer["BEND_UP"], *by_layer["BEND_DOWN"]]
    length = sum((line.dxf.end - line.dxf.start).magnitude for line in lines)
    assert length == pytest.approx(sum(bend.length for bend in made.bends), rel=1e-9)
    for direction in ("up", "down"):
        count = sum(len(bend.lines) for bend in made.bends if bend.direction == direction)
        assert len(by_layer[f"BEND_{direction.upper()}"]) == count
    texts = sorted(text.dxf.text for text in by_layer["BEND_TEXT"])
    assert len(texts) == len(made.bends)
    for place, number in enumerate(made.order, start=1):
        bend = made.bends[number - 1]
        assert f"{place}: {bend.direction} {bend.angle:.4g}%%d R{bend.radius:.3g}" in texts


def _area(entity):
    if entity.dxftype() == "CIRCLE":
        return math.pi * entity.dxf.radius**2
    assert entity.closed
    x = np.array(entity.get_points("xyb"))
    ends = np.roll(x, -1, axis=0)
    area = 0.5 * float((x[:, 0] * ends[:, 1] - x[:, 1] * ends[:, 0]).sum())
    for (ax, ay, bulge), (bx, by, _) in zip(x, ends, strict=True):
        angle = 4.0 * math.atan(bulge)
        if angle:
            radius = math.hypot(bx - ax, by - ay) / (2.0 * math.sin(0.5 * abs(angle)))
            area += math.copysign(0.5 * radius**2 * (abs(angle) - math.sin(abs(angle))), angle)
    return area


def test_arcs_are_arcs_in_the_drawing(pattern, dxf):
    arcs = [segment for segment in pattern("rounded corners").outer.segments if isinstance(segment, Arc)]
    (outer,) = ezdxf.readfile(dxf["rounded corners"]).modelspace().query('*[layer=="CONTOUR"]')
    assert sum(1 for *_, bulge in outer.get_points("xyb") if bulge) == len(arcs) == 2


def test_the_picture_has_all_bends_and_contours(pattern):
    made = pattern("hole across the bend")
    text = svg(made)
    assert text.count("stroke-dasharray") == sum(len(bend.lines) for bend in made.bends)
    assert text.count("M ") == 1 + len(made.holes)
    assert "1: up 90°" in text
    assert [f">{size:.2f}</text>" in text for size in made.size] == [True, True]


@pytest.mark.skipif(shutil.which("freecadcmd") is None, reason="FreeCAD is not installed")
def test_freecad_reads_what_was_written(pattern, dxf, tmp_path):
    script, found = tmp_path / "read.py", tmp_path / "found.json"
    files = {name: str(path) for name, path in dxf.items()}
    script.write_text(
        "import json, FreeCAD, importDXF\n"
        "found = {}\n"
        f"for name, path in {files!r}.items():\n"
        "    document = FreeCAD.newDocument('part')\n"
        "    importDXF.insert(path, document.Name)\n"
        "    shapes = [one.Shape for one in document.Objects if hasattr(one, 'Shape')]\n"
        "    edges = [edge for shape in shapes for edge in shape.Edges]\n"
        "    boxes = [edge.BoundBox for edge in edges]\n"
        "    size = [max(b.XMax for b in boxes) - min(b.XMin for b in boxes)]\n"
        "    size += [max(b.YMax for b in boxes) - min(b.YMin for b in boxes)]\n"
        "    found[name] = [sum(edge.Length for edge in edges), *size]\n"
        "    FreeCAD.closeDocument(document.Name)\n"
        f"json.dump(found, open({str(found)!r}, 'w'))\n"
    )
    subprocess.run(["freecadcmd", str(script)], capture_output=True, timeout=200, check=False)
    read = json.loads(found.read_text())
    for name in UNFOLDED:
        made = pattern(name)
        contours = sum(segment.length for one in (made.outer, *made.holes) for segment in one.segments)
        length = contours + sum(bend.length for bend in made.bends)
        assert read[name] == pytest.approx([length, *made.size.tolist()], abs=2e-3)
