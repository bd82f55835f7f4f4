"""Arguments of another kind are refused by name, and not by an error of Python."""

import pytest

import umform as uf
from umform.errors import InvalidValue


def strip():
    model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (2, 1)), material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    return model


def run():
    model = strip()
    tip = model.prescribe("x1_lower", "z", name="tip")
    return uf.solve(model, uf.Move(tip, to=-0.1, steps=1), progress=False)


def pressed():
    model = strip()
    model.press(model.contact("lower", uf.Plane((0.0, 0.0, -0.2), (0.0, 0.0, 1.0)), penalty=100), "z", name="press")
    return model


CALLS = {
    "evaluate": lambda: strip().evaluate(None),
    "evaluate a list": lambda: strip().evaluate([0.0] * 36),
    "evaluate pressed": lambda: pressed().evaluate(pressed().u),
    "toward": lambda: strip().state.toward("x"),
    "set_threads": lambda: uf.set_threads(0),
    "set_threads of a half": lambda: uf.set_threads(1.5),
    "rolling_at": lambda: uf.rolling_at("x"),
    "sweep": lambda: uf.sweep(None),
    "solve": lambda: uf.solve("x", []),
    "resume": lambda: uf.resume(None, strip(), []),
    "OpenRun": lambda: uf.OpenRun(None),
    "Stage": lambda: uf.Stage(None, strip),
    "solve_stages": lambda: uf.solve_stages(None),
    "derivatives": lambda: uf.derivatives(lambda: (strip(), []), {}),
    "write": lambda: run().write(None),
    "report": lambda: run().report(3),
    "column": lambda: run()[3],
    "mesh.read": lambda: uf.mesh.read(None),
    "write_tool": lambda: uf.write_tool(uf.Sphere((0.0, 0.0, 0.0), 5.0), None),
    "export_state": lambda: uf.export_state(uf.mesh.strip(10.0, 1.0, 0.2, (2, 1)), "part.k"),
}


@pytest.mark.parametrize("call", CALLS.values(), ids=list(CALLS))
def test_an_argument_of_another_kind(call):
    with pytest.raises(InvalidValue) as refused:
        call()
    assert refused.value.where and refused.value.cause and refused.value.remedy
