"""The page in a real browser: nothing is loaded, all is drawn, controls work, numbers are those of the CSV."""

import csv
import io
import shutil
from importlib.resources import files

import numpy as np
import pytest
from matplotlib.image import imread
from scipy.spatial import KDTree

import umform as uf
from umform.processes import FreeBending, demo
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.air_bending.files import write_files
from umform.report.page import write_report
from umform.report.part import Part
from umform.report.skin import skin_of
from umform.report.symmetry import mirrors

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = pytest.mark.skipif(BROWSER is None, reason="no Chromium on this machine")
SOFTWARE_GL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
READY = "html[data-ready=yes]"


@pytest.fixture(scope="module")
def result():
    steel = uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Linear(yield_stress=160, modulus=500))
    model = uf.Model(uf.mesh.strip(12, 4, 0.8, (10, 2)), "ANS3DEAS", material=steel)
    model.symmetry("x0", normal="x")
    model.fix([0], "y")
    model.contact("lower", uf.Cylinder((7, 0, -4.4), "y", 4.0), penalty=100, points=2, name="cylinder")
    punch = model.prescribe("x0_lower", "z", name="punch")
    steps = [uf.Move(punch, to=-2.0, steps=12), uf.Move(punch, to=-1.9, steps=2)]
    return uf.solve(model, steps, progress=False, frames=8)


@pytest.fixture(scope="module")
def path(result, tmp_path_factory):
    return result.report(tmp_path_factory.mktemp("browser") / "run.html")


@pytest.fixture(scope="module")
def browser():
    sync_api = pytest.importorskip("playwright.sync_api", reason="no playwright")
    with sync_api.sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=BROWSER, args=SOFTWARE_GL)
        yield chromium
        chromium.close()


class Visit:
    """A page with what it asked the network for and what it complained about."""

    def __init__(self, browser, path, before="", **options):
        self.context = browser.new_context(viewport={"width": 1100, "height": 1400}, **options)
        self.page = self.context.new_page()
        self.complaints, self.requests = [], []
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.context.route(lambda url: not url.startswith("file:"), lambda route: route.abort())
        if before:
            self.page.add_init_script(before)
        self.page.goto(path.as_uri())

    def picture(self, selector="#shape-canvas"):
        """Pixels, after the frame that is being drawn."""
        self.page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        return imread(io.BytesIO(self.page.locator(selector).screenshot()))[:, :, :3]

    def text(self, selector):
        return self.page.locator(selector).inner_text()

    def unfold(self):
        self.page.evaluate("() => document.querySelectorAll('details.part').forEach((part) => { part.open = true; })")

    def slide(self, frame):
        self.page.locator("#shape-frame").fill(str(frame))


@pytest.fixture
def visit(browser, path):
    visit = Visit(browser, path)
    visit.page.wait_for_selector(READY, state="attached")
    yield visit
    assert visit.complaints == []
    visit.context.close()


def differing(one, other):
    """Share of the pixels that differ."""
    return (np.abs(one - other).max(axis=2) > 0.02).mean()


def test_nothing_is_asked_of_the_network(visit, path):
    assert visit.requests == [path.as_uri()]
    assert visit.page.locator("#shape").is_visible()
    visit.unfold()
    assert visit.page.locator("#curves").is_visible()
    assert not visit.page.locator(".still").first.is_visible()


def test_the_sheet_is_drawn(visit):
    picture = visit.picture()
    assert len(np.unique((picture * 255).round().astype(int).reshape(-1, 3), axis=0)) > 200
    visit.page.locator("#shape-tools").select_option("hidden")
    red = (picture[:, :, 0] > 0.4) & (picture[:, :, 1] < 0.35) & (picture[:, :, 2] < 0.45)
    assert red.sum() > 100  # the hinge, at the upper end of the scale


CURVED = """() => {
  const { sheet } = window.umform.shape;
  const { geometry, kinds } = sheet.faces;
  const of = (name) => Array.from(geometry.getAttribute(name).array);
  return { points: of("position"), normals: of("normal"), values: of("value"), index: geometry.index.count,
    drawn: geometry.drawRange.count, inner: kinds.at(-1).inner * kinds.at(-1).points,
    lines: Array.from(sheet.lines.geometry.index.array) };
}"""


