"""What Windows lacks is not needed to import umform; the lock of files that stands in for one of them."""

import subprocess
import sys
from pathlib import Path

#: Modules and names of a POSIX system; the platform changes once the packages of others are loaded.
WITHOUT = """
import importlib, os, pkgutil, signal, sys, types

import ezdxf, h5py, matplotlib.pyplot, meshio, numpy, pydantic, rich.console, scipy.linalg, scipy.optimize
import scipy.sparse.linalg, starlette.applications, typer, uvicorn
import asyncio, concurrent.futures.process, ctypes, multiprocessing.context, selectors, subprocess, tempfile, webbrowser

POSIX = ("fcntl", "grp", "posix", "pty", "pwd", "resource", "syslog", "termios", "tty")
for name in POSIX:
    sys.modules[name] = None
for owner, names in (
    (os, "fork forkpty getloadavg getpgid getuid geteuid killpg sched_getaffinity setsid uname"),
    (signal, "SIGALRM SIGHUP SIGKILL SIGPIPE SIGQUIT SIGUSR1"),
):
    for name in names.split():
        delattr(owner, name)
sys.modules["msvcrt"] = types.ModuleType("msvcrt")
sys.platform = "win32"

import umform, umform_book
"""

IMPORT_ALL = """
failed, count = [], 0
for package in (umform, umform_book):
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        if module.name.split(".")[:2] == ["umform", "parallel"] or module.name.endswith("__main__"):
            continue  # MPI is for Linux
        try:
            importlib.import_module(module.name)
            count += 1
        except Exception as error:
            failed.append(f"{module.name}: {type(error).__name__}: {error}")
print(count, *failed, sep="\\n")
"""

LOCK = """
def locking(descriptor, mode, count):
    assert (mode, count) == (2, 1)
    assert os.lseek(descriptor, 0, os.SEEK_CUR) > 1e9  # far from what others read
    calls.append(descriptor)
    if len(calls) > 1:
        raise OSError(13, "Permission denied")

calls = []
sys.modules["msvcrt"].LK_NBLCK, sys.modules["msvcrt"].locking = 2, locking
from umform.io.locks import try_lock

with open("lock", "w+") as file:
    print(try_lock(file), try_lock(file, shared=True))
    file.write("12")
print(open("lock").read())
"""


def run(script, folder):
    done = subprocess.run([sys.executable, "-c", script], cwd=folder, capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_every_module_is_imported_without_what_windows_lacks(tmp_path):
    count, *failed = run(WITHOUT + IMPORT_ALL, tmp_path)
    assert failed == []
    assert int(count) > 400


def test_the_lock_of_windows_is_a_byte_that_no_reader_wants(tmp_path):
    assert run(WITHOUT + LOCK, tmp_path) == ["True False", "12"]
    assert (Path(tmp_path) / "lock").stat().st_size == 2
