"""Pictures of formed parts for the gallery, README and site: one after the other; what has been run is not run again.

    python benchmarks/gallery.py                 # all (some 4 minutes of CPU)
    python benchmarks/gallery.py cup hem         # some

Results are kept in results/gallery; a run that was stopped begins again. Needs PyVista (extra view) and the
verification book.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import needs_book  # noqa: F401
import umform as uf
from umform.report.rendering import VIEW, Cut, Panel, Rendering, scaled, write_picture
from umform.report.skin import skin_of
from umform.report.stored_scene import read_frame
from umform.surfaces.triangles import Triangles
from umform_book.drawing import s_rail as rail
from umform_book.drawing.cups import NEWTON

RESULTS, PICTURES = Path("results/gallery"), Path("docs/images/gallery")
#: Width of pictures in pixels, without the scale.
WIDTH = 1000
THINNING, STRAIN = ("thickness_change", "thinning, %", -100.0), ("plastic_strain_max", "plastic strain", 1.0)
Field = tuple[str, str, float]


@dataclass(frozen=True)
class Shot:
    """What is drawn of a file of fields.

    Attributes
    ----------
    file : str
        In the folder of the results.
    frame : int
        Of the file.
    field : tuple
        Name, label and factor.
    view : tuple of float
        Azimuth and elevation of the observer in degrees.
    width : float
        Of a sheet in plane strain, which is as it is at any width; mm.
    tools : tuple
        Name, opacity, and height above its place of each tool that is drawn.
    cut : Cut, optional
        Plane that tools are drawn behind.
    limits : tuple of float, optional
        Of the scale.
    whole : bool
        Whether mirror images are drawn.
    ghost : tuple, optional
        File and frame of another state, drawn transparent.
    """

    file: str
    frame: int = -1
    field: Field = THINNING
    view: tuple[float, float] = VIEW
    width: float = 0.0
    tools: tuple[tuple[str, float, float], ...] = ()
    cut: Cut | None = None
    whole: bool = True
    lines: bool = True
    limits: tuple[float, float] | None = None
    ghost: tuple[str, int] | None = None


def panel(folder: Path, shot: Shot, title: str = "", width: int = WIDTH, *, scale: bool = True) -> Panel:
    """Draw one view."""
    part, tools = read_frame(folder / shot.file, shot.frame, whole=shot.whole)
    if shot.width:
        part = part.stretched(1, shot.width)
    name, label, factor = shot.field
    skin = skin_of(part, name, factor=factor)
    drawn = Rendering("the gallery", shot.view)
    scales = scaled(skin, label, shot.limits)
    drawn.add_sheet(skin, scales, lines=shot.lines)
    if shot.ghost:
        other, _ = read_frame(folder / shot.ghost[0], shot.ghost[1], whole=shot.whole)
        other = other.stretched(1, shot.width) if shot.width else other
        drawn.add_sheet(skin_of(other), lines=False, opacity=0.35)
    for tool, opacity, lift in shot.tools:
        surface = widened(tools[tool], 1.15 * shot.width) if shot.width else tools[tool]
        surface = Triangles(surface.points + np.array([0.0, 0.0, lift]), surface.triangles)
        drawn.add_tool(surface, cut=shot.cut, opacity=opacity)
    return Panel(drawn.image(width), scales if scale else None, title)


def widened(tool: Triangles, width: float) -> Triangles:
    """A tool of one section with another width."""
    points = tool.points.copy()
    y = points[:, 1]
    points[:, 1] = (y - y.min()) / np.ptp(y) * width - 0.5 * width
    return Triangles(points, tool.triangles)


def flanged_hole(folder: Path) -> None:
    """A hole of 26 mm is widened to a collar by a punch of 40 mm; the rim is clamped, a quarter is computed."""
    steel = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(strength=565.3, offset=0.0071, exponent=0.259))
    model = uf.Model(uf.mesh.ring(13.0, 36.0, 1.0, (14, 12), part="quarter"), "ANS3DEAS", material=steel)
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    model.fix("rim")
    die = uf.Profile.from_corners([(90.0, -0.5), (21.4, -0.5), (21.4, -90.0)], [0.0, 4.0, 0.0], closed=False)
    nose = uf.Profile.from_corners([(0.0, 0.5), (20.0, 0.5), (20.0, 90.0)], [0.0, 8.0, 0.0], closed=False)
    model.contact("lower", uf.Revolved(die), name="die", friction=0.1, points=2)
    punch = model.contact("upper", uf.Revolved(nose), name="punch", friction=0.1, points=2)
    stroke = model.drive(punch, "-z", name="stroke")
    uf.solve(model, uf.Move(stroke, 20.0, steps=60), frames=10).write(folder / "fields.vtkhdf")


def s_rail(folder: Path) -> None:
    """The S-rail of the verification book on its coarse mesh."""
    model, steps = rail.model_of(rail.MESHES[rail.COARSE])
    uf.solve(model, steps, options=NEWTON, frames=4).write(folder / "fields.vtkhdf")


def press_brake(folder: Path) -> Panel:
    """Tools of the press brake as they are, 60 mm long."""
    drawn = Rendering("the gallery", (-60.0, 22.0))
    box = ((-20.0, -30.0, -18.0), (20.0, 30.0, 34.0))
    cut = Cut((0.0, 1.0, 0.0), (0.0, -30.0, 0.0), 4.0)
    stations = (
        (uf.VDie(opening=16.0, angle=86.0, shoulder_radius=2.0), uf.Punch(tip_radius=1.5, angle=86.0, width=14.0)),
        (
            uf.UDie(opening=20.0, depth=14.0, shoulder_radius=4.0, bottom_radius=3.0),
            uf.Punch(tip_radius=4.0, angle=60.0),
        ),
        (uf.WipingDie(radius=3.0),),
    )
    for number, tools in enumerate(stations):
        for tool, lift in zip(tools, (0.0, 6.0), strict=False):
            surface = tool.triangles(box, chord=0.02)
            shift = [46.0 * number, 0.0, lift]
            drawn.add_tool(Triangles(surface.points + shift, surface.triangles), cut=cut, opacity=1.0)
    return Panel(drawn.image(WIDTH))


@dataclass(frozen=True)
class Entry:
    """A picture of the gallery.

    Attributes
    ----------
    title, text : str
        What it shows.
    run : tuple of str or callable
        Commands, in which FOLDER is that of the results, or a function of the folder.
    shots : tuple of Shot or callable
        What is drawn, side by side; or a function of the folder that draws it.
    titles : tuple of str
        Above each.
    """

    title: str
    text: str
    run: tuple[str, ...] | Callable[[Path], None] | None
    shots: tuple[Shot, ...] | Callable[[Path], Panel]
    titles: tuple[str, ...] = ()


def solid(*names: str, lift: float = 0.0) -> tuple[tuple[str, float, float], ...]:
    """Opaque tools; the punch is lifted."""
    return tuple((name, 1.0, lift if name == "punch" else 0.0) for name in names)


COARSE = "--elements-per-thickness 2 --layers 1 --increment 0.0125"
BESIDE = (-60.0, 26.0)
ENTRIES = {
    "air-bend": Entry(
        "Air bend",
        "Sheet of 2 mm in a V of 16 mm under load, so that 90 degrees are left after springback. Plane strain, drawn "
        "40 mm wide; the tools are cut.",
        ("umform bend --angle 90 --thickness 2 --opening 16 --material DC04 --out FOLDER",),
        (
            Shot(
                "bend.vtkhdf",
                -2,
                STRAIN,
                (-58.0, 24.0),
                width=40.0,
                tools=solid("die", "punch"),
                cut=Cut((0.0, 1.0, 0.0), (0.0, -12.0, 0.0), 1.0),
            ),
        ),
    ),
    "bracket": Entry(
        "Bracket of three bends",
        "One run after the other, each from the state that the bend before has left. Plane strain, drawn 50 mm wide.",
        (f"umform bend --sequence examples/bracket.toml --material DC04 {COARSE} --out FOLDER",),
        (Shot("part.vtkhdf", field=STRAIN, view=(-62.0, 28.0), width=50.0),),
    ),
    "hem": Entry(
        "Hem",
        "Bent to 40 degrees in an acute V, then flattened between plate and table until it touches itself. Plane "
        "strain, drawn 12 mm wide.",
        ("umform hem --material DC04 --base 14 --out FOLDER",),
        (Shot("hem.vtkhdf", field=STRAIN, view=(-60.0, 22.0), width=12.0, whole=False),),
    ),
    "u-bend": Entry(
        "U-bend with springback",
        "Drawn between punch, die and holder, and taken out: transparent at the end of the stroke, coloured after "
        "springback. Plane strain, drawn 35 mm wide.",
        ("umform draw u --no-extrapolate --out FOLDER",),
        (Shot("release.vtkhdf", field=STRAIN, view=(-60.0, 24.0), width=35.0, ghost=("draw.vtkhdf", -1)),),
    ),
    "cup": Entry(
        "Drawn cup",
        "The cup of the ESAFORM benchmark 2021: halfway between its tools, which are cut, and "
        "after springback with its ears. A quarter is computed.",
        ("umform draw cup --turn 12 --around 20 --material AA6016-T4 --out FOLDER",),
        (
            Shot(
                "draw.vtkhdf",
                14,
                view=(-65.0, 22.0),
                tools=solid("die", "holder", "punch"),
                cut=Cut((0.0, 1.0, 0.0), depth=3.0),
            ),
            Shot("release.vtkhdf", view=BESIDE),
        ),
    ),
    "box": Entry(
        "Square box",
        "NUMISHEET 93, aluminium, 15 mm deep. A quarter is computed.",
        ("umform new square-cup --out FOLDER.toml", "umform run FOLDER.toml --out FOLDER"),
        (Shot("fields.vtkhdf", view=(-60.0, 30.0)),),
    ),
    "s-rail": Entry(
        "S-rail",
        "Between tools of triangles, under a holder; the whole rail is computed.",
        s_rail,
        (Shot("fields.vtkhdf", view=(-60.0, 32.0)),),
    ),
    "dome": Entry(
        "Stretched dome",
        "A clamped disc over a ball of 50 mm, seen from below. A quarter is computed.",
        ("umform new dome --out FOLDER.toml", "umform run FOLDER.toml --out FOLDER"),
        (Shot("fields.vtkhdf", view=(-60.0, -28.0)),),
    ),
    "hole": Entry(
        "Flanged hole",
        "A hole of 26 mm is widened to a collar of 40 mm. The rim is clamped; a quarter is computed.",
        flanged_hole,
        (Shot("fields.vtkhdf", view=(-60.0, -30.0)),),
    ),
    "press-brake": Entry(
        "Tools of the press brake",
        "Punches, V-die, U-die and wiping die: exact surfaces of planes and arcs, cut to 60 mm.",
        None,
        press_brake,
    ),
}
INTRODUCTION = (
    "Computed and drawn by umform, on coarse meshes. Surfaces are those of the shape functions of the elements, lines "
    "are their edges. `umform view FIELDS.vtkhdf --png FILE.png` draws such a picture of any run: see "
    "[reports](reports.md#fields-in-pyvista-and-paraview)."
)
COMMAND = (
    '`make gallery` makes all pictures (some 4 minutes of CPU), `make gallery ARGS="cup hem"` some. Results are kept '
    "in `results/gallery`; without them a picture is run again."
)
#: First picture of README and site: entry, number of its shot, width in pixels, and whether with a scale.
MONTAGE = (("cup", 1, 430, True), ("u-bend", 0, 540, True))


def made(name: str) -> Path:
    """The folder of the results of an entry, which is run if it is not there."""
    entry, folder = ENTRIES[name], RESULTS / name
    if entry.run is None or (not callable(entry.shots) and (folder / entry.shots[0].file).is_file()):
        return folder
    print(f"{name}: running", flush=True)
    RESULTS.mkdir(parents=True, exist_ok=True)
    if callable(entry.run):
        folder.mkdir(exist_ok=True)
        entry.run(folder)
        return folder
    folder.with_suffix(".toml").unlink(missing_ok=True)  # the deck of a run that was stopped
    for command in entry.run:
        umform = str(Path(sys.executable).with_name("umform"))
        words = [
            str(folder) + word.removeprefix("FOLDER") if word.startswith("FOLDER") else word for word in command.split()
        ]
        subprocess.run([umform, *words[1:]], check=True, stdout=subprocess.DEVNULL)
    return folder


def draw(name: str) -> None:
    """Draw an entry."""
    entry, folder = ENTRIES[name], made(name)
    if callable(entry.shots):
        panels = [entry.shots(folder)]
    else:
        width = WIDTH if len(entry.shots) == 1 else 490
        titles = entry.titles or ("",) * len(entry.shots)
        panels = [panel(folder, shot, title, width) for shot, title in zip(entry.shots, titles, strict=True)]
    print(f"{name}: {write_picture(PICTURES / f'{name}.png', panels)}", flush=True)


def montage() -> None:
    """The first picture of README and site."""
    panels = []
    for name, number, width, scale in MONTAGE:
        shots = ENTRIES[name].shots
        assert not callable(shots)
        panels.append(panel(made(name), shots[number], width=width, scale=scale))
    write_picture(PICTURES / "formed.png", panels)


def page() -> str:
    """The page of the gallery."""
    lines = [
        "# Gallery",
        "",
        *textwrap.wrap(INTRODUCTION, 118),
        "",
        *textwrap.wrap(COMMAND, 118),
    ]
    for name, entry in ENTRIES.items():
        lines += [
            "",
            f"## {entry.title}",
            "",
            f"![{entry.title}](images/gallery/{name}.png)",
            "",
            *textwrap.wrap(entry.text, 118),
        ]
        if entry.run is not None and not callable(entry.run):
            commands = [f"$ {command}" for command in entry.run]
            lines += ["", "```console", *(one.replace("FOLDER", name) for one in commands), "```"]
        else:
            function = entry.run or entry.shots
            lines += ["", f"`{function.__name__}` in [benchmarks/gallery.py](../benchmarks/gallery.py)."]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Run what is missing, draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="entries; default: all, the first picture and the page")
    arguments = parser.parse_args()
    unknown = set(arguments.names) - set(ENTRIES)
    if unknown:
        parser.error(f"no such picture: {', '.join(sorted(unknown))}; there are {', '.join(ENTRIES)}")
    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in arguments.names or ENTRIES:
        draw(name)
    if not arguments.names:
        montage()
        Path("docs/gallery.md").write_text(page())


if __name__ == "__main__":
    main()
