"""Picture of relative derivatives: a bar for each parameter, the largest on top."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from umform.plotting import Plot, house_style, save
from umform.studies.derivatives.derivative import Derivative


def tornado(derivatives: Sequence[Derivative], path: str | Path | None = None) -> Figure:
    """Bars of the changes of one response for 1 % of each parameter, or for 1 of one that is zero.

    Parameters
    ----------
    derivatives : sequence of Derivative
        Of one response; unknown ones are left out.
    path : str or Path, optional
        Picture to write.
    """
    known = [one for one in derivatives if one.value is not None]
    known.sort(key=lambda one: abs(one.change or 0.0))
    response = derivatives[0].response
    changes = [one.change or 0.0 for one in known]
    labels = [one.parameter.path if one.parameter.value else f"{one.parameter.path}, 1 more" for one in known]
    with house_style():
        figure = Plot(figsize=(6.5, 0.9 + 0.32 * max(1, len(known))), layout="constrained")
        axes = figure.add_subplot()
        colours = ["tab:red" if change < 0.0 else "tab:blue" for change in changes]
        bands = [abs(one.size) * (one.band or 0.0) for one in known]
        axes.barh(labels, changes, color=colours, xerr=bands if any(bands) else None)
        axes.axvline(0.0, color="black", linewidth=0.8)
        axes.locator_params(axis="x", nbins=6)
        unit = f", {response.unit}" if response.unit else ""
        axes.set_xlabel(f"change of the {response.label} for 1 % more of each parameter{unit}")
    if path is not None:
        save(figure, path)
    return figure
