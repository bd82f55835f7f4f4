"""Mutants: small errors put into the code on purpose, each of which a test must notice.

Each row of tests/mutants.toml has a file, a text that occurs there once, what takes its place, and the tests that must
fail then. `make mutants` applies them one after the other to a copy in build/mutants, builds what a test needs, runs it
and reports: killed, survived, or equivalent, where the row says why no test can notice. The installed package and the
checkout stay as they are.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ROWS = ROOT / "tests" / "mutants.toml"
PLACE = ROOT / "build" / "mutants"
TREE = PLACE / "tree"
#: As deep as build/venv, so that ccache knows the objects.
BUILD = TREE / "build" / "venv"
#: What the kernels are built from.
SOURCES = ("CMakeLists.txt", "cpp", "tests/cpp")
#: Seconds until a test is stopped; a mutant that hangs is noticed.
LIMIT = 300


@dataclass(frozen=True)
class Mutant:
    """One row: old becomes new in a file, and one of the tests fails, or the row says why none can."""

    name: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]
    equivalent: str = ""

    @property
    def compiled(self) -> bool:
        """Whether the file is C++."""
        return self.file.endswith((".hpp", ".cpp"))


def load(path: Path = ROWS) -> list[Mutant]:
    """The rows of a file."""
    rows = tomllib.loads(path.read_text())["mutant"]
    return [Mutant(**{**row, "tests": tuple(row["tests"])}) for row in rows]


def problems(mutants: list[Mutant], root: Path = ROOT) -> list[str]:
    """What is wrong with rows: texts that do not occur once, tests that do not exist, names that occur twice."""
    found = []
    names = [mutant.name for mutant in mutants]
    found += [f"{name}: the name occurs twice" for name in sorted({n for n in names if names.count(n) > 1})]
    for mutant in mutants:
        path = root / mutant.file
        count = path.read_text().count(mutant.old) if path.is_file() else 0
        if count != 1 or not mutant.old.strip():
            found.append(f"{mutant.name}: the old text occurs {count} times in {mutant.file}")
        if mutant.old == mutant.new:
            found.append(f"{mutant.name}: it changes nothing")
        if not mutant.tests:
            found.append(f"{mutant.name}: it names no test")
        found += [f"{mutant.name}: there is no test {test}" for test in mutant.tests if not _exists(root, test)]
    return found


def _exists(root: Path, test: str) -> bool:
    """Whether a C++ test, or a function of a file of pytest, is there."""
    file, _, function = test.partition("::")
    if not (root / file).is_file():
        return False
    if file.endswith(".cpp"):
        return not function
    name = function.partition("[")[0].rpartition("::")[2]
    return not name or re.search(rf"^\s*def {re.escape(name)}\(", (root / file).read_text(), re.M) is not None


class Sandbox:
    """A copy of sources, objects and package in which mutants are tried."""

    def __init__(self, compiled: bool) -> None:
        installed = Path(sysconfig.get_path("platlib")) / "umform"
        PLACE.mkdir(parents=True, exist_ok=True)
        self.package = Path(tempfile.mkdtemp(prefix="package-", dir=PLACE))
        copy = self.package / "umform"
        shutil.copytree(installed, copy, ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copytree(ROOT / "src" / "umform", copy, dirs_exist_ok=True)
        self._core = next(copy.glob("_core*.so"))
        self._installed = installed / self._core.name
        if compiled:
            self._sync()
            self._configure()

    def try_out(self, mutant: Mutant) -> tuple[str, str]:
        """The outcome of a mutant, and the test that noticed it."""
        path = self.package / Path(mutant.file).relative_to("src") if not mutant.compiled else TREE / mutant.file
        text = path.read_text()
        path.write_text(text.replace(mutant.old, mutant.new))
        try:
            test = self._failing(mutant)
        finally:
            path.write_text(text)
            shutil.copy2(self._installed, self._core)
        if mutant.equivalent:
            return ("killed, but called equivalent", test) if test else ("equivalent", mutant.equivalent)
        return ("killed", test) if test else ("survived", ", ".join(mutant.tests))

    def passes(self, tests: list[str]) -> str:
        """Output of tests of the code as it is; empty if they pass."""
        python = sorted({test for test in tests if not test.endswith(".cpp")})
        compiled = sorted({test for test in tests if test.endswith(".cpp")})
        outputs = [self._run_cpp(test) for test in compiled] + [self._pytest(python) if python else ""]
        return "\n".join(output for output in outputs if output)

    def _failing(self, mutant: Mutant) -> str:
        """The first test that fails."""
        python = [test for test in mutant.tests if not test.endswith(".cpp")]
        for test in mutant.tests:
            if test.endswith(".cpp") and self._run_cpp(test):
                return test
        if python and mutant.compiled:
            self._build("_core")
            shutil.copy2(BUILD / self._core.name, self._core)
        return next((test for test in python if self._pytest([test])), "")

    def _sync(self) -> None:
        """Copy what has changed, so that the objects of the rest stay."""
        for name in SOURCES:
            for path in [ROOT / name, *(ROOT / name).rglob("*")]:
                target = TREE / path.relative_to(ROOT)
                if path.is_file() and not (target.is_file() and target.read_bytes() == path.read_bytes()):
                    target.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(path, target)

    def _configure(self) -> None:
        """The options of the installed build, and the tests."""
        options = ROOT / "build" / "venv" / "CMakeInit.txt"
        _quietly([_tool("cmake"), "-C", options, "-S", TREE, "-B", BUILD, "-G", "Ninja", "-DUMFORM_BUILD_TESTS=ON",
                  f"-DCMAKE_MAKE_PROGRAM={_tool('ninja')}", "-DCMAKE_BUILD_TYPE=Release"])  # fmt: skip

    def _build(self, target: str) -> None:
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", "1")
        _quietly([_tool("cmake"), "--build", BUILD, "--target", target, "-j", jobs])

    def _run_cpp(self, test: str) -> str:
        """Output of a C++ test that fails, else empty."""
        target = Path(test).relative_to("tests/cpp").with_suffix("").as_posix().replace("/", "_")
        self._build(target)
        return self._output([BUILD / "tests" / "cpp" / target])

    def _pytest(self, tests: list[str]) -> str:
        """Output of tests of Python if one fails, else empty."""
        return self._output([sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests])

    def _output(self, command: list[object]) -> str:
        """What a program says that fails or takes too long, else nothing."""
        environment = {
            **os.environ,
            "PYTHONPATH": str(self.package),
            "OMP_NUM_THREADS": "1",
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        parts = [str(part) for part in command]
        try:
            done = subprocess.run(
                parts, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=LIMIT, check=False
            )
        except subprocess.TimeoutExpired:
            return f"no end after {LIMIT} s"
        return (done.stdout + done.stderr or "it failed") if done.returncode else ""


def _tool(name: str) -> Path:
    """A program beside this interpreter."""
    return Path(sys.executable).parent / name


def _quietly(command: list[object]) -> None:
    """Run a program; its output is shown only if it fails."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{done.stdout}\n{done.stderr}\nthe mutant cannot be built")


