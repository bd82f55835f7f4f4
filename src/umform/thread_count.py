"""Number of threads of the kernels."""

from __future__ import annotations

from umform import _core
from umform.spec import check_arguments
from umform.spec.types import Count


def set_threads(count: Count) -> None:
    """Set the number of threads that the kernels use.

    Parameters
    ----------
    count : int
        Number of threads, one at least. By default one for each free processor, or ``OMP_NUM_THREADS``.

    Raises
    ------
    InvalidValue

    Examples
    --------
    >>> import umform as uf
    >>> before = uf.threads()
    >>> uf.set_threads(1)
    >>> uf.threads()
    1
    >>> uf.set_threads(before)
    """
    check_arguments(set_threads, count=count)
    _core.set_threads(count)
