"""Refuse Abaqus input that meshio would misread."""

from __future__ import annotations

from pathlib import Path

from umform.errors import FileProblem

NOT_READ = {"INCLUDE", "SYSTEM", "NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY"}


def checked_abaqus(path: Path) -> str:
    """The text of a file without its comments, at which meshio would end a list of nodes, elements or sets.

    Rejects the other parts of the Abaqus language that meshio would read wrongly without saying so.

    These are generated or included nodes and elements, several lists of nodes (parts and assemblies), sets
    made of other sets, sets given in pieces, and element sets named on some ``*ELEMENT`` lines only.

    Parameters
    ----------
    path : pathlib.Path
        The input file.

    Raises
    ------
    FileProblem
        The file has such a part, or cannot be read.
    """
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise FileProblem(
            "the mesh file cannot be read",
            where=str(path),
            cause=error.strerror or str(error),
            remedy="look at the path: it is gone, has another name, or must not be read",
        ) from error
    keyword = ""
    node_lists = 0
    named: list[tuple[str, str]] = []  # (NSET or ELSET, name)
    element_sets: list[str] = []  # one entry for each *ELEMENT
    for number, line in enumerate(lines, start=1):
        text = line.strip()
        if not text or text.startswith("**"):
            continue
        doubt = ""
        if text.startswith("*"):
            keyword, options = _keyword(text)
            if keyword in NOT_READ:
                doubt = f"*{keyword} is not read"
            elif keyword == "NODE":
                node_lists += 1
                doubt = "there is more than one list of nodes" if node_lists > 1 else ""
            elif keyword == "ELEMENT":
                element_sets.append(options.get("ELSET", ""))
            elif keyword in ("NSET", "ELSET"):
                named.append((keyword, options.get(keyword, "")))
                doubt = "the set is given in several pieces" if named.count(named[-1]) > 1 else ""
        elif keyword in ("NSET", "ELSET") and not text.split(",")[0].strip().isdigit():
            doubt = f"the {keyword} is made of other sets"
        if doubt:
            raise _doubtful(path, number, text, doubt)
    given = [name for name in element_sets if name]
    all_named = given + [name for keyword, name in named if keyword == "ELSET"]
    if given and (len(given) < len(element_sets) or len(set(all_named)) < len(all_named)):
        raise _doubtful(
            path,
            len(lines),
            ", ".join(given),
            "ELSET must stand on all *ELEMENT lines, with different names, or on none",
        )
    return "\n".join(line for line in lines if not line.lstrip().startswith("**")) + "\n"


def _keyword(text: str) -> tuple[str, dict[str, str]]:
    """Split a keyword line such as ``*ELSET, ELSET=sheet, GENERATE``."""
    keyword, *options = (part.strip() for part in text.lstrip("*").split(","))
    pairs = (option.partition("=") for option in options)
    return keyword.upper(), {key.strip().upper(): value.strip() for key, _, value in pairs}


def _doubtful(path: Path, number: int, text: str, cause: str) -> FileProblem:
    """The error for a line that cannot be read unambiguously."""
    return FileProblem(
        "this Abaqus file cannot be read without doubt about its meaning",
        where=f"{path}, line {number}",
        value=text,
        cause=cause,
        remedy="export a flat file: one *NODE list, *ELEMENT lists, sets as plain numbers",
    )
