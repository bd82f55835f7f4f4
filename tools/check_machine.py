"""Say at once what a machine lacks to build umform, and how to get it. Runs under any Python 3."""

# ruff: noqa: PTH118, PTH110, UP032, RUF005
import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig

OLDEST = (3, 11)
PROGRAM = b"#include <concepts>\n#include <span>\nint main() {}\n"


def missing():
    """Yield one sentence for each thing that is missing."""
    found = ".".join(str(n) for n in sys.version_info[:3])
    if sys.version_info[:2] < OLDEST:
        yield ("Python {}.{} or newer: {} is Python {}. Name another one: make PYTHON=/path/to/python3.11").format(
            *OLDEST, sys.executable, found
        )
        return
    if importlib.util.find_spec("ensurepip") is None:
        yield "Python's venv with pip. On Debian and Ubuntu: apt install python3-venv"
    header = os.path.join(sysconfig.get_paths()["include"], "Python.h")
    if not os.path.exists(header):
        yield "the headers of Python ({}). On Debian and Ubuntu: apt install python3-dev".format(header)
    compiler = os.environ.get("CXX") or shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        yield "a C++20 compiler. On Debian and Ubuntu: apt install g++"
        return
    command = compiler.split() + ["-std=c++20", "-fsyntax-only", "-x", "c++", "-"]
    try:
        done = subprocess.run(command, input=PROGRAM, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        reads = done.returncode == 0
    except OSError:
        reads = False
    if not reads:
        yield (
            "a C++20 compiler: {} cannot compile C++20 (g++ 11, clang 14 or newer do). "
            "Name another one: make CXX=g++-12"
        ).format(compiler)


if __name__ == "__main__":
    lacks = list(missing())
    for sentence in lacks:
        sys.stderr.write("umform needs " + sentence + "\n")
    sys.exit(1 if lacks else 0)
