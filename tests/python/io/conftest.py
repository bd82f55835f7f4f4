"""Small distorted meshes, the exact interpolation of umform's cells written once more, independently, and VTK's."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonCore import reference, vtkVersion
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader

FACE = [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)]
NODES = {
    "hex8": np.array([(r, s, t) for t in (-1, 1) for r, s in FACE[:4]], dtype=float),
    "hex18": np.array([(r, s, t) for t in (-1, 1) for r, s in FACE], dtype=float),
}


class Sheet:
    """A sheet of 3 x 2 cells in two layers, curved and distorted, with its shape functions."""

    def __init__(self, cells):
        self.cells = cells
        order = 2 if cells == "hex18" else 1
        local = ((NODES[cells] + 1) / 2 * (order, order, 1)).round().astype(int)
        size = (3 * order + 1, 2 * order + 1, 3)
        corners = np.array(list(itertools.product(range(3), range(2), range(2)))) * (order, order, 1)
        ijk = corners[:, None] + local
        self.connectivity = np.ravel_multi_index(tuple(np.moveaxis(ijk, -1, 0)), size)
        x, y, z = np.stack(np.unravel_index(np.arange(np.prod(size)), size)).astype(float)
        x, y = 2.0 * x / order, 3.0 * y / order
        noise = np.random.default_rng(7).uniform(-0.08, 0.08, (len(x), 3))
        self.points = np.stack([x + 0.1 * y * z, y, 0.5 * z + 0.3 * np.sin(x) * np.cos(y)], axis=1) + noise

    def shape_functions(self, rst):
        """Lagrange polynomials through the nodes, for parametric coordinates in [-1, 1]."""
        abscissae = ([-1.0, 0.0, 1.0] if self.cells == "hex18" else [-1.0, 1.0],) * 2 + ([-1.0, 1.0],)
        N = np.ones(len(NODES[self.cells]))
        for a, node in enumerate(NODES[self.cells]):
            for direction, knots in enumerate(abscissae):
                for knot in knots:
                    if knot != node[direction]:
                        N[a] *= (rst[direction] - knot) / (node[direction] - knot)
        return N

    def position(self, cell, rst):
        return self.shape_functions(rst) @ self.points[self.connectivity[cell]]

    def volume(self, cell):
        """Volume by a Gauss rule; central differences of these polynomials of degree 2 are exact."""
        abscissae, weights = np.polynomial.legendre.leggauss(5)
        total = 0.0
        for i, j, k in itertools.product(range(5), repeat=3):
            rst = np.array([abscissae[i], abscissae[j], abscissae[k]])
            J = [(self.position(cell, rst + h) - self.position(cell, rst - h)) / 2 for h in np.eye(3)]
            total += weights[i] * weights[j] * weights[k] * np.linalg.det(J)
        return total


@pytest.fixture
def nodes():
    """Natural coordinates of the nodes of each cell type."""
    return NODES


@pytest.fixture(params=["hex8", "hex18"])
def sheet(request):
    return Sheet(request.param)


@pytest.fixture
def quadratic_sheet():
    return Sheet("hex18")


def read(path, step):
    """What VTK's own reader gives for a step, as a PyVista grid."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    reader.SetStep(step)
    reader.Update()
    return pv.wrap(reader.GetOutputDataObject(0))


def times(path):
    """The times of the steps that VTK's own reader finds."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    return reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())


def steps(path):
    """The number of steps that VTK's own reader finds; it gives no times for a single one."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    return reader.GetNumberOfSteps()


def evaluate(cell, rst):
    """Position and interpolation weights in VTK, for parametric coordinates in [-1, 1]."""
    x, weights = [0.0] * 3, [0.0] * cell.GetNumberOfPoints()
    cell.EvaluateLocation(reference(0), [(c + 1) / 2 for c in rst], x, weights)
    return np.array(x), np.array(weights)


def volume(cell):
    """Volume by a Gauss rule over VTK's own shape functions; differences of these polynomials are exact."""
    abscissae, weights = np.polynomial.legendre.leggauss(5)
    total = 0.0
    for i, j, k in itertools.product(range(5), repeat=3):
        rst = abscissae[[i, j, k]]
        J = [(evaluate(cell, rst + h)[0] - evaluate(cell, rst - h)[0]) / 2 for h in np.eye(3)]
        total += weights[i] * weights[j] * weights[k] * np.linalg.det(J)
    return total


@pytest.fixture
def vtk():
    """What VTK finds in a VTKHDF file and in its cells."""
    return SimpleNamespace(
        version=(vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()),
        read=read,
        times=times,
        steps=steps,
        evaluate=evaluate,
        volume=volume,
    )
