"""Packages whose names are imported when they are first used."""

from importlib import import_module
from pathlib import Path

import pytest

import umform as uf
from umform.renamed import MOVED, RENAMED

LAZY = [
    "umform.problem",
    "umform.io",
    "umform.materials",
    "umform.processes",
    "umform.results.forming",
    "umform.surfaces",
]


@pytest.mark.parametrize("package", LAZY)
def test_each_public_name_has_a_home(package):
    module = import_module(package)
    homes = module.names() if package == "umform.materials" else module._HOME
    assert sorted(homes) == sorted(module.__all__)
    for name, home in homes.items():
        assert getattr(module, name) is getattr(import_module(f"{package}.{home}"), name)


@pytest.mark.parametrize("package", LAZY)
def test_no_file_hides_a_name(package):
    module = import_module(package)
    files = {file.stem for file in Path(module.__file__).parent.glob("*.py")}
    assert not files & set(module.__all__)


def test_an_unknown_name_is_refused():
    with pytest.raises(AttributeError, match=r"module 'umform\.surfaces' has no attribute 'Cone'"):
        _ = import_module("umform.surfaces").Cone


@pytest.mark.parametrize("name", RENAMED)
def test_an_old_name_says_what_it_is_now_called(name):
    new, remedy = RENAMED[name]
    assert name not in uf.__all__ and new in uf.__all__
    with pytest.raises(ImportError, match=rf"umform\.{name} is now called umform\.{new}") as caught:
        getattr(uf, name)
    assert remedy in str(caught.value)


@pytest.mark.parametrize("old", list(MOVED))
def test_an_old_module_says_where_it_is(old):
    with pytest.raises(ModuleNotFoundError, match=f"{old} is now called umform"):
        import_module(old)
    assert import_module(MOVED[old].split(",")[0])
