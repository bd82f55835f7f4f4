"""The page in Chromium: bend, stop, resume, compare, table, deck, parts, tables, phone, tabs, keyboard, languages."""

import contextlib

import pytest
from visits import BROWSER, READY, SOFTWARE_GL, Visit, quick, serious


def opened(page):
    """Unfold all groups of fields."""
    for group in page.locator("#fields details").all():
        if group.get_attribute("open") is None:
            group.locator("summary").click()


def bent(page, stroke):
    quick(page, stroke)
    page.click("#run")
    page.wait_for_selector("[data-measure=stroke]")


def test_bend_is_drawn_run_and_told(visit):
    page = visit.page
    sheet = page.locator("#drawing .sheet").get_attribute("d")
    page.fill("#f-thickness", "3")
    page.wait_for_function(
        "(before) => document.querySelector('#drawing .sheet').getAttribute('d') !== before", arg=sheet
    )
    page.fill("#f-thickness", "2")
    bent(page, 1)
    assert page.locator("[data-measure=stroke] b").inner_text() == "1.000"
    assert "kN" in page.locator("[data-measure=press]").inner_text()
    assert page.locator("#drawing .computed").count() == 1
    shape = page.frame_locator("iframe")
    shape.locator(READY).wait_for(state="attached")
    assert page.locator("a[href$='report.html']").get_attribute("target") == "_blank"
    page.click("#more-numbers summary")
    page.fill("#flat-a", "50")
    assert page.locator(".flat .value").inner_text().endswith("mm")
    page.select_option("#language", "de")
    page.locator("#measured summary", has_text="Ich habe einen anderen Winkel").wait_for()


def test_angle_out_of_reach_is_refused_beside_its_field(visit):
    page = visit.page
    page.fill("#f-angle", "70")
    page.wait_for_selector("#f-angle[aria-invalid=true]")
    assert page.locator("#run").is_disabled()
    page.click("#n-angle button")
    page.wait_for_selector("#run:enabled")
    assert float(page.input_value("#f-die_angle")) < 70


def test_decimal_comma_is_read_and_said_in_every_field(visit):
    page = visit.page
    opened(page)
    page.locator("#f-opening").fill("")
    page.locator("#f-opening").press_sequentially("12,5")
    page.locator("#n-opening", has_text="read as 12.5").wait_for()
    kept = "JSON.parse(localStorage.getItem('form'))"
    assert page.evaluate(f"{kept}.opening") == 12.5
    for name in ("thickness", "angle", "length", "die_radius", "punch_angle", "tensile_strength"):
        before = page.input_value(f"#f-{name}")
        for text, value in (("1,250", "may mean 1.25 or 1250"), ("1.250,5", "no clear number")):
            page.fill(f"#f-{name}", text)
            page.locator(f"#n-{name}", has_text=value).wait_for()
            assert page.locator("#run").is_disabled(), name
        page.fill(f"#f-{name}", before)
    page.wait_for_selector("#run:enabled")
    page.select_option("#f-work", "sequence")
    page.fill("#b-0-position", "25,5")
    page.locator("#n-bends", has_text="Bend 1: read as 25.5").wait_for()
    page.fill("#b-0-position", "1,250")
    page.locator("#n-bends", has_text="Bend 1: “1,250” may mean").wait_for()
    assert page.locator("#run").is_disabled()
    page.select_option("#f-work", "bend")
    page.click("#table")
    page.fill("#table-angles", "90,105")
    page.click("#table-go")
    page.locator("#table-dialog .note.bad", has_text="may mean").wait_for()


@pytest.mark.parametrize("typed", ["70", "71"])
def test_remedy_clicked_while_a_check_is_under_way_is_taken(visit, typed):
    """Between the press of the button and its release an answer arrives: to the angle there, or to another one."""
    page, held = visit.page, []
    page.fill("#f-angle", "70")
    page.wait_for_selector("#n-angle button")
    page.route("**/api/look", lambda route: held.append(route))
    page.fill("#f-angle", typed)
    button = page.locator("#n-angle button").bounding_box()
    page.mouse.move(button["x"] + 9, button["y"] + 9)
    page.mouse.down()
    for route in held:
        route.continue_()
    page.wait_for_timeout(500)
    page.unroute("**/api/look")
    page.mouse.up()
    page.wait_for_selector("#run:enabled", timeout=10_000)
    assert float(page.input_value("#f-die_angle")) < 70


