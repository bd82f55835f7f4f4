"""Sheet metal: yield functions, hardening, and what they do to bending and springback."""

from umform_book.case import Chapter
from umform_book.material import cards

CHAPTER = Chapter(
    "Material",
    "Laws of sheet metal at a point and in an element, and what they do to bending and springback.",
    (cards.CASE,),
)
