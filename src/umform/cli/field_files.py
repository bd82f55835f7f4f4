"""Files of fields on the command line."""

from __future__ import annotations

from pathlib import Path

from umform.cli.root import say


def file_of_fields(path: Path) -> Path:
    """The file of fields: the given one, or that of a folder that was written last.

    Raises
    ------
    FileProblem
        If there is none, or it is damaged.
    """
    from umform.errors import FileProblem

    file = _last_in(path) if path.is_dir() else path
    if not file.is_file():
        raise FileProblem(
            "there is no such file",
            where=str(file),
            cause="another path, or a run without fields",
            remedy="result.write('run.vtkhdf') and `umform run` write one",
        )
    import h5py

    from umform.io.trees import opened

    if not h5py.is_hdf5(file):
        raise FileProblem(
            "this is no file of fields",
            where=str(file),
            cause="another ending, as that of a table",
            remedy="give a file that ends in .vtkhdf",
        )
    with opened(file) as content:
        if "VTKHDF" not in content:
            raise FileProblem(
                "this HDF5 file holds no VTKHDF",
                where=str(file),
                cause="a checkpoint, or a file of another program",
                remedy="give a file that ends in .vtkhdf",
            )
    return file


def _last_in(path: Path) -> Path:
    from umform.errors import FileProblem

    files = sorted(path.glob("*.vtkhdf"), key=lambda file: (file.stat().st_mtime_ns, file.name))
    if not files:
        raise FileProblem(
            "this is a folder without a file of fields",
            where=str(path),
            cause="no name in it ends in .vtkhdf",
            remedy="`umform run` writes fields.vtkhdf, unless [output] says no; bends and draws write theirs",
        )
    *others, last = files
    if others:
        names = ", ".join(file.name for file in others)
        say(f"{last.name}, the last one in {path}; it also has {names}")
    return last
