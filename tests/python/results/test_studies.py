"""Bands from studies of other parts."""

import json
import math

import pytest
from scipy.special import stdtrit

from umform.results.outcome import Outcome
from umform.results.quantity import ALL_BUT_MESH, Band, Quantity
from umform.results.studies import (
    COARSE,
    DEFAULT,
    STUDIES,
    StudiedMesh,
    band_of,
    estimated,
    studied_name,
)

ROW = {
    "count": 5,
    "factor": 2.5,
    "relative": True,
    "meshes": {DEFAULT: 0.1, COARSE: 0.3},
    "sources": {"mesh": 0.08, "increments": 0.02},
}
DATA = json.loads(STUDIES.read_text(encoding="utf-8"))


class Made(Outcome):
    """Numbers of a cup."""

    title, stages, warnings = "made", {}, ()

    def __init__(self, *found, at=None):
        self.found, self.at = found, at

    @property
    def studied(self):
        return self.at

    @property
    def quantities(self):
        return self.banded(self.found)


@pytest.mark.parametrize(("relative", "softness", "error"), [(True, 1.0, 1.0), (False, 1.0, 0.25), (True, 16.0, 4.0)])
def test_the_band_is_the_usual_error_with_a_factor(relative, softness, error):
    at = StudiedMesh("cup", softness=softness)
    band = band_of(ROW | {"relative": relative}, 0.5, -4.0, at, "studies")
    assert band.error == pytest.approx(error) and band.source == "estimated from studies, not from this run"
    assert band.sources == pytest.approx({"mesh": 0.8 * error, "increments": 0.2 * error})


@pytest.mark.parametrize(("size", "factor"), [(2.0, 4.0), (1.0, 1.0), (0.5, 0.5)])
def test_coarser_elements_have_a_wider_band(size, factor):
    usual, other = (band_of(ROW, 0.0, 1.0, StudiedMesh("cup", DEFAULT, one), "") for one in (1.0, size))
    assert other.error == pytest.approx(factor * usual.error)
    assert other.sources["mesh"] == pytest.approx(factor * usual.sources["mesh"])
    assert other.sources["increments"] == usual.sources["increments"]


@pytest.mark.parametrize(("name", "unit", "factor"), [("roll_in", "mm", 2.0), ("angle", "degrees", 1.0)])
def test_errors_of_lengths_follow_the_thickness(name, unit, factor):
    one = Quantity(name, unit, name=name, value=0.5)
    thin, thick = (estimated(one, StudiedMesh("hem, flat", length=length)) for length in (1.0, 2.0))
    assert thick.error == pytest.approx(factor * thin.error) and thin.error > 0.0


def test_the_nearest_mesh_of_the_studies_counts():
    near = [StudiedMesh.nearest("cup", size, 2.0, 3.0) for size in (0.7, 1.0, 1.4, 1.5, 3.0)]
    assert [one.mesh for one in near] == [DEFAULT] * 3 + [COARSE] * 2
    assert [one.size for one in near] == pytest.approx([0.7, 1.0, 1.4, 0.75, 1.5])
    assert {one.softness for one in near} == {3.0}


def test_a_mesh_that_was_not_studied_has_no_band():
    assert band_of(ROW | {"meshes": {DEFAULT: 0.1}}, 0.0, 1.0, StudiedMesh("cup", COARSE), "") is None


@pytest.mark.parametrize(
    ("name", "studied"),
    [
        ("bend 12: springback", "springback"),
        ("bend 1: final_angle", "angle"),
        ("flange 3", "flange"),
        ("total_force", "largest_force"),
        ("largest punch force", "largest punch force"),
    ],
)
def test_equal_features_share_a_study(name, studied):
    assert studied_name(name) == studied


def test_what_was_not_studied_is_unknown():
    at = StudiedMesh("cup")
    assert estimated(Quantity("colour", value=1.0), at) is None
    assert estimated(Quantity("largest thinning", "%"), at) is None
    assert estimated(Quantity("largest thinning", "%", value=9.0), StudiedMesh("casting")) is None
    assert Made(Quantity("largest thinning", "%", value=9.0))["largest thinning"].band is None


def test_numbers_of_an_outcome_have_bands():
    thinning, at = Quantity("largest thinning", "%", value=9.0), StudiedMesh("cup")
    band = Made(thinning, at=at)["largest thinning"].band
    assert band == estimated(thinning, at) and band.error > 0.1
    kept = Made(thinning, at=at).record()["quantities"][0]
    assert kept["band"]["sources"]["mesh"] > 0.0 and Quantity.of(kept) == Made(thinning, at=at).quantities[0]
    assert Made(thinning, at=at).all_notes == [f"error: {band.source}"]


def test_a_band_of_this_run_stays():
    """Changes by refinements stay; of others the wider one counts."""
    at = StudiedMesh("cup")
    own = Band(1e-6, "budget", parts={"mesh/2": 1e-6})
    assert Made(Quantity("largest thinning", "%", value=9.0, band=own), at=at).quantities[0].band == own
    narrow, wide = (
        Made(Quantity("largest thinning", "%", value=9.0, band=Band(error, "ripple")), at=at).quantities[0].band
        for error in (1e-6, 100.0)
    )
    assert narrow.error > 0.1 and narrow.source.endswith("or ripple if that is more")
    assert wide.error == 100.0 and wide.source.startswith("ripple; or estimated") and wide.sources == narrow.sources


def test_an_extrapolation_gets_the_sources_beside_the_mesh():
    given = Quantity("largest thinning", "%", value=9.0, band=Band(0.4, "meshes", middle=8.0))
    band, studied = Made(given, at=StudiedMesh("cup")).quantities[0].band, estimated(given, StudiedMesh("cup"))
    rest = studied.sources[ALL_BUT_MESH]
    assert band.error == pytest.approx(math.hypot(0.4, rest)) and band.error > 0.4
    assert band.sources == {"mesh": 0.4, ALL_BUT_MESH: rest} and band.middle == 8.0
    assert band.source == f"meshes; errors by other sources {studied.source}"


def test_scatter_widens_a_band():
    at = StudiedMesh("cup")
    before = Made(Quantity("largest thinning", "%", value=9.0), Quantity("colour", value=1.0), at=at)
    after = before.with_deviations({"largest thinning": 2.0, "colour": 0.5, "weight": 1.0})
    bands = [one.band for one in after.quantities]
    assert bands[0].error == pytest.approx(math.hypot(before.quantities[0].band.error, 4.0))
    assert bands[0].sources["scatter"] == 4.0 and bands[0].source.endswith("by the scatter of parameters")
    assert bands[1].error == 1.0 and bands[1].source == "two standard deviations by the scatter of parameters"
    assert before.quantities[1].band is None
    unknown = before.with_deviations({"largest thinning": math.nan}).quantities
    assert [one.error_text for one in unknown] == ["unknown", "unknown"]


@pytest.mark.parametrize("process", DATA)
def test_the_studies_have_what_they_promise(process):
    assert DATA[process]["parts"] >= 2 and 0.0 <= DATA[process]["exponent"] <= 1.0
    for row in DATA[process]["quantities"].values():
        assert (
            set(row) == {"count", "factor", "relative", "meshes", "sources"}
            and 1 <= row["count"] <= DATA[process]["parts"]
        )
        of_an_earlier_study = 2.0 if row["count"] >= 4 else 3.0  # on the largest error
        assert row["factor"] in (pytest.approx(stdtrit(row["count"], 0.975), abs=0.006), of_an_earlier_study)
        assert DEFAULT in row["meshes"] and all(error >= 0.0 for error in row["meshes"].values())
