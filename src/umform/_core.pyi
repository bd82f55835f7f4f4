"""
Kernels of umform: elements, materials, surfaces, contact, sparse patterns.
"""

from collections.abc import Callable, Sequence
import enum
from typing import Final


from collections.abc import Callable
from numpy import float64, int32, int64, uint8
from numpy.typing import NDArray

def gauss(n: int) -> tuple[NDArray[float64], NDArray[float64]]:
    """Gauss rule of n points on [-1, 1]: abscissae and weights."""

def lobatto(n: int) -> tuple[NDArray[float64], NDArray[float64]]:
    """Gauss-Lobatto rule of n points on [-1, 1]: abscissae and weights."""

def split(n: int) -> tuple[NDArray[float64], NDArray[float64]]:
    """
    Gauss rule of n/2 points on each half of [-1, 1]: abscissae and weights.
    """

def shell_functions(nodes: int, points: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64]]:
    """
    Shape functions (count, nodes) and their derivatives (count, 3, nodes) at natural points (count, 3).
    """

class Hardening:
    """Yield stress as a function of the accumulated plastic strain."""

    def __call__(self, eqps: float) -> tuple[float, float]:
        """Yield stress and its slope."""

    def work(self, eqps: float) -> float:
        """Integral of the yield stress from 0 to eqps."""

def linear_voce(y0: float, modulus: float, saturation: float, rate: float) -> Hardening: ...

def swift(strength: float, offset: float, exponent: float) -> Hardening: ...

def tabulated(eqps: Sequence[float], stress: Sequence[float]) -> Hardening: ...

class Material:
    """
    A material law: strain and history in, stress, tangent and new history out.
    """

    @property
    def state_size(self) -> int: ...

    @property
    def history_variables(self) -> dict[str, int]:
        """Parts of the history of a point, in their order."""

    @property
    def symmetric(self) -> bool:
        """Whether the tangent is symmetric at any strain."""

    @property
    def sees_points(self) -> bool:
        """Whether the law asks for axes, size and step."""

    @property
    def staged_returns(self) -> int:
        """
        Points at which its return map has gone through stages of a shrinking yield surface so far.
        """

    def initial(self) -> NDArray[float64]:
        """History of the virgin material."""

    def respond(self, E: NDArray[float64], state: NDArray[float64], axes: NDArray[float64] | None = None, size: float = 0.0, step: float = 0.0) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]:
        """
        S (n, 6), CC (n, 6, 6) and the new history at n points with the same axes (3, 3), size and step.
        """

    def lead(self, turn: NDArray[float64], strain: NDArray[float64], stress: NDArray[float64], steps: NDArray[float64], finite: bool = False) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]:
        """
        A law of logarithmic strains, or of Green-Lagrange strains (finite), along a path of logarithmic strains (n, 6), NaN where the stress is prescribed: strains, stresses, histories behind the rows up to the first that cannot be reached.
        """

    def energy(self, E: NDArray[float64], state: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64]]:
        """
        Elastic energy and plastic work per reference volume at n points, with the history that belongs to E; NaN where not known.
        """

def saint_venant_kirchhoff(lambda_: float, mu: float) -> Material: ...

def neo_hooke_logarithmic(lambda_: float, mu: float) -> Material: ...

def neo_hooke_power(mu: float, beta: float) -> Material: ...

def j2(kappa: float, mu: float, hardening: Hardening) -> Material: ...

def material_from_function(function: Callable[[NDArray[float64], NDArray[float64], int, tuple[NDArray[float64], float, float] | None], tuple[NDArray[float64], NDArray[float64], NDArray[float64]]], initial: Sequence[float], state: Sequence[tuple[str, int]], energy: Callable[[NDArray[float64], NDArray[float64], int], tuple[NDArray[float64], NDArray[float64]]] | None, symmetric: bool, sees_points: bool) -> Material:
    """
    A law from a function (E (n, 6), state (n, size), cell, (axes (n, 3, 3), size, step) or None) -> (S (n, 6), CC (n, 6, 6), new state (n, size)); its energy (E, state, cell) -> (elastic (n,), plastic (n,)).
    """

class YieldFunction:
    """
    Equivalent stress as a function of the stress in the axes of the sheet.
    """

    def __call__(self, stress: NDArray[float64]) -> tuple[float, NDArray[float64]]:
        """
        Equivalent stress, and its gradient as a strain with engineering shears (6,).
        """

