"""The U-bend of NUMISHEET 93 in plane strain: 70 mm of stroke under a holder with friction, beside CalculiX.

    python benchmarks/ubend.py --page docs/performance-codes.md
    python benchmarks/ubend.py --calculix 600        # with so many seconds for CalculiX
    python benchmarks/ubend.py --deck ubend.inp      # only writes the deck of CalculiX

Half of a blank of 350 x 35 x 0.78 mm, one millimetre of its width. Tools and hardening are those widely used for the
benchmark; friction and force of the holder are from "Springback of two-dimensional draw bending" in Abaqus' Example
Problems.
"""

from __future__ import annotations

import argparse
import resource
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

import needs_book  # noqa: F401
import pages
import record
from umform_book.calculix import element, node_set

THICKNESS, LENGTH, STROKE = 0.78, 175.0, 70.0
MU, HOLDING = 0.144, 2450.0 / 35.0 / 2.0  # N per millimetre of width, on half of the blank
PUNCH, DIE, RADIUS = 25.0, 26.0, 5.0  # half widths
PENALTY, HOLDER_PENALTY = 1000.0, 60.0
#: Ratio of the stick slope of CalculiX to the penalty; with 1 its iterations diverge after some millimetres.
STICK = 0.05
CELLS, LAYERS = 175, 2  # layers: of CalculiX' elements with incompatible modes
E, NU, SWIFT = 206e3, 0.3, (565.32, 0.007117, 0.2589)
#: Nodes of a flat part of a tool are so far apart, and so many facets make a quarter of a circle.
FLAT, ARC = 2.0, 40


def build(
    friction: float | None = MU, stroke: float = STROKE, rule: str = "points", mesh: Any = None, stiffer: float = 1.0
) -> tuple[Any, list[Any]]:
    """Model and steps in umform; another mesh has its lower face at z = 0, all penalties can be stiffer."""
    import umform as uf

    if mesh is None:
        mesh = uf.mesh.strip(LENGTH, 1.0, THICKNESS, (CELLS, 1))
        mesh = mesh.moved((0.0, 0.0, THICKNESS / 2))
    model = uf.Model(mesh, "BEND8", material=uf.J2(E=E, nu=NU, hardening=uf.Swift(*SWIFT)))
    model.symmetry("x0", normal="x")
    model.fix(lambda x, y, z: x > -1.0, "y")
    die = model.tool("die", uf.UDie(2 * DIE, 200.0, RADIUS, RADIUS))
    holder = model.tool("holder", uf.Plane((0, 0, THICKNESS), (0, 0, -1)))
    punch = model.tool("punch", uf.Box((0, 0, THICKNESS + 100), (2 * PUNCH, 100, 200), RADIUS))
    each = {rule: 3, "friction": friction}
    model.contact("lower", die, name="on_die", penalty=stiffer * PENALTY, **each)
    model.contact("upper", holder, name="under_holder", penalty=stiffer * HOLDER_PENALTY, **each)
    model.contact("upper", punch, name="under_punch", penalty=stiffer * PENALTY, **each)
    hold, ram = model.press(holder, "z", name="hold"), model.drive(punch, "z", name="stroke")
    return model, [uf.Move(hold, to=-HOLDING, steps=2), uf.Move(ram, to=-stroke)]


def in_umform(friction: float | None, stroke: float, rule: str) -> dict[str, Any]:
    """Run it in this process."""
    import umform as uf

    uf.set_threads(1)
    model, steps = build(friction, stroke, rule)
    start = time.process_time()
    result = uf.solve(model, steps, progress=False, frames=0)
    iterations = result["iterations"][3:]
    return {
        "what": f"umform, BEND8, 3 x 3 {rule}" + ("" if friction else ", without friction"),
        "stroke": -result["stroke"][-1],
        "force": result["punch_fz"][-1],
        "CPU s": time.process_time() - start,
        "increments": len(result) - 1,
        "iterations": int(result["iterations"].sum()),
        "median": float(np.median(iterations)),
        "discarded": result.timing.attempts.share,
    }


# CalculiX ----------------------------------------------------------------------------------------------------


