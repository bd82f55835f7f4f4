"""The bench: a page in the browser that orders bends and decks, and shows their runs and results."""
