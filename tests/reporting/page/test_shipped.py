"""The pages of shipped campaigns in a real browser: silent, accessible, on at most six sheets, within their budgets."""

import pytest
from tests.reporting.page.browser import chromium, opened, printed_pages, sideways, violations

import fddbench
from fddbench import gallery

pytestmark = pytest.mark.slow

SHIPPED = (
    *("smoke", "yaw_rate_table8", "yaw_rate_gusts", "jet_engine_monte_carlo"),
    *("b747_monte_carlo", "b747_trim", "yaw_rate_comparison", "smoke_6dof"),
)
SIGNALS = 500_000
ALL = sorted(path.stem for path in gallery.folder("campaigns").glob("*.yaml"))


@pytest.mark.parametrize("name", SHIPPED)
def test_page_of_a_shipped_campaign(tmp_path, name):
    fddbench.run(name, tmp_path / name, jobs=1)
    plain = fddbench.report(tmp_path / name, tmp_path / "plain.html", replay=False)
    path = fddbench.report(tmp_path / name)
    assert path.stat().st_size - plain.stat().st_size <= SIGNALS
    with chromium() as browser:
        for scheme in ("light", "dark"):
            with opened(browser, path, scheme=scheme) as page:
                assert len(page.locator("#answer").inner_text()) > 40
                assert violations(page) == []
        with opened(browser, path, width=390) as page:
            assert sideways(page) <= 0
        with opened(browser, path) as page:
            assert printed_pages(page) <= 6


@pytest.fixture(scope="module")
def browser():
    with chromium() as own:
        yield own


@pytest.mark.parametrize("name", [name for name in ALL if name not in SHIPPED])
def test_page_of_a_few_flights_of_every_other_shipped_campaign(browser, tmp_path, name):
    """The whole ones were looked at; here one flight a scenario, for what a page must keep whatever is in it."""
    fddbench.run(name, tmp_path / name, jobs=1, only="point=0,run=0")
    path = fddbench.report(tmp_path / name, replay=False)
    with opened(browser, path, width=390) as page:
        assert len(page.locator("#answer").inner_text()) > 30
        assert sideways(page) <= 0
        assert violations(page) == []
        assert printed_pages(page) <= 6
