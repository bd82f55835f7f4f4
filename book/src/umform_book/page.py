"""The page of a case: text, tables, plots, pictures and checks in the order in which the case enters them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from umform.errors import UmformError
from umform.plotting import plot_shape, save
from umform_book.balance import BalanceRow, balance_row
from umform_book.case import Case
from umform_book.checks import Check, Verdict
from umform_book.markdown import folded, markdown_table
from umform_book.pictures import small_png, small_svg
from umform_book.printed import shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from umform.analysis.run import Result
    from umform.analysis.steps import Step
    from umform.model import Model
    from umform.results.shape import Shape

Item = TypeVar("Item")
Cell = str | float | int | None


@dataclass(frozen=True)
class StudyRecord:
    """A normalised number (1 is right) for each element (its label) on each mesh (intervals along an edge)."""

    case: str
    title: str
    values: dict[str, dict[int, float]]


@dataclass(frozen=True)
class Comparison:
    """A number beside its measurement, as the summary prints it.

    Attributes
    ----------
    what : str
        The number and its unit.
    measured, computed, deviation, scatter : str
        Its values; the signed deviation of the computed one; the scatter of measurements, or of other codes.
    """

    what: str
    measured: str
    computed: str
    deviation: str
    scatter: str

    #: Heads of such a table.
    COLUMNS: ClassVar = ("what", "measured", "computed", "deviation", "scatter")

    @property
    def row(self) -> tuple[str, str, str, str, str]:
        """Its row in a table."""
        return self.what, self.measured, self.computed, self.deviation, self.scatter


@dataclass
class Page:
    """Results of a case.

    Attributes
    ----------
    case : Case
        The case.
    images : Path or None
        Folder for pictures; without one, none are drawn.
    short : bool
        Whether only the short meshes are run.
    main : str
        The picture that stands first (Markdown).
    """

    case: Case
    images: Path | None = None
    short: bool = False
    tick: Callable[[str, float], None] = lambda what, done: None
    blocks: list[str] = field(default_factory=list)
    checks: list[Check] = field(default_factory=list)
    balances: list[BalanceRow] = field(default_factory=list)
    studies: list[StudyRecord] = field(default_factory=list)
    comparisons: list[Comparison] = field(default_factory=list)
    pictures: list[Path] = field(default_factory=list)
    main: str = ""

    @property
    def verdict(self) -> Verdict:
        """The worst of all checks, where an expected failure counts as green; red without any check."""
        worst = max((check.verdict for check in self.checks), default=Verdict.RED)
        return Verdict.GREEN if worst is Verdict.EXPECTED else worst

    # What a case calls ------------------------------------------------------------------------------------------

    def pick(self, whole: Sequence[Item], short: Sequence[Item]) -> Sequence[Item]:
        """The items, such as meshes, of the whole case or of the short one."""
        return short if self.short else whole

    def each(self, items: Iterable[Item], label: Callable[[Item], str] = str) -> Iterator[Item]:
        """Run through items and report progress."""
        sequence = list(items)
        for number, item in enumerate(sequence):
            self.tick(label(item), number / len(sequence))
            yield item
        self.tick("", 1.0)

    def solve(self, label: str, model: Model, steps: Sequence[Step] | Step, **options: Any) -> Result:
        """Solve a nonlinear problem and enter its balance of work and forces, and the order of Newton's method."""
        from umform.analysis.run import solve

        try:
            result = solve(model, steps, progress=False, **{"frames": 0, **options})
        except UmformError as error:  # what was reached counts too
            reached: Result = error.result  # type: ignore[attr-defined]
            self.balances.append(balance_row(self.case.name, f"{label} (ended early)", reached))
            raise
        self.balances.append(balance_row(self.case.name, label, result))
        return result

    def text(self, markdown: str) -> None:
        """Add a paragraph."""
        self.blocks.append(markdown)

    def heading(self, title: str) -> None:
        """Begin a section of the results."""
        self.blocks.append(f"### {title}")

    def table(self, title: str, columns: Sequence[str], rows: Iterable[Sequence[Cell]]) -> None:
        """Add a table, folded if it is long; numbers have four digits, None is a dash."""
        lines = [tuple(_cell(cell) for cell in row) for row in rows]
        self.blocks.append(folded(title, markdown_table(columns, lines, numbers=True), len(lines)))

    def check(
        self,
        what: str,
        found: float,
        reference: float,
        within: float,
        *,
        relative: bool = True,
        known: float = 0.0,
        cause: str = "",
        theory: str = "",
    ) -> Check:
        """Compare a number with its reference, see :class:`Check`."""
        check = Check(what, float(found), float(reference), within, relative, known, cause, theory)
        self.checks.append(check)
        return check

    def at_most(
        self, what: str, found: float, limit: float, *, known: float = 0.0, cause: str = "", theory: str = ""
    ) -> Check:
        """Check that an error, which should be zero, is not above a limit."""
        return self.check(what, found, 0.0, limit, relative=False, known=known, cause=cause, theory=theory)

    def compare(self, what: str, computed: float, measured: float | None, scatter: str = "-") -> None:
        """Enter a number beside its measurement into the first table of the page and of the summary.

        Parameters
        ----------
        what : str
            The number and its unit.
        computed, measured : float
            Its values; None where no measurement is at hand.
        scatter : str
            Scatter of the measurements, or of other codes.
        """
        given = "not at hand" if measured is None else shown(float(measured))
        deviation = "-" if measured is None else f"{computed - measured:+.3g}"
        self.comparisons.append(Comparison(what, given, shown(float(computed)), deviation, scatter))

    def figure(self, name: str, figure: Figure, caption: str) -> None:
        """Add a plot."""
        if self.images is None:
            return
        path = save(figure, self.images / f"{self.case.name}-{name}.svg")
        path.write_text(small_svg(path.read_text(encoding="utf-8")), encoding="utf-8")
        self._show(path, caption)

    def shape(
        self,
        name: str,
        shape: Shape | Result,
        caption: str,
        *,
        values: str | None = None,
        view: tuple[float, float] = (-115.0, 28.0),
    ) -> None:
        """Add a picture of a deformed shape."""
        if self.images is None:
            return
        path = self.images / f"{self.case.name}-{name}.png"
        save(plot_shape(shape, values, view=view), path, dpi=90)
        path.write_bytes(small_png(path.read_bytes()))
        self._show(path, caption)

    def _show(self, path: Path, caption: str) -> None:
        """Add a picture; the main one of the case stands first on the page instead."""
        block = f"![{caption}](images/{path.name})\n\n*{caption}*"
        wanted = self.case.picture
        first = path.stem == f"{self.case.name}-{wanted}" if wanted else not self.pictures
        self.pictures.append(path)
        if first:
            self.main = block
        else:
            self.blocks.append(block)


def _cell(cell: Cell) -> str:
    if cell is None:
        return "-"
    return shown(cell) if isinstance(cell, float) else str(cell)
