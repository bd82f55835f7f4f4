"""Reality: numbers beside measurements, and signs and orders on which measurements agree."""

from umform_book.case import Chapter
from umform_book.drawing import aa6016_cup, square_cup
from umform_book.reality import measured_loop, orders, split_ring, u_bend

CHAPTER = Chapter(
    "Reality",
    "Measured sheets and parts, and signs on which measurements of springback agree. No input was tuned to the "
    "measured number; *not at hand*: only signs are compared. Deviation: computed less measured. The scatter is that "
    "of the measurements or, where only one is published, of other codes.",
    (measured_loop.CASE, aa6016_cup.CASE, square_cup.CASE, u_bend.CASE, split_ring.CASE, orders.CASE),
)
