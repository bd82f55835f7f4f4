"""File formats of bend tables."""
