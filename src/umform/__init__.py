"""umform: solid-shell finite elements for sheet-metal bending and forming."""