class RateFactor:
    """Factor of the yield stress over the rate of the plastic strain."""

    def __call__(self, rate: float) -> float:
        """The factor at a plastic strain rate."""

def cowper_symonds(reference: float, exponent: float) -> RateFactor: ...

def johnson_cook(reference: float, strength: float) -> RateFactor: ...

def hill48(F: float, G: float, H: float, L: float, M: float, N: float) -> YieldFunction: ...

def yld2004(exponent: float, first: Sequence[float], second: Sequence[float]) -> YieldFunction:
    """
    c12, c13, c21, c23, c31, c32 and the shears 12, 23, 13 of both transformations.
    """

class MetalCard:
    """The parts of a metal."""

    def __init__(self, kappa: float, mu: float, hardening: Hardening, yield_function: YieldFunction, back_stress: Sequence[tuple[float, float]], first: float, growth: float, fall: float, rate: float, surfaces: Sequence[float] = [], rate_factor: RateFactor = ...) -> None:
        """
        Back stresses are pairs (modulus, recall) whose moduli begin at the share `first`; Young's modulus falls by `fall`.
        """

    def law(self) -> Material:
        """The small-strain law."""

    def residuals(self, strain: NDArray[float64], state: NDArray[float64], step: float) -> list[float]:
        """
        Residuals of the return map at a strain (6,), over the stresses, from its start to its end.
        """

def logarithmic_space(law: Material) -> Material:
    """
    A small-strain law as one of finite strain: asked with logarithmic strains.
    """

def compiled_law(function: int, energy: int, name: str, properties: Sequence[float], state: Sequence[tuple[str, int]], initial: Sequence[float], symmetric: bool, parallel: bool, sees_points: bool) -> Material:
    """A law from the address of a C function, and that of its energy or 0."""

def umat_law(function: int, energies: bool, name: str, properties: Sequence[float], state: Sequence[tuple[str, int]], initial: Sequence[float], symmetric: bool, parallel: bool) -> Material:
    """
    A small-strain law from the address of a UMAT; with `energies` it fills SSE, SPD and SCD.
    """

class Surface:
    """
    A rigid tool: signed distance, normal and Hessian as functions of position.
    """

    def gap(self, x: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]:
        """
        Signed distance (n,), normal (n, 3) and Hessian (n, 3, 3) at the positions x (n, 3).
        """

    @property
    def is_distance(self) -> bool:
        """
        Whether the gap changes by no more than a point moves: contact leaves out what is far then.
        """

def plane(point: Sequence[float], normal: Sequence[float]) -> Surface: ...

def sphere(centre: Sequence[float], radius: float, inside: bool) -> Surface: ...

def cylinder(centre: Sequence[float], axis: Sequence[float], radius: float, inside: bool) -> Surface: ...

def surface_from_function(function: Callable[[NDArray[float64]], tuple[NDArray[float64], NDArray[float64], NDArray[float64]]]) -> Surface:
    """A tool from a function x (n, 3) -> (g (n,), n (n, 3), H (n, 3, 3))."""

class ProfileEnd(enum.Enum):
    """What the first and the last segment of a profile do."""

    joined = 0

    endless = 1

    on_axis = 2

def extruded(segments: NDArray[float64], start: ProfileEnd, end: ProfileEnd, origin: Sequence[float], x: Sequence[float], y: Sequence[float]) -> Surface:
    """
    A profile of segments (n, 7): start, end, centre, turn; drawn out across its directions x and y.
    """

def revolved(segments: NDArray[float64], start: ProfileEnd, end: ProfileEnd, origin: Sequence[float], axis: Sequence[float]) -> Surface:
    """
    A profile of segments (n, 7): start, end, centre, turn; turned about an axis.
    """

def led_around(segments: NDArray[float64], origin: Sequence[float], axes: NDArray[float64], core: Sequence[float], corner: float) -> Surface:
    """
    A profile of segments (n, 7): start, end, centre, turn; led around a rectangle with rounded corners.
    """

def rounded_box(centre: Sequence[float], axes: NDArray[float64], core: Sequence[float], radius: float) -> Surface: ...

