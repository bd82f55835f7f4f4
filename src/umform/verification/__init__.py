"""The verification book: problems with a known answer, and the pages that say what came out on every relevant element.

Each case is a module with a :class:`Case`; a chapter is a folder of them. ``umform verify`` and ``make verification``
run cases and write their pages, the tests run each case on its short meshes.
"""

from umform.verification.case import Case, Chapter
from umform.verification.page import Page
from umform.verification.variants import VARIANTS, Variant

__all__ = ["VARIANTS", "Case", "Chapter", "Page", "Variant"]
