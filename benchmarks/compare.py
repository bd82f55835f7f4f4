"""Compare the speed of two commits: both are built, and run the same workloads in turns on the same machine.

``python benchmarks/compare.py main HEAD`` prints for each workload of ``workloads.py`` the CPU seconds of the first
commit and the ratio second / first: the median over the rounds and its spread. A ratio is of two runs that follow each
other, and who goes first changes from round to round, so that a shared machine troubles both alike. Below 1 the second
commit is faster. ``WORK`` stands for the files as they are, committed or not.

Each commit is checked out by ``git worktree`` into a temporary folder and its kernels are compiled by CMake, once where
they are the same in both.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import record

ROOT = Path(__file__).resolve().parents[1]
#: What the compiled core is made of.
KERNELS = ("cpp", "CMakeLists.txt")


def run(*command: str | Path, **options: object) -> str:
    """Output of a command; the script ends with what it has to say if it fails."""
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True, **options)  # type: ignore[call-overload]
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return str(done.stdout)


@contextmanager
def checked_out(commit: str, folder: Path) -> Iterator[Path]:
    """A folder with the files of a commit, or a copy of those that stand here."""
    if commit == "WORK":
        ignore = shutil.ignore_patterns("*.so", "__pycache__")
        for name in ("src", "cpp", "cmake"):
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, folder / name, ignore=ignore)
        for name in ("CMakeLists.txt", "pyproject.toml"):
            shutil.copy(ROOT / name, folder)
        yield folder
        return
    run("git", "-C", ROOT, "worktree", "add", "--detach", folder, commit)
    try:
        yield folder
    finally:
        run("git", "-C", ROOT, "worktree", "remove", "--force", folder)


def fingerprint(source: Path) -> str:
    """What tells whether two folders have the same kernels."""
    files = sorted(file for name in KERNELS for file in [source / name, *(source / name).rglob("*")] if file.is_file())
    return run("git", "hash-object", "--", *files)


def build(source: Path, folder: Path) -> Path:
    """Compile the kernels of a source folder; return the library."""
    import nanobind

    tools = {**os.environ, "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])}
    options = ("-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", f"-Dnanobind_DIR={nanobind.cmake_dir()}")
    run("cmake", "-S", source, "-B", folder, f"-DPython_EXECUTABLE={sys.executable}", *options, env=tools)
    run("cmake", "--build", folder, env=tools)
    return next(folder.glob("_core*.so"))


def measure(source: Path) -> dict[str, float]:
    """CPU seconds of the workloads with the umform of a source folder."""
    variables = {**os.environ, "PYTHONPATH": str(source / "src"), "OMP_NUM_THREADS": "1"}
    output = run(sys.executable, ROOT / "benchmarks/workloads.py", env=variables, cwd=source)
    numbers: dict[str, float] = json.loads(output)
    return numbers


def main() -> None:
    """Build, run in turns, print ratios."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", help="a commit, or WORK")
    parser.add_argument("second", help="a commit, or WORK")
    parser.add_argument("--rounds", type=int, default=5, help="how often both run")
    record.add_option(parser)
    arguments = parser.parse_args()

    with ExitStack() as stack:
        temporary = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="umform-compare-")))
        sources, libraries = [], {}
        for place, commit in (("a", arguments.first), ("b", arguments.second)):
            folder = temporary / place
            if commit == "WORK":
                folder.mkdir()
            source = stack.enter_context(checked_out(commit, folder))
            kernels = fingerprint(source)
            if kernels not in libraries:
                print(f"compiling {commit}", flush=True)
                libraries[kernels] = build(source, temporary / f"build-{place}")
            shutil.copy(libraries[kernels], source / "src/umform")
            sources.append(source)
        rounds = in_turns(sources, arguments.rounds)
    report(rounds, arguments)


def in_turns(sources: list[Path], count: int) -> list[list[dict[str, float]]]:
    """Numbers of both sources in each round."""
    rounds = []
    for number in range(count):
        order = (0, 1) if number % 2 == 0 else (1, 0)
        numbers = {k: measure(sources[k]) for k in order}
        rounds.append([numbers[0], numbers[1]])
        print(f"round {number + 1} of {count}", flush=True)
    return rounds


def report(rounds: list[list[dict[str, float]]], arguments: argparse.Namespace) -> None:
    """Print ratios with their spread, and write them."""
    print(f"{'':<38}{'CPU s':>8}{'ratio':>8}   least to most   {arguments.second} / {arguments.first}")
    found = {}
    for name in rounds[0][0]:
        ratios = sorted(second[name] / first[name] for first, second in rounds)
        seconds, middle = statistics.median(first[name] for first, _ in rounds), statistics.median(ratios)
        print(f"{name:<38}{seconds:>8.3f}{middle:>8.3f}   {ratios[0]:.3f} to {ratios[-1]:.3f}")
        found |= {f"{name}, ratio": middle, f"{name}, least": ratios[0], f"{name}, most": ratios[-1]}
    record.write(arguments.json, f"compare {arguments.first} {arguments.second}", found)


if __name__ == "__main__":
    main()
