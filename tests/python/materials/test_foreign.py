"""Laws from shared libraries: a UMAT in C and in Fortran beside the same metal, C functions, and what is refused."""

from __future__ import annotations

import ctypes
import math
import re
import runpy
import shutil
import subprocess
from pathlib import Path

import cards
import numpy as np
import pytest

import umform as uf
from umform import materials as mt
from umform.errors import FileProblem, InvalidValue, NoConvergence, NotFinite
from umform.history_variables import history_of, named
from umform.problem import Problem
from umform.problem.errors import DeckError
from umform.report.materials import material_text

EXAMPLES = Path(__file__).resolve().parents[3] / "examples" / "umat"
STATE = {"back_stress": 6, "eqps": 1}
PROPERTIES = [210e3, 0.3, 200.0, 500.0, 3000.0]
METAL = mt.Metal(210e3, 0.3, hardening=mt.Linear(200.0, 500.0), back_stress=mt.Chaboche([(3000.0, 0.0)]))
COMPILER = shutil.which("gcc") or shutil.which("cc")
needs_compiler = pytest.mark.skipif(COMPILER is None or not EXAMPLES.is_dir(), reason="no C compiler, or no examples")

#: SVK, which has no answer beyond a strain of properties[2] along 1; a NaN beyond properties[3], a kink of the tangent
#: beyond properties[4]. Its history is how often an increment was taken, and the time.
ELASTIC = """
#include <math.h>
int elastic(int points, const double *strain, const double *state, const double *properties, const double *axes,
            double length, double step, double *stress, double *tangent, double *new_state) {
    const double lambda = properties[0], mu = properties[1];
    for (int q = 0; q < points; ++q) {
        const double *e = strain + 6 * q;
        double *C = tangent + 36 * q, *S = stress + 6 * q;
        if (e[0] > properties[2]) return 1;
        for (int i = 0; i < 36; ++i) C[i] = 0.0;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) C[6 * i + j] = lambda + 2.0 * mu * (i == j);
            C[7 * (i + 3)] = mu;
        }
        for (int i = 0; i < 6; ++i) {
            S[i] = 0.0;
            for (int j = 0; j < 6; ++j) S[i] += C[6 * i + j] * e[j];
        }
        if (e[0] > properties[3]) S[1] = NAN;
        if (e[0] > properties[4]) C[1] += 1.0;
        new_state[2 * q] = state[2 * q] + 1.0;
        new_state[2 * q + 1] = state[2 * q + 1] + step;
        if (axes) new_state[2 * q] = length + 100.0 * axes[9 * q];
    }
    return 0;
}
int energy(int points, const double *strain, const double *state, const double *properties, double *energies) {
    for (int q = 0; q < points; ++q) {
        const double *e = strain + 6 * q, tr = e[0] + e[1] + e[2];
        energies[2 * q] = 0.5 * properties[0] * tr * tr;
        for (int i = 0; i < 6; ++i) energies[2 * q] += properties[1] * (i < 3 ? 1.0 : 0.5) * e[i] * e[i];
        energies[2 * q + 1] = 0.0;
    }
    return 0;
}
"""
#: Elastic, wants a smaller increment where dstran(1) > props(2); statev counts calls, keeps the name's length and KINC.
CAREFUL = """
#include <stddef.h>
void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props, const int *nprops, const double *coords, const double *drot,
           double *pnewdt, const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
           const int *npt, const int *layer, const int *kspt, const int *jstep, const int *kinc, size_t length) {
    for (int i = 0; i < 36; ++i) ddsdde[i] = 0.0;
    for (int i = 0; i < 6; ++i) {
        ddsdde[7 * i] = props[0] * (1 + i);
        stress[i] += props[0] * (1 + i) * dstran[i];
        statev[i] = stran[i] + dstran[i];
    }
    statev[6] = time[1] + *dtime;
    statev[7] = *noel + 1000.0 * *npt + 1e6 * *kinc + 1e8 * (cmname[0] == 'C' && cmname[79] == ' ' && length == 80);
    statev[8] = *celent;
    if (dstran[0] > props[1]) *pnewdt = 0.5;
}
"""


