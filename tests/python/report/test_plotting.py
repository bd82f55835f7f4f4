import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

import umform as uf
from umform.errors import FileProblem, InvalidValue
from umform.plotting import Picture, compare_histories, house_style, inline_svg, plot_history, plot_shape, save
from umform.results.shape import Shape


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


def bars(kind):
    """A figure with a colour bar, which ties its layout."""
    with house_style():
        figure = kind(figsize=(4.0, 3.0), layout="constrained")
        drawn = figure.add_subplot().imshow([[0.0, 1.0], [2.0, 3.0]])
        figure.colorbar(drawn, label="a quantity with a long name")
        figure.axes[0].set(xlabel="x", ylabel="y", title="title")
    return figure


def test_a_picture_is_laid_out_once_and_drawn_once_as_svg(tmp_path, monkeypatch):
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    layouts, drawings = [], []
    execute, draw = ConstrainedLayoutEngine.execute, Picture.draw
    monkeypatch.setattr(ConstrainedLayoutEngine, "execute", lambda *args: (layouts.append(1), execute(*args)))
    monkeypatch.setattr(Picture, "draw", lambda *args: (drawings.append(1), draw(*args)))
    picture = bars(Picture)
    for name in ("a.png", "a.svg", "b.svg"):
        save(picture, tmp_path / name)
    inline = inline_svg(picture)
    assert (len(layouts), len(drawings)) == (1, 2)  # one drawing for PNG, one for all SVG
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    assert inline[-2000:] == (tmp_path / "a.svg").read_text()[-2000:]


def test_a_picture_is_laid_out_as_a_figure_is(tmp_path):
    """But for the width of words, which depends a little on the dots an inch that they are measured with."""
    places = []
    for kind in (Picture, Figure):
        figure = bars(kind)
        save(figure, tmp_path / "a.svg")
        places.append([axes.get_position().bounds for axes in figure.axes])
    assert np.allclose(*places, atol=0.01)
    untouched = [axes.get_position().bounds for axes in bars(Figure).axes]
    assert not np.allclose(places[0], untouched, atol=0.01)


def test_svg_is_what_matplotlib_writes(result, tmp_path):
    figure = plot_history(result, "end", ["end_force"], tmp_path / "a.svg")
    with house_style():
        figure.savefig(tmp_path / "b.svg", dpi=200, metadata={"Date": None})
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_refusals(result, tmp_path):
    with pytest.raises(InvalidValue, match="PNG"):
        plot_history(result, "end", ["end_force"], tmp_path / "a.bmp")
    with pytest.raises(InvalidValue, match="column"):
        plot_history(result, "end", ["nothing"])
    for columns in ([], "end_force"):
        with pytest.raises(InvalidValue, match="list of names"):
            plot_history(result, "end", columns)
    with pytest.raises(InvalidValue, match="list of names"):
        compare_histories({"one": result.table()}, "end", [])
    with pytest.raises(InvalidValue, match="no histories"):
        compare_histories({}, "end", ["end_force"])
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
