"""A real browser, headless and without a network, for tests of pages."""

import re
import shutil
from contextlib import contextmanager
from pathlib import Path

SCHEMES = ("light", "dark")


@contextmanager
def chromium():
    """Debian's Chromium; where it is missing the test fails, see .ci/tools."""
    from playwright.sync_api import sync_playwright

    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    assert found, "the page is tested in a real browser: apt-get install chromium (.ci/tools does)"
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=found, args=["--no-sandbox"])
        yield browser
        browser.close()


@contextmanager
def opened(browser, path, *, width=1440, scheme="light", fragment="", scripts=True):
    """Page of a file, and what it said on its console; nothing may be said, nothing fetched."""
    context = browser.new_context(
        viewport={"width": width, "height": 900}, color_scheme=scheme, offline=True, java_script_enabled=scripts
    )
    page, said = context.new_page(), []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: said.append(request.url) if not request.url.startswith("file:") else None)
    page.goto(Path(path).resolve().as_uri() + fragment)
    yield page
    assert said == []
    context.close()


def violations(page):
    """What axe-core finds, in words; run beside the page, whose own policy stays as it is."""
    import axe_playwright_python

    axe = Path(axe_playwright_python.__file__).parent / "axe.min.js"
    page.evaluate("document.querySelectorAll('details').forEach(d => { d.open = true; })")
    page.evaluate(axe.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run()")
    return [f"{v['id']}: {v['nodes'][0]['html'][:160]}" for v in found["violations"]]


def printed_pages(page):
    """Sheets of paper."""
    return len(re.findall(rb"/Type\s*/Page\b", page.pdf(prefer_css_page_size=True)))


def sideways(page):
    """Pixels that the page is wider than the window."""
    return page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
