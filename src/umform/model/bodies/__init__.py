"""Bodies: cells, element, law."""
