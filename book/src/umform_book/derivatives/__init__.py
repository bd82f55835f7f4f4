"""Derivatives of runs by shadows, beside whole runs with changed parameters."""

from umform_book.case import Chapter
from umform_book.derivatives import differences_page

CHAPTER = Chapter(
    "Derivatives",
    "Derivatives of runs with respect to their parameters: all laws, steps, tools, controls and loads.",
    (differences_page.CASE,),
)
