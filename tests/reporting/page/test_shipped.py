"""The pages of shipped campaigns in a real browser: silent, accessible, on at most six sheets, within their budgets."""

import pytest
from tests.reporting.page.browser import chromium, opened, printed_pages, sideways, violations

import fddbench

pytestmark = pytest.mark.slow

SHIPPED = (
    *("smoke", "yaw_rate_table8", "yaw_rate_gusts", "jet_engine_monte_carlo"),
    *("b747_monte_carlo", "b747_trim", "yaw_rate_comparison", "smoke_6dof"),
)
SIGNALS = 500_000


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
