"""A tool that lies inside of a sheet is named, one on its outer face is not."""

import pytest

import umform as uf


@pytest.mark.parametrize(("face", "above", "named"), [("upper of base", 0.0, True), ("upper of cover", 0.8, False)])
def test_a_tool_between_two_sheets_is_named(face, above, named):
    """The cover ends in the middle of an element of the base: faces that it covers in part do not count."""
    base = uf.mesh.strip(8.0, 4.0, 1.0, (4, 2))
    cover = uf.mesh.strip(5.0, 4.0, 0.8, (4, 3)).moved((0.0, 0.0, 0.9))
    model = uf.Model(uf.mesh.together(base=base, cover=cover), "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    model.sheet_contact("upper of base", "lower of cover", name="stack")
    model.contact(face, uf.Plane((0.0, 0.0, 0.5 + above), normal=(0.0, 0.0, -1.0)), name="pad")
    for sheet in ("base", "cover"):
        model.fix(f"x0 of {sheet}", "xy")
    if named:
        model.fix("upper of cover", "z")
    lift = model.prescribe("lower of base", "z", "lift")
    result = uf.solve(model, uf.Move(lift, 0.002, steps=1), progress=False)
    assert result["pad_active"][-1] > 0 and result["stack_active"][-1] > 0
    found = [text for text in result.warnings if "at once" in text]
    assert len(found) == named
    if named:
        assert "contact pad and contact stack press 4 faces at once" in found[0]