def triangulated(control: NDArray[float64], across: NDArray[int32], neighbour: NDArray[int32], ends: NDArray[int32], face: NDArray[int32], normals: NDArray[float64], corner: NDArray[int32], faces: Sequence[Surface], trust: float) -> Surface:
    """
    Thirds of triangles: points (n, 15, 3) of quartic patches; across their edge 0 smooth, 1 sharp, 2 a rim; the third on its other side or -1; its two corners (n, 2); its exact face or -1. Of the corners: the sum of normals (m, 3), and 0, 1, 2.
    """

def offset(tool: Surface, distance: float, side: int) -> Surface:
    """
    The tool grown by a distance (side 1), or all that is farther from it (side -1).
    """

def offset_by_field(tool: Surface, axes: NDArray[float64], values: NDArray[float64]) -> Surface:
    """
    The tool grown by a cubic B-spline over its directions (n, 6): direction, place of the first coefficient, distance of two, number. The last direction runs fastest in the values.
    """

def placed(tool: Surface, matrix: NDArray[float64], shift: Sequence[float]) -> Surface: ...

class Connectivity:
    """Node ids of the elements of one kind: what a term couples."""

    def __init__(self, ids: NDArray[int32]) -> None: ...

    @property
    def ids(self) -> NDArray[int32]:
        """Node ids (elements, nodes)."""

    def __len__(self) -> int: ...

class Scatter:
    """Map from the element matrices of one kind into a pattern."""

    @property
    def symmetric(self) -> bool: ...

    def require(self, symmetric_tangent: bool, term: str) -> None:
        """
        Refuse a tangent that is not symmetric, by the name of its term, if the pattern holds one triangle only.
        """

    def add(self, matrices: NDArray[float64], values: NDArray[float64]) -> None:
        """
        Add matrices (elements, 3 nodes, 3 nodes), in the order 3 * node + direction, to the entries of the pattern.
        """

    @property
    def bytes(self) -> int: ...

class Pattern:
    """
    Sparse pattern over the free degrees of freedom (upper triangle if symmetric).
    """

    def __init__(self, equation: NDArray[int32], parts: Sequence[Connectivity], symmetric: bool) -> None: ...

    @property
    def indptr(self) -> NDArray[int64]: ...

    @property
    def indices(self) -> NDArray[int32]: ...

    @property
    def symmetric(self) -> bool: ...

    def find(self, row: int, column: int) -> int:
        """
        Position of an entry; IndexError for a pair that is not in the pattern.
        """

    def scatter(self, part: Connectivity) -> Scatter:
        """The map for the elements of one kind."""

class BlockPattern:
    """Upper triangle in square blocks, one for two neighbouring groups."""

    @property
    def size(self) -> int:
        """Rows of a block."""

    @property
    def indptr(self) -> NDArray[int32]: ...

    @property
    def indices(self) -> NDArray[int32]: ...

    @property
    def place(self) -> NDArray[int32]:
        """Row of each equation; other rows say x = 0."""

    def fill(self, indptr: NDArray[int32], indices: NDArray[int32], values: NDArray[float64], out: NDArray[float64]) -> None:
        """Entries of the blocks from those of the pattern."""

class SheetOrder:
    """
    Order of elimination of a sheet, from the upper triangle of its pattern.
    """

    def __init__(self, indptr: NDArray[int32], indices: NDArray[int32]) -> None: ...

    @property
    def vertices(self) -> NDArray[int32]:
        """Groups in their order; empty if it is no sheet."""

    @property
    def equations(self) -> NDArray[int32]:
        """Equations in their order; empty if it is no sheet."""

    @property
    def largest(self) -> int:
        """Equations of the largest group."""

    def blocks(self) -> BlockPattern:
        """The matrix in blocks, one row of them for each group."""

def set_blas(api: dict[str, object], set_threads: int, get_threads: int) -> None:
    """Take BLAS from capsules of Cython's kind."""

class Outcome:
    """How a factorisation has ended."""

    @property
    def done(self) -> bool: ...

    @property
    def not_positive(self) -> bool: ...

    @property
    def equation(self) -> int:
        """That of the pivot which has ended it; -1 if there is none."""

class Pivots:
    """What the pivots tell."""

    @property
    def negative(self) -> int: ...

    @property
    def odd(self) -> bool:
        """Whether the determinant is negative."""

    @property
    def size(self) -> NDArray[float64]:
        """Pivot of each equation."""

