"""The store of results: what is kept, found, damaged, pruned."""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor

import pytest

from umform.errors import FileProblem
from umform.io.store import Store, key_of, store_folder


@pytest.fixture
def store(tmp_path):
    return Store(tmp_path / "store")


def test_keeps_numbers_to_the_last_bit(store):
    key = key_of("sum", 1, "a")
    assert store.get(key) is None
    store.put(key, "sum", {"of": [1, "two"]}, {"third": 1.0 / 3.0, "undefined": math.nan}, 1)
    entry = store.get(key)
    assert entry.value["third"] == 1.0 / 3.0 and math.isnan(entry.value["undefined"])
    assert entry.about == {"of": [1, "two"]} and entry.current
    assert [one.key for one in store.entries("sum")] == [key] and not list(store.entries("other"))


def test_key_names_kind_version_and_input():
    keys = {key_of(kind, version, text) for kind in "ab" for version in (1, 2) for text in ("x", "y")}
    assert len(keys) == 8


@pytest.mark.parametrize(
    "damage", [lambda text: text[:-40], lambda text: text.replace("2.5", "2.6"), lambda text: "[]"]
)
def test_a_damaged_entry_is_missing_with_a_warning(store, damage, caplog):
    key = key_of("sum", 1, "a")
    path = store.put(key, "sum", {}, {"is": 2.5}, 1)
    path.write_text(damage(path.read_text()))
    assert store.get(key) is None
    assert "cannot be read and is computed again" in caplog.text
    assert not list(store.entries())
    assert store.prune() == 1 and not path.exists()


def test_prunes_entries_of_other_versions_and_old_ones(store, monkeypatch):
    monkeypatch.setitem(Store.versions, "sum", 2)
    old, new = (key_of("sum", version, "a") for version in (1, 2))
    store.put(old, "sum", {}, {}, 1)
    store.put(new, "sum", {}, {}, 2)
    assert store.prune() == 1 and store.get(new) is not None and store.get(old) is None
    left = store.path(new).with_name(".left.json")
    left.touch()
    os.utime(left, (0.0, 0.0))
    assert store.prune(older_than=1.0) == 0 and not left.exists()
    assert store.prune(older_than=-1.0) == 1


def test_folder_is_that_of_the_variable_or_of_the_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("UMFORM_STORE", str(tmp_path / "own"))
    assert store_folder() == tmp_path / "own"
    monkeypatch.delenv("UMFORM_STORE")
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert store_folder() == tmp_path / "umform" / "store"


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(FileProblem, match="UMFORM_STORE"):
        Store(tmp_path / "file" / "store").prepare()


def _write(folder, number):
    store, key = Store(folder), key_of("sum", 1, "the same")
    for _ in range(20):
        store.put(key, "sum", {"by": "x" * 2000}, {"is": float(number)}, 1)
    return store.get(key).value["is"]


def test_processes_write_the_same_entry_at_the_same_time(tmp_path, caplog):
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(_write, [tmp_path] * 4, range(4)))
    assert set(found) <= {0.0, 1.0, 2.0, 3.0} and not caplog.text
    assert len(list(Store(tmp_path).entries())) == 1
    assert not list(tmp_path.glob("*/.*"))
