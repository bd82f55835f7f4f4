"""Results on the page in Chromium: first numbers, marks, tables of an order, German files, a phone, the next work."""

import csv
import io
import re

from visits import Visit, quick, serious

from umform.bench.forces import Force
from umform.results.quantity import Band

PHONE = {"viewport": {"width": 390, "height": 844}, "color_scheme": "dark", "locale": "de-DE", "has_touch": True}


def bent(page, stroke):
    quick(page, stroke)
    page.click("#run")
    page.wait_for_selector("[data-measure=stroke]")


def test_first_numbers_are_those_of_the_machine_and_the_others_are_folded(visit):
    page = visit.page
    bent(page, 1.1)
    names = page.locator(".heroes.first > div").evaluate_all("(all) => all.map((one) => one.dataset.measure)")
    assert names == ["stroke", "press", "springback", "bend_deduction"]
    press = page.locator("[data-measure=press]").inner_text()
    assert " kN" in press
    assert " t;" in press
    assert not page.locator("[data-measure=largest_force]").is_visible()
    assert "N/mm" not in page.locator("main").inner_text()
    page.click("#more-numbers summary")
    assert page.locator("[data-measure=k_factor]").is_visible()


def test_numbers_of_a_coarse_mesh_say_so_and_its_job_is_not_green(visit):
    page = visit.page
    bent(page, 1.2)
    assert "of this mesh" in page.locator("[data-measure=springback]").inner_text()  # one layer: no studies
    assert "of this mesh" not in page.locator("[data-measure=stroke]").inner_text()  # it is given
    page.wait_for_selector("#jobs li:first-child .dot.done")
    dot = page.locator("#jobs .dot").first
    assert dot.get_attribute("class").split()[:2] in (["dot", "done"], ["dot", "done warned"])
    assert dot.get_attribute("aria-label") in ("done, with warnings", "limit missed")
    assert "section (2D)" in page.locator("#jobs button").first.inner_text()
    assert "section (2D)" in page.locator("#result h2").inner_text()


def test_the_press_has_the_error_of_the_computed_force(visit):
    press = Force("flatten", 100.0, 100.0, "computed", band=Band(4.0, "studies")).over(500.0)
    job = {"summary": {"hem": {}, "warnings": [], "first": {"angle": 40.0, "stroke": 12.0}, "press": press}}
    said = "(job) => import('/assets/strips.js').then(({ stripNumbers }) => stripNumbers(job)[0].textContent)"
    assert "50.0 kN ± 2.0" in visit.page.evaluate(said, job)


def test_only_a_job_with_a_checkpoint_is_resumed(visit):
    page = visit.page
    bent(page, 1.15)
    answers = {}

    def answer(route):
        route.fulfill(json=route.fetch().json() | {"state": "failed", "reason": "it failed"} | answers)

    page.route(re.compile(r"/api/jobs/[^/]+$"), answer)
    page.reload()
    page.wait_for_selector("#do-restart")
    assert page.locator("#do-resume").count() == 0
    answers["has_checkpoint"] = True
    page.reload()
    page.wait_for_selector("#do-resume")


def test_a_job_beyond_a_limit_is_red_in_words_and_colour(visit):
    page = visit.page
    bent(page, 1.3)

    def answer(route):
        found = route.fetch().json()
        found["jobs"][0]["summary"]["verdict"] = "missed"
        route.fulfill(json=found)

    page.route("**/api/jobs", answer)
    page.wait_for_selector("#jobs .dot.missed")
    # in one call: the list is drawn anew while jobs run
    colour = "(dot) => getComputedStyle(document.querySelector(dot)).backgroundColor"
    assert page.evaluate(colour, "#jobs .dot.missed") == "rgb(179, 64, 10)"
    page.locator("#jobs li").first.locator("b", has_text="limit missed").wait_for()  # until then its progress


def test_all_bends_of_an_order_are_one_table_that_fills(visit):
    page = visit.page
    quick(page, 1)
    page.fill("#f-angle", "150")
    page.click("#table")
    page.fill("#table-angles", "160 165")
    page.fill("#table-openings", "16")
    page.click("#table-go")
    rows = page.locator("#series-table tbody tr")
    rows.nth(1).wait_for()
    assert page.evaluate("location.hash").startswith("#all/")
    page.wait_for_function("() => !document.querySelector('#series-table .state')")
    assert [row.locator("th").nth(1).inner_text() for row in rows.all()] == ["160°", "165°"]
    assert rows.first.locator("td").count() == 9
    href = page.locator("#all a.button").get_attribute("href")
    assert len(page.request.get(f"http://{page.evaluate('location.host')}{href}").text().splitlines()) == 3
    rows.first.locator("a").click()
    page.wait_for_selector("[data-measure=stroke]")
    page.locator("#result header a.button").click()
    page.wait_for_selector("#series-table")
    page.click("nav [data-view=compare]")
    page.locator("#compare a", has_text="DC04 2 mm").click()
    page.wait_for_selector("#series-table")


