"""The bench: a page on which a sheet is bent, seen to bend, and measured; it stands on `umform bend` and decks."""
