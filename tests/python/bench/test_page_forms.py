"""The forms of the page in Chromium: outside dimensions, drawn parts, usual tools, metals, values of a coil."""

import json
import re

import pytest
from visits import Visit, quick, serious


def test_outside_dimensions_give_flat_length_and_bend_lines(visit):
    page = visit.page
    page.select_option("#f-work", "outside")
    page.locator("[data-rule=flat]", has_text="about 80.57 mm").wait_for()  # 88 - 2 * 3.716, by K = 0.44
    assert page.locator("[data-rule=lines] dd").inner_text() == "about 20.14 · 60.43 mm"
    assert page.locator("#drawing .size").all_text_contents() == ["22", "44", "22"]
    page.fill("#o-1-flange", "44,5")
    page.locator("#n-outside", has_text="Flange 2: outside length in mm: read as 44.5").wait_for()
    page.locator("[data-rule=flat]", has_text="81.07").wait_for()
    page.fill("#o-1-flange", "-5")
    page.locator("#n-outside.bad", has_text="Flange 2: the outside length of a flange must be positive").wait_for()
    assert page.get_attribute("#o-1-flange", "aria-invalid") == "true" and page.locator("#run").is_disabled()
    assert "do not fit" not in page.inner_text("#drawing-text")
    page.fill("#o-1-flange", "12")
    page.locator("#n-outside", has_text="too short").wait_for()
    page.fill("#o-1-flange", "60")
    page.click("#outside-add")
    page.select_option("#o-3-order", "0")
    page.wait_for_function("() => document.activeElement.id === 'o-3-order'")
    kept = json.loads(page.evaluate("localStorage.getItem('form')"))["outside"]
    assert [bend["line"] for bend in kept["bends"]] == [3, 1, 2] and kept["flanges"] == [22, 60, 22, 22]
    page.click("#o-1-remove")
    kept = json.loads(page.evaluate("localStorage.getItem('form')"))["outside"]
    assert [bend["line"] for bend in kept["bends"]] == [2, 1] and kept["flanges"] == [22, 22, 22]


def test_a_part_by_outside_dimensions_is_bent_to_them(visit):
    page = visit.page
    page.select_option("#f-work", "outside")
    page.locator("#fields details[data-group=Solution] summary").click()
    page.select_option("#f-mesh", "quick")
    page.wait_for_selector("#run:enabled")
    page.click("#run")
    page.wait_for_selector("#strip-table")
    flanges = [page.inner_text(f"[data-measure='flange {number}'] b") for number in (1, 2, 3)]
    assert [float(one) for one in flanges] == pytest.approx([22.0, 44.0, 22.0], abs=0.005)
    page.click("#do-again")
    page.locator("[data-rule=flat]").wait_for()
    assert "about" not in page.inner_text("[data-rule=flat] dd")  # the bend is in the store now


def test_a_second_sheet_of_the_library_is_bent_with_the_first(visit):
    page = visit.page
    page.locator("#fields details[data-group='Second sheet'] summary").click()
    assert page.locator("#f-second_material option").first.inner_text() == "none"
    page.select_option("#f-second_material", "1.4301")
    page.fill("#f-second_thickness", "0,5")
    page.fill("#f-second_friction", "0.1")
    quick(page, 1.0)
    page.wait_for_selector("#run:enabled")
    page.locator("#drawing-text", has_text="2 + 0.5 mm sheet").wait_for()
    page.click("#run")
    page.locator("#result", has_text="sheet 2: springback").wait_for()


def test_a_collision_is_red_before_the_run_and_named(visit):
    page = visit.page
    page.select_option("#f-work", "outside")
    page.wait_for_selector("[data-rule=flat]")
    assert page.locator("#n-outside").inner_text() == ""  # the default part does not collide
    page.fill("#o-0-flange", "60")
    page.fill("#o-1-flange", "25")
    page.fill("#o-2-flange", "60")
    page.locator("#n-outside.bad", has_text="Bend 2: the part will collide with the punch").wait_for()
    assert "another order" in page.inner_text("#n-outside")


