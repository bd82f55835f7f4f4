"""The verification book: problems with a known answer, and pages with the results of every relevant element.

Each case is a module with a :class:`Case`; a chapter is a folder of them. ``umform verify`` and ``make verification``
run cases and write their pages, the tests run each case on its short meshes.
"""