class Multifrontal:
    """Multifrontal factors of matrices with one pattern."""

    def __init__(self, indptr: NDArray[int32], indices: NDArray[int32], symmetric: bool) -> None: ...

    @property
    def fill(self) -> int:
        """Entries of the factors."""

    @property
    def bytes(self) -> int:
        """
        Memory of the factors and of what is on the way to them, on one thread.
        """

    def factor(self, values: NDArray[float64], positive: bool) -> Outcome: ...

    def pivots(self) -> Pivots: ...

    def solve(self, b: NDArray[float64], x: NDArray[float64]) -> None:
        """Solve for rows of b, each a right-hand side."""

    def residual(self, values: NDArray[float64], b: NDArray[float64], x: NDArray[float64], r: NDArray[float64]) -> None: ...

    def residual_of_magnitudes(self, values: NDArray[float64], b: NDArray[float64], x: NDArray[float64], r: NDArray[float64]) -> None:
        """r = b - |K| x, without a copy of the matrix."""

    @property
    def column_sizes(self) -> NDArray[float64]:
        """
        Largest entry of each column of the matrix that was eliminated; none for Cholesky.
        """

    @property
    def scales(self) -> tuple[NDArray[float64], NDArray[float64]]:
        """
        Powers of two for rows and columns of that; empty where it is the matrix itself.
        """

class Tying:
    """One row of an assumed-strain rule."""

    def __init__(self, component: int, r: Sequence[float], s: Sequence[float], at_layer: bool) -> None: ...

class Polynomial:
    """
    factor * r^a s^b P_c(t) of an enhanced mode in one covariant component.
    """

    def __init__(self, component: int, factor: float, a: int, b: int, c: int) -> None: ...

class Technology:
    """Which strains are tied where, and which are enhanced by what."""

    def __init__(self, tying: Sequence[Tying], modes: Sequence[Sequence[Polynomial]]) -> None: ...

class ShellBlock:
    """All solid-shell elements of one kind with their history."""

    @property
    def connectivity(self) -> Connectivity: ...

    @property
    def dofs(self) -> int:
        """Degrees of freedom of the model."""

    def evaluate(self, u: NDArray[float64], scatter: Scatter, f: NDArray[float64], values: NDArray[float64] | None, du: NDArray[float64] | None, Kdu: NDArray[float64] | None) -> tuple[int, float, str]:
        """
        Add the share of the block to f (and the tangent to values, K du to Kdu, where given); returns the first failed element (or -1), sum |f_e|^2 and why it has failed, in words that follow its number.
        """

    @property
    def points(self) -> int: ...

    @property
    def modes(self) -> int: ...

    @property
    def state_size(self) -> int: ...

    @property
    def history_variables(self) -> dict[str, int]:
        """Parts of the history of a point, in their order."""

    @property
    def symmetric(self) -> bool:
        """Whether the tangent is symmetric."""

    def failing_point(self, e: int, u: NDArray[float64]) -> tuple[int, NDArray[float64]]:
        """
        First point of an element at which its law has no answer, or -1, and its Green-Lagrange strain (6,).
        """

    @property
    def step(self) -> float:
        """Increment of time, for laws that ask for it."""

    @step.setter
    def step(self, arg: float, /) -> None: ...

    def set_numbers(self, numbers: NDArray[int32]) -> None:
        """
        Numbers of the cells for messages, where they are a part of a larger mesh.
        """

    def recover(self, du: NDArray[float64], mixed: bool = False) -> None:
        """
        Update the enhanced parameters after u += du; mixed: the geometric stiffness is of the foreseen stress.
        """

    def recover_by(self, change: NDArray[float64]) -> None:
        """Add a known change to the enhanced parameters."""

    @property
    def keeps_blocks(self) -> bool:
        """
        Whether enhanced parameters can be recovered from the converged state without an evaluation there.
        """

    @property
    def enhanced_change(self) -> float:
        """
        Largest change of an enhanced parameter that a recovery without a displacement makes after the last evaluation.
        """

    @property
    def staged_returns(self) -> int:
        """
        Points at which return maps have gone through stages of a shrinking yield surface so far.
        """

    def take_blocks(self, of: ShellBlock) -> None:
        """
        Take the tangent with which enhanced parameters are recovered from the same elements of a similar run.
        """

    def follow(self) -> None:
        """
        After an evaluation of forces alone: the next recover takes its residual, with the previous tangent.
        """

    def shorten(self, part: float) -> None:
        """Shorten what the last recover has changed to a part of it."""

    def commit(self) -> None:
        """Make the trial history the converged one."""

    def revert(self) -> None:
        """Go back to the converged history."""

    @property
    def state(self) -> NDArray[float64]:
        """Converged history (elements, points, state_size)."""

    @property
    def flowing(self) -> NDArray[uint8]:
        """
        For each point 1 where the last evaluation has changed its history, else 0; empty without a history.
        """

    @property
    def alpha(self) -> NDArray[float64]:
        """Converged enhanced parameters (elements, modes)."""

    def restore(self, state: NDArray[float64], alpha: NDArray[float64]) -> None:
        """Put a stored history back."""

    def point_fields(self, u: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64]]:
        """
        E, S (elements, points, 6) in the local frame, the frame and F (elements, points, 3, 3), dV (elements, points).
        """

    def cell_fields(self, u: NDArray[float64], scalar: int = -1) -> list[NDArray[float64]]:
        """
        Means (elements, 6) of the Cauchy stress in global and local axes and of S in both; largest von Mises stress; mean and largest value of a number of the history.
        """

    def energy(self, u: NDArray[float64]) -> tuple[float, float]:
        """
        Elastic energy and plastic work of the block at the converged state u; NaN if the law does not know them.
        """

    def element(self, e: int, u: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64]]:
        """Condensed K and f of one element."""

