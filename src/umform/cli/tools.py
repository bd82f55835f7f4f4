"""``umform tools``: usual tools of press brakes."""

from __future__ import annotations

from umform.cli.root import app, console


@app.command()
def tools() -> None:
    """List usual dies and punches of press brakes: umform bend --die V16/88 --punch 88/R0.8."""
    from rich import box
    from rich.table import Table

    from umform.processes.air_bending.spec import sizes_of
    from umform.processes.air_bending.usual_tools import usual_tools

    opening, radius = (sizes_of("die")[size] for size in ("opening", "radius"))
    dies = Table("die", box=box.SIMPLE_HEAD)
    for name in ("opening, mm", "shoulder radius, mm"):
        dies.add_column(name, justify="right")
    dies.add_column("names")
    rows: dict[tuple[float, float], list[str]] = {}
    for one in usual_tools("die"):
        rows.setdefault((one.sizes[opening], one.sizes[radius]), []).append(one.name)
    for (width, round_), names in rows.items():
        dies.add_row(f"V{width:g}", f"{width:g}", f"{round_:g}", " ".join(names))
    punches = Table("punch", box=box.SIMPLE_HEAD)
    punches.add_column("angle, degrees", justify="right")
    punches.add_column("names")
    tips: dict[float, list[str]] = {}
    for one in usual_tools("punch"):
        tips.setdefault(one.sizes[sizes_of("punch")["angle"]], []).append(one.name)
    for tip, names in tips.items():
        punches.add_row("straight", f"{tip:g}", " ".join(names))
    console().print(dies)
    console().print(punches)
    console().print(
        "Common sizes, not those of one maker; goosenecks and other outlines: --punch-dxf, --die-dxf.", soft_wrap=True
    )
