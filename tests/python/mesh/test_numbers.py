import numpy as np
from hypothesis import given
from hypothesis.extra.numpy import arrays

from umform.mesh.numbers import common, median, unique

NUMBERS = arrays(np.int32, (3, 4), elements={"min_value": -3, "max_value": 3}) | arrays(np.int32, 0)


@given(NUMBERS, NUMBERS)
def test_sets_of_numbers_are_those_of_numpy(some, others):
    np.testing.assert_array_equal(unique(some), np.unique(some), strict=True)
    np.testing.assert_array_equal(common(some, others), np.intersect1d(some, others), strict=True)


@given(NUMBERS.filter(len))
def test_the_median_is_that_of_numpy(numbers):
    assert median(numbers) == np.median(numbers)