def sections() -> dict[str, np.ndarray[Any, np.dtype[np.float64]]]:
    """Polygons of die, holder and punch with the sheet on their left, seen against y."""

    def line(*ends: tuple[float, float]) -> list[Any]:
        (a, b), (c, d) = ends
        return np.linspace((a, b), (c, d), max(2, round(np.hypot(c - a, d - b) / FLAT))).tolist()

    def arc(x: float, z: float, first: float, last: float) -> list[Any]:
        angle = np.radians(np.linspace(first, last, ARC + 1))
        return np.stack([x + RADIUS * np.cos(angle), z + RADIUS * np.sin(angle)], axis=1).tolist()

    far, t, foot = LENGTH + 10.0, THICKNESS, THICKNESS + RADIUS
    die = [
        *line((far, 0), (DIE + RADIUS, 0)),
        *arc(DIE + RADIUS, -RADIUS, 90, 180)[1:],
        *line((DIE, -RADIUS), (DIE, -90))[1:],
    ]
    punch = [
        *line((0, t), (PUNCH - RADIUS, t)),
        *arc(PUNCH - RADIUS, foot, -90, 0)[1:],
        *line((PUNCH, foot), (PUNCH, 90))[1:],
    ]
    return {"DIE": np.array(die), "HOLDER": np.array(line((DIE + RADIUS, t), (far, t))), "PUNCH": np.array(punch)}


def deck(
    mesh: Any = None, friction: float | None = MU, stroke: float = STROKE, ways: tuple[float, float] = (0.07, 0.28)
) -> list[str]:
    """Lines of the deck: solid elements with incompatible modes, rigid tools of facets, contact of surfaces.

    The ways of the punch in the first increment and in one at most are given; its force is printed.
    """
    import umform as uf

    if mesh is None:
        mesh = uf.mesh.strip(LENGTH, 1.0, THICKNESS, (CELLS, 1), layers=LAYERS)
        mesh = mesh.moved((0.0, 0.0, THICKNESS / 2))
    points = mesh.points
    cells = mesh.connectivity
    made = ["*NODE,NSET=NSHEET", *(f"{n},{x:.9g},{y:.9g},{z:.9g}" for n, (x, y, z) in enumerate(points.tolist(), 1))]
    made.append("*ELEMENT,TYPE=C3D8I,ELSET=SHEET")
    for number, nodes in enumerate((cells + 1).tolist(), 1):
        made += element(number, nodes)
    node, count, held = len(points), len(cells), {}
    for name, section in sections().items():
        first, made_nodes = node, [f"*NODE,NSET=N{name}"]
        ahead = np.gradient(section, axis=0)
        out = np.stack([ahead[:, 1], -ahead[:, 0]], axis=1) / np.linalg.norm(ahead, axis=1)[:, None]
        for outer, inner in zip(section, section - out, strict=True):
            for x, z in (outer, inner):
                for y in (-0.1, 1.1):
                    node += 1
                    made_nodes.append(f"{node},{x:.9g},{y:.9g},{z:.9g}")
        made += [*made_nodes, f"*ELEMENT,TYPE=C3D8,ELSET={name}"]
        for i in range(len(section) - 1):
            a, b = first + 4 * i, first + 4 * i + 4
            count += 1
            made += element(count, (a + 3, a + 4, b + 4, b + 3, a + 1, a + 2, b + 2, b + 1))
        held[name] = node + 1, node + 2
        made += ["*NODE", *(f"{n},0,0,0" for n in held[name])]
        made += [f"*RIGID BODY,NSET=N{name},REF NODE={held[name][0]},ROT NODE={held[name][1]}"]
        made += [f"*SURFACE,NAME=S{name}", f"{name},S2"]
        node += 2
    strains = np.concatenate([[0.0], np.geomspace(1e-3, 2.0, 60)])
    K, e0, n = SWIFT
    made += ["*MATERIAL,NAME=STEEL", "*ELASTIC", f"{E},{NU}", "*PLASTIC"]
    made += [f"{K * (e0 + p) ** n:.7g},{p:.7g}" for p in strains.tolist()]
    made += ["*SOLID SECTION,ELSET=SHEET,MATERIAL=STEEL", "*MATERIAL,NAME=TOOL", "*ELASTIC", f"{E},{NU}"]
    made += [f"*SOLID SECTION,ELSET={name},MATERIAL=TOOL" for name in held]
    made += ["*SURFACE,NAME=SLOWER", *(f"{e + 1},S1" for e in mesh.face_set("lower")[:, 0].tolist())]
    made += ["*SURFACE,NAME=SUPPER", *(f"{e + 1},S2" for e in mesh.face_set("upper")[:, 0].tolist())]
    for name, face in (("DIE", "SLOWER"), ("HOLDER", "SUPPER"), ("PUNCH", "SUPPER")):
        penalty = HOLDER_PENALTY if name == "HOLDER" else PENALTY
        made += [
            f"*SURFACE INTERACTION,NAME=I{name}",
            "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR",
            f"{penalty},0.,0.01",
        ]
        made += [] if friction is None else ["*FRICTION", f"{friction},{STICK * penalty:g}"]
        made += [f"*CONTACT PAIR,INTERACTION=I{name},TYPE=SURFACE TO SURFACE", f"{face},S{name}"]
    made += node_set("MIDDLE", (np.flatnonzero(points[:, 0] < 1e-9) + 1).tolist())
    free = {"DIE": "", "HOLDER": "3", "PUNCH": ""}
    made += node_set("RAM", [held["PUNCH"][0]])
    made += ["*BOUNDARY", "NSHEET,2,2", "MIDDLE,1,1"]
    for name, (reference, rotation) in held.items():
        made += [f"{reference},{axis},{axis}" for axis in "123" if axis != free[name]] + [f"{rotation},1,3"]
    step = ["*STEP,NLGEOM,INC=100000", "*STATIC,SOLVER=SPOOLES"]
    made += [*step, "0.1,1.,1e-9,0.5", "*CLOAD", f"{held['HOLDER'][0]},3,{-HOLDING}", "*END STEP"]
    made += [*step, f"{ways[0] / stroke:.3g},1.,1e-9,{ways[1] / stroke:.3g}"]
    made += ["*BOUNDARY", f"{held['PUNCH'][0]},3,3,{-stroke}"]
    return [*made, "*NODE PRINT,NSET=RAM,TOTALS=ONLY", "RF", "*END STEP"]


