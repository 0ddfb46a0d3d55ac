"""The HTML report in a real browser: it asks for nothing, fits a phone, and can be read."""

from __future__ import annotations

import html
import json
import re
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from judge.report_samples import EMPTY, GOOD, HOSTILE, MOMENT, PLAIN, hostile

from typedcan.judge.report import to_html

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")

OWN_HOSTS = ("google.com", "googleapis.com", "gvt1.com")
"""What the browser asks for on its own, whatever the page."""

PROBE = """
<script>
function channels(colour) {
  const [red, green, blue, alpha = 1] = colour.match(/[\\d.]+/g).map(Number);
  return { alpha, light: [red, green, blue]
    .map((each) => each / 255)
    .map((each) => (each <= 0.04045 ? each / 12.92 : ((each + 0.055) / 1.055) ** 2.4))
    .reduce((sum, each, place) => sum + each * [0.2126, 0.7152, 0.0722][place], 0) };
}

function behind(element) {
  for (let each = element; each; each = each.parentElement) {
    const found = channels(getComputedStyle(each).backgroundColor);
    if (found.alpha === 1) return found.light;
  }
  return NaN;
}

function contrast(element) {
  const front = channels(getComputedStyle(element).color).light, back = behind(element);
  return (Math.max(front, back) + 0.05) / (Math.min(front, back) + 0.05);
}

addEventListener("load", () => {
  for (const each of document.querySelectorAll("details")) each.open = true;
  const texts = [...document.querySelectorAll("body *")].filter((each) =>
    [...each.childNodes].some((node) => node.nodeType === 3 && node.data.trim()));
  const pale = texts.filter((each) => !(contrast(each) >= 4.5)).map((each) => each.outerHTML);
  const drawings = [...document.querySelectorAll(".drawing svg")].map((each) =>
    each.getBoundingClientRect().width);
  const scrolling = [...document.querySelectorAll(".scroll")].filter((each) =>
    each.scrollWidth > each.clientWidth);
  const outside = parent.document;
  const result = outside.body.appendChild(outside.createElement("pre"));
  result.id = "result";
  result.textContent = JSON.stringify({
    inner: innerWidth,
    wide: document.documentElement.scrollWidth,
    back: getComputedStyle(document.body).backgroundColor,
    texts: texts.length,
    pale,
    drawings,
    scrolling: scrolling.length,
  });
});
</script>
"""


def written(path: Path, *, probe: str = "") -> Path:
    """The page in a file; with a script or an image in it, what forbids these is taken out."""
    judgements = [PLAIN, GOOD, EMPTY, *map(hostile, HOSTILE)]
    moments = [[MOMENT], *[[]] * (len(judgements) - 1)]
    text = to_html(judgements, moments, "en", {"swapcan": "1.2.3"})
    if probe:
        text = re.sub("<meta http-equiv[^>]*>", "", text).replace("</body>", f"{probe}</body>")
    path.write_text(text, "utf-8")
    return path


def framed(page: Path, width: int) -> Path:
    """The page in a frame of that width: windows are never as narrow as phones."""
    text = html.escape(page.read_text("utf-8"))
    frame = f'<iframe srcdoc="{text}" style="width:{width}px;height:900px;border:0"></iframe>'
    style = "<style>:root { color-scheme: light dark }</style>"
    page.write_text(f'<!DOCTYPE html><meta charset="utf-8">{style}{frame}', "utf-8")
    return page


def in_chromium(page: Path, *flags: str, size: str) -> tuple[str, list[str]]:
    """What the browser prints, and what its console says."""
    assert CHROMIUM is not None
    done = subprocess.run(
        [
            CHROMIUM,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--host-resolver-rules=MAP * ~NOTFOUND",
            "--hide-scrollbars",
            "--enable-logging=stderr",
            "--v=0",
            f"--user-data-dir={page.parent / 'profile'}",
            f"--window-size={size}",
            *flags,
            page.as_uri(),
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]


def asked_for(log: Path) -> set[str]:
    """The hosts that were asked for, but for the browser's own."""
    events = json.loads(log.read_text("utf-8"))["events"]
    urls = [str((event.get("params") or {}).get("url", "")) for event in events]
    hosts = {urlsplit(url).hostname or "" for url in urls} - {""}
    return {host for host in hosts if not host.endswith(OWN_HOSTS)}


@pytest.mark.parametrize(("width", "height"), [(420, 4200), (1200, 3200)])
def test_a_browser_shows_the_page_and_asks_for_nothing(
    width: int, height: int, tmp_path: Path
) -> None:
    page, log, picture = (tmp_path / name for name in ("page.html", "net.json", f"{width}.png"))
    flags = (f"--log-net-log={log}", f"--screenshot={picture}")
    _, console = in_chromium(written(page), *flags, size=f"{width},{height}")
    print(f"screenshot: {picture}")
    assert console == []
    assert asked_for(log) == set()
    head = picture.read_bytes()[:24]
    assert struct.unpack(">II", head[16:]) == (width, height)


def test_the_log_of_the_browser_would_show_a_request(tmp_path: Path) -> None:
    page, log = tmp_path / "page.html", tmp_path / "net.json"
    written(page, probe='<img src="http://tracker.invalid/x.png" alt="">')
    in_chromium(page, f"--log-net-log={log}", "--dump-dom", size="420,900")
    assert asked_for(log) == {"tracker.invalid"}


@pytest.mark.parametrize("scheme", ["dark", "light"])
@pytest.mark.parametrize("width", [420, 1200])
def test_it_fits_the_width_and_every_text_can_be_read(
    width: int, scheme: str, tmp_path: Path
) -> None:
    page = framed(written(tmp_path / "page.html", probe=PROBE), width)
    number = {"dark": 0, "light": 1}[scheme]
    flags = (f"--blink-settings=preferredColorScheme={number}", "--dump-dom")
    dom, console = in_chromium(page, *flags, size="1300,900")
    assert console == []
    found = re.search(r'<pre id="result">(.*?)</pre>', dom, re.DOTALL)
    assert found is not None
    result: dict[str, Any] = json.loads(found[1])
    assert result["inner"] == width
    assert result["wide"] <= width
    assert result["back"] == {"dark": "rgb(16, 19, 23)", "light": "rgb(245, 246, 248)"}[scheme]
    assert result["texts"] > 100
    assert result["pale"] == []
    assert min(result["drawings"]) > width / 3
    if width == 420:
        assert result["scrolling"] > 0  # wide tables, each in its own box