@pytest.fixture(scope="module")
def build_library(tmp_path_factory):
    """Compiles C to a shared library."""
    folder = tmp_path_factory.mktemp("libraries")

    def build(name, source):
        library = folder / f"{name}.so"
        if not library.exists():
            path = source if isinstance(source, Path) else folder / f"{name}.c"
            if path is not source:
                path.write_text(source)
            subprocess.run([COMPILER, "-O1", "-shared", "-fPIC", "-o", library, path, "-lm"], check=True)
        return library

    return build


@pytest.fixture(scope="module")
def kinematic(build_library):
    return build_library("kinematic", EXAMPLES / "kinematic.c")


@pytest.fixture(scope="module")
def elastic(build_library):
    return build_library("elastic", ELASTIC)


def as_metal(library):
    umat = uf.Umat(library, state=STATE, properties=PROPERTIES, energies=True, directional=False)
    one, other = umat.law(), METAL.law()
    E, count = np.zeros((20, 6)), 20
    here, there = np.tile(one.initial(), (count, 1)), np.tile(other.initial(), (count, 1))
    for step in range(4):
        E = E + cards.increments(count, 0.03, seed=step)
        S, CC, here = one.respond(E, here, step=1.0)
        S2, CC2, there = other.respond(E, there)
        assert np.abs(S - S2).max() < 1e-13 * np.abs(S2).max()
        assert np.abs(CC - CC2).max() < 1e-13 * np.abs(CC2).max()
        for mine, its in zip(one.energy(E, here), other.energy(E, there), strict=True):
            assert mine == pytest.approx(its, rel=1e-12)
    assert (here[:, 22] > 0.05).all()


@needs_compiler
def test_a_umat_in_c_is_the_metal(kinematic):
    as_metal(kinematic)


@pytest.mark.skipif(shutil.which("gfortran") is None or not EXAMPLES.is_dir(), reason="no Fortran compiler")
def test_a_umat_in_fortran_is_the_metal(tmp_path):
    library = tmp_path / "kinematic_f.so"
    subprocess.run(["gfortran", "-O1", "-shared", "-fPIC", "-o", library, EXAMPLES / "kinematic.f90"], check=True)
    as_metal(library)


@needs_compiler
def test_the_example(capsys):
    runpy.run_path(str(EXAMPLES / "compare.py"))
    difference = float(re.search(r"differ by (\S+)", capsys.readouterr().out)[1])
    assert difference < 1e-10


@needs_compiler
def test_threads_give_the_same_bits(kinematic):
    """A library that bears threads and one that does not, more cells than one thread takes."""
    mesh = uf.mesh.strip(length=20.0, width=16.0, thickness=0.5, cells=(20, 16))
    u = 0.01 * np.random.default_rng(0).normal(size=mesh.points.size)
    threads, found = uf.threads(), []
    for number, parallel in ((1, False), (4, False), (4, True)):
        umat = uf.Umat(kinematic, state=STATE, properties=PROPERTIES, directional=False, parallel=parallel)
        model = uf.Model(mesh, material=umat)
        model.fix("x0")
        uf.set_threads(number)
        try:
            found.append(model.evaluate(u).residual)
        finally:
            uf.set_threads(threads)
    assert np.abs(found[0]).max() > 1.0
    assert np.array_equal(found[0], found[1])
    assert np.array_equal(found[0], found[2])


@needs_compiler
def test_fields_energies_and_balance_as_for_own_laws(kinematic):
    umat = uf.Umat(kinematic, state=STATE, properties=PROPERTIES, energies=True, directional=False)
    runs = []
    for material in (umat, METAL):
        strip = uf.mesh.strip(length=6.0, width=2.0, thickness=1.0, cells=(3, 1))
        model = uf.Model(strip, "ANS3DEAS", material=material)
        model.fix("x0")
        tip = model.prescribe("x1", "z", "tip")
        runs.append((model, uf.solve(model, uf.Move(tip, to=0.6, steps=4), progress=False)))
    (model, result), (other, expected) = runs
    assert result.balance().drift == pytest.approx(expected.balance().drift, abs=1e-9)
    assert list(result["iterations"]) == list(expected["iterations"])
    cells, wanted = uf.fields.cell_fields(model), uf.fields.cell_fields(other)
    swapped = [0, 1, 2, 3, 5, 4]  # its shears are 13 before 23
    assert cells["back_stress"][:, swapped] == pytest.approx(wanted["back_stress"], abs=1e-6)
    assert cells["plastic_strain_max"] == pytest.approx(wanted["plastic_strain_max"], abs=1e-11)
    assert cells["plastic_strain_max"].max() > 0.01
    assert not any(name.startswith("umat_") for name in cells)


