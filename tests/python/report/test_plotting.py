import matplotlib as mpl
import numpy as np
import pytest

import umform as uf
from umform.errors import FileProblem, InvalidValue
from umform.plotting import inline_svg, plot_history, plot_shape
from umform.shape import Shape


@pytest.fixture(scope="module", params=["hex8", "hex18"])
def result(request):
    strip = uf.mesh.strip(4, 1, 0.2, (4, 2), cell=request.param)
    element = "ANS3DEAS" if request.param == "hex8" else "MI9K3DEAS"
    model = uf.Model(strip, element, material=uf.SVK(E=1000.0, nu=0.3))
    model.fix("x0", "xyz")
    end = model.prescribe("x1", "z", name="end")
    return uf.solve(model, uf.Move(end, to=0.5, steps=2), progress=False)


def test_history_as_picture(result, tmp_path):
    before = dict(mpl.rcParams)
    figure = result.plot("end", ["end_force", "iterations"], tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    assert [line.get_label() for line in figure.axes[0].lines] == ["end_force", "iterations"]
    assert figure.axes[0].get_xlabel() == "end"
    assert dict(mpl.rcParams) == before


def test_pictures_of_equal_results_are_equal_files(result, tmp_path):
    for name in ("a.svg", "b.svg"):
        plot_shape(result, path=tmp_path / name)
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_inline_svg_has_no_addresses(result):
    svg = inline_svg(plot_history(result, "end", ["end_force"]))
    assert svg.startswith("<svg")
    assert svg.rstrip().endswith("</svg>")
    assert "http" not in svg


def test_refusals(result, tmp_path):
    with pytest.raises(InvalidValue, match="PNG"):
        plot_history(result, "end", ["end_force"], tmp_path / "a.bmp")
    with pytest.raises(InvalidValue, match="column"):
        plot_history(result, "end", ["nothing"])
    with pytest.raises(InvalidValue, match="field"):
        plot_shape(result, "nothing")
    with pytest.raises(FileProblem):
        plot_history(result, "end", ["end_force"], tmp_path / "missing" / "a.png")


def test_shape_is_closed_and_of_the_right_size(result):
    shape = Shape.of(result, 0)
    corners = shape.points[shape.quads]
    area = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    assert np.allclose(area.sum(axis=0), 0.0)
    assert np.linalg.norm(area, axis=1).sum() == pytest.approx(2 * (4 * 1 + 4 * 0.2 + 1 * 0.2))
    outward = np.einsum("ki,ki->k", corners.mean(axis=1) - [2.0, 0.5, 0.0], area)
    assert (outward > 0).all()
    assert Shape.of(result).points[:, 2].max() > 0.5


def test_mirror_image_keeps_faces_outwards(result):
    whole = Shape.of(result, 0).mirrored(axis=0)
    corners = whole.points[whole.quads]
    area = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    volume = np.einsum("ki,ki->", corners.mean(axis=1), area) / 3
    assert volume == pytest.approx(2 * 4 * 1 * 0.2)
    assert whole.points[:, 0].min() == pytest.approx(-4.0)
