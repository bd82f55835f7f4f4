"""Rigid tools and what drives them."""
