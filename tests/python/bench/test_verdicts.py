"""Verdicts on finished jobs: the list is green only where the numbers are good."""

import pytest

from umform.bench.verdicts import verdict

GOOD = {"name": "angle", "missed": False}
MISSED = {"name": "drift", "missed": True}


@pytest.mark.parametrize(
    ("summary", "found"),
    [
        ({"quantities": [GOOD], "checks": [GOOD], "warnings": [], "coarse_mesh": []}, ""),
        ({"quantities": [GOOD], "checks": [MISSED], "warnings": ["w"]}, "missed"),
        ({"quantities": [MISSED], "collisions": ["the part collides"]}, "collides"),
        ({"unfinished": True, "quantities": [MISSED], "warnings": ["the sheet tears"]}, "failed"),
        ({"unfinished": False, "warnings": ["the sheet tears"]}, "warned"),
        ({"columns": [[GOOD], [MISSED]], "sizes": [GOOD]}, "missed"),
        ({"quantities": [GOOD], "coarse_mesh": ["coarse mesh"]}, "warned"),
        ({"table": [], "failed": ["no bend"]}, "missed"),
        ({"table": [], "failed": [], "remarks": ["far"]}, "warned"),
        ({"flat": {"bends": [1], "order": []}}, "missed"),
        ({"flat": {"bends": [1], "order": [1]}}, ""),
        ({"flat": {"bends": [], "order": []}}, ""),
        ({"corrected": [{"error": 0.1}], "misfit": 0.5}, ""),
        ({"corrected": [{"error": 0.1}], "misfit": 3.0}, "missed"),
        ({"corrected": [{"error": None}], "misfit": 0.5}, "missed"),
        ({}, ""),
    ],
)
def test_verdict(summary, found):
    assert verdict(summary) == found
