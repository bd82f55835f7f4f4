"""Scatter of results: derivatives of one run beside many random runs."""

from umform_book.case import Chapter
from umform_book.scatter import random_runs

CHAPTER = Chapter(
    "Scatter",
    "Standard deviations and shares from the derivatives of one run, beside random runs.",
    (random_runs.BEND, random_runs.U_BEND),
)
