"""S-shaped rail with tools of our own: STL files of die and punch, and a sheet between them.

    python examples/s_rail.py [FOLDER] [DEPTH]

writes s_rail.stl, prints how it was read, and presses a coarse sheet 2 mm deep into it. With a depth it writes the
tools of a press too, closes a holder, and draws the rail.
"""

import sys
from pathlib import Path

import meshio
import numpy as np

import umform as uf

LENGTH, SWAY, THICKNESS = 120.0, 15.0, 1.0
SECTION = uf.UDie(opening=44, depth=20, shoulder_radius=5, bottom_radius=5)
STEEL = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(strength=567.0, offset=0.0071, exponent=0.264))

#: The drawn rail: length, sway and width of the die, its radius, clearance with the punch, half the width of the blank.
RAIL, RAIL_SWAY, HALF, RADIUS, CLEARANCE, BLANK = 200.0, 25.0, 37.5, 5.0, 1.058, 85.0
SHEET, HOLDER_FORCE, MU, PENALTY = 0.92, 60e3, 0.11, 2e3


def sweep(
    profile: uf.Profile,
    path: Path,
    length: float,
    sway: float,
    beyond: float,
    chord: float,
    along: int,
    over: float = 0.0,
) -> Path:
    """Sweep a section along an S, from so much before its beginning to so much after its end; write the triangles."""
    curve = profile.points(chord, beyond=beyond)
    t = np.linspace(-over, 1.0 + over, along + 1)
    middle = np.c_[length * t, sway * np.cos(np.pi * t)]
    slope = np.c_[np.full(t.shape, length), -sway * np.pi * np.sin(np.pi * t)]
    left = np.c_[-slope[:, 1], slope[:, 0]] / np.hypot(*slope.T)[:, None]
    points = np.empty((len(t), len(curve), 3))
    points[..., :2] = middle[:, None] + curve[None, :, :1] * left[:, None]
    points[..., 2] = curve[None, :, 1]
    at = np.arange(points[..., 0].size).reshape(points.shape[:2])
    a, b, c, d = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel(), at[1:, :-1].ravel()
    triangles = np.vstack([np.c_[a, b, c], np.c_[a, c, d]])
    meshio.write(path, meshio.Mesh(points.reshape(-1, 3), [("triangle", triangles)]), binary=True)
    return path


def write_die(path: Path, chord: float = 0.1, along: int = 60) -> Path:
    """The die of the pressed sheet."""
    return sweep(SECTION.profile, path, LENGTH, SWAY, 30.0, chord, along)


def press(die: uf.Triangulated, depth: float, cells: tuple[int, int] = (18, 14)) -> uf.Result:
    """Press a sheet on the die by the counterpart of the die, from where both touch it."""
    sheet = uf.mesh.strip(LENGTH - 20.0, 80.0, THICKNESS, cells)
    sheet = sheet.transformed(lambda x: x + np.array([10.0, -40.0, 0.5 * THICKNESS]))
    model = uf.Model(sheet, "ANS3DEAS", material=STEEL)
    model.contact("lower", die, penetration=0.02, points=2, friction=0.1, name="die")
    middle = model.contact("upper", die.counterpart(THICKNESS).moved((0, 0, 20.0)), penetration=0.02, name="punch")
    way = model.drive(middle, "z", name="way")
    model.fix("x0", "x")
    return uf.solve(model, uf.Move(way, -depth, steps=8))


def blank(turn: float, along: int) -> uf.Mesh:
    """A blank whose lines follow the S, and turn by no more than an angle over the radii that metal slides over."""
    over = uf.mesh.Bent(HALF - 6.5, 2.0 * HALF, RADIUS + 0.5 * SHEET, "die and punch")
    sizes = uf.mesh.bending_sizes(0.0, BLANK, [over], turn=turn, largest=10.0)
    print(sizes)
    lines = np.r_[-sizes.ends[:0:-1], sizes.ends]
    flat = uf.mesh.grid(np.linspace(0.0, RAIL, along + 1), lines, [0.0, SHEET])

    def along_the_s(x: np.ndarray) -> np.ndarray:
        share = np.clip((BLANK - np.abs(x[:, 1])) / 35.0, 0.0, 1.0)
        return np.c_[x[:, 0], x[:, 1] + share * RAIL_SWAY * np.cos(np.pi * x[:, 0] / RAIL), x[:, 2]]

    return flat.transformed(along_the_s)


def draw(folder: Path, depth: float, turn: float = 36.0, along: int = 20, steps: int = 120) -> uf.Result:
    """Draw the rail: a holder under force, a punch by its way."""
    shoulders = [(HALF + 60, 0), (HALF, 0), (HALF, -60), (-HALF, -60), (-HALF, 0), (-HALF - 60, 0)]
    inner = HALF - CLEARANCE
    sections = {
        "die": uf.Profile.from_corners(shoulders, [0, RADIUS, 3, 3, RADIUS, 0], closed=False),
        "punch": uf.Profile.from_corners(
            [(-inner, 60), (-inner, 0), (inner, 0), (inner, 60)], [0, RADIUS, RADIUS, 0], False
        ),
    }
    tools = {}
    for name, section in sections.items():
        file = sweep(section, folder / f"s_rail_{name}.stl", RAIL, RAIL_SWAY, 80.0, 0.05, 80, over=0.1)
        tools[name] = uf.Triangulated.from_stl(file, open=True)
        print(tools[name])
    model = uf.Model(blank(turn, along), "ANS3DEAS", material=STEEL, thickness_points=5)
    touch = {"penalty": PENALTY, "points": 2, "friction": MU}
    model.contact("lower", tools["die"], name="die", **touch)
    holder = model.contact("upper", uf.Plane((0, 0, SHEET), normal=(0, 0, -1)), name="holder", **touch)
    punch = model.contact("upper", tools["punch"].moved((0, 0, SHEET)), name="punch", **touch)
    way, hold = model.drive(punch, "-z", name="way"), model.press(holder, "-z", name="hold")
    return uf.solve(model, [uf.Close(hold, HOLDER_FORCE), uf.Move(way, depth, steps=steps)])


def main() -> None:
    """Write, read, press; or draw."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    if len(sys.argv) > 2:
        result = draw(folder, float(sys.argv[2]))
        print(f"punch at {result['way'][-1]:.4g} mm: {abs(result['way_force'][-1]) / 1e3:.4g} kN")
        print(result.write(folder / "s_rail.vtkhdf"))
        return
    die = uf.Triangulated.from_stl(write_die(folder / "s_rail.stl"), open=True)
    print(die)
    result = press(die, 2.0)
    print(f"force of the punch: {result['way_force'][-1]:.4g} N")


if __name__ == "__main__":
    main()
