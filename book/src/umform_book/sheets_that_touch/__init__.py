"""Sheets that touch: pressure across other meshes, strips, an air bend, cylinders, ironing, folds and hems."""

from umform_book.case import Chapter
from umform_book.sheets_that_touch import (
    air_bend,
    closed_fold,
    curved_hem,
    cylinders,
    elastic_tools,
    flat_hem,
    ironing,
    patch,
    reopened_fold,
    strips,
)

CHAPTER = Chapter(
    "Sheets that touch",
    "A uniform pressure across meshes that do not match, two strips with and without friction, two sheets in "
    "an air bend, two cylinders, ironing with a block, tools that deform, a fold that is pressed flat, one that "
    "is opened again, flat hems, hems of curved edges.",
    (
        patch.CASE,
        strips.CASE,
        air_bend.CASE,
        cylinders.CASE,
        ironing.CASE,
        elastic_tools.CASE,
        closed_fold.CASE,
        reopened_fold.CASE,
        flat_hem.CASE,
        curved_hem.CASE,
    ),
)
