"""Files of measurements: what is read, and what is refused with its cause."""

from __future__ import annotations

import numpy as np
import pytest

from umform.errors import UmformError
from umform.studies.calibration import read_cycles, read_directions, read_tension


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / "measured.csv"
        path.write_text(text)
        return path

    return write


def test_directions_in_mpa_are_divided_by_the_first(file):
    found = read_directions(file("# a sheet\nangle,stress,r\n0,200,1.8\n45,210,\n90,190,2.1\nbiaxial,220,0.9\n"))
    assert found.stress == {0.0: 1.0, 45.0: 1.05, 90.0: 0.95}
    assert found.r == {0.0: 1.8, 90.0: 2.1}
    assert (found.biaxial, found.r_biaxial) == (1.1, 0.9)


def test_engineering_values_are_converted_up_to_the_largest_force(file):
    path = file("strain,stress\n10,300\n20,320\n25,310\n")
    with pytest.raises(UmformError, match="three or more"):
        read_tension(file("strain,stress\n10,300\n"), 2e5, engineering=True, percent=True)
    path = file("strain,stress\n10,300\n20,320\n25,310\n")
    found = read_tension(path, 2e5, engineering=True, percent=True)
    assert found.strain == pytest.approx(np.log([1.1, 1.2]))
    assert found.stress == pytest.approx([330.0, 384.0])


def test_plastic_strains_get_their_elastic_part(file):
    found = read_tension(file("plastic_strain,stress\n0,200\n0.01,240\n0.02,260\n"), 2e5)
    assert found.strain == pytest.approx([0.001, 0.0112, 0.0213])
    text = "plastic_strain,stress\n0,200\n0.1,300\n0.2,320\n"
    total = np.array([0.001, 0.1015, 0.2016])  # elongation: the plastic one and force over first area over E
    found = read_tension(file(text), 2e5, engineering=True)
    assert found.strain == pytest.approx(np.log1p(total), rel=1e-12)
    assert found.stress == pytest.approx(np.array([200.0, 300.0, 320.0]) * (1.0 + total), rel=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("angle,stress\n0,1\n", "the column r is missing"),
        ("0,1,1\n45,1,1\n", "the column angle is missing"),
        ("angle;stress;r\n0;1;1\n", "another separator"),
        ("angle,stress,r\n0,1,0,8\n", "decimal comma"),
        ("angle,stress,r\n0,1,one\n", "the r is not a number"),
        ("angle,stress,r\n0,1,-0.8\n", r"r at 0\.0 must be positive(.|\n)*\.csv"),
        ("angle,stress,r\n0,1,0.8\n0,1,0.9\n", "each once"),
        ("angle,stress,r\n135,1,0.8\n", "between 0 and 90"),
        ("angle,stress,r\n45,210,0.8\n90,215,0.8\n", "need that at 0 degrees"),
        ("", "this table has no rows"),
    ],
)
def test_directions_are_refused(file, text, message):
    with pytest.raises(UmformError, match=message):
        read_directions(file(text))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("strain,force\n0,1\n", "the column stress is missing"),
        ("elongation,stress\n0,1\n", "the column strain is missing"),
        ("strain,plastic_strain,stress\n0,0,100\n", "strain or plastic_strain"),
        ("strain,stress\n1,200\n5,250\n10,300\n", "strains are fractions"),
        ("strain,stress\n0.01,200\n0.02,nan\n0.05,260\n0.1,300\n", "the stress is not a number"),
        ("strain,stress\n0.01,0.2\n0.05,0.25\n0.1,0.3\n", "stresses are in MPa"),
        ("strain,stress\n0.01,200\n0.1,300\n0.2,280\n", "engineering=True"),
        ("strain,stress\n0.01,200\n0.1,300\n0.05,310\n", "the strains of a tension test rise"),
        ("strain,stress\n0,400\n0.05,450\n0.1,500\n", "smaller than stress / E"),
    ],
)
def test_tension_is_refused(file, text, message):
    with pytest.raises(UmformError, match=message):
        read_tension(file(text), 2e5)


def test_a_modulus_in_gpa_is_refused(file):
    with pytest.raises(UmformError, match="GPa"):
        read_tension(file("strain,stress\n0.01,200\n0.1,300\n0.2,320\n"), 210.0)


def test_cycles(file):
    found = read_cycles(file("strain,stress\n0.01,200\n0.02,\n0.01,-150\n0,-200\n"), 2e5)
    assert np.isnan(found.stress[1])
    with pytest.raises(UmformError, match="forth and back"):
        read_cycles(file("strain,stress\n0.01,200\n0.02,210\n0.03,220\n"), 2e5)
    with pytest.raises(UmformError, match="total strains"):
        read_cycles(file("plastic_strain,stress\n0.01,200\n0.02,210\n0.0,-220\n"), 2e5)
    with pytest.raises(UmformError, match="cannot be read"):
        read_cycles("nowhere.csv", 2e5)
