import numpy as np
from matplotlib import pyplot as plt

import umform as uf
from umform.report.part_pictures import outline_picture, section_picture
from umform.results.forming import draw_in, section


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
