"""Defaults and bounds of parameters stand once: tools/said_once.py finds what states them again."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

SPEC = '''
@dataclass(frozen=True)
class VDie:
    """A die."""

    die_radius: Annotated[float, Gt(0.0), Le(50.0)] = 2.1
    """Radius of the shoulders."""
    width: Width = 12.5
    """Width."""


class Wide(VDie):
    width: Width = 40.0


Width = Annotated[float, Gt(0.0), Le(99.0)]


def disc(radius: float, core: float = 0.4): ...


class Disc(Part, of=mesh.disc):
    """A disc."""
'''


def found(folder, **files):
    """What the tool says of a tree with the Spec and other files."""
    for name, text in {"src/dies.py": SPEC, **files}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    code = f"import said_once, pathlib; print(*said_once.said_twice(pathlib.Path({str(folder)!r})), sep='\\n')"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT / "tools", capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_the_repository_states_each_number_once():
    done = subprocess.run([sys.executable, ROOT / "tools" / "said_once.py"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_one_statement_is_enough(tmp_path):
    page = "`die_radius` of 2.1 mm. The default is 2.1 times as wide. `die_radius` without a default."
    assert found(tmp_path, **{"docs/dies.md": page, "src/use.py": "VDie(die_radius=2.1, width=3.0)\n"}) == ""


@pytest.mark.parametrize(
    ("text", "where"),
    [
        ("def bend(die_radius: float = 2.1): ...\n", "src/again.py:1: die_radius and 2.1: read it from src/dies.py"),
        ("def bend(*, core=0.4): ...\n", "core and 0.4"),
        ("class Key(Part):\n    die_radius: float = 2.1\n", "src/again.py:2: die_radius and 2.1"),
        ("_DIE_RADIUS = 2.1\n", "_DIE_RADIUS and 2.1"),
        ("@given_by(VDie, die_radius=2.1)\ndef bend(given): ...\n", "die_radius and 2.1"),
        ("ok = 0 < self.die_radius <= 50.0\n", "die_radius and 50"),
        ("ok = width > 99.0\n", "width and 99"),
        ('help = "Radius `--die-radius`, default 2.1."\n', "die-radius and its default 2.1"),
        (
            'class Other:\n    """Other."""\n\n    width: float = 12.5\n    """Width."""\n',
            "src/dies.py:8: width and 12.5: read it from src/again.py",
        ),
    ],
)
def test_a_second_statement_is_found(tmp_path, text, where):
    assert where in found(tmp_path, **{"src/again.py": text})


def test_a_page_that_repeats_a_default_is_found(tmp_path):
    page = "# Dies\n\nThe shoulders have `die_radius` (by default 2.1) and more.\n"
    assert found(tmp_path, **{"docs/dies.md": page}).startswith("docs/dies.md:3: die_radius and its default 2.1")


def test_a_default_of_air_bending_in_another_file_is_found(tmp_path):
    """The Spec itself, and an option that repeats a default of it."""
    spec = (ROOT / "src" / "umform" / "processes" / "air_bending" / "spec.py").read_text()
    text = "def bend(opening: float = 16.0): ...\n"
    assert "opening and 16" in found(tmp_path, **{"src/spec.py": spec, "src/cli.py": text})
