"""Springback and force of an air bend over the angle of the rolling direction to the bend line."""

import sys
from pathlib import Path

from matplotlib.figure import Figure

from umform import sheet_metals
from umform.plotting import COLOURS, house_style, save
from umform.processes.air_bending import AirBending, Measures, bending_table

CARDS = ("AA6016-T4", "AA6016-T4 Hill48", "NUMISHEET93 mild steel")
ANGLES = (0, 15, 30, 45, 60, 75, 90)


def bends(card: str, angles: tuple[int, ...] = ANGLES) -> dict[int, Measures]:
    """A sheet of 1 mm over an opening of 12 mm, bent by 3.5 mm in plane strain, for each angle."""
    law = sheet_metals.get(card).law
    cases = {angle: AirBending(thickness=1.0, opening=12.0, material=law, rolling=angle) for angle in angles}
    return {angle: bending_table(case, [3.5], progress=False)[0] for angle, case in cases.items()}


def table(found: dict[str, dict[int, Measures]]) -> str:
    """Springback in degrees and largest force in N/mm as Markdown."""
    angles = list(next(iter(found.values())))
    lines = [f"| | {' | '.join(f'{angle}°' for angle in angles)} |", "|---|" + "---:|" * len(angles)]
    for card, row in found.items():
        lines.append(f"| {card}, springback | {' | '.join(f'{row[angle].springback:.2f}' for angle in angles)} |")
        lines.append(f"| {card}, force | {' | '.join(f'{row[angle].largest_force:.1f}' for angle in angles)} |")
    return "\n".join(lines)


def draw(found: dict[str, dict[int, Measures]]) -> Figure:
    """Springback over the angle."""
    figure = Figure(figsize=(6, 3.6), layout="constrained")
    axes = figure.subplots()
    for (card, row), colour in zip(found.items(), COLOURS, strict=False):
        axes.plot(list(row), [bend.springback for bend in row.values()], "o-", color=colour, label=card)
    axes.set(xlabel="angle of the rolling direction to the bend line, degrees", ylabel="springback, degrees")
    axes.set(xticks=ANGLES, ylim=(0, None))
    axes.legend()
    return figure


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    results = {name: bends(name) for name in CARDS}
    print(table(results))
    with house_style():
        save(draw(results), folder / "rolling_angle.png", dpi=110)
