"""Pictures by PyVista, off screen: what is seen, what is cut away, scales; skipped where VTK cannot render."""

import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

import umform as uf
from umform.errors import UmformError
from umform.plotting import COLOUR_MAP
from umform.report import rendering
from umform.report.part import Part
from umform.report.rendering import Cut, Panel, Rendering, Scale, scaled, write_picture
from umform.report.skin import skin_of

_PROBE = (
    "import pyvista; p = pyvista.Plotter(off_screen=True); p.add_mesh(pyvista.Sphere()); p.screenshot(return_img=True)"
)


@pytest.fixture(scope="module")
def renders():
    """A process of its own, which a machine without any OpenGL ends."""
    if subprocess.run([sys.executable, "-c", _PROBE], capture_output=True, check=False).returncode:
        pytest.skip("VTK cannot render on this machine")


def sheet(field="height"):
    """A flat sheet with a field that rises along x."""
    mesh = uf.mesh.strip(4.0, 2.0, 0.1, (4, 2))
    nodal = {"height": mesh.points[:, 0]}
    return skin_of(Part.deformed(mesh.points, mesh.connectivity, nodal, {}), field)


def test_a_sheet_fills_its_picture_with_the_colours_of_its_field(renders):
    skin = sheet()
    drawn = Rendering("test", (-90.0, 89.0))
    drawn.add_sheet(skin, scaled(skin, "x, mm"), lines=False)
    pixels = drawn.image(400)
    ink = (pixels < 250).any(axis=2)
    assert ink.any(axis=0).mean() == pytest.approx(1.0 / 1.04, abs=0.01)
    assert ink.any(axis=1).mean() == pytest.approx(1.0 / 1.04, abs=0.02)
    assert pixels.shape[0] == pytest.approx(200, abs=8)
    left, right = (pixels[pixels.shape[0] // 2, k].astype(float) for k in (15, 385))
    for seen, value in ((left, 0.02), (right, 0.98)):
        true = 255.0 * np.array(COLOUR_MAP(value)[:3])
        assert seen / seen.max() == pytest.approx(true / true.max(), abs=0.08)
    assert np.ptp(right) > 3.0 * np.ptp(left)  # from light grey to red


def test_lines_are_drawn_on_request(renders):
    pictures = []
    for lines in (False, True):
        drawn = Rendering("test", (-90.0, 89.0))
        drawn.add_sheet(sheet(None), lines=lines)
        pictures.append(drawn.image(400).astype(int))
    plain, lined = pictures
    darker = (plain - lined).max(axis=2)[plain.shape[0] // 4] > 20
    starts = np.flatnonzero(np.diff(darker.astype(int)) == 1)
    assert len(starts) == 5  # the lines across, x = 0 to 4


def test_a_cut_tool_is_before_the_sheet_no_more(renders):
    """A ball above the sheet: half of it, with its section."""
    ball = uf.Sphere((2.0, 0.0, 1.2), 1.0).triangles(((0.5, -1.5, 0.0), (3.5, 1.5, 3.0)))
    pictures = []
    for cut in (None, Cut((0.0, 1.0, 0.0), (2.0, 0.0, 0.0))):
        drawn = Rendering("test", (-90.0, 0.0))
        drawn.add_sheet(sheet(None))
        drawn.add_tool(ball, cut=cut, opacity=1.0)
        pictures.append(drawn.image(300))
    assert pictures[0].shape == pictures[1].shape
    whole, half = (picture[picture.shape[0] // 2, 150].astype(float) for picture in pictures)
    section = 255.0 * np.array(rendering.mpl.colors.to_rgb(rendering.SECTION))
    assert half == pytest.approx(section, abs=3.0)
    assert np.abs(whole - section).max() > 15.0


def test_scales_and_titles_are_in_the_file(tmp_path):
    """Needs no PyVista: white pixels with a scale at their right and titles above."""
    white = np.full((200, 300, 3), 255, dtype=np.uint8)
    file = write_picture(
        tmp_path / "a.png", [Panel(white, Scale("strain", (0.0, 1.0)), "one"), Panel(white, None, "two")]
    )
    pixels = np.asarray(Image.open(file).convert("RGB")).astype(int)
    assert pixels.shape == (200 + 36, 300 + 110 + 300, 3)
    ink = (pixels < 128).any(axis=2)
    assert ink[:36, :300].any()
    assert ink[:36, 410:].any()
    assert not ink[36:, 410:].any()
    column = pixels[40:, 300 + 15]
    reds = column[(column < 250).any(axis=1)]
    assert reds[0] == pytest.approx(255.0 * np.array(COLOUR_MAP(1.0)[:3]), abs=12)
    assert reds[-1] == pytest.approx(255.0 * np.array(COLOUR_MAP(0.0)[:3]), abs=12)
    for side in (ink[0], ink[-1], ink[:, 0], ink[:, -1], ink[:, 405:410]):
        assert not side.any()  # no label is clipped


def test_a_large_picture_has_few_colours_and_a_white_ground(tmp_path, monkeypatch):
    monkeypatch.setattr(rendering, "_LARGEST", 1000)
    x, y = np.meshgrid(np.linspace(0, 1, 200), np.linspace(0, 1, 100))
    pixels = (255 * COLOUR_MAP(x * y)[..., :3]).astype(np.uint8)
    pixels[:10] = 255
    file = write_picture(tmp_path / "a.png", [Panel(pixels)])
    picture = Image.open(file)
    assert picture.mode == "P"
    seen = np.asarray(picture.convert("RGB")).astype(int)
    assert (seen[:10] == 255).all()
    assert np.abs(seen - pixels)[10:].mean() < 2.0


def test_without_pyvista_there_is_one_message(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(UmformError, match="needs PyVista") as caught:
        Rendering("the gallery")
    assert caught.value.where == "the gallery"
    assert 'pip install "umform[view]"' in caught.value.remedy