def test_orders_with_other_tools_are_told_apart_in_their_table_and_no_angle_is_left_out(visit):
    page = visit.page
    quick(page, 1)
    page.fill("#f-angle", "150")
    page.locator("#fields summary", has_text="Die and punch").click()
    for radius in ("2", "2.5"):
        page.fill("#f-punch_radius", radius)
        page.click("#table")
        page.fill("#table-angles", "170")
        page.fill("#table-openings", "16")
        page.click("#table-go")
        page.wait_for_selector("#series-table")
        page.click("nav [data-view=bend]")
    page.fill("#f-die_radius", "3")
    page.click("#table")
    page.fill("#table-angles", "160:172:1")
    page.fill("#table-openings", "16 20")
    orders = []

    def taken(route):
        if route.request.method != "POST":
            return route.fallback()
        orders.append(route.request.post_data_json["forms"])
        return route.fulfill(json={"jobs": [], "refused": [{"title": "all of them"}]})

    page.route("**/api/jobs", taken)
    page.click("#table-go")
    page.locator("#table-dialog", has_text="all of them").wait_for()
    (forms,) = orders
    assert len(forms) == 26
    assert {(form["opening"], form["die_radius"]) for form in forms} == {(16, 3), (20, 2.5)}  # the form, the library
    page.keyboard.press("Escape")
    page.evaluate("location.hash = '#all/DC04%202%20mm'")
    page.wait_for_function("() => !document.querySelector('#series-table .state')")
    assert "Tip radius" in page.locator("#series-table thead").inner_text()
    rows = page.locator("#series-table tbody tr", has_text="170°").all()
    assert [row.locator("td").first.inner_text() for row in rows] == ["2.5", "2"]


def test_what_jobs_were_given_is_said_in_words(visit):
    said = "import('/assets/fields.js').then(({ givenText }) => Object.keys(given).map((name) => "
    said += "givenText({ parameters: given }, name)))"
    given = {"work": "bottom", "whole": False, "material": "DC04", "stroke": None, "opening": 16}
    words = visit.page.evaluate(f"(given) => {said}", given)
    assert words == ["bottoming", "no", "DC04", "–", "16"]


def test_on_a_phone_the_page_goes_to_the_result_and_says_so(browser, link):
    visit = Visit(browser, link, **PHONE)
    page = visit.page
    quick(page, 1.4)
    page.click("#run")
    page.wait_for_selector("[data-measure=stroke]")
    page.wait_for_function("() => document.querySelector('#announced').textContent.includes('fertig')")
    assert "über dem Formular" in page.locator("#announced").text_content()
    page.wait_for_selector("iframe", state="attached")
    page.wait_for_timeout(1000)
    assert -5 < page.locator("#result").bounding_box()["y"] < 120  # it stays there as the result grows
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    for file in ("curve.csv",):
        href = page.locator(f"a[href*='{file}']").get_attribute("href")
        assert href.endswith("?language=de")
    page.get_by_role("button", name="Zum Formular").click()
    assert abs(page.locator("#form").bounding_box()["y"]) < 120
    assert visit.complaints == []
    visit.context.close()


def test_german_table_opens_in_a_german_spreadsheet(browser, link):
    visit = Visit(browser, link, locale="de-DE")
    page = visit.page
    bent(page, 1.5)
    page.locator("#jobs li:first-child input:enabled").check()  # the newest: the list follows the result
    page.click("nav [data-view=compare]")
    href = page.locator("#compare a.button").get_attribute("href")
    body = page.request.get(f"http://{page.evaluate('location.host')}{href}").body().decode("utf-8-sig")
    [row] = csv.DictReader(io.StringIO(body), delimiter=";")
    assert row["stroke mm"] == "1,500"
    visit.context.close()


def test_a_measured_angle_an_angle_table_and_a_bend_table_are_one_click_away(visit):
    page = visit.page
    bent(page, 1.6)
    page.click("#next-measured")
    assert page.evaluate("document.activeElement.id") == "m-measured_angle"
    page.click("#next-angles")
    page.wait_for_selector("#table-dialog[open]")
    page.keyboard.press("Escape")
    page.click("#next-table")
    page.wait_for_selector("#f-metals")
    assert page.input_value("#f-openings") == "16"
    assert page.input_value("#f-thicknesses") == "2"


def test_a_finished_deck_shows_all_increments(visit):
    page = visit.page
    page.click("nav [data-view=deck]")
    page.select_option("#deck-template", "cantilever")
    page.wait_for_function("() => document.querySelector('#deck-text').value.includes('Cantilever')")
    page.click("#deck-run")
    page.locator("#result figcaption", has_text="All increments.").wait_for()
    assert "Largest von Mises stress" in page.locator(".heroes.first").inner_text()
    page.locator(".last summary").click()
    assert "force_force" not in page.locator(".last").inner_text()  # columns in words
    assert not page.locator("#sketch").is_visible() and not page.locator("#expected > *").count()  # those of the form
    page.click("nav [data-view=bend]")
    page.locator("#sketch").wait_for()


def test_results_fit_and_axe_finds_nothing_serious(visit):
    page = visit.page
    page.locator("#jobs li button").first.click()
    page.wait_for_selector("#result header")
    for view in ("", "#all/DC04%202%20mm"):
        if view:
            page.evaluate(f"location.hash = '{view}'")
            page.wait_for_selector("#view-all:not([hidden])")
        for width in (1440, 1024, 390):
            page.set_viewport_size({"width": width, "height": 900})
            assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
            assert serious(page) == []
