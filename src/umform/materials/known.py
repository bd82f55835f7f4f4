"""The known classes of each kind: subclasses of an interface in the files of this package."""

from __future__ import annotations

from functools import partial

from umform.spec.known import known as known_in

#: Dataclasses of umform.materials that name an interface as their base, by name.
known = partial(known_in, __package__)