@pytest.mark.parametrize(("work", "first"), [("cup", "Ø 107.50"), ("u", "350")])
def test_drawn_parts_are_forms_with_a_sketch(visit, work, first):
    page = visit.page
    page.select_option("#f-work", work)
    page.locator("#drawing .size", has_text=first).wait_for()
    assert page.locator("#drawing .tool").count() == 5
    assert page.get_attribute(f"#f-{work}_opening", "placeholder") in ("62.4", "52")
    assert page.locator("#f-opening").count() == 0 and page.locator("#tool-ask").count() == 0
    page.fill(f"#f-{work}_punch_edge", "7,5")
    page.locator(f"#n-{work}_punch_edge", has_text="read as 7.5").wait_for()
    page.fill(f"#f-{work}_opening", "40")
    page.locator(f"#n-{work}_opening.bad", has_text="gap between punch and die").wait_for()
    page.fill(f"#f-{work}_opening", "")
    page.fill(f"#f-{work}_holder_force", "2")
    page.locator(".note.warn", has_text="kN in place of N").wait_for()


def test_a_cup_is_drawn(visit):
    page = visit.page
    page.select_option("#f-work", "cup")
    page.locator("#fields details[data-group=Solution] summary").click()
    page.select_option("#f-mesh", "quick")
    page.wait_for_function("() => document.querySelector('#f-cup_turn').placeholder === '30'")
    page.locator("#fields details[data-group=Tools] summary").click()
    page.fill("#f-cup_stroke", "8")
    page.wait_for_selector("#run:enabled")
    page.click("#run")
    page.wait_for_selector("[data-measure='largest punch force']", timeout=180_000)
    assert "kN" in page.inner_text("[data-measure='largest punch force']")
    assert page.locator("a[href$='report.html']").is_visible()
    page.select_option("#language", "de")
    page.locator("#result", has_text="größte Stempelkraft").wait_for()
    page.locator("#result .note", has_text="Grobes Netz").wait_for()


def test_an_angle_of_30_degrees_has_tools_and_is_seen_whole(visit):
    page = visit.page
    page.fill("#f-angle", "30")
    page.wait_for_selector("#n-angle button")
    low = """() => {
        const box = (one) => document.querySelector(one).getBoundingClientRect();
        const [all, sheet] = ['#drawing', '#drawing .sheet'].map(box);
        return [sheet.top - all.top, all.bottom - sheet.bottom];
    }"""
    assert min(page.evaluate(low)) >= 0.0
    page.click("#n-angle button")
    page.wait_for_selector("#run:enabled")
    assert page.input_value("#f-die_angle") == "26" and page.input_value("#f-die") == "usual:V16/26"
    assert min(page.evaluate(low)) >= 0.0


def test_usual_tools_are_chosen_by_name(visit):
    page = visit.page
    page.locator("#fields details[data-group=Tools] summary").click()
    assert page.input_value("#f-die") == "usual:V16/85"
    page.select_option("#f-die", "usual:V20/60")
    page.select_option("#f-punch", "usual:60/R1")
    assert [page.input_value(f"#f-{name}") for name in ("opening", "die_angle", "die_radius")] == ["20", "60", "2.5"]
    assert [page.input_value(f"#f-{name}") for name in ("punch_angle", "punch_radius")] == ["60", "1"]
    page.fill("#f-opening", "21")
    page.wait_for_function("() => document.querySelector('#f-die').value === ''")  # no usual one any more
    assert page.input_value("#f-punch") == "usual:60/R1"