def test_list_of_drawn_tools_that_comes_late_leaves_the_notes(browser, link):
    visit = Visit(browser, link)
    page, held = visit.page, []
    page.fill("#f-angle", "70")
    page.wait_for_selector("#n-angle button")
    page.route("**/api/tools", lambda route: held.append(route))
    page.reload()
    page.wait_for_selector("#n-angle button")
    with page.expect_response("**/api/tools"):
        held[0].continue_()
    page.wait_for_timeout(200)
    assert page.locator("#n-angle button").is_visible()
    page.click("#n-angle button")
    page.wait_for_selector("#run:enabled", timeout=10_000)
    visit.context.close()


def test_check_without_an_answer_is_asked_again(browser, link):
    visit = Visit(browser, link)
    page = visit.page
    page.fill("#f-angle", "70")
    page.wait_for_selector("#n-angle button")
    page.route("**/api/look", lambda route: route.abort(), times=1)
    page.click("#n-angle button")
    page.wait_for_selector("#run:enabled", timeout=10_000)
    visit.context.close()


def test_jobs_are_compared_in_two_tabs_and_stay(visit, link):
    page = visit.page
    bent(page, 0.8)
    page.fill("#f-stroke", "0.85")
    page.click("#run")
    other = visit.tab(link.split("?")[0])
    other.wait_for_function("() => document.querySelectorAll('#jobs input:enabled').length >= 2")
    boxes = other.locator("#jobs input:enabled")
    for number in range(2):
        boxes.nth(number).check()
    other.click("nav [data-view=compare]")
    other.wait_for_selector("#compare table")
    assert other.locator("#compare thead th").count() == 2
    assert other.locator("#compare .curve").count() == 2


def test_deck_is_stopped_and_goes_on(visit):
    page = visit.page
    page.click("nav [data-view=deck]")
    page.select_option("#deck-template", "cantilever")
    page.wait_for_function("() => document.querySelector('#deck-text').value.includes('Cantilever')")
    text = page.input_value("#deck-text")
    page.fill("#deck-text", text.replace("increments = 20", "increments = 800"))
    assert page.locator("#deck-help details").count() > 0
    page.click("#deck-run")
    page.wait_for_selector(".progress p:has-text('increment')")
    page.click("#do-stop")
    page.wait_for_selector("#do-resume")
    page.click("#do-resume")
    page.wait_for_selector("#do-stop")
    page.click("#do-stop")
    page.wait_for_selector("#do-resume")


def test_phone_dark_german_and_keyboard(browser, link):
    phone = {"viewport": {"width": 390, "height": 844}, "color_scheme": "dark", "locale": "de-DE", "has_touch": True}
    visit = Visit(browser, link, toured=False, **phone)
    page = visit.page
    assert page.locator("#tour-dialog[open]").count() == 0  # it would lie over the form
    page.click("#tour")
    page.wait_for_selector("#tour-dialog[open]")
    for _ in range(6):
        lit, dialog = (page.locator(one).bounding_box() for one in (".lit", "#tour-dialog"))
        assert lit["y"] >= 0 and lit["y"] + min(lit["height"], 60) <= dialog["y"]
        page.locator("#tour-dialog .main").press("Enter")
    assert page.locator("#tour-dialog[open]").count() == 0
    assert page.locator("#run").inner_text() == "Biegen"
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(19, 23, 27)"
    page.focus("#f-angle")
    page.keyboard.press("ArrowUp")
    assert page.input_value("#f-angle") == "91"
    page.select_option("#language", "en")
    page.wait_for_function("() => document.querySelector('#run').textContent === 'Bend'")
    unnamed = page.evaluate("""() => [...document.querySelectorAll('button, a[href], input, select, textarea')]
        .filter((one) => one.checkVisibility() && !one.labels?.length)
        .filter((one) => !(one.getAttribute('aria-label') ?? one.textContent).trim())
        .map((one) => one.outerHTML)""")
    assert unnamed == []
    assert visit.complaints == []
    visit.context.close()


def test_shape_follows_the_run_in_its_frame(visit):
    page = visit.page
    page.fill("#f-angle", "140")
    page.click("#run")
    frame = page.locator("iframe")
    frame.wait_for(state="attached")
    frame.evaluate("(one) => { one.dataset.first = 'yes'; }")
    page.wait_for_selector("[data-measure=stroke]")
    assert frame.get_attribute("data-first") == "yes"  # it was not loaded again
    job = page.evaluate("location.hash.split('/')[1]")
    asked = "(job) => fetch(`/api/jobs/${job}`).then((answer) => answer.json()).then((one) => one.live.increments)"
    increments = page.evaluate(asked, job)
    page.frame_locator("iframe").locator(f"#shape-time[data-row='{increments}']").wait_for(state="attached")


