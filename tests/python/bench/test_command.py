"""`umform bench` on the command line: what it refuses, and where it listens."""

import subprocess
import sys

import pytest

from umform.bench.server import HOST, listening, token_of
from umform.errors import InvalidValue

WITHOUT = """
import sys
sys.modules[sys.argv.pop(1)] = None  # as if it were not installed
from umform.cli import main
sys.exit(main())
"""


@pytest.mark.parametrize("name", ["starlette", "uvicorn"])
def test_missing_extra_is_named(name, tmp_path):
    command = [sys.executable, "-c", WITHOUT, name, "bench", "--folder", str(tmp_path / "b")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)
    assert done.returncode == 1 and 'pip install "umform[bench]"' in done.stderr, done.stderr
    assert not (tmp_path / "b").exists()


def test_port_that_is_taken_is_refused():
    with listening(0) as first:
        assert first.getsockname()[0] == HOST == "127.0.0.1"
        with pytest.raises(InvalidValue, match="port"):
            listening(first.getsockname()[1])


def test_token_is_kept_for_its_owner_only(tmp_path):
    token = token_of(tmp_path)
    assert len(token) >= 32 and token_of(tmp_path) == token
    assert (tmp_path / "token").stat().st_mode & 0o077 == 0


@pytest.mark.parametrize(("text", "mode"), [("a" * 32, 0o644), ("a" * 30 + "; b", 0o600), ("\u00e4" * 32, 0o600)])
def test_token_that_others_can_read_or_that_is_none_is_replaced(tmp_path, text, mode):
    (tmp_path / "token").write_text(text, encoding="utf-8")
    (tmp_path / "token").chmod(mode)
    token = token_of(tmp_path)
    assert token != text and (tmp_path / "token").read_text() == token
    assert (tmp_path / "token").stat().st_mode & 0o077 == 0


@pytest.mark.parametrize("module", ["work", "server"])
def test_pictures_are_loaded_after_the_first_increments(module):
    """Matplotlib takes as long to load as all else that a bend needs before its first picture on the page."""
    command = [sys.executable, "-c", f"import sys, umform.bench.{module}; sys.exit('matplotlib' in sys.modules)"]
    assert subprocess.run(command, timeout=100, check=False).returncode == 0