#: What ends a run in its middle.
STOPPED: list[bool] = []


def there_and_back(fraction):
    """Way of a tip; a run is stopped on it."""
    if STOPPED and fraction > 0.7:
        raise KeyboardInterrupt
    return 0.6 * np.sin(4.0 * fraction)


@needs_compiler
def test_a_run_goes_on_to_the_same_bits(kinematic, build_library, tmp_path):
    def made(library=kinematic):
        strip = uf.mesh.strip(length=6.0, width=2.0, thickness=1.0, cells=(3, 1))
        umat = uf.Umat(library, state=STATE, properties=PROPERTIES, energies=True, directional=False)
        model = uf.Model(strip, "ANS3DEAS", material=umat)
        model.fix("x0")
        tip = model.prescribe("x1", "z", "tip")
        return model, uf.Move(tip, to=there_and_back, steps=5, time=3.0)

    path, (model, step) = tmp_path / "run.h5", made()
    whole = uf.solve(model, step, progress=False)
    STOPPED.append(True)
    stopped, step = made()
    try:
        with pytest.raises(KeyboardInterrupt):
            uf.solve(stopped, step, progress=False, checkpoint=path, every=0.0)
    finally:
        STOPPED.clear()
    again, step = made()
    result = uf.resume(path, again, step, progress=False)
    assert np.array_equal(again.u, model.u)
    assert np.array_equal(again.bodies.only.block.state, model.bodies.only.block.state)
    assert np.array_equal(result["tip_force"], whole["tip_force"])
    other, step = made(build_library("other", (EXAMPLES / "kinematic.c").read_text() + "\nint more = 1;\n"))
    with pytest.raises(FileProblem, match="material"):
        uf.resume(path, other, step, progress=False)


@needs_compiler
def test_a_umat_sees_what_its_interface_says(build_library):
    """Order of the shears, strain, time, NOEL, NPT, KINC, CMNAME with its length, CELENT."""
    library = build_library("careful", CAREFUL)
    umat = uf.Umat(library, state=9, properties=[100.0, 1e9], directional=False, name="CAREFUL")
    law = umat.small_strain_law()
    h = 1e-3 * np.arange(1.0, 7.0)
    S, CC, after = law.respond(h[None], law.initial()[None], size=2.5, step=0.25)
    factors = np.array([1, 2, 3, 4, 6, 5]) * 100.0  # ours has 23 before 13
    assert S[0] == pytest.approx(factors * h)
    assert CC[0] == pytest.approx(np.diag(factors))
    own = named(after, law.history_variables)["state"][0]
    assert own[:6] == pytest.approx(h[[0, 1, 2, 3, 5, 4]])
    assert own[6:] == pytest.approx([0.25, 1e8 + 1e6 + 1000.0, 2.5])
    _, _, later = law.respond(h[None], after, size=2.5, step=0.5)
    assert named(later, law.history_variables)["state"][0, 6:] == pytest.approx([0.75, 1e8 + 2e6 + 1000.0, 2.5])
    still, _, same = law.respond(h[None], later, size=2.5)  # at rest: no time, no change
    assert np.array_equal(still, S)
    assert same[0, 12] == 0.75


def pulled(material, steps=2, to=0.1):
    mesh = uf.mesh.strip(length=2.0, width=1.0, thickness=1.0, cells=(2, 1))
    model = uf.Model(mesh, "ANS3DEAS", material=material)
    model.fix("x0")
    pull = model.prescribe("x1", "x", "pull")
    return model, lambda: uf.solve(model, uf.Move(pull, to=to, steps=steps, cuts=4), progress=False)


