import numpy as np
from matplotlib import pyplot as plt

import umform as uf
from umform.report.part_pictures import ears_picture, outline_picture, section_picture
from umform.results.forming import EarProfile, draw_in, section


def test_nothing_is_drawn_between_pieces_of_an_edge_and_over_a_hole():
    washer = uf.mesh.ring(inner=10.0, outer=50.0, thickness=1.0, cells=(12, 2))
    u = np.zeros_like(washer.points)
    radius = np.hypot(*washer.points[:, :2].T)
    edge = draw_in(washer, u, np.flatnonzero((radius < 10.01) | (radius > 49.99)))
    assert edge.is_closed and len(edge.pieces) == 2
    figure = outline_picture(edge)
    for line in figure.axes[0].lines:
        x = np.hypot(*line.get_xydata().T)
        assert np.ptp(x) < 1e-9 and (line.get_xydata()[0] == line.get_xydata()[-1]).all()
    assert [text.get_text() for text in figure.legends[0].texts] == ["blank", "end of the stroke"]
    cut = section(washer, u)
    picture = section_picture({"formed": cut}, np.array([1.0, 0.0, 0.0]))
    for line in picture.axes[0].lines:
        x = line.get_xdata()
        assert np.isnan(x).sum() == 1 and np.nansum(np.abs(np.diff(x))) < 80.0 + 1e-9
    plt.close(figure)
    plt.close(picture)


def test_the_bands_of_draw_in_and_height_are_shaded():
    """A disc that shrinks by a tenth: the draw-in of 5 mm has a band of 1 mm, the height of 2 mm one of 0.25 mm."""
    disc = uf.mesh.disc(radius=50.0, thickness=1.0, cells=(4, 3))
    u = -0.1 * disc.points * [1.0, 1.0, 0.0]
    figure = outline_picture(draw_in(disc, u), error=1.0)
    (shade,) = figure.axes[0].patches
    radius = np.hypot(*shade.get_xy().T)
    assert np.unique(np.round(radius, 6)).tolist() == [44.0, 46.0]
    assert not outline_picture(draw_in(disc, u)).axes[0].patches
    ears = ears_picture(EarProfile(np.array([0.0, 45.0, 90.0]), np.array([2.0, 2.5, 2.0])), error=0.25)
    (shade,) = ears.axes[0].collections
    heights = shade.get_paths()[0].vertices[:, 1]
    assert (heights.min(), heights.max()) == (1.75, 2.75)
    plt.close("all")