def run_deck(folder: Path, lines: list[str], seconds: float) -> None:
    """Run a deck in ccx in a folder, for so many CPU seconds at most."""
    (folder / "job.inp").write_text("\n".join(lines) + "\n", encoding="ascii")

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds) + 5))

    subprocess.run(
        ["ccx", "job"],
        cwd=folder,
        capture_output=True,
        preexec_fn=limit,
        check=False,
        env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"},
    )


def in_calculix(seconds: float) -> dict[str, Any] | None:
    """Run it in ccx, if there is one, for so many CPU seconds at most."""
    if not shutil.which("ccx"):
        return None
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run_deck(folder, deck(), seconds)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        rows = [line.split() for line in (folder / "job.sta").read_text().splitlines()[2:]]
        done = [row for row in rows if row[0] == "2" and not row[2].endswith("U")]
        return {
            "what": "CalculiX, C3D8I in two layers",
            "stroke": STROKE * (float(done[-1][5]) if done else 0.0),
            "CPU s": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
            "increments": sum(not row[2].endswith("U") for row in rows),
            "iterations": len((folder / "job.cvg").read_text().splitlines()[4:]),
        }


def table(rows: list[dict[str, Any]]) -> str:
    """Rows as a table in Markdown."""
    lines = [
        "| | stroke, mm | punch force, N/mm | CPU s | increments | iterations | discarded |",
        "|---|---:|---:|---:|---:|---:|---:|",
    ]
    for row in rows:
        force = f"{row['force']:.2f}" if "force" in row else ""
        discarded = f"{100 * row['discarded']:.1f} %" if "discarded" in row else ""
        counts = f"{row['increments']} | {row['iterations']}"
        lines.append(f"| {row['what']} | {row['stroke']:.1f} | {force} | {row['CPU s']:.0f} | {counts} | {discarded} |")
    return "\n".join(lines)


def main() -> None:
    """Run, print, and write where asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    record.add_option(parser)
    parser.add_argument("--page", type=Path, help="page that gets the table between its marks")
    parser.add_argument(
        "--calculix", type=float, default=600.0, metavar="SECONDS", help="CPU seconds for CalculiX; 0: none"
    )
    parser.add_argument("--stroke", type=float, default=STROKE, help="of umform alone")
    parser.add_argument("--deck", type=Path, metavar="FILE", help="write the deck of CalculiX, and run nothing")
    given = parser.parse_args()
    if given.deck is not None:
        given.deck.write_text("\n".join(deck()) + "\n", encoding="ascii")
        return
    rows = [in_umform(friction, given.stroke, rule) for rule in ("points", "cells") for friction in (MU, None)]
    if given.calculix > 0 and (row := in_calculix(given.calculix)) is not None:
        rows.append(row)
    print(table(rows))
    for with_friction, without in (rows[:2], rows[2:4]):
        more = with_friction["median"] / without["median"]
        print(f"{with_friction['what']}: iterations an increment, median, over those without friction: {more:.2f}")
    if given.page is not None:
        pages.put(given.page, "ubend", table(rows))
    numbers = {f"{row['what']}: {key}": row[key] for row in rows for key in ("stroke", "CPU s", "iterations")}
    record.write(given.json, "ubend", numbers)


if __name__ == "__main__":
    main()