def point_stresses(E: NDArray[float64], S: NDArray[float64], frame: NDArray[float64], F: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]:
    """
    From what point_fields gives, (points, 6): Cauchy stress in the local frame and in global axes, S in global axes.
    """

def shell_block(technology: Technology, surface_points: tuple[int, int], t: NDArray[float64], w: NDArray[float64], material: Material, connectivity: NDArray[int32], X: NDArray[float64], rolling: NDArray[float64] | None = None) -> ShellBlock:
    """
    Solid-shells on the cells of a mesh; rolling: direction of e_1, one vector (3,) or one for each cell (cells, 3).
    """

class ContactFound:
    """
    What an evaluation of a contact came across: a copy that later evaluations do not change.
    """

    @property
    def active(self) -> NDArray[uint8]:
        """
        For each contact point 1 where the tool holds it, 2 where it slips as well, else 0.
        """

    @property
    def tangential_stiffness(self) -> NDArray[float64]:
        """Traction per elastic slip, shape (held,)."""

    @property
    def elastic_slip(self) -> NDArray[float64]:
        """Elastic slips along the tool (held, 3), zero without friction."""

    @property
    def slip(self) -> NDArray[float64]:
        """Distances slid so far (held,)."""

    @property
    def points(self) -> NDArray[int32]:
        """
        Numbers of the points that are held, ascending; the arrays that follow are of these points.
        """

    @property
    def x(self) -> NDArray[float64]:
        """Positions (held, 3)."""

    @property
    def normal(self) -> NDArray[float64]:
        """Unit normals out of the tool (held, 3)."""

    @property
    def traction(self) -> NDArray[float64]:
        """Tractions of the tool on the sheet, on the reference area (held, 3)."""

    @property
    def force(self) -> NDArray[float64]:
        """Forces of the sheet on the tool (held, 3)."""

    @property
    def gap(self) -> NDArray[float64]:
        """Signed distances (held,), negative in penetration."""

    @property
    def pressure(self) -> NDArray[float64]:
        """Normal parts of the tractions (held,)."""

    @property
    def area(self) -> NDArray[float64]:
        """Reference areas (held,)."""

    @property
    def share(self) -> NDArray[float64]:
        """Parts of the areas that are held (held,), 1 at points."""

    @property
    def stored(self) -> float:
        """Energy of the elastic slip."""

    @property
    def friction_work(self) -> float:
        """Work of friction so far, at all points."""

    @property
    def work_above_mean(self) -> float:
        """
        Part of the work of friction that the mean of the forces at both ends of each increment misses.
        """

    @property
    def contact_work(self) -> float:
        """
        Work of the pressure so far, of rules that measure it along the way; zero at points.
        """

    @property
    def penetration(self) -> float:
        """The largest penetration, zero if there is none."""

    @property
    def round_off_squared(self) -> float:
        """
        Square of what a relative error 1 of all positions makes of the residual.
        """