@pytest.fixture(scope="module")
def quarter(tmp_path_factory):
    """A quarter of a disc of elements with 18 nodes, lifted to a bowl."""
    mesh = uf.mesh.disc(10.0, 1.0, (2, 2), part="quarter", cell="hex18")
    model = uf.Model(mesh, "MI9K3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    model.symmetry("x0", normal="x")
    model.symmetry("y0", normal="y")
    model.fix("rim")
    push = model.prescribe(lambda x, y, z: np.hypot(x, y) < 4.0, "z", name="push")
    result = uf.solve(model, uf.Move(push, to=2.0, steps=2), progress=False, frames=4)
    return result, result.report(tmp_path_factory.mktemp("quarter") / "run.html")


def test_the_browser_draws_the_surface_of_the_pictures(browser, quarter):
    """Points, normals, colours and lines are those of `skin_of`, which PyVista draws, of the whole part."""
    result, path = quarter
    visit = Visit(browser, path)
    visit.page.wait_for_selector(READY, state="attached")
    visit.page.locator("#shape-field").select_option("thinning, %")
    drawn = visit.page.evaluate(CURVED)
    mesh, frame = result.model.mesh, result.frames[-1]
    part = Part.deformed(mesh.points, mesh.connectivity, frame.points, frame.cells)
    skin = skin_of(part.whole(mirrors(result.model)), "thickness_change", 4, factor=-100.0)
    points, normals = (np.reshape(drawn[name], (-1, 3)) for name in ("points", "normals"))
    near, which = KDTree(np.hstack([skin.points, skin.normals])).query(np.hstack([points, normals]))
    quads = drawn["drawn"] // 6
    outer = slice(len(points) - drawn["inner"])  # without the faces in the planes, which the whole part has not
    assert drawn["inner"] == 2 * 4 * 2 * 5
    assert quads == len(skin.quads) // 4
    assert near[outer].max() < 2e-3
    assert np.abs(np.asarray(drawn["values"]) - skin.values[which])[outer].max() < 1e-2
    lengths = np.linalg.norm(np.diff(points[np.reshape(drawn["lines"], (-1, 2))], axis=1), axis=2)
    quarter_skin = skin_of(part, None, 4)
    expected = sum(np.linalg.norm(np.diff(line, axis=1), axis=2).sum() for line in quarter_skin.lines)
    assert lengths.sum() == pytest.approx(expected, rel=1e-4)
    visit.page.locator("#shape-whole").uncheck()
    assert visit.page.evaluate(CURVED)["drawn"] == drawn["index"]
    assert visit.complaints == []
    visit.context.close()


def test_slider_field_scale_tools_mesh_and_views_change_the_picture(visit):
    page = visit.page
    pictures = [visit.picture()]
    for act in (
        lambda: visit.slide(3),
        lambda: page.locator("#shape-field").select_option("displacement"),
        lambda: page.locator("#shape-scale").select_option("one"),
        lambda: page.locator("#shape-lines").uncheck(),
        lambda: page.locator("#shape-tools").select_option("solid"),
        lambda: page.locator("#shape-tools").select_option("hidden"),
        lambda: page.get_by_role("button", name="Front").click(),
    ):
        act()
        pictures.append(visit.picture())
        assert differing(*pictures[-2:]) > 0.005
    assert visit.text("#legend-name") == "displacement"


def test_legend_tells_the_extremes(visit, result):
    visit.page.locator("#shape-field").select_option("contact pressure")
    top = max(frame.points["contact_pressure"].max() for frame in result.frames)
    assert float(visit.text("#legend-ticks span >> nth=0")) == pytest.approx(top, rel=5e-3)
    visit.page.locator("#shape-scale").select_option("one")
    visit.slide(2)
    top = result.frames[2].points["contact_pressure"].max()
    assert float(visit.text("#legend-ticks span >> nth=0")) == pytest.approx(top, rel=5e-3)


def test_play_runs_to_the_last_frame(visit, result):
    page, last = visit.page, len(result.frames) - 1
    visit.slide(last)
    page.evaluate("window.seen = []; document.addEventListener('frame', (event) => window.seen.push(event.detail))")
    page.get_by_role("button", name="Play").click()
    page.get_by_role("button", name="Pause").wait_for()
    page.get_by_role("button", name="Play").wait_for(timeout=20000)
    assert page.evaluate("window.seen") == [frame.number for frame in result.frames]
    assert page.locator("#shape-frame").input_value() == str(last)


def test_mouse_and_keys_turn_and_zoom(visit):
    page, before = visit.page, visit.picture()
    box = page.locator("#shape-canvas").bounding_box()
    x, y = box["x"] + 200, box["y"] + 200
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y + 20, steps=4)
    page.mouse.up()
    turned = visit.picture()
    assert differing(before, turned) > 0.02
    page.mouse.wheel(0, -200)
    zoomed = visit.picture()
    assert differing(turned, zoomed) > 0.02
    page.keyboard.press("ArrowLeft")
    assert differing(zoomed, visit.picture()) > 0.01
    page.keyboard.press("+")
    page.keyboard.press("Home")
    page.mouse.move(5, 5)
    page.evaluate("document.activeElement.blur()")  # the ring of the focus is gone, too
    assert differing(before, visit.picture()) < 0.001