@needs_compiler
def test_pnewdt_below_one_cuts_the_increment(build_library, caplog):
    library = build_library("careful", CAREFUL)
    caplog.set_level("INFO", logger="umform.analysis.steps")
    model, run = pulled(uf.Umat(library, state=9, properties=[1e3, 0.012], directional=False))
    result = run()
    assert len(result.rows) > 5
    text = next(record.getMessage() for record in caplog.records if "increment cut" in record.getMessage())
    assert re.search(r"cell [01] .* point \d+ .* strain \(0\.\d+, ", text)
    assert uf.fields.point_fields(model).history["state"][..., 7].min() > 2e6
    with pytest.raises(NoConvergence, match="at its point"):
        pulled(uf.Umat(library, state=9, properties=[1e3, 1e-6], directional=False))[1]()


SVK = [121e3, 80e3]
MANY = 1e9


def compiled(library, *, limits=(MANY, MANY, MANY), **options):
    options = {"state": {"count": 1, "clock": 1}, "energy": "energy"} | options
    return uf.CompiledLaw("elastic", library, properties=[*SVK, *limits], **options)


@needs_compiler
def test_a_compiled_law_is_svk(elastic):
    own = mt.SVK(E=208.159203980e3, nu=0.300995025)
    assert [own.lambda_, own.mu] == pytest.approx(SVK, rel=1e-8)
    E = cards.increments(5, 0.02)
    for strain, other in (("green-lagrange", own), ("logarithmic", uf.LogarithmicSpace(own))):
        law = compiled(elastic, strain=strain).law()
        S, CC, state = law.respond(E, np.zeros((5, 2)), step=0.5)
        S2, CC2, _ = other.law().respond(E, np.empty((5, 0)))
        assert pytest.approx(S2, rel=1e-7) == S
        assert pytest.approx(CC2, rel=1e-7, abs=1e-2) == CC
        assert (state == [1.0, 0.5]).all()
        assert law.energy(E, state)[0] == pytest.approx(other.law().energy(E, np.empty((5, 0)))[0], rel=1e-7)


@needs_compiler
def test_a_compiled_law_in_a_run(elastic):
    """Its energies go into the balance, its state into the fields; axes and length come where it wants them."""
    model, run = pulled(compiled(elastic))
    result = run()
    assert np.abs(result.balance().drift).max() < 0.01
    cells = uf.fields.cell_fields(model)
    assert (cells["count"] == 2.0).all()
    assert cells["clock"] == pytest.approx(1.0)
    assert material_text(model.bodies.only.material) == "compiled law elastic, 5 properties, 2 state variables"
    mesh = uf.mesh.strip(length=2.0, width=1.0, thickness=1.0, cells=(2, 1))
    seen = uf.Model(mesh, material=compiled(elastic, sees_points=True), rolling=(0.6, 0.8, 0))
    seen.fix("x0")
    seen.evaluate(seen.u)
    seen.bodies.only.block.commit()
    # e_1 along the rolling direction: 0.6 of it along x
    assert history_of(seen.bodies.only.block)["count"] == pytest.approx(1.0 + 60.0)


@needs_compiler
def test_addresses_of_ctypes_and_numba(elastic):
    library = ctypes.CDLL(str(elastic))
    numba = type("Compiled", (), {"address": ctypes.cast(library.elastic, ctypes.c_void_p).value})()
    E = cards.increments(3, 0.02)
    wanted = compiled(elastic).law().respond(E, np.zeros((3, 2)))[0]
    for function in (library.elastic, numba, numba.address):
        law = uf.CompiledLaw(function, state=2, properties=[*SVK, MANY, MANY, MANY], name="svk")
        assert np.array_equal(law.law().respond(E, np.zeros((3, 2)))[0], wanted)
        assert law.law().history_variables == {"state": 2}


