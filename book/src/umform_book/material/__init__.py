"""Sheet metal: yield functions, hardening, and their effect on bending and springback."""

from umform_book.case import Chapter
from umform_book.material import (
    bending,
    cards,
    elements,
    finite_strain,
    identification,
    paths,
    u_bend,
    yield_functions,
)

CHAPTER = Chapter(
    "Material",
    "Laws of sheet metal at a point and in an element, and their effect on bending and springback.",
    (
        yield_functions.CASE,
        paths.CASE,
        finite_strain.CASE,
        elements.CASE,
        cards.CASE,
        bending.CASE,
        u_bend.CASE,
        identification.CASE,
    ),
)