def test_the_probe_tells_the_value_under_the_pointer(visit, result):
    page = visit.page
    page.locator("#shape-field").select_option("displacement")
    page.get_by_role("button", name="Top").click()
    visit.picture()
    box = page.locator("#shape-canvas").bounding_box()
    page.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 0.5 * box["height"])
    name, value = visit.text("#shape-probe").rsplit(" ", 1)
    size = np.linalg.norm(result.frames[-1].points["displacement"], axis=1)
    assert name == "displacement"
    assert size.min() <= float(value) <= size.max()


def test_values_at_the_cursor_are_those_of_the_history(visit, result):
    page = visit.page
    page.locator("#curves-y").select_option("external_work")
    page.locator("#curves-plot").focus()
    page.keyboard.press("Home")
    for row in range(len(result)):
        shown = [visit.text(f"#curves-names button >> nth={i} >> output") for i in (0, 1)]
        assert shown == [f"{result[name][row] + 0.0:.6g}" for name in ("punch_force", "external_work")]
        assert visit.text("#curves-at") == f"punch {result['punch'][row] + 0.0:.6g}"
        page.keyboard.press("ArrowRight")
    page.locator("#curves-names button >> nth=0").click()
    assert page.locator("#curves-plot .curve").count() == 1
    page.locator("#curves-x").select_option("time")
    assert page.locator("#curves-plot .name").text_content() == "time"


def test_a_state_has_its_place_and_the_first_curve_there(visit, result):
    for number, frame in enumerate(result.frames):
        visit.slide(number)
        values = {name: float(f"{result[name][frame.number]:.4g}") + 0.0 for name in ("punch", "punch_force")}
        place = ", ".join(f"{name} {value:.6g}" for name, value in values.items()).replace("_", " ")
        assert visit.text("#shape-time") == f"{place} · state {number} of {len(result.frames) - 1}"


def test_the_mouse_finds_the_nearest_point_and_a_click_its_frame(visit, result):
    """The history turns back, so that one x has two points."""
    page = visit.page
    page.locator("#curves-plot").focus()
    page.keyboard.press("End")
    dot = page.locator("#curves-plot circle").bounding_box()
    end = dot["x"] + dot["width"] / 2, dot["y"] + dot["height"] / 2
    page.keyboard.press("Home")
    page.mouse.move(*end)
    assert visit.text("#curves-at") == f"punch {result['punch'][-1] + 0.0:.6g}"
    visit.slide(0)
    page.mouse.move(end[0], end[1] + 1)
    page.mouse.click(*end)
    assert page.locator("#shape-frame").input_value() == str(len(result.frames) - 1)


def test_the_table_is_the_history(visit, result, tmp_path):
    page = visit.page
    visit.unfold()
    page.get_by_text("All rows").click()
    page.locator("#history-rows tr").last.wait_for()
    titles = page.eval_on_selector_all(
        "#history-rows tr", "(rows) => rows.map((row) => [...row.cells].map((cell) => [cell.title, cell.textContent]))"
    )
    with page.expect_download() as download:
        page.locator("#history-csv").click()
    download.value.save_as(tmp_path / "history.csv")
    lines = list(csv.reader((tmp_path / "history.csv").read_text().splitlines()))
    assert lines[0] == result.columns()
    assert len(titles) == len(result) == len(lines) - 1
    for shown, row, line in zip(titles, result.rows, lines[1:]):
        assert [float(title) for title, _ in shown] == list(row.values()) == [float(cell) for cell in line]
        assert [text for _, text in shown] == [f"{value + 0.0:.6g}" for value in row.values()]


