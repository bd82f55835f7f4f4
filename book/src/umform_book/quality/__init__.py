"""Requirements on every element: patch tests, eigenvalues, invariance."""

from umform_book.case import Chapter
from umform_book.quality import eigenvalues, invariance, patch_tests

CHAPTER = Chapter(
    "Elements",
    "Requirements on each element: patch tests, eigenvalues, invariance.",
    (patch_tests.CASE, eigenvalues.CASE, invariance.CASE),
)