def test_a_cfunc_of_numba():
    numba = pytest.importorskip("numba")
    from numba import types

    pointer = types.CPointer(types.float64)
    signature = types.intc(types.intc, *[pointer] * 4, types.float64, types.float64, *[pointer] * 3)

    @numba.cfunc(signature)
    def spring(points, strain, state, properties, axes, length, step, stress, tangent, new_state):
        for i in range(36 * points):
            tangent[i] = 0.0
        for q in range(points):
            for i in range(6):
                stress[6 * q + i] = properties[0] * strain[6 * q + i]
                tangent[36 * q + 7 * i] = properties[0]
        return 0

    law = uf.CompiledLaw(spring, properties=[50.0], name="spring")
    h = cards.increments(3, 0.01)
    assert np.array_equal(law.small_strain_law().respond(h, np.empty((3, 0)))[0], 50.0 * h)


@needs_compiler
def test_an_answer_that_is_none_cuts_the_increment(elastic):
    with pytest.raises(NoConvergence, match=r"cell \d .* at its point \d+ with the strain"):
        pulled(compiled(elastic, limits=(0.01, MANY, MANY)))[1]()


@needs_compiler
def test_not_a_number_is_refused(elastic):
    """In Newton's method it cuts the increment, as with own laws; asked for alone it is an error."""
    law = compiled(elastic, limits=(MANY, 0.01, MANY), name="bad law")
    with pytest.raises(NoConvergence) as refusal:
        pulled(law)[1]()
    assert re.fullmatch(r"the stress of a law is not finite, bad law, cell \d, point \d+", refusal.value.cause)
    with pytest.raises(NotFinite, match="the stress of a law is not finite") as refusal:
        law.small_strain_law().respond(np.full((1, 6), 0.02), np.zeros((1, 2)))
    assert refusal.value.where == "bad law, point 0"
    assert "PNEWDT" in refusal.value.remedy


@needs_compiler
def test_a_tangent_that_is_not_symmetric_is_refused(elastic):
    law = compiled(elastic, limits=(MANY, MANY, 0.01))
    with pytest.raises(InvalidValue, match="the tangent of a law is not symmetric"):
        pulled(law)[1]()
    _, run = pulled(compiled(elastic, limits=(MANY, MANY, 0.01), symmetric=False))
    run()


@needs_compiler
def test_what_is_refused_before_a_run(elastic, kinematic, tmp_path):
    text = tmp_path / "text.so"
    text.write_text("no library")
    for make, kind, message in (
        (lambda: uf.Umat(tmp_path / "none.so"), FileProblem, "does not exist"),
        (lambda: uf.Umat(text), FileProblem, "cannot be loaded"),
        (lambda: uf.Umat(elastic), FileProblem, "does not have the function"),
        (lambda: uf.Umat(kinematic, symbol="other"), FileProblem, "does not have the function"),
        (lambda: uf.Umat(kinematic, state=-1), InvalidValue, "state of a law"),
        (lambda: uf.Umat(kinematic, state={"a": 0}), InvalidValue, "state of a law"),
        (lambda: uf.Umat(kinematic, properties=3.0), InvalidValue, "constants of the law must be an array"),
        (lambda: uf.Umat(kinematic, state=7, initial=[0.0]), InvalidValue, "size of the state"),
        (lambda: uf.Umat(kinematic, state=1, initial=[math.nan]), NotFinite, "initial"),
        (lambda: uf.CompiledLaw(lambda E: E), InvalidValue, "needs a C function"),
        (lambda: uf.CompiledLaw("elastic"), InvalidValue, "needs a C function"),
        (lambda: compiled(elastic, strain="small"), InvalidValue, "must be logarithmic or green-lagrange"),
    ):
        with pytest.raises(kind, match=message) as refusal:
            make()
        assert refusal.value.remedy
    mesh = uf.mesh.strip(length=1.0, width=1.0, thickness=1.0, cells=(1, 1))
    with pytest.raises(InvalidValue, match="rolling direction"):
        uf.Model(mesh, material=uf.Umat(kinematic, state=STATE, properties=PROPERTIES))


