"""Imported first by the benchmarks that take problems of the verification book, which is a package of its own."""

from importlib.util import find_spec

if find_spec("umform_book") is None:
    raise SystemExit("this benchmark takes a problem of the verification book: make book, or pip install ./book")
