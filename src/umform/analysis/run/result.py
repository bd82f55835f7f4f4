"""The result of a run: its history and frames, files and plots."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from umform.errors import InvalidValue
from umform.results.history import History
from umform.results.run_record import run_record
from umform.spec import check_arguments

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Suffixes of files of fields.
_FIELDS = (".vtkhdf", ".xdmf", ".pvd", ".vtu")
_WRITTEN = ".csv for the history; .vtkhdf, .xdmf, .pvd or .vtu for fields"


class Result(History):
    """History of all converged increments, frames of some of them; see :class:`umform.results.history.History`.

    Examples
    --------
    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.fix("x0")
    >>> tip = model.prescribe("x1_lower", "z", name="tip")
    >>> result = uf.solve(model, uf.Move(tip, to=-0.1, steps=2))
    >>> force = result["tip_force"]
    >>> result.write("bending.vtkhdf")  # doctest: +SKIP
    >>> result.plot("tip", "tip_force", "curve.png")  # doctest: +SKIP
    """

    def summary(self) -> dict[str, Any]:
        """Numbers that describe the run: effort, events, warnings, penetration of the contacts, balance."""
        return super().summary() | run_record({"run": self})

    def write(self, path: str | Path, *, lagrange: bool = False) -> Path:
        """Write frames (``.vtkhdf``) with the tools and planes of symmetry, or the history (``.csv``), atomically.

        Programs that do not read VTKHDF take the frames as ``.xdmf`` (with ``.xdmf.h5``) or ``.pvd`` (with a folder of
        ``.vtu`` files), or the last one as ``.vtu``; without tools.

        Parameters
        ----------
        path : str or Path
            The file to write.
        lagrange : bool, optional
            Whether frames of 18-node cells are written as Lagrange cells of VTK with the same nodes, which needs
            VTK 9.7 or later to read, and not as cells with 27 nodes, which every VTK reads. Of ``.vtkhdf`` only.

        Returns
        -------
        Path
            The file written.

        Raises
        ------
        InvalidValue
            If the suffix is another one, or the run kept no frames.
        FileProblem
            If the file cannot be written.
        """
        check_arguments(Result.write, path=path)
        path = Path(path)
        if not self._writes:
            return path
        if path.suffix == ".csv":
            from umform.io.tables import write_csv

            write_csv(path, self.table())
        elif path.suffix in _FIELDS:
            if not self.frames:
                raise InvalidValue(
                    "this run kept no frames",
                    where="write",
                    cause="frames=0, which a run without pictures has",
                    remedy="solve(..., frames=60)",
                )
            self._write_fields(path, lagrange)
        else:
            raise InvalidValue(
                "results are not written in this format",
                where="path",
                value=path.name,
                cause="another ending, or none",
                remedy=_WRITTEN,
            )
        return path

    def _write_fields(self, path: Path, lagrange: bool) -> None:
        mesh = (self.model.mesh.points, self.model.mesh.cell, self.model.mesh.connectivity)
        if path.suffix != ".vtkhdf":
            from umform.io.series import Grid, Step, write_series

            if lagrange:
                raise InvalidValue(
                    "only .vtkhdf has Lagrange cells",
                    where="lagrange",
                    value=path.name,
                    cause="other formats have cells with 27 nodes",
                    remedy="leave lagrange out",
                )
            write_series(path, Grid(*mesh), [Step(frame.time, frame.points, frame.cells) for frame in self.frames])
            return
        from umform.io.vtkhdf import BUFFER, VtkHdfSeries
        from umform.report.stored_scene import attach_scene

        with VtkHdfSeries(path, *mesh, lagrange=lagrange, buffer=BUFFER) as series:
            for frame in self.frames:
                series.append(frame.time, frame.points, frame.cells)
            attach_scene(series, self)

    def plot(self, x: str, y: str | list[str], path: str | Path | None = None) -> Figure:
        """Draw columns of the history against each other.

        Parameters
        ----------
        x : str
            Column along the horizontal axis.
        y : str or list of str
            One or more columns.
        path : str or Path, optional
            Picture to write: .png, .svg or .pdf.
        """
        from umform.plotting import plot_history

        return plot_history(self, x, [y] if isinstance(y, str) else y, path if self._writes else None)

    def report(self, path: str | Path, *, deck: str = "") -> Path:
        """Write one self-contained HTML page: the shape in 3D, curves, events, history, settings, deck, versions.

        Parameters
        ----------
        path : str or Path
            The page, ending in .html.
        deck : str, optional
            The input of the run, to be embedded in the page.

        Returns
        -------
        Path
            The page.

        Raises
        ------
        InvalidValue
            If the name does not end in .html.
        """
        from umform.report.page import write_report

        check_arguments(Result.report, path=path)
        return write_report(self, path, deck=deck) if self._writes else Path(path)
