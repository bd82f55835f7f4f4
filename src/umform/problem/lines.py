"""Line number of each key of a deck, which tomllib does not report.

The scanner follows headers, arrays of tables, dotted keys, inline tables, arrays and strings of all kinds. It does not
validate: for invalid TOML it keeps what it has understood, and it never fails.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Mapping
from contextlib import suppress

#: Keys of tables and indices of array entries, from the outside inwards.
Path = tuple[str | int, ...]

_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_SPACE = re.compile(r"[ \t]*")
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_QUOTED_KEY = re.compile(r'"((?:[^"\\\n]|\\.)*)"|\'([^\'\n]*)\'')
_STRING = re.compile(r'"""(?:[^\\]|\\.)*?"{3,5}|\'\'\'.*?\'{3,5}|"(?:[^"\\\n]|\\.)*"|\'[^\'\n]*\'', re.DOTALL)
_ESCAPE = re.compile(r"\\u([0-9A-Fa-f]{4})|\\U([0-9A-Fa-f]{8})|\\(.)")
_SHORT = {"b": "\b", "t": "\t", "n": "\n", "f": "\f", "r": "\r"}
_PLAIN = re.compile(r"[^,\]}\n#]*")
_REST = re.compile(r"[^\n]*")
#: Values nested deeper than this get the line of their container.
_DEEPEST = 60


def lines_of(text: str) -> dict[Path, int]:
    """Line of each key and array entry of a TOML text, from 1.

    Parameters
    ----------
    text : str
        The text, valid or not.

    Returns
    -------
    dict of path to int
        ``("steps", 0, "to")`` is the path of ``to`` in the first of the tables ``[[steps]]``.
    """
    scanner = _Scanner(text)
    with suppress(Exception):  # whatever the cause, the message that needs a line is more important
        scanner.run()
    return scanner.lines


def repeated(text: str) -> list[tuple[Path, int, int]]:
    """Keys and tables that a TOML text defines twice: the path, the line of the first and that of the second."""
    scanner = _Scanner(text)
    with suppress(Exception):
        scanner.run()
    return scanner.repeated


def nearest_line(lines: Mapping[Path, int], path: Path) -> int | None:
    """Line of a path, or of the innermost table around it that has one."""
    for end in range(len(path), 0, -1):
        if path[:end] in lines:
            return lines[path[:end]]
    return None


class _Scanner:
    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.lines: dict[Path, int] = {}
        self.repeated: list[tuple[Path, int, int]] = []
        self._given: dict[Path, int] = {}
        self._starts = [0, *(match.end() for match in re.finditer("\n", text))]
        self._counts: dict[Path, int] = {}

    def run(self) -> None:
        """Headers and keys in order; anything else is skipped."""
        table: Path = ()
        while self.at < len(self.text):
            self._skip(_BLANK)
            before = self.at
            if self._take("[["):
                table = self._header(array=True)
            elif self._take("["):
                table = self._header(array=False)
            elif not self._pair(table, 0):
                self._skip(_REST)
            self.at = max(self.at, before + 1)

    def _header(self, *, array: bool) -> Path:
        start = self.at
        keys = self._keys()
        path: Path = ()
        for number, key in enumerate(keys):
            path = (*path, key)
            if array and number == len(keys) - 1:
                self._counts[path] = self._counts.get(path, 0) + 1
                self._enter(path, start)
            if path in self._counts:
                path = (*path, self._counts[path] - 1)
            self._enter(path, start)
        if not array and keys:
            self._give(path, start)
        self._skip(_REST)
        return path

    def _pair(self, table: Path, depth: int) -> bool:
        """A key and its value; False if there is none."""
        start = self.at
        keys = self._keys()
        for end in range(1, len(keys) + 1):
            self._enter((*table, *keys[:end]), start)
        self._skip(_SPACE)
        if not keys or not self._take("="):
            return False
        self._skip(_SPACE)
        self._give((*table, *keys), start)
        self._value((*table, *keys), depth + 1)
        return True

    def _value(self, path: Path, depth: int) -> None:
        string = _STRING.match(self.text, self.at)
        if string:
            self.at = string.end()
        elif depth > _DEEPEST:
            self._skip(_REST)
        elif self._take("["):
            self._array(path, depth)
        elif self._take("{"):
            self._inline_table(path, depth)
        else:
            self._skip(_PLAIN)

    def _array(self, path: Path, depth: int) -> None:
        number = 0
        while self.at < len(self.text):
            self._skip(_BLANK)
            if self._take("]"):
                return
            before = self.at
            self._enter((*path, number), before)
            self._value((*path, number), depth + 1)
            self._skip(_BLANK)
            if self._take(","):
                number += 1
            elif self.at == before:
                return

    def _inline_table(self, path: Path, depth: int) -> None:
        while self.at < len(self.text):
            self._skip(_BLANK)
            if self._take("}"):
                return
            before = self.at
            self._pair(path, depth)
            self._skip(_BLANK)
            if not self._take(",") and self.at == before:
                return

    def _keys(self) -> list[str]:
        keys: list[str] = []
        while True:
            self._skip(_SPACE)
            bare, quoted = _BARE_KEY.match(self.text, self.at), _QUOTED_KEY.match(self.text, self.at)
            match = bare or quoted
            if match is None:
                return keys
            self.at = match.end()
            keys.append(match[0] if bare else _unescaped(match))
            self._skip(_SPACE)
            if not self._take("."):
                return keys

    def _take(self, mark: str) -> bool:
        if not self.text.startswith(mark, self.at):
            return False
        self.at += len(mark)
        return True

    def _skip(self, what: re.Pattern[str]) -> None:
        match = what.match(self.text, self.at)
        if match:
            self.at = match.end()

    def _enter(self, path: Path, at: int) -> None:
        self.lines.setdefault(path, bisect_right(self._starts, at))

    def _give(self, path: Path, at: int) -> None:
        """Store the line of a key or a table, and whether it had one before."""
        line = bisect_right(self._starts, at)
        if path in self._given:
            self.repeated.append((path, self._given[path], line))
        self._given.setdefault(path, line)


def _unescaped(match: re.Match[str]) -> str:
    basic, literal = match.groups()
    if literal is not None:
        return str(literal)
    return _ESCAPE.sub(lambda m: chr(int(m[1] or m[2], 16)) if m[1] or m[2] else _SHORT.get(m[3], m[3]), basic)