def test_digits_are_those_of_python(visit):
    values = [0.0, 1.0, -2.5, 9.9999996, 123456.7, 999999.6, 1e-4, 9.99999999e-5, 1.5e-300, -3e20, 0.1 + 0.2, 1 / 3]
    source = files("umform.report").joinpath("assets", "unpack.js").read_text(encoding="utf-8")
    shown = visit.page.evaluate(f"(values) => {{ {source}; return values.map(digits); }}", values)
    assert shown == [f"{value:.6g}" for value in values]


def test_all_controls_are_reached_by_keys_and_named(visit):
    page = visit.page
    visit.unfold()
    reached = []
    for _ in range(45):
        page.keyboard.press("Tab")
        reached.append(page.evaluate("document.activeElement.id || document.activeElement.dataset.view || ''"))
    ids = ["shape-field", "shape-scale", "shape-tools", "shape-lines", "shape-whole", "oblique", "top", "shape-canvas"]
    ids += ["shape-play", "shape-frame", "curves-x", "curves-y", "curves-plot", "history-csv"]
    assert [name for name in reached if name in ids][: len(ids)] == ids
    for selector in ("#shape-canvas", "#shape-frame", "#curves-plot", "#shape-play"):
        assert page.locator(selector).get_attribute("aria-label")


def bend(folder):
    case = AirBending(stroke=1.0, elements_per_thickness=1.0, layers=1, increment=0.025)
    write_files(folder, air_bending(case, progress=False))


def example(folder):
    demo(folder, [FreeBending(steps=20, mesh=(12, 1))], processes=1, progress=False)


@pytest.mark.parametrize("write", [bend, example])
def test_the_pages_of_ready_processes_turn_and_play_as_well(write, browser, tmp_path):
    write(tmp_path)
    visit = Visit(browser, tmp_path / "report.html")
    visit.page.wait_for_selector(READY, state="attached")
    last = visit.picture()
    visit.slide(0)
    assert differing(last, visit.picture()) > 0.005
    if write is bend:  # the unit of a column stands behind its number
        assert visit.text("#shape-time").startswith("stroke 0, force 0 kN/m · state 0 of ")
    visit.unfold()
    assert visit.page.locator("#curves").is_visible()
    assert visit.requests == [(tmp_path / "report.html").as_uri()]
    assert visit.complaints == []
    visit.context.close()


def test_without_scripts_the_stills_are_shown(browser, path):
    visit = Visit(browser, path, java_script_enabled=False)
    assert visit.page.locator(".still svg").count() == 2
    assert all(still.is_visible() for still in visit.page.locator(".still svg").all())
    for panel in ("#shape", "#curves", "#shape-problem"):
        assert not visit.page.locator(panel).is_visible()
    visit.context.close()


def test_without_webgl_the_still_is_shown_and_the_curves_live(browser, path):
    visit = Visit(browser, path, before="HTMLCanvasElement.prototype.getContext = () => null")
    visit.page.wait_for_selector(READY, state="attached")
    assert visit.page.locator("#shape-problem").is_visible()
    assert visit.page.locator(".still svg").first.is_visible()
    assert not visit.page.locator("#shape").is_visible()
    assert visit.page.locator("#curves").is_visible()
    visit.context.close()


@pytest.mark.parametrize(("scheme", "dark"), [("light", False), ("dark", True)])
def test_the_page_follows_the_scheme_of_the_reader(browser, path, scheme, dark):
    visit = Visit(browser, path, color_scheme=scheme)
    visit.page.wait_for_selector(READY, state="attached")
    assert (visit.picture("header").mean() < 0.4) == dark
    assert (np.median(visit.picture()) < 0.4) == dark
    assert visit.complaints == []
    visit.context.close()


def test_on_paper_the_stills_are_shown(visit):
    visit.page.emulate_media(media="print")
    assert visit.page.locator(".still svg").first.is_visible()
    assert not visit.page.locator("#shape").is_visible()


