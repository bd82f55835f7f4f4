"""Die of an S-shaped rail from an STL file, its punch from the die, and a sheet that is pressed between them.

    python examples/s_rail.py [FOLDER]

writes s_rail.stl, says how it was read, and presses a coarse sheet 2 mm deep.
"""

import sys
from pathlib import Path

import meshio
import numpy as np

import umform as uf

LENGTH, SWAY, THICKNESS = 120.0, 15.0, 1.0
SECTION = uf.UDie(opening=44, depth=20, shoulder_radius=5, bottom_radius=5)
STEEL = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(strength=567.0, offset=0.0071, exponent=0.264))


def write_die(path: Path, chord: float = 0.1, along: int = 60) -> Path:
    """Sweep a section along an S, and write the triangles."""
    curve = SECTION.profile.points(chord, beyond=30.0)
    t = np.linspace(0.0, 1.0, along + 1)
    middle = np.c_[LENGTH * t, SWAY * np.cos(np.pi * t)]
    slope = np.c_[np.full(t.shape, LENGTH), -SWAY * np.pi * np.sin(np.pi * t)]
    left = np.c_[-slope[:, 1], slope[:, 0]] / np.hypot(*slope.T)[:, None]
    points = np.empty((len(t), len(curve), 3))
    points[..., :2] = middle[:, None] + curve[None, :, :1] * left[:, None]
    points[..., 2] = curve[None, :, 1]
    at = np.arange(points[..., 0].size).reshape(points.shape[:2])
    a, b, c, d = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel(), at[1:, :-1].ravel()
    triangles = np.vstack([np.c_[a, b, c], np.c_[a, c, d]])
    meshio.write(path, meshio.Mesh(points.reshape(-1, 3), [("triangle", triangles)]), binary=True)
    return path


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


def main() -> None:
    """Write, read, press."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    die = uf.Triangulated.from_stl(write_die(folder / "s_rail.stl"), open=True)
    print(die)
    result = press(die, 2.0)
    print(f"force of the punch: {result['way_force'][-1]:.4g} N")


if __name__ == "__main__":
    main()