class ContactLaw:
    """Traction at a place of a face from its gap, and what it remembers."""

    @property
    def penalty(self) -> float:
        """Pressure per penetration."""

    @penalty.setter
    def penalty(self, arg: float, /) -> None: ...

    @property
    def symmetric(self) -> bool:
        """Whether its tangent is symmetric."""

class FrictionLaw:
    """The largest tangential traction that a tool can bear."""

    def bound(self, pressure: float, slip: float = 0.0, z: Sequence[float] = [0.0, 0.0, 0.0]) -> tuple[float, float, float]:
        """
        Largest traction at a pressure, a distance slid and a place in the frame of the tool, and its derivatives with respect to pressure and slip.
        """

def coulomb_friction(pressure: Sequence[float], mu: Sequence[float], kinetic: float, decay: float, cap: float) -> FrictionLaw:
    """
    min(mu p, cap), with mu from a table over the pressure, that falls to its kinetic part by exp(-slip/decay) if decay > 0.
    """

def friction_by_region(regions: Sequence[tuple[Sequence[float], Sequence[float], FrictionLaw]], elsewhere: FrictionLaw) -> FrictionLaw:
    """Other laws within boxes in the frame of the tool."""

def friction_from_function(function: Callable[[float, float, Sequence[float]], float]) -> FrictionLaw:
    """The bound from a function of pressure, slip and place."""

def coulomb_law(penalty: float, ratio: float, slip: float, friction: FrictionLaw) -> ContactLaw:
    """
    Contact with friction: a penalty and multipliers in both directions; ratio is the tangential over the normal stiffness at first touch, slip the elastic slip that is allowed.
    """

def bead_law(curve: Sequence[Sequence[float]], closed: bool, half_width: float, restraint: float, uplift: float, slip: float, off: float) -> ContactLaw:
    """
    An equivalent draw bead along a polyline in the frame of the tool: forces per length across it and off the tool, within a band; slip is the elastic one, off the gap at which it ends.
    """

def penalty_law(penalty: float) -> ContactLaw:
    """
    Frictionless contact: a pressure of penalty times penetration, and multipliers.
    """

class NormalLaw:
    """The pressure of a contact over its gap, by a function of a user."""

    @property
    def reach(self) -> float:
        """The largest gap at which there is a pressure."""

    def pressures(self, gap: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64]]:
        """Pressures and their derivatives with respect to the gap (n,)."""

    def energies(self, gap: NDArray[float64], parts: int = 16) -> NDArray[float64]:
        """
        Energy per area (n,): the integral of the pressure from each gap up to the reach.
        """

def normal_from_function(function: Callable[[NDArray[float64]], tuple[NDArray[float64], NDArray[float64]]], name: str, reach: float) -> NormalLaw:
    """
    A law from a function gap (n,) -> (pressure (n,), its derivative (n,)).
    """

def compiled_normal_law(function: int, name: str, properties: Sequence[float], reach: float, parallel: bool) -> NormalLaw:
    """A law from the address of a C function."""

def own_law(penalty: float, normal: NormalLaw) -> ContactLaw:
    """
    Frictionless contact with a law of the pressure; penalty is a measure of its stiffness.
    """

def own_coulomb_law(penalty: float, ratio: float, slip: float, friction: FrictionLaw, normal: NormalLaw) -> ContactLaw:
    """The same with friction."""