def main() -> None:
    """Try the mutants whose names contain one of the words; without words all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", help="parts of names of mutants; default: all")
    parser.add_argument("--check", action="store_true", help="only look whether texts and tests are there")
    options = parser.parse_args()
    mutants = load()
    wrong = problems(mutants)
    if wrong:
        raise SystemExit("\n".join(wrong))
    if options.check:
        return
    mutants = [m for m in mutants if not options.words or any(word in m.name for word in options.words)]
    compiled = any(m.compiled or any(t.endswith(".cpp") for t in m.tests) for m in mutants)
    sandbox = Sandbox(compiled)
    try:
        lost = _try_all(sandbox, mutants)
    finally:
        shutil.rmtree(sandbox.package)
    print(f"{len(mutants) - lost} of {len(mutants)} mutants are killed or equivalent")
    raise SystemExit(1 if lost else 0)


def _try_all(sandbox: Sandbox, mutants: list[Mutant]) -> int:
    """Report the outcome of mutants; return the number of those that no test notices."""
    output = sandbox.passes([test for mutant in mutants for test in mutant.tests])
    if output:
        raise SystemExit(f"{output}\nthese tests fail without a mutant")
    lost = 0
    for mutant in mutants:
        verdict, reason = sandbox.try_out(mutant)
        lost += verdict not in ("killed", "equivalent")
        print(f"{verdict:10s} {mutant.name}: {reason}", flush=True)
    return lost


if __name__ == "__main__":
    main()
