import csv
import json
import math

import numpy as np
import pytest

from umform.errors import FileProblem, InvalidValue, NotFinite
from umform.io import write_csv, write_json
from umform.io.tables import csv_style


def test_csv_is_read_back_bit_by_bit(tmp_path):
    values = np.random.default_rng(3).normal(size=50) * 10.0 ** np.arange(-25, 25)
    write_csv(tmp_path / "a.csv", {"step": range(50), "force": values, "note": ['a,"b"\n'] * 50})
    with (tmp_path / "a.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["step", "force", "note"]
    assert [float(row["force"]) for row in rows] == values.tolist()
    assert rows[49]["step"] == "49"
    assert rows[49]["note"] == 'a,"b"\n'


def test_csv_text(tmp_path):
    write_csv(tmp_path / "a.csv", {"t": [0, np.float64(0.1)], "on": [True, None], "x": [np.nan, -np.inf]})
    assert (tmp_path / "a.csv").read_bytes() == b"t,on,x\n0,True,nan\n0.1,,-inf\n"


def test_german_csv_has_semicolons_and_decimal_commas(tmp_path):
    with csv_style("german"):
        write_csv(tmp_path / "a.csv", {"t mm": [0, np.float64(0.1)], "name": ["1.5", "ä"], "x": [np.nan, None]})
    assert (tmp_path / "a.csv").read_text(encoding="utf-8") == "\ufefft mm;name;x\n0;1.5;nan\n0,1;ä;\n"
    write_csv(tmp_path / "a.csv", {"t": [0.5]})
    assert (tmp_path / "a.csv").read_bytes() == b"t\n0.5\n"


@pytest.mark.parametrize("columns", [{}, {"a": [1], "b": [1, 2]}, {"a": np.eye(2)}, {"a": [1j]}])
def test_csv_refuses(tmp_path, columns):
    with pytest.raises(InvalidValue):
        write_csv(tmp_path / "a.csv", columns)
    assert list(tmp_path.iterdir()) == []


def test_json_is_read_back(tmp_path):
    record = {
        "b": np.arange(4).reshape(2, 2),
        "a": {"x": np.float64(1 / 3), "on": np.True_, "none": None, "name": "Füße"},
        "c": (1, np.float32(0.5), [np.array(7), "s"]),
    }
    write_json(tmp_path / "a.json", record)
    assert json.loads((tmp_path / "a.json").read_text(encoding="utf-8")) == {
        "a": {"x": 1 / 3, "on": True, "none": None, "name": "Füße"},
        "b": [[0, 1], [2, 3]],
        "c": [1, 0.5, [7, "s"]],
    }


def test_json_does_not_depend_on_the_order_of_keys(tmp_path):
    write_json(tmp_path / "a.json", {"x": 1, "y": 2})
    write_json(tmp_path / "b.json", {"y": 2, "x": 1})
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()


@pytest.mark.parametrize("number", [math.nan, math.inf, np.float32("nan")])
def test_json_refuses_what_is_not_finite(tmp_path, number):
    with pytest.raises(NotFinite, match=r"\$\.a\[1\]\.b"):
        write_json(tmp_path / "a.json", {"a": [0, {"b": number}]})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("record", [{1: 2}, {"a": 1j}, {"a": {1, 2}}, object()])
def test_json_refuses_other_kinds(tmp_path, record):
    with pytest.raises(InvalidValue):
        write_json(tmp_path / "a.json", record)


def test_missing_directory(tmp_path):
    with pytest.raises(FileProblem, match="does not exist"):
        write_csv(tmp_path / "no" / "a.csv", {"a": [1]})
    with pytest.raises(FileProblem, match="does not exist"):
        write_json(tmp_path / "no" / "a.json", {})