class ContactBlock:
    """Contact of element faces with one rigid tool."""

    @property
    def connectivity(self) -> Connectivity: ...

    @property
    def dofs(self) -> int:
        """Degrees of freedom of the model."""

    def evaluate(self, u: NDArray[float64], scatter: Scatter, f: NDArray[float64], values: NDArray[float64] | None, du: NDArray[float64] | None, Kdu: NDArray[float64] | None) -> tuple[int, float, str]:
        """
        Add the share of the block to f (and the tangent to values, K du to Kdu, where given); returns the first failed element (or -1), sum |f_e|^2 and why it has failed, in words that follow its number.
        """

    @property
    def name(self) -> str:
        """For messages."""

    @name.setter
    def name(self, arg: str, /) -> None: ...

    @property
    def open(self) -> bool:
        """
        Whether the tool has been taken away: it holds no point, wherever it stands.
        """

    @open.setter
    def open(self, arg: bool, /) -> None: ...

    def keep(self, points: NDArray[uint8]) -> None:
        """
        Points that the next evaluation holds, without friction, wherever they are: not 0.
        """

    @property
    def law(self) -> ContactLaw: ...

    @property
    def symmetric(self) -> bool:
        """Whether its tangent is symmetric."""

    @property
    def penalty(self) -> float:
        """That of its law."""

    @penalty.setter
    def penalty(self, arg: float, /) -> None: ...

    def set_pose(self, Q: NDArray[float64], c: NDArray[float64]) -> None:
        """Place the tool: x = Q X + c."""

    def locate(self, u: NDArray[float64]) -> None:
        """Move the contact points to X + u and measure the gaps."""

    def row(self, w: Sequence[float], omega: Sequence[float] = ..., p: Sequence[float] = ...) -> NDArray[float64]:
        """
        Derivative of the sum of the tractions times areas times the way w + omega x (x - p) with respect to u.
        """

    def found(self) -> ContactFound:
        """What is known of the points that are held now, as a copy."""

    @property
    def shape_values(self) -> NDArray[float64]:
        """
        Shape functions at the points of all facets (1, points, nodes), or of each (facets, points, nodes).
        """

    @property
    def points(self) -> int: ...

    @property
    def per_facet(self) -> int:
        """Contact points of each facet."""

    @property
    def positions(self) -> NDArray[float64]:
        """Of all points (points, 3)."""

    @property
    def gaps(self) -> NDArray[float64]:
        """Of all points; those of far facets are measured now."""

    @property
    def normals(self) -> NDArray[float64]:
        """Of all points (points, 3)."""

    @property
    def areas(self) -> NDArray[float64]: ...

    @property
    def active(self) -> NDArray[uint8]:
        """For each point 1 where the tool holds it, else 0."""

    @property
    def pressures(self) -> NDArray[float64]:
        """Normal parts of the tractions at all points."""

    @property
    def tractions(self) -> NDArray[float64]:
        """
        Of the tool on the sheet at all points (points, 3), on the reference area.
        """

    @property
    def penetration(self) -> float:
        """The largest, zero if there is none."""

    @property
    def round_off_squared(self) -> float:
        """
        Square of what a relative error 1 of all positions makes of the residual, at the last evaluation.
        """

    @property
    def far_facets(self) -> int:
        """
        Facets so far from the tool that nothing was measured there since the last evaluation.
        """

    @property
    def multipliers(self) -> NDArray[float64]:
        """
        Pressures that are there without a penetration: those of now, which commit makes the converged ones.
        """

    @multipliers.setter
    def multipliers(self, values: NDArray[float64], /) -> None: ...

    @property
    def history_variables(self) -> dict[str, int]:
        """Parts of the history of a point, in their order."""

    @property
    def state(self) -> NDArray[float64]:
        """
        Converged history (points, size) in the order of the history_variables.
        """

    @property
    def read(self) -> NDArray[float64]:
        """
        The history that the last evaluation has read, with the multipliers that it was to take (points, size).
        """

    @property
    def begun(self) -> bool:
        """Whether there is a converged history."""

    def begin(self) -> None:
        """
        Take the places where the points are now as those of a sheet that was never held; nothing once there is a history.
        """

    def augment(self, tractions: NDArray[float64]) -> None:
        """
        Let multipliers carry tractions (points, 3) along the tool at the points that are held.
        """

    def commit(self) -> None:
        """Make the trial history the converged one."""

    def revert(self) -> None:
        """Go back to the converged history."""

    def restore(self, state: NDArray[float64]) -> None:
        """Put a stored history back."""

def contact_block(facets: NDArray[int32], X: NDArray[float64], points: tuple[int, int], at_nodes: bool, surface: Surface, law: ContactLaw) -> ContactBlock: ...

def contact_cells(facets: NDArray[int32], X: NDArray[float64], cells: int, surface: Surface, law: ContactLaw) -> ContactBlock:
    """Contact integrated over cells x cells cells of each facet."""

class PressureBlock:
    """Follower pressure on element faces."""

    @property
    def connectivity(self) -> Connectivity: ...

    @property
    def dofs(self) -> int:
        """Degrees of freedom of the model."""

    def evaluate(self, u: NDArray[float64], scatter: Scatter, f: NDArray[float64], values: NDArray[float64] | None, du: NDArray[float64] | None, Kdu: NDArray[float64] | None) -> tuple[int, float, str]:
        """
        Add the share of the block to f (and the tangent to values, K du to Kdu, where given); returns the first failed element (or -1), sum |f_e|^2 and why it has failed, in words that follow its number.
        """

    @property
    def pressure(self) -> float: ...

    @pressure.setter
    def pressure(self, arg: float, /) -> None: ...

    @property
    def name(self) -> str:
        """For messages."""

    @name.setter
    def name(self, arg: str, /) -> None: ...

    symmetric: Final[bool] = ...
    """Whether its tangent is symmetric."""

