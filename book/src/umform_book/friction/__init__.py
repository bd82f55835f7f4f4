"""Friction: stick, slip and reversal, bands over cylinders, tools that turn, partial slip, drawing and bending."""

from umform_book.case import Chapter
from umform_book.friction import (
    bending_work,
    beside_calculix,
    block,
    capstan,
    draw_bead,
    free_bending,
    history,
    partial_slip,
    partial_slip_point,
    rolling,
    turning,
    u_bend,
    unconstrained,
    work,
)

CHAPTER = Chapter(
    "Friction",
    "Stick, slip, reversal, strips over cylinders, turning tools, partial slip, drawing and bending.",
    (
        block.CASE,
        work.CASE,
        capstan.CASE,
        history.CASE,
        turning.CASE,
        rolling.CASE,
        partial_slip.CASE,
        partial_slip_point.CASE,
        bending_work.CASE,
        free_bending.CASE,
        beside_calculix.CASE,
        u_bend.CASE,
        draw_bead.CASE,
        unconstrained.CASE,
    ),
)
