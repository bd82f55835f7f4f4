"""The ready processes, on coarse meshes: air bend, bottoming, sequence, hem, bead, cup, U-bend; and loads alone."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import umform as uf
from corpus.answers import LEFT_RIGHT, Answer, carried, unlike
from corpus.laws import law
from umform import sheet_metals
from umform.analysis.steps import Step
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.air_bending.bottoming import with_travel
from umform.processes.bend_sequence import Bend, BendSequence, bend_sequence
from umform.processes.draw.cup import Cup
from umform.processes.draw.u_bend import UBend
from umform.processes.draw_bead.case import build
from umform.processes.draw_bead.spec import DrawBead
from umform.processes.hemming import Hemming, hemming
from umform.processes.hemming.spec import acute

_COARSE: dict[str, Any] = {"elements_per_thickness": 1.0, "layers": 1}
_AS_BENDS: dict[str, Any] = {"element": AirBending.element}


def air_bend(*, metal: str = "DC04", travel: float | None = None, **keys: Any) -> Answer:
    """An air bend; with a travel the punch is pressed onto the flanks."""
    case = AirBending(material=sheet_metals.get(metal).law, **_COARSE | keys)
    if travel is not None:
        case = with_travel(replace(case, die_angle=88.0, punch_angle=88.0, bottoming=True), travel)
    result = air_bending(case, frames=1, progress=False).result
    return Answer([result], tools=[carried(result, [tool.name for tool in result.model.tools])])


def sequence() -> Answer:
    """Two bends of a strip, one after the other in the same state."""
    bends = (Bend(25.0, stroke=3.0), Bend(55.0, stroke=3.0))
    part = bend_sequence(BendSequence(80.0, bends, AirBending(**_COARSE)), frames=1, progress=False)
    results = [bend.result for bend in part.bends]
    return Answer(results, tools=[carried(result, [tool.name for tool in result.model.tools]) for result in results])


def hem(**keys: Any) -> Answer:
    """A hem over an insert."""
    sheet = acute(**_COARSE | _AS_BENDS)
    hem = hemming(Hemming(form="insert", base=13.0, sheet=sheet, **keys), tolerance=5.0, frames=1, progress=False)
    return Answer([hem.result], tools=[carried(hem.result, [tool.name for tool in hem.result.model.tools])])


def bead(*, name: str = "swift", way: float = 6.0, **keys: Any) -> Answer:
    """A strip is drawn through a bead of real geometry."""
    small = {"thickness": 1.0, "radius": 4.0, "height": 3.0, "groove_radius": 3.0, "elements": 5.0}
    model, (close, pull) = build(DrawBead(material=law(name)["material"], **small | keys))
    steps = [close, replace(pull, to=way)]
    result = uf.solve(model, steps, frames=0, progress=False)
    return Answer([result], tools=[carried(result, ["lower_tool", "upper_tool"])])


def draw(case: Cup | UBend, options: uf.NewtonOptions | None = None) -> Answer:
    """The closing, the stroke and the opening of a press; by default as tight as other jobs."""
    model, press = case.build()
    result = uf.solve(model, press.closing, options=options, frames=0, progress=False)
    released = uf.solve(model, press.opening, options=options, frames=0, progress=False)
    return Answer([result, released], tools=[carried(result, [tool.name for tool in model.tools])])


def arch(*, element: str = "ANS3DEAS", spherical: bool = False, increment: float = 0.005) -> Answer:
    """A shallow arch snaps through; the path goes over both limit points."""
    mesh = uf.mesh.strip(20.0, 1.0, 0.2, (16, 1)).transformed(lambda X: X - [10.0, 0.0, 0.0])
    mesh = mesh.transformed(lambda X: X + [0.0, 0.0, 0.5] * (1.0 - (X[:, :1] / 10.0) ** 2))
    model = uf.Model(mesh, element, material=uf.SVK(E=1000.0, nu=0.0))
    for end in ("x0", "x1"):
        model.hinge(end, "xz")
    model.fix(range(len(mesh.points)), "y")
    force = model.force(lambda x, y, z: abs(x) < 1e-9, (0.0, 0.0, -1.0), "force")
    path = uf.Arc(force, 0.5, increment=increment, grow=1.0, kind="spherical" if spherical else "cylindrical")
    return Answer([uf.solve(model, path, frames=0, progress=False)], [unlike(model, model, LEFT_RIGHT)])


def freed(*, name: str = "linear", element: str = "ANS3DEAS") -> Answer:
    """A strip is bent between clamps beyond yield, then a clamp is freed."""
    cell = uf.elements.element(element).cell
    model = uf.Model(uf.mesh.strip(20.0, 2.0, 1.0, (16, 1), cell=cell), element, **law(name))
    model.fix("x0")
    clamp = model.fix("x1", "xy")
    tip = model.prescribe("x1", "z", "tip")
    steps: list[Step] = [uf.Move(tip, -1.0, steps=8), uf.Release(tip), uf.Free(clamp, steps=4)]
    return Answer([uf.solve(model, steps, frames=0, progress=False)])
