"""Tools from STEP and IGES files, by OpenCASCADE: faces, their triangles, and how far these are from them."""

from umform.surfaces.cad.tool import CadTool

__all__ = ["CadTool"]
