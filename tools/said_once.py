"""Find defaults and bounds of parameters that are stated a second time: `make lint` calls it.

A parameter is declared by a field with a sentence below it, or by an argument of a function whose arguments are keys
of a deck (`of=`) or options of another function (`takes`). Its numbers are to be read there. These state them again:

- a default of the same name and number: of another argument, a field without a sentence, an option, a constant;
- a comparison of the name with a bound;
- a text that names the parameter and its default, such as "`die_radius` (default 2.1)".

0 and 1 are left out, which too many things have by nature.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

ROOT = Path(__file__).parents[1]
#: Things of other meaning that have name and number of a parameter by chance.
OTHERS = {
    ("src/umform/analysis/shadows/shadow.py", "TOLERANCE"): "of a derivative, not of the force of a release",
    ("src/umform/sheet_metals/cyclic_fit.py", "_TOLERANCE"): "of a fit, not of the force of a release",
}
#: A name as code, and a default in the same clause.
TOLD = re.compile(
    r"`+(?:--)?([a-z]\w*(?:-\w+)*)`+[^.;|`]{0,40}?\bdefault:?(?: is| of)? `?(-?\d+(?:\.\d+)?(?:e-?\d+)?)(?![\w/])"
)

#: A place of a declaration, or of what states it again: file, line, name, number.
Found = tuple[Path, int, str, float]


def number(node: ast.expr | None) -> float | None:
    """The number that an expression is; none if it is another one, 0 or 1."""
    try:
        value = ast.literal_eval(node) if node is not None else None
    except ValueError:
        return None
    return value if type(value) in (int, float) and value not in (-1, 0, 1) else None


def arguments(function: ast.FunctionDef) -> Iterator[tuple[ast.arg, ast.expr | None]]:
    """Arguments of a function with their defaults."""
    places = [*function.args.posonlyargs, *function.args.args]
    none = [None] * (len(places) - len(function.args.defaults))
    yield from zip(places, [*none, *function.args.defaults], strict=True)
    yield from zip(function.args.kwonlyargs, function.args.kw_defaults, strict=True)


def bounds(node: ast.expr | None) -> Iterator[float]:
    """Bounds in an annotation, Ge(2) or Field(ge=2)."""
    for one in ast.walk(node) if node is not None else ():
        if isinstance(one, ast.Call) and isinstance(one.func, ast.Name):
            kept = one.args if one.func.id in ("Gt", "Ge", "Lt", "Le") else []
            kept = (
                [k.value for k in one.keywords if k.arg in ("gt", "ge", "lt", "le")] if one.func.id == "Field" else kept
            )
            yield from (value for value in map(number, kept) if value is not None)


class Source:
    """The Python files of a folder: what they declare, and what they state."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.trees = {file: ast.parse(file.read_text(encoding="utf-8")) for file in sorted(root.glob("src/**/*.py"))}
        nodes = [(file, node) for file, tree in self.trees.items() for node in ast.walk(tree)]
        self.types: dict[str, set[float]] = {}
        for _, node in nodes:
            if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
                self.types.setdefault(node.targets[0].id, set()).update(bounds(node.value))
        taken = set(self._taken(node for _, node in nodes))
        self.defaults: dict[str, dict[float, Path]] = {}
        self.bounds: dict[str, dict[float, Path]] = {}
        self.places: set[tuple[Path, int]] = set()
        self.sentences: dict[tuple[str, float, str], Path] = {}
        self.twice: list[str] = []
        fields: dict[str, set[str]] = {}
        for file, node in nodes:
            if isinstance(node, ast.ClassDef):
                for one, below in pairwise([*node.body, ast.Pass()]):
                    if isinstance(one, ast.AnnAssign) and isinstance(one.target, ast.Name):
                        name = one.target.id
                        text = below.value if isinstance(below, ast.Expr) else None
                        known = {getattr(base, "id", "") for base in node.bases} & fields.get(name, set())
                        if text is not None or known:  # a subclass may have another default
                            fields.setdefault(name, set()).add(node.name)
                            self._declare(file, one.lineno, name, one.annotation, one.value)
                            self._tell(file, one, name, text)
            elif isinstance(node, ast.FunctionDef) and node.name in taken:
                for argument, default in arguments(node):
                    self._declare(file, argument.lineno, argument.arg, argument.annotation, default)

    def _taken(self, nodes: Iterator[ast.AST]) -> Iterator[str]:
        """Names of functions whose arguments a table or another function takes."""
        for node in nodes:
            named = [k.value for k in node.keywords if k.arg == "of"] if isinstance(node, ast.ClassDef) else []
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "takes":
                named = node.args[:1]
            yield from (one.attr if isinstance(one, ast.Attribute) else getattr(one, "id", "") for one in named)

    def _declare(self, file: Path, line: int, name: str, hint: ast.expr | None, default: ast.expr | None) -> None:
        self.places.add((file, line))
        if (value := number(default)) is not None:
            self.defaults.setdefault(name, {})[value] = file
        used = {one.id for one in ast.walk(hint) if isinstance(one, ast.Name)} if hint is not None else set()
        for bound in [*bounds(hint), *(limit for one in used for limit in self.types.get(one, ()))]:
            self.bounds.setdefault(name, {})[bound] = file

    def _tell(self, file: Path, one: ast.AnnAssign, name: str, text: ast.expr | None) -> None:
        """Two fields with name, number and sentence are one."""
        value = number(one.value)
        if value is not None and isinstance(text, ast.Constant):
            first = self.sentences.setdefault((name, value, " ".join(str(text.value).split())), file)
            if first is not file:
                place = f"{file.relative_to(self.root)}:{one.lineno}"
                self.twice.append(f"{place}: {name} and {value:g}: read it from {first.relative_to(self.root)}")

    def again(self) -> Iterator[str]:
        """What states a number of a parameter again, in the code."""
        for file, tree in self.trees.items():
            for node in ast.walk(tree):
                for line, name, value, known in self._stated(node):
                    home = known.get(name.strip("_").lower(), {}).get(value)
                    place = file.relative_to(self.root)
                    if home and (file, line) not in self.places and (place.as_posix(), name) not in OTHERS:
                        yield f"{place}:{line}: {name} and {value:g}: read it from {home.relative_to(self.root)}"

    def _stated(self, node: ast.AST) -> Iterator[tuple[int, str, float, dict[str, dict[float, Path]]]]:
        """Line, name and number of the defaults and comparisons of a node."""
        pairs: list[tuple[str, ast.expr | None]] = []
        if isinstance(node, ast.FunctionDef):
            for argument, default in arguments(node):
                if (value := number(default)) is not None:
                    yield argument.lineno, argument.arg, value, self.defaults
        elif isinstance(node, ast.AnnAssign | ast.Assign):
            target = node.target if isinstance(node, ast.AnnAssign) else node.targets[0]
            pairs = [(target.id, node.value)] if isinstance(target, ast.Name) else []
        elif isinstance(node, ast.Call) and getattr(node.func, "id", "") == "given_by":
            pairs = [(one.arg or "", one.value) for one in node.keywords]
        elif isinstance(node, ast.Compare):
            parts = [node.left, *node.comparators]
            names = {getattr(part, "attr", getattr(part, "id", "")) for part in parts} - {""}
            for value in map(number, parts):
                yield from ((node.lineno, name, value, self.bounds) for name in sorted(names) if value is not None)
        for name, expression in pairs:
            if (value := number(expression)) is not None:
                yield node.lineno, name, value, self.defaults  # type: ignore[attr-defined]

    def told(self) -> Iterator[str]:
        """Texts that name a parameter and its default: pages, and strings of the code."""
        names = set(self.defaults) | set(self.bounds)
        for page in [*sorted(self.root.glob("*.md")), *sorted(self.root.glob("docs/**/*.md")), *self.trees]:
            text = page.read_text(encoding="utf-8")
            for match in TOLD.finditer(text):
                if match[1].replace("-", "_") in names:
                    line = text.count("\n", 0, match.start()) + 1
                    what = (
                        f"{match[1]} and its default {match[2]}: the sentence of the parameter is read with its default"
                    )
                    yield f"{page.relative_to(self.root)}:{line}: {what}"


def said_twice(root: Path = ROOT) -> list[str]:
    """What is stated a second time below a folder with `src` and `docs`."""
    source = Source(root)
    return [*source.twice, *source.again(), *source.told()]


if __name__ == "__main__":
    found = said_twice()
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)
