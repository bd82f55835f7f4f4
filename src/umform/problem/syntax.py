"""Invalid TOML: the probable intention, from the line at which the parser stops."""

from __future__ import annotations

import re
import unicodedata

from umform.problem.errors import DeckSyntax, shortened, written
from umform.problem.lines import repeated

#: Numbers written with a decimal comma, as values of a key, or within an inline table.
_COMMA = re.compile(r"(?<![A-Za-z0-9_-])([A-Za-z0-9_-]+)\s*=\s*([-+]?\d[\d.]*),(\d+(?:[eE][-+]?\d+)?)\s*(?=$|#|\}|,)")
#: Numbers without digits on one side of the point.
_BARE_POINT = re.compile(r"=\s*([-+]?)(?:\.(\d+)|(\d+)\.)(?=\s*(?:$|#|\}|,))")
#: Unquoted text before the equals sign or within the brackets of a header.
_KEY = re.compile(r"""\s*\[{0,2}([^="'#\]]*)""")
_LETTERS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "ß": "ss", "ø": "oe"})

_OTHERWISE = 'words stand in quotes, name = "die"; tables begin with [name], lists of tables with [[name]]'


def no_toml(text: str, name: str, error: Exception) -> DeckSyntax:
    """The error for a text that the parser refuses.

    Parameters
    ----------
    text : str
        The text.
    name : str
        Of the file.
    error : Exception
        The error of the parser.
    """
    said = str(error).splitlines()[0] if str(error) else type(error).__name__
    place = re.search(r"\(at line (\d+), column (\d+)\)", said)
    lines = text.splitlines()
    number = int(place[1]) if place else len(lines)
    wrong = lines[number - 1].strip() if 0 < number <= len(lines) else ""
    if isinstance(error, RecursionError):
        said = "arrays or tables are nested too deeply"
    cause, remedy = _meant(text, number, wrong, said) or (re.sub(r" \(at .*\)$", "", said), _OTHERWISE)
    return DeckSyntax(
        "the deck is no TOML",
        where=f"{name}, line {number}" + (f", column {place[2]}" if place else ""),
        value=shortened(wrong) if wrong else None,
        cause=cause,
        remedy=remedy,
    )


def _meant(text: str, number: int, line: str, said: str) -> tuple[str, str] | None:
    """Cause and remedy of a common mistake, or None."""
    if re.search(r"overwrite|twice|[Dd]uplicate", said):
        return _twice(text, number)
    if comma := _COMMA.search(line):
        key, whole, decimals = comma.groups()
        return "a decimal comma", f"numbers have a decimal point: {key} = {whole.replace('.', '')}.{decimals}"
    if point := _BARE_POINT.search(line):
        sign, decimals, whole = point.groups()
        return "no digit on one side of the point", f"write {sign}{whole or '0'}.{decimals or '0'}"
    key_match = _KEY.match(line)
    if key_match and not key_match[1].isascii():
        key = key_match[1].strip()
        remedy = f"names are made of the letters a to z, digits, _ and -: {_ascii(key)}"
        return f"a letter that keys and tables cannot have: {key}", remedy
    return None


def _twice(text: str, number: int) -> tuple[str, str] | None:
    """Cause and remedy of a key or a table that is defined twice; the parser reports the end of the second one."""
    found = [(path, first) for path, first, second in repeated(text) if second <= number]
    if not found:
        return None
    path, first = found[-1]
    remedy = "take one of the two out; a table has one header, and lists of tables begin with [[name]]"
    return f"{written(path)} is given twice: it stands on line {first} already", remedy


def _ascii(word: str) -> str:
    """A word without accents."""
    plain = unicodedata.normalize("NFKD", unicodedata.normalize("NFC", word).translate(_LETTERS))
    return plain.encode("ascii", "ignore").decode()
