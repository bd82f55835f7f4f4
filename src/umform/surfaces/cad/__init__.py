"""Tools from STEP and IGES files, by OpenCASCADE: faces, their triangles, and the deviation between them."""

from umform.surfaces.cad.tool import CadTool

__all__ = ["CadTool"]