def pressure_block(facets: NDArray[int32], X: NDArray[float64]) -> PressureBlock: ...

class SheetPass:
    """Contact points of one face against the facets of another that deforms."""

    @property
    def name(self) -> str:
        """For messages."""

    @name.setter
    def name(self, arg: str, /) -> None: ...

    @property
    def dofs(self) -> int:
        """Degrees of freedom of the model."""

    @property
    def symmetric(self) -> bool:
        """Whether its tangent is symmetric."""

    @property
    def points(self) -> int: ...

    @property
    def per_facet(self) -> int:
        """Contact points of each facet."""

    @property
    def areas(self) -> NDArray[float64]:
        """Reference areas of the points."""

    @property
    def penalty(self) -> float:
        """Pressure per penetration."""

    @penalty.setter
    def penalty(self, arg: float, /) -> None: ...

    def search(self, u: NDArray[float64], way: float, turn: float) -> None:
        """
        Find the facets that each facet may meet while no node moves farther than a way and no facet turns farther.
        """

    def moved_since_search(self, u: NDArray[float64]) -> list[float]:
        """
        Largest way of a node of both faces and largest turn of a facet since the search, infinite before the first one.
        """

    def couplings(self) -> Connectivity:
        """
        Pairs of nodes that its tangent couples, as the last search found them.
        """

    def evaluate(self, u: NDArray[float64], pattern: Pattern, f: NDArray[float64], values: NDArray[float64] | None, du: NDArray[float64] | None, Kdu: NDArray[float64] | None) -> float:
        """
        Add forces to f (and the tangent to values, K du to Kdu, where given); returns the sum of the squares of the forces.
        """

    def found(self) -> dict[str, object]:
        """Results of the last evaluation, as copies."""

    @property
    def history_variables(self) -> dict[str, int]:
        """Parts of the history of a point, in their order."""

    @property
    def state(self) -> NDArray[float64]:
        """Converged history (points, size)."""

    @property
    def augmented(self) -> bool:
        """Whether multipliers carry pressure without penetration."""

    @augmented.setter
    def augmented(self, arg: bool, /) -> None: ...

    @property
    def multipliers(self) -> NDArray[float64]:
        """
        Pressures at zero penetration: of the converged state, or what was set since then.
        """

    @multipliers.setter
    def multipliers(self, values: NDArray[float64], /) -> None: ...

    @property
    def shape_values(self) -> NDArray[float64]:
        """
        Shape functions (1 or facets, points, nodes) of this face at its points.
        """

    def commit(self) -> None:
        """Make the trial history the converged one."""

    def revert(self) -> None:
        """Go back to the converged history."""

    def restore(self, state: NDArray[float64]) -> None:
        """Put a stored history back."""

def sheet_crossings(facets: NDArray[int32], x: tuple[NDArray[float64], NDArray[float64]], others: NDArray[int32], y: tuple[NDArray[float64], NDArray[float64]], deepest: float) -> tuple[NDArray[float64], NDArray[float64]]:
    """
    Places and depths (one for each facet) where a face goes through another, farther than deepest, from the first to the second positions of both.
    """

def sheet_pass(facets: NDArray[int32], others: NDArray[int32], edges: NDArray[int32], at: Sequence[Sequence[int]], X: NDArray[float64], points: tuple[int, int], cells: int, penalty: float, deepest: float, highest: float, near: Sequence[Sequence[int]], friction: FrictionLaw | None, stiffness: float) -> SheetPass:
    """
    A half pass, over cells x cells cells of each facet, or at Gauss points where cells is 0. `edges` are the nodes of cut edges of the other face, then those across the thickness; `at` their facets and sides there.
    """

def build() -> str:
    """Compiler, kind of build and instruction set of the kernels."""

def threads() -> int:
    """
    Number of threads that the kernels use; by default one for each free processor, or OMP_NUM_THREADS.
    """

def set_threads(count: int) -> None:
    """Set the number of threads that the kernels use."""
