"""Scatter of results: closed forms of a cantilever, whose force is a product; limits, held results, second runs."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import umform as uf
from umform.analysis.run.stages import Stage
from umform.errors import InvalidValue
from umform.processes.air_bending import AirBending
from umform.processes.draw.cup import ESAFORM, Cup
from umform.processes.draw.u_bend import NUMISHEET, UBend
from umform.processes.draw_bead import DrawBead
from umform.results.quantity import Quantity
from umform.studies.derivatives.subjects import OfFunction
from umform.studies.scatter import Limits
from umform.studies.scatter.found import RESULTS
from umform.studies.scatter.second_run import _corrected
from umform.studies.scatter.study import Plan

VALUES = {"E": 210e3, "deflection": 0.1}

STEEL = uf.sheet_metals.get("DC04").law


def build(E, deflection, length=10.0, cells=8):
    model = uf.Model(uf.mesh.strip(length, 1.0, 0.2, (cells, 1)), material=uf.SVK(E=E, nu=0.3))
    model.fix("x0")
    return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-deflection, steps=4)


def force(result):
    return Quantity("force", "N", 4, value=-float(result["tip_force"][-1]))


def steep(result):
    """Far from linear in the force."""
    return math.exp(300.0 * force(result).value)


def bow(result):
    """As far from linear, and nothing but round-off beside the force."""
    return Quantity("bow", "N", 4, value=1e-20 * steep(result))


def scatter(sources, of=(force,), function=build, **rest):
    return uf.scatter(function, sources, of, **{"values": VALUES, "progress": False} | rest)


def test_standard_deviation_and_shares_of_a_product():
    found = scatter({"E": "3%", "deflection": uf.Scatter(0.012, tolerance=True)})["force"]
    assert found.deviation.value == pytest.approx(0.05 * found.mean.value, rel=1e-3)
    assert [one.value for one in found.shares.values()] == pytest.approx([36.0, 64.0], abs=0.1)
    assert found.largest == "deflection"
    assert found.deviation.unit == "N"


def test_round_off_is_no_warning():
    found = scatter({"E": "3%"}, of=(force, steep, bow))
    warned = " ".join(found.warnings)
    assert "changes steep" in warned
    assert "bow" not in warned


def twice(size, decimals):
    """A result near 1 that changes by twice of what its derivative predicts: by `size` more."""

    def bent(result):
        part = (force(result).value / 0.0426353606 - 1.0) / 0.06
        return Quantity("bent", "N", decimals, value=1.0 + size * (part + part**2))

    return bent


@pytest.mark.parametrize(
    ("size", "decimals", "warned"), [(1e-2, None, True), (1e-3, None, False), (1e-2, 3, True), (1e-2, 2, False)]
)
def test_waves_of_a_mesh_and_hidden_digits_are_no_warning(size, decimals, warned):
    found = scatter({"E": "3%"}, of=(twice(size, decimals),))
    assert found.second_runs[0].difference("bent") == pytest.approx(0.5, rel=1e-2)
    assert bool(found.warnings) == warned


@pytest.mark.parametrize("r", [-0.5, 0.8, 1.0])
def test_shares_by_covariance_with_correlations(r):
    found = scatter({"E": "3%", "deflection": "4%"}, correlations={("deflection", "E"): r})["force"]
    variance = 9.0 + 16.0 + 2.0 * r * 12.0
    assert found.deviation.value == pytest.approx(0.01 * math.sqrt(variance) * found.mean.value, rel=1e-3)
    expected = [100.0 * (9.0 + 12.0 * r) / variance, 100.0 * (16.0 + 12.0 * r) / variance]
    assert [one.value for one in found.shares.values()] == pytest.approx(expected, abs=0.2)


def test_capability():
    limits = Limits.of("89:91")
    assert (limits.cp(0.25), limits.cpk(90.25, 0.25)) == pytest.approx((4.0 / 3.0, 1.0))
    assert limits.outside(90.0, 1.0) == pytest.approx(0.3173105, rel=1e-6)
    assert Limits.of(":91").cp(0.25) is None
    assert Limits.of(":91").cpk(90.25, 0.25) == pytest.approx(1.0)
    found = scatter({"E": "3%"}, limits={"force": (0.0, None)})["force"]
    assert [one.name for one in found.quantities[-3:]] == ["force.cp", "force.cpk", "force.beyond_the_limits"]
    assert found.capability[1].value == pytest.approx(100.0 / 9.0, rel=1e-3)


def test_a_held_result_moves_the_scatter_to_the_parameter_that_follows():
    found = scatter({"E": "3%"}, hold={"force": "deflection"})
    assert found["force"].deviation.value == 0.0
    assert found["force"].largest is None
    assert found["deflection"].deviation.value == pytest.approx(0.003, rel=1e-3)
    (second,) = found.second_runs
    assert second.predicted["deflection"] == pytest.approx(-0.006, rel=1e-3)
    assert second.found["deflection"] == pytest.approx(0.1 / 1.06 - 0.1, rel=5e-3)


def test_a_second_run_confirms_the_first_order():
    found = scatter({"E": "3%", "deflection": "1%"})
    (second,) = found.second_runs
    assert (second.path, second.step) == ("E", pytest.approx(12600.0))
    assert second.difference("force") < 1e-3
    assert found.warnings == []
    assert found["force"].mean.band.error < 1e-3 * found["force"].deviation.value


def test_a_second_run_shows_that_the_first_order_does_not_hold():
    found = scatter({"E": "3%"}, [steep, force])
    (second,) = found.second_runs
    base = math.log(found["steep"].mean.value)
    assert second.found["steep"] == pytest.approx(math.exp(1.06 * base) - math.exp(base), rel=1e-2)
    (warning,) = found.warnings
    assert "changes steep by more than 20 %" in warning
    assert "umform sweep over E" in warning
    curvature = second.found["steep"] - second.predicted["steep"]
    assert found["steep"].mean.band.error == pytest.approx(curvature / 4.0)
    assert found["steep"].deviation.band.error == pytest.approx(curvature / 2.0, rel=1e-3)
    of_mesh = [replace(one, mean=replace(one.mean, of_mesh=True)) for one in found]
    assert replace(found, spreads=tuple(of_mesh)).tables[RESULTS] == found.tables[RESULTS]


def test_a_second_run_goes_down_where_a_larger_value_is_refused_or_changes_the_mesh():
    def stiff(E, deflection):
        if 1.01 * VALUES["E"] < E:
            raise InvalidValue("too stiff", where="E")
        return build(E, deflection)

    def finer(E, deflection):
        model, move = build(E, deflection)
        if 1.01 * VALUES["E"] > E:
            return model, move
        mesh = uf.mesh.strip(10.0, 1.0, 0.2, (9, 1))
        other = uf.Model(mesh, material=uf.SVK(E=E, nu=0.3))
        other.fix("x0")
        return other, uf.Move(other.prescribe("x1_lower", "z", name="tip"), to=-deflection, steps=4)

    for function in (stiff, finer):
        (second,) = scatter({"E": "3%"}, function=function).second_runs
        assert second.step == pytest.approx(-12600.0)
        assert second.title == "a second run at E - 2 sigma"


class Two(OfFunction):
    """Two operations with different meshes, such as a second sheet that is added."""

    def build(self):
        model, move = build(**self.values, cells=6)
        return replace(super().build(), after=[Stage("next", lambda before: (model, [move]))])

    def with_(self, changes):
        return Two(self.function, {**self.values, **changes})


def test_a_second_run_of_several_operations_has_the_elements_of_the_first():
    (second,) = uf.scatter(Two(build, VALUES), {"E": "3%"}, [steep], progress=False).second_runs
    assert second.elements == (6, 6) and not second.note


def test_a_second_run_corrects_held_results_that_do_not_depend_on_the_followers_of_others():
    """Two bends of a part, each held by its own stroke: the derivative of one by the stroke of the other is zero."""
    slopes = {("first", "a"): 1.0, ("first", "b"): 0.0, ("second", "a"): 0.0, ("second", "b"): 2.0}
    free = {key: Quantity("d", value=value) for key, value in slopes.items()}
    found = _corrected(free, {"first": "a", "second": "b"}, {"first": 0.5, "second": 0.5}, {"a": 1.0, "b": 1.0})
    assert found == {"first": 0.0, "second": 0.0, "a": 0.5, "b": 0.75}


def test_a_second_run_that_fails_is_a_warning():
    def narrow(E, deflection):
        if abs(E / VALUES["E"] - 1.0) > 0.01:
            raise InvalidValue("not this steel", where="E")
        return build(E, deflection)

    found = scatter({"E": "3%"}, function=narrow)
    assert found.second_runs == ()
    assert "a second run at E ± 2 sigma failed: not this steel" in found.warnings[0]


def test_other_values_of_a_function_are_kept():
    short = scatter({"E": "3%"}, values=VALUES | {"length": 5.0})["force"].mean.value
    assert short == pytest.approx(8.0 * scatter({"E": "3%"})["force"].mean.value, rel=0.05)


def test_one_parameter_has_all_the_variance_and_no_picture(tmp_path):
    files = scatter({"E": "3%"}).write(tmp_path)
    assert [file.name for file in files] == ["scatter.csv", "scatter.json"]
    assert sorted(file.name for file in tmp_path.iterdir()) == ["scatter.csv", "scatter.json"]


def test_files(tmp_path):
    found = scatter({"E": "3%", "deflection": "4%"}, correlations={("E", "deflection"): -0.9})
    files = found.write(tmp_path)
    assert [file.name for file in files] == ["scatter.csv", "scatter.json", "scatter.png"]
    record = json.loads((tmp_path / "scatter.json").read_text())
    by_name = {one["name"]: one["value"] for one in record["quantities"]}
    assert by_name["force.share.E"] == found["force"].shares["E"].value
    assert by_name["force.share.E"] < 0.0  # the picture has it to the left of zero
    assert np.array(record["covariance"])[0, 1] == pytest.approx(-0.9 * 6300.0 * 0.004)
    assert (tmp_path / "scatter.csv").read_text().startswith("name,label,value,unit")
    assert [rows[0][0] for rows in found.tables.values()] == ["parameter", "quantity", "quantity", "quantity"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("5%", uf.Scatter(0.05, relative=True)),
        ("0.02", uf.Scatter(0.02)),
        ("±0.1", uf.Scatter(0.1)),
        ("+-.1", uf.Scatter(0.1)),
        (2, uf.Scatter(2.0)),
    ],
)
def test_how_a_scatter_is_written(text, expected):
    assert uf.Scatter.of(text) == expected


@pytest.mark.parametrize(
    ("sources", "rest", "where", "words"),
    [
        ({"G": "3%"}, {}, "sources", "there is no number of this path"),
        ({}, {}, "sources", "no parameter scatters"),
        ({"E": "0%"}, {}, "E", "a scatter is a positive number"),
        ({"E": None}, {}, "E", "a scatter is a positive number"),
        ({"E": 1e300}, {}, "E", "a scatter is a positive number"),
        ({"E": True}, {}, "E", "a scatter is a positive number"),
        ({"E": "3,5%"}, {}, "E", "a decimal comma"),
        ({"E": "much"}, {}, "E", "write 0.02, 5% or ±0.1"),
        ({"zero": "3%"}, {"values": VALUES | {"zero": 0.0}}, "zero", "a number instead of a percentage"),
        ({"E": "3%"}, {"hold": {"force": "E"}}, "E", "a parameter that follows has no scatter"),
        ({"E": "3%"}, {"hold": {"force": "G"}}, "hold", "there is no number of this path"),
        ({"E": "3%"}, {"correlations": {("E", "deflection"): 0.5}}, "correlations", "deflection has no scatter"),
        ({"E": "3%"}, {"correlations": {("E", "E"): 0.5}}, "correlations", "twice the same parameter"),
        ({"E": 1, "deflection": 1}, {"correlations": {("E", "deflection"): 1.5}}, "correlations", "from -1 to 1"),
        ({"E": "3%"}, {"limits": {"force": "91:89"}}, "limits", "a smaller and a larger number"),
        ({"E": "3%"}, {"limits": {"force": (None, "b")}}, "limits", "a smaller and a larger number"),
        ({"E": "3%"}, {"limits": {"force": "89"}}, "limits", "low: or :high"),
        ({"E": "3%"}, {"limits": {"force": "89,5:91"}}, "limits", "a decimal comma"),
        ({"E": "3%"}, {"limits": {"force": 210.0}}, "limits", "limits are two numbers"),
        ({"E": "3%"}, {"limits": {"angle": "89:91"}}, "limits", "the run has no such quantity"),
        (["E"], {}, "sources", "must be a dictionary"),
        ({"E": "3%"}, {"hold": ["force"]}, "hold", "must be a dictionary"),
        ({"E": "3%"}, {"of": 5}, "of", "must be a text or an array"),
    ],
)
def test_refusals(sources, rest, where, words):
    with pytest.raises(InvalidValue) as caught:
        scatter(sources, **rest)
    assert caught.value.where == where
    assert words in str(caught.value)
    assert caught.value.remedy


@pytest.mark.parametrize(
    "case",
    [
        Cup(material=STEEL, **ESAFORM),
        UBend(material=STEEL, **NUMISHEET),
        DrawBead(material=STEEL),
    ],
    ids=lambda case: type(case).__name__,
)
def test_tools_do_not_follow_a_sheet_that_scatters(case):
    thing = Plan.of(case, {"thickness": "1%"}).thing
    thicker = thing.with_({"thickness": 1.01 * case.thickness}).case
    for name in ("throat", "gap", "width", "way"):
        assert getattr(thicker, name, None) == getattr(case, name, None)


def test_values_beside_a_case_are_refused():
    with pytest.raises(InvalidValue, match="those of a function") as caught:
        uf.scatter(AirBending(stroke=3.0), {"thickness": "1%"}, values={"thickness": 2.0})
    assert caught.value.where == "values"


def test_correlations_that_exclude_each_other():
    correlations = {("E", "deflection"): 0.9, ("E", "length"): 0.9, ("deflection", "length"): -0.9}
    with pytest.raises(InvalidValue, match="its smallest eigenvalue is -0\\.8"):
        scatter(
            {"E": "1%", "deflection": "1%", "length": "1%"}, values=VALUES | {"length": 9.0}, correlations=correlations
        )
