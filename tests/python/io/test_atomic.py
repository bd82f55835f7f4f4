import os
import stat
from pathlib import Path

import pytest

from umform.errors import FileProblem
from umform.io import PendingFile


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_file_appears_at_the_end_of_the_block(tmp_path):
    target = tmp_path / "a.txt"
    with PendingFile(target) as temporary:
        temporary.write_text("whole")
        assert temporary.suffix == ".txt"
        assert not target.exists()
    assert target.read_text() == "whole"
    assert names(tmp_path) == ["a.txt"]


def test_exception_keeps_the_old_file(tmp_path):
    target = tmp_path / "a.txt"
    target.write_text("old")
    with pytest.raises(ZeroDivisionError), PendingFile(target) as temporary:
        temporary.write_text("half")
        raise ZeroDivisionError
    assert target.read_text() == "old"
    assert names(tmp_path) == ["a.txt"]


def test_symbolic_link_is_followed(tmp_path):
    (tmp_path / "a.txt").write_text("old")
    (tmp_path / "link.txt").symlink_to(tmp_path / "a.txt")
    with PendingFile(tmp_path / "link.txt") as temporary:
        temporary.write_text("new")
    assert (tmp_path / "a.txt").read_text() == "new"
    assert (tmp_path / "link.txt").is_symlink()


@pytest.mark.skipif(os.name != "posix", reason="permission bits are those of POSIX")
def test_permissions_follow_the_umask(tmp_path):
    plain = tmp_path / "plain.txt"
    plain.touch()
    with PendingFile(tmp_path / "a.txt") as temporary:
        temporary.write_text("x")
    assert stat.S_IMODE((tmp_path / "a.txt").stat().st_mode) == stat.S_IMODE(plain.stat().st_mode)


@pytest.mark.parametrize(
    ("path", "cause"),
    [
        ("missing/a.txt", "missing does not exist"),
        ("file/a.txt", "is a file, not a directory"),
        ("folder", "directory of this name"),
        ("x" * 300, "long"),
        ("file/a/b.txt", "file is a file, not a directory"),
    ],
)
def test_causes(tmp_path, path, cause):
    (tmp_path / "file").touch()
    (tmp_path / "folder").mkdir()
    with pytest.raises(FileProblem) as info, PendingFile(tmp_path / path):
        pass
    assert cause in info.value.cause
    assert info.value.remedy
    assert names(tmp_path) == ["file", "folder"]


def test_no_permission(tmp_path, monkeypatch):
    def refuse(*args, **options):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("pathlib.Path.touch", refuse)
    with pytest.raises(FileProblem, match="no permission"), PendingFile(tmp_path / "a.txt"):
        pass


def test_operating_system_errors_while_writing_are_explained(tmp_path):
    with pytest.raises(FileProblem, match="No space left"), PendingFile(tmp_path / "a.txt"):
        raise OSError(28, "No space left on device")
    assert names(tmp_path) == []


def test_failing_rename_leaves_nothing(tmp_path):
    target = tmp_path / "a.txt"
    with pytest.raises(FileProblem), PendingFile(target):
        target.mkdir()
    assert names(tmp_path) == ["a.txt"]


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="no such folder here")
def test_a_folder_of_the_system():
    with pytest.raises(FileProblem) as info, PendingFile("/proc/x.txt"):
        pass
    assert "takes no new files" in info.value.cause or "no permission" in info.value.cause
