"""Meshes whose edge lies on a line: a layer of cells between the line and the cells inside."""
