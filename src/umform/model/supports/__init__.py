"""Supports, local axes, linear constraints."""