def test_a_small_screen_needs_no_scrolling_to_the_side(browser, path):
    visit = Visit(browser, path)
    visit.page.set_viewport_size({"width": 390, "height": 800})
    visit.page.wait_for_selector(READY, state="attached")
    assert visit.page.evaluate("document.documentElement.scrollWidth") <= 390
    visit.context.close()


LONG = "Linux-6.18.44-fc-v595-x86_64-with-glibc2.36" * 3


def test_on_a_small_screen_no_value_is_cut(browser, result, tmp_path):
    """All but the table of all rows fits; the long word stands for names of tools, paths and platforms."""
    path = write_report(result, tmp_path / "run.html", deck=LONG, title=f"A title of {LONG}")
    visit = Visit(browser, path)
    visit.page.set_viewport_size({"width": 390, "height": 800})
    visit.page.wait_for_selector(READY, state="attached")
    visit.page.locator("table.pairs td").last.evaluate(f"(cell) => (cell.textContent = '{LONG}')")
    for summary in visit.page.locator("details:not(#history-all) summary").all():
        summary.click()
    cut = "(all) => all.filter((e) => e.scrollWidth > e.clientWidth).map((e) => e.innerText.slice(0, 40))"
    assert visit.page.eval_on_selector_all(".wide:not(.tall), h1, pre, main", cut) == []
    visit.context.close()


def test_the_whole_part_is_drawn_and_can_be_switched_off(visit):
    page = visit.page
    page.get_by_role("button", name="Front").click()
    page.locator("#shape-tools").select_option("hidden")

    def share(side):
        picture = visit.picture()[:, : int(0.85 * visit.picture().shape[1])]
        half = picture.shape[1] // 2
        part = picture[:, :half] if side == "left" else picture[:, half:]
        return (np.abs(part - part[:1, :1]).max(axis=2) > 0.05).mean()

    assert share("left") == pytest.approx(share("right"), rel=0.1)
    assert page.evaluate("window.umform.shape.images.visible")
    whole = visit.picture()
    page.locator("#shape-whole").uncheck()
    assert not page.evaluate("window.umform.shape.images.visible")
    assert differing(whole, visit.picture()) > 0.02
    page.locator("#shape-field").select_option("von Mises stress")
    assert visit.text("#legend-name") == "von Mises stress"


def test_a_mirror_image_tells_its_values_too(visit):
    page = visit.page
    page.get_by_role("button", name="Top").click()
    page.locator("#shape-tools").select_option("hidden")
    visit.picture()
    box = page.locator("#shape-canvas").bounding_box()
    for part in (0.2, 0.6):
        page.mouse.move(box["x"] + part * box["width"], box["y"] + 0.5 * box["height"])
        assert visit.text("#shape-probe").startswith("largest plastic strain ")


def test_an_earlier_state_that_comes_late_is_no_error(visit):
    """States of a run are unpacked side by side; the table of an earlier one has fewer rows than the frame shown."""
    page = visit.page
    visit.slide(len(page.evaluate("window.umform.shape.head.frames")) - 1)
    page.evaluate("""() => {
        const { table, curves } = window.umform;
        const columns = Object.fromEntries(table.names.map((name) => [name, table.columns[name].slice(0, 2)]));
        curves.renew({ ...table, columns, length: 2 });
    }""")
    assert visit.text("#curves-at").startswith("punch ")
    assert "nan" not in visit.text("#curves-at")


@pytest.mark.parametrize(("width", "height"), [(1440, 900), (390, 844)])
def test_picture_and_key_numbers_are_on_the_first_screen(browser, path, width, height):
    visit = Visit(browser, path)
    page = visit.page
    page.set_viewport_size({"width": width, "height": height})
    page.wait_for_selector(READY, state="attached")
    for place in ("#shape-canvas", ".cards"):
        box = page.locator(place).bounding_box()
        assert box["y"] + box["height"] < height, place
    assert page.locator(".cards dt").count() >= 4
    options = page.locator("#shape-options")
    assert options.is_visible() == (width < 640)
    if options.is_visible():
        assert not page.locator("#shape-field").is_visible()
        options.press("Enter")
        assert page.locator("#shape-field").is_visible()
        assert options.get_attribute("aria-expanded") == "true"
    visit.context.close()