def test_metals_are_one_list_with_a_search_by_keyboard(visit):
    page = visit.page
    page.click("#f-material")
    heads = page.locator("#metal-options .head").all_inner_texts()
    assert heads == ["From standards", "Published cards"]
    fits = "() => [...document.querySelectorAll('#metal-options b')].every((one) => one.scrollWidth <= one.clientWidth)"
    assert page.evaluate(fits) and page.locator("#metal-options [role=option]").count() > 15
    page.keyboard.press("Escape")
    assert page.locator("#metal-options").is_hidden() and page.input_value("#f-material") == "DC04 (1.0338)"
    page.fill("#f-material", "4301")
    assert page.locator("#metal-options [role=option]").all_inner_texts()[0].startswith("1.4301")
    page.keyboard.press("Enter")
    assert page.input_value("#f-material") == "1.4301" and page.evaluate("location.hash") in ("", "#bend")
    page.locator("[data-rule=rm]", has_text=re.compile(r"^Rm\s*54\d MPa")).wait_for()
    page.fill("#f-material", "postech")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    assert page.input_value("#f-material") == "AA6016-T4 Postech"
    assert page.input_value("#f-rolling") == "90"  # a law with directions
    page.fill("#f-material", "cheese")
    page.locator("#metal-options", has_text="No metal with “cheese”").wait_for()
    page.keyboard.press("Tab")
    assert page.input_value("#f-material") == "AA6016-T4 Postech"


def test_exchanged_values_of_a_coil_are_one_message_at_their_field(visit):
    page = visit.page
    page.locator("#fields details[data-group=Sheet] summary").click()
    page.fill("#f-yield_stress", "410")
    page.fill("#f-tensile_strength", "290")
    page.locator("#n-yield_stress.bad", has_text="Re 410 is not below Rm 290").wait_for()
    assert page.locator(".note.bad:not(:empty)").count() == 1 and page.inner_text("#form-note") == ""
    assert "do not fit" not in page.inner_text("#drawing-text")
    page.select_option("#language", "de")
    page.locator("#n-yield_stress", has_text="Re 290 und Rm 410, falls sie vertauscht sind").wait_for()


def test_the_strip_above_a_hem_has_the_force_of_the_hem(visit):
    page = visit.page
    page.select_option("#f-work", "hem")
    page.locator("[data-rule=press]", has_text="flattening").wait_for()
    force = float(page.inner_text("[data-rule=press] dd").split()[0].strip(">"))
    bend = float(page.inner_text("[data-rule=force] dd").split("–")[1].split()[0])
    assert force > 2.0 * bend  # over 1000 mm


def test_the_first_bend_of_a_hem_has_decimal_commas_in_german(visit):
    visit.page.select_option("#language", "de")
    visit.page.wait_for_function("() => document.documentElement.lang === 'de'")
    job = {"summary": {"hem": {}, "warnings": [], "first": {"angle": 40.12, "stroke": 12.25}}}
    said = "(job) => import('/assets/strips.js').then(({ stripNumbers }) => stripNumbers(job).at(-1).textContent)"
    assert "40,1° bei 12,25 mm" in visit.page.evaluate(said, job)


@pytest.mark.parametrize("work", ["outside", "cup", "u", "sequence", "hem"])
def test_forms_fit_their_screen_in_german(browser, link, work):
    visit = Visit(browser, link, locale="de-DE")
    page = visit.page
    page.select_option("#f-work", work)
    page.wait_for_selector("#run:enabled")
    for group in page.locator("#fields details summary").all():
        group.click()
    out = """() => {
        const end = (one) => one.getBoundingClientRect().right;
        const right = end(document.querySelector('#form'));
        const shown = [...document.querySelectorAll('#fields *')].filter((one) => one.checkVisibility());
        return shown.filter((one) => end(one) > right).map((one) => one.outerHTML);
    }"""
    for width in (390, 1024, 1440):
        page.set_viewport_size({"width": width, "height": 800})
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        assert page.evaluate(out) == []
    assert visit.complaints == []
    visit.context.close()


def test_axe_finds_nothing_serious_in_the_forms(visit):
    page = visit.page
    for work in ("outside", "cup"):
        page.select_option("#f-work", work)
        page.wait_for_selector("#run:enabled")
        page.click("#f-material")  # with the list of metals open
        assert serious(page) == []