DECK = """
[mesh]
generator = "strip"
length = 4.0
width = 2.0
thickness = 1.0
cells = [4, 1]

[material]
%s

[[supports]]
kind = "fix"
nodes = "x0"

[controls.tip]
kind = "displacement"
nodes = "x1"
direction = "z"

[[steps]]
kind = "move"
to = { tip = 0.2 }
increments = 2
time = 0.5
"""
UMAT = """law = "UMAT"
file = "kinematic.so"
state = { back_stress = 6, eqps = 1 }
properties = [210e3, 0.3, 200.0, 500.0, 3000.0]
rolling = "x"
energies = true"""
COMPILED = """law = "Compiled"
file = "elastic.so"
function = "elastic"
energy = "energy"
state = 2
properties = [121e3, 80e3, 1e9, 1e9, 1e9]"""


@needs_compiler
def test_decks(kinematic, elastic):
    for text, law in ((UMAT, "Umat"), (COMPILED, "CompiledLaw")):
        problem = Problem.read(DECK % text, "deck.toml", kinematic.parent).build()
        assert type(problem.model.bodies.only.material).__name__ == law
        result = problem.solve(progress=False)
        assert result["time"][-1] == 0.5
        assert np.isfinite(result.balance().drift).all()


@needs_compiler
@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ('"kinematic.so"', '"none.so"', "library of a law does not exist"),
        ("energies = true", 'symbol = "other"', "does not have the function"),
        ('rolling = "x"', "", "needs rolling"),
        ("eqps = 1", "eqps = 0", "eqps"),
        ("state = {", "states = {", "unknown"),
    ],
)
def test_bad_decks(kinematic, old, new, text):
    with pytest.raises(DeckError, match=text):
        Problem.read(DECK % UMAT.replace(old, new), "deck.toml", kinematic.parent).build()


BEYOND = """
#include <stddef.h>
int beyond(int points, const double *strain, const double *state, const double *properties, const double *axes,
           double length, double step, double *stress, double *tangent, double *new_state) {
    for (int i = 0; i < 6 * points; ++i) stress[i] = 100.0 * strain[i];
    for (int i = 0; i < 36 * points; ++i) tangent[i] = (i % 36) % 7 == 0 ? 100.0 : 0.0;
    for (int i = 0; i < (int)properties[0] * points; ++i) new_state[i] = 1.0;
    stress[6 * points] += properties[1], tangent[36 * points] += properties[2];
    return 0;
}
void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props) {
    for (int i = 0; i < 36; ++i) ddsdde[i] = i % 7 == 0 ? 100.0 : 0.0;
    for (int i = 0; i < 6; ++i) stress[i] = 100.0 * (stran[i] + dstran[i]);
    for (int i = 0; i < (int)props[0]; ++i) statev[i] = 1.0;
}
"""


@needs_compiler
def test_a_law_that_writes_beyond_its_arrays_is_refused(build_library):
    library = build_library("beyond", BEYOND)
    E = cards.increments(3, 0.01)

    def law(*properties, state=2):
        return uf.CompiledLaw("beyond", library, state=state, properties=properties, strain="green-lagrange").law()

    S, _, state = law(2.0, 0.0, 0.0).respond(E, np.zeros((3, 2)))
    assert np.array_equal(S, 100.0 * E)
    assert (state == 1.0).all()
    for properties, what in (((3.0, 0.0, 0.0), "state"), ((2.0, 1.0, 0.0), "stress"), ((2.0, 0.0, 1.0), "tangent")):
        with pytest.raises(InvalidValue, match=f"written beyond its {what}") as refused:
            law(*properties).respond(E, np.zeros((3, 2)))
        assert refused.value.where == "beyond"
        assert "NSTATV" in refused.value.remedy
    good, bad = (uf.Umat(library, state=2, properties=[size], directional=False) for size in (2.0, 3.0))
    rows = good.law().initial()[None]
    assert (good.law().respond(E[:1], rows)[2][0, -2:] == 1.0).all()
    with pytest.raises(InvalidValue, match="written beyond its state"):
        bad.law().respond(E[:1], rows)
    with pytest.raises(InvalidValue, match=r"written beyond its state[^$]*cell 0"):
        pulled(bad)[1]()
