"""A blank whose formed edge ends where it is wanted: runs of a deck correct its outline (theory, chapter 6)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.flat_pattern.net.corrections import NetBlank, net_blank

__all__ = ["NetBlank", "net_blank"]

_HOME = {"NetBlank": "corrections", "net_blank": "corrections"}

__getattr__ = at_first_use(__name__, _HOME)