def test_job_goes_on_when_the_browser_is_killed(visit, browser, link):
    other = browser.browser_type.launch(executable_path=BROWSER, args=SOFTWARE_GL)
    doomed = Visit(other, link).page
    doomed.fill("#f-angle", "150")
    doomed.click("#run")
    doomed.wait_for_selector("#do-stop")
    name = doomed.evaluate("location.hash.split('/')[1]")
    with contextlib.suppress(Exception):
        other.new_browser_cdp_session().send("Browser.crash")
    page = visit.page
    page.wait_for_selector(f"#job-o-{name} .dot.done")
    page.click(f"#job-o-{name}")
    page.wait_for_selector("[data-measure=stroke]")
    page.reload()
    page.wait_for_selector("[data-measure=stroke]")


def test_die_from_a_drawing_is_read_drawn_and_kept(visit, tmp_path):
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new(units=ezdxf.units.MM)
    section = document.modelspace()
    flank = 1.0 / 2**0.5
    for side in (1, -1):  # a V of 90 degrees and 20 mm with shoulders of 2 mm
        edge, turn = 10 + 2 * (2**0.5 - 1), 2 * flank
        section.add_line((30 * side, 0), (edge * side, 0))
        section.add_arc((edge * side, -2), 2, *((90, 135) if side > 0 else (45, 90)))
        section.add_line(((edge - turn) * side, turn - 2), (0, -10))
        section.add_line((30 * side, 0), (30 * side, -30))
    section.add_line((30, -30), (-30, -30))
    document.saveas(tmp_path / "V20.dxf")
    (tmp_path / "broken.dxf").write_text("0\nSECTION\n")
    page = visit.page
    page.locator("#fields details").first.locator("summary").click()
    page.click("#tool-ask")
    page.select_option("#tool-kind", "die")
    page.set_input_files("#tool-file", tmp_path / "broken.dxf")
    page.click("#tool-send")
    page.wait_for_selector("#tool-said.bad")
    page.set_input_files("#tool-file", tmp_path / "V20.dxf")
    page.fill("#tool-name", "mine")
    page.click("#tool-send")
    page.wait_for_selector("#tool-said.good")
    assert "20" in page.inner_text("#tool-said")
    page.click("#tool-close")
    page.wait_for_selector("#f-opening:disabled")
    assert float(page.input_value("#f-opening")) == pytest.approx(20.0, abs=1e-3)
    assert float(page.input_value("#f-die_angle")) == pytest.approx(90.0, abs=1e-3)
    page.wait_for_selector("#f-angle[aria-invalid=true]")  # 90 degrees are out of reach of a die of 90 degrees
    page.select_option("#language", "de")
    page.locator("#n-angle", has_text="nicht erreichbar").wait_for()
    page.click("#n-angle button")  # tools that would do
    page.wait_for_selector("#run:enabled")
    assert page.input_value("#f-die") in ("", "usual:V20/85") and page.locator("#f-opening").is_enabled()
    visit.complaints.clear()  # a refused file is an answer with an error, which the browser writes down


def test_kinds_of_work_have_their_own_fields(visit):
    page = visit.page
    page.select_option("#f-work", "bottom")
    assert page.locator("#f-travel").is_visible() and page.locator("#f-angle").count() == 0
    page.wait_for_selector("#run:enabled")
    page.select_option("#f-work", "sequence")
    page.click("#bends-add")
    page.wait_for_selector("#f-bends .note:not(:empty)")  # no room for a third bend on 80 mm
    page.fill("#f-strip_length", "110")
    page.wait_for_selector("#run:enabled")
    page.wait_for_function("() => document.querySelectorAll('#drawing .mark').length === 3")
    page.fill("#b-1-angle", "-5")
    page.locator("#n-bends", has_text="(-5)").wait_for()
    assert "Bend 2" in page.inner_text("#n-bends")
    assert page.locator("#run").is_disabled()
    page.click("#b-1-remove")
    page.wait_for_selector("#run:enabled")
    page.select_option("#f-work", "hem")
    page.wait_for_selector("#f-gap")
    page.wait_for_selector("#run:enabled")
    assert page.locator("#table").is_hidden()


@pytest.fixture(scope="module")
def step(tmp_path_factory):
    """STEP files of brackets by their names."""
    pytest.importorskip("OCP")
    pytest.importorskip("ezdxf")
    from brackets import BRACKETS

    folder = tmp_path_factory.mktemp("brackets")
    return lambda name: BRACKETS[name].file(folder / f"{name}.step")


def coarse(page):
    """Take the mesh that is done in a moment."""
    page.locator("#fields details[data-group=Solution] summary").click()
    page.select_option("#f-mesh", "quick")


