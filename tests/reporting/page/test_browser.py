"""The page in a real browser: nothing said or fetched, filters, arrow keys, the address, hostile names, axe-core, paper."""

import json

import pytest
from tests.reporting.page.browser import SCHEMES, chromium, opened, printed_pages, sideways, violations

from fddbench.reporting.page.writing import write_page

pytestmark = pytest.mark.slow

EVIL = "<img src=x onerror=alert(1)>"
QUOTED = "a\"b'c&amp;d"
MATRIX = "#matrix tbody tr:not(.off)"


@pytest.fixture(scope="module")
def browser():
    with chromium() as own:
        yield own


@pytest.fixture
def plain(make_report, tmp_path):
    path = tmp_path / "page.html"
    write_page(make_report(flights=40), path)
    return path


@pytest.fixture
def hostile(make_report, tmp_path):
    report = make_report(scenarios=("jam_a", "jam_b", "healthy"), flights=10, recordings=())
    rows = report.rows
    rows["scenario"] = rows["scenario"].str.replace("jam_a", EVIL)
    rows["detector"] = rows["detector"].str.replace("voting_monitor", QUOTED)
    path = tmp_path / "hostile.html"
    write_page(report, path)
    return path


def pressed(page):
    return page.locator("button[aria-pressed=true]").get_attribute("data-c")


def test_it_opens_at_the_weakest_cell_and_says_what_it_holds(browser, plain):
    with opened(browser, plain) as page:
        assert page.locator("#answer").inner_text().startswith("Best of 2: sliding_mode, ")
        assert "voting_monitor" in page.locator("#detail h2").inner_text()
        assert page.locator("#detail svg").count() >= 2
        assert page.locator("#matrix").bounding_box()["y"] < 900  # on the first screen


def test_arrow_keys_walk_the_matrix_and_the_address_keeps_the_choice(browser, plain):
    with opened(browser, plain) as page:
        page.locator('button[data-c="0,0"]').click()
        page.keyboard.press("ArrowDown")
        page.keyboard.press("ArrowRight")
        assert pressed(page) == "1,1"
        page.keyboard.press("ArrowRight")
        assert pressed(page) == "1,1"
        page.keyboard.press("ArrowUp")
        assert pressed(page) == "0,1"
        assert "scenario=oscill_a" in page.url
        fragment = page.url.partition("#")[2]
    with opened(browser, plain, fragment=f"#{fragment}") as page:
        assert pressed(page) == "0,1"


def test_filters_hide_and_sort_and_stay_in_the_address(browser, plain):
    with opened(browser, plain) as page:
        scenarios = page.locator(MATRIX).count()
        page.get_by_role("checkbox", name="voting_monitor").uncheck()
        assert page.locator("#matrix thead th:not(.off)").count() == 2
        page.get_by_label("only scenarios with failures").check()
        assert 0 < page.locator(MATRIX).count() < scenarios
        page.get_by_role("checkbox", name="voting_monitor").check()
        page.get_by_label("worst first").check()
        badness = [int(row.get_attribute("data-w")) for row in page.locator(MATRIX).all()]
        assert badness == sorted(badness, reverse=True)
        fragment = page.url.partition("#")[2]
    with opened(browser, plain, fragment=f"#{fragment}") as page:
        assert page.get_by_label("worst first").is_checked()
        assert page.get_by_label("only scenarios with failures").is_checked()


def test_an_address_of_another_page_falls_back(browser, plain):
    with opened(browser, plain, fragment="#scenario=nowhere&detector=nobody&off=nothing&x=%E0%A4") as page:
        assert pressed(page)


def test_hostile_names_stay_text(browser, hostile):
    with opened(browser, hostile) as page:
        assert page.locator("img").count() == 0
        page.locator('button[data-c="0,0"]').click()
        assert EVIL in page.locator("#detail h2").inner_text()
        assert page.get_by_role("checkbox", name=QUOTED).count() == 1
        fragment = page.url.partition("#")[2]
    with opened(browser, hostile, fragment=f"#{fragment}") as page:
        assert pressed(page) == "0,0"


def test_tables_are_copied_as_csv_and_latex(browser, hostile):
    with opened(browser, hostile) as page:
        page.evaluate("navigator.clipboard.writeText = text => { window.copied = text; return Promise.resolve(); }")
        page.get_by_label("copy detectors as CSV").click()
        lines = page.evaluate("window.copied").splitlines()
        assert len(lines) == 3
        assert lines[0].startswith("detector,")
        assert '"a""b' in "".join(lines)
        page.get_by_label("copy outcome matrix as LaTeX").click()
        text = page.evaluate("window.copied")
        assert text.startswith("\\begin{tabular}{lll}")
        assert "sliding\\_mode" in text
        assert "a\"b'c\\&amp;d" in text


def test_without_its_script_the_page_still_tells(browser, plain):
    with opened(browser, plain, scripts=False) as page:
        assert page.locator("#matrix tbody tr").count() == 11
        assert "need the script" in page.locator("noscript").inner_text()


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("name", ["plain", "hostile"])
def test_axe_core_finds_nothing(browser, request, name, scheme):
    with opened(browser, request.getfixturevalue(name), scheme=scheme) as page:
        assert violations(page) == []


@pytest.mark.parametrize("width", [390, 800, 1440])
def test_nothing_scrolls_sideways(browser, plain, width):
    with opened(browser, plain, width=width) as page:
        page.evaluate("document.querySelectorAll('details').forEach(d => { d.open = true; })")
        assert sideways(page) <= 0


def test_paper_opens_what_is_folded_and_cuts_no_picture(browser, plain):
    with opened(browser, plain) as page:
        assert printed_pages(page) <= 6
        page.emulate_media(media="print")
        page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        assert page.locator("details:not([open])").count() == 0
        width = page.evaluate("document.documentElement.clientWidth")
        boxes = page.evaluate(
            "[...document.querySelectorAll('svg')].map(e => e.getBoundingClientRect()).filter(r => r.width)"
            ".map(r => [r.left, r.right, r.height])"
        )
        assert all(left >= 0 and right <= width + 1 and height < 690 for left, right, height in boxes), json.dumps(
            boxes
        )
        assert page.evaluate("getComputedStyle(document.querySelector('figure')).breakInside") == "avoid"