def test_part_is_dropped_seen_and_unfolded(visit, step):
    page = visit.page
    page.click("nav [data-view=flat]")
    page.locator("#form-title", has_text="Unfold a part").wait_for()
    assert page.locator("#f-work").count() == 0
    page.wait_for_selector("#run:disabled")
    page.set_input_files("#part-file", step("tube"))
    page.wait_for_selector("#part-said.bad")
    assert "the section is closed" in page.inner_text("#part-said")
    data = page.evaluate_handle(
        "(text) => { const data = new DataTransfer(); data.items.add(new File([text], 'an U.step')); return data; }",
        step("u").read_text(),
    )
    page.dispatch_event("#form", "drop", {"dataTransfer": data})
    page.locator("#n-part", has_text="2.000 mm thick").wait_for()
    assert page.input_value("#f-part") == "an U.step" and page.inner_text("#part-said") == ""
    page.frame_locator("#part-view iframe").locator(READY).wait_for(state="attached")
    coarse(page)
    page.wait_for_selector("#run:enabled")
    page.click("#run")
    page.wait_for_selector("#flat-steps")
    assert page.locator("#flat-bends tbody tr").count() == 2
    assert "computed: DC04" in page.locator("#flat-bends").inner_text()
    assert page.locator(".paper img").evaluate("(one) => one.decode().then(() => one.naturalWidth)") > 0
    for file in ("flat.dxf", "flat.svg", "flat.json", "sheet.html"):
        assert page.locator(f"a[href$='{file}']").is_visible()
    page.select_option("#language", "de")
    page.locator("#flat-steps", has_text="flache Kante").wait_for()
    assert page.locator("nav [aria-current]").inner_text() == "Zuschnitt"
    page.click("nav [data-view=bend]")
    page.wait_for_selector("#f-angle")
    page.wait_for_selector("#drawing")


def test_bend_table_is_computed_and_corrected_by_a_measured_bend(visit):
    page = visit.page
    page.click("nav [data-view=table]")
    page.wait_for_selector("#f-angles")
    coarse(page)
    page.fill("#f-thicknesses", "1")
    page.fill("#f-openings", "8")
    page.fill("#f-angles", "140:150")
    page.locator("#n-angles", has_text="is no range").wait_for()
    assert page.locator("#run").is_disabled()
    page.fill("#f-angles", "140:150:10")
    page.select_option("#f-metals", ["DC04"])
    page.wait_for_selector("#run:enabled")
    page.click("#run")
    page.wait_for_selector("a[href$='bends.csv']")
    assert page.locator("#bend-table tbody tr").count() == 3
    formats = page.locator("a[href$='.FCStd'], a[href$='.bnd'], a[href$='.txt']")
    formats.nth(3).wait_for()  # the files come one after the other
    assert formats.count() == 4

    page.click("nav [data-view=bend]")
    page.fill("#f-thickness", "1")
    page.fill("#f-opening", "8")
    page.fill("#f-angle", "140")
    page.wait_for_selector("#run:enabled")
    page.click("#run")
    page.click("#measured summary")
    page.fill("#m-measured_angle", "1,403")
    page.click("#measured-go")
    page.locator("#measured-said.bad", has_text="may mean").wait_for()
    page.fill("#m-measured_angle", "139,4")
    assert page.inner_text("#measured-said") == "read as 139.4"
    assert page.input_value("#m-issue_again") != ""
    page.click("#measured-go")
    page.wait_for_selector("[data-measure=new_stroke]")
    assert page.locator("[data-factor=flow_stress] b").inner_text().startswith("×")
    assert page.locator("#measured-bends tbody tr").count() == 6
    assert page.locator("#bend-table .was").count() == 14  # two bends of seven numbers, and what they were
    assert page.locator("a[href$='metal.toml']").is_visible()


@pytest.mark.parametrize("view", ["flat", "table"])
def test_further_views_fit_a_phone(browser, link, view):
    visit = Visit(browser, link, viewport={"width": 390, "height": 844}, color_scheme="dark", locale="de-DE")
    visit.page.click(f"nav [data-view={view}]")
    visit.page.wait_for_selector("#form-title:has-text('abwickeln'), #form-title:has-text('Biegetabelle')")
    assert visit.page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert visit.complaints == []
    visit.context.close()


@pytest.mark.parametrize("view", ["bend", "compare", "deck", "flat", "table"])
def test_axe_finds_nothing_serious(browser, link, view):
    visit = Visit(browser, link)
    if view == "bend":
        visit.page.select_option("#f-work", "sequence")
        for group in visit.page.locator("#fields details summary").all():
            group.click()
    visit.page.goto(link.split("?")[0] + f"#{view}")
    assert serious(visit.page) == []
    visit.context.close()
