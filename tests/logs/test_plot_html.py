"""The page of a plot in a browser: no requests, any text, light and dark, and it answers."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path
from xml.etree.ElementTree import Element

import html5lib
import numpy as np
import pytest
from logs.plot_logs import data_of

from typedcan.logs.plot.html import to_html
from typedcan.logs.plot.model import Band, Curve, Heat, Mark, Plot

HOSTILE = "</script><script>alert(1)</script><!-- \u2028 &amp; \"'`${x}"
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


def sample(text: str = "drive.blf") -> Plot:
    time = np.arange(0.0, 100.0, 0.1)
    hole = (time < 40) | (time >= 60)
    begins = np.zeros(int(hole.sum()), np.bool_)
    begins[[0, 400]] = True
    curve = Curve(
        name="S",
        title=text,
        unit="V",
        factor=0.1,
        time=time[hole],
        value=np.round(time[hole], 1),
        begins=begins,
        marks={Mark.GAP: np.array([[39.9, 60.0]])},
    )
    states = ((0, text, np.array([[0.0, 50.0]])), (1, "On", np.array([[50.0, 99.9]])))
    band = Band("B", text, states, {Mark.INVALID: np.array([[10.0, 20.0]])})
    values = np.array([[3.3, 3.4], [3.3, np.nan], [3.3, 3.6]])
    heat = Heat(
        title=text,
        unit="V",
        step=0.001,
        rows=("cell_1_1", "cell_1_2"),
        spans=np.array([[0.0, 30.0], [30.0, 60.0], [70.0, 99.9]]),
        low=values,
        high=values,
        invalid=np.isnan(values),
    )
    return Plot(text, None, 0.0, 99.9, (curve,), (band,), (heat,), (text,), {}, 0, None)


def document(page: str) -> Element:
    """The document, parsed by the rules of browsers; any error in it is an exception."""
    parsed = html5lib.HTMLParser(namespaceHTMLElements=False, strict=True).parse(page)
    assert isinstance(parsed, Element)
    return parsed


def test_nothing_is_fetched() -> None:
    page = to_html(sample())
    assert set(re.findall(r"https?://[^\"' ]*", page)) <= {"http://www.w3.org/2000/svg"}
    for element in document(page).iter():
        assert element.tag not in {"link", "img", "iframe", "object", "embed", "base"}
        assert not {"src", "href", "srcset"} & set(element.attrib)
        assert not {name for name in element.attrib if name.startswith("on")}
    assert not re.search(r"\bfetch\(|XMLHttpRequest|import\(|url\(|@import|WebSocket", page)
    assert "default-src 'none'" in page


def test_any_text_is_shown_and_never_markup(tmp_path: Path) -> None:
    calm, nasty = (document(to_html(sample(text))) for text in ("calm", HOSTILE))
    assert [element.tag for element in calm.iter()] == [element.tag for element in nasty.iter()]
    assert nasty.findtext(".//title") == HOSTILE
    (tmp_path / "page.html").write_text(to_html(sample(HOSTILE)))
    assert data_of(tmp_path / "page.html")["strips"][0]["curves"][0]["name"] == HOSTILE


def test_a_text_that_names_a_place_of_the_page_stays_a_text() -> None:
    page = to_html(sample("<!--script-->"))
    assert page.count("ResizeObserver") == to_html(sample()).count("ResizeObserver") == 1


def test_the_same_plot_gives_the_same_bytes() -> None:
    assert to_html(sample()) == to_html(sample())


PROBE = """
<script>
const said = [];
const canvases = () => [...document.querySelectorAll(".plot canvas")];
const drawn = () => new Promise((done) => setTimeout(done, 50));

async function point(number, type, share, height) {
  const canvas = canvases()[number], box = canvas.getBoundingClientRect();
  canvas.dispatchEvent(new PointerEvent(type, {
    pointerId: 1,
    clientX: box.left + 56 + share * (box.width - 66),
    clientY: box.top + height * box.height,
  }));
  await drawn();
}

async function read(name, number, share, height) {
  await point(number, "pointermove", share, height);
  const legends = [...document.querySelectorAll(".legend")].map((each) => each.textContent);
  said.push([name, ...legends, document.querySelector(".clock").textContent]);
}

function isPainted(canvas) {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return data.some((part) => part > 0);
}

async function probe() {
  HTMLElement.prototype.setPointerCapture = () => {};  // there is no real pointer to capture
  await drawn();
  await read("value", 0, 0.25, 0.5);
  await read("gap", 0, 0.5, 0.5);
  await read("invalid", 1, 0.15, 0.5);
  await read("state", 1, 0.75, 0.5);
  await read("cell", 2, 0.45, 0.9);
  await read("spike", 2, 0.9, 0.9);
  document.dispatchEvent(new KeyboardEvent("keydown", { key: "+" }));
  await drawn();
  await read("zoomed", 0, 0, 0.5);
  await point(0, "pointerdown", 0.5, 0.5);
  await point(0, "pointermove", 0.7, 0.5);
  await point(0, "pointerup", 0.7, 0.5);
  await read("moved", 0, 0, 0.5);
  document.querySelector("[data-do=all]").click();
  await drawn();
  await read("all", 0, 1, 0.5);
  const result = document.body.appendChild(document.createElement("pre"));
  result.id = "result";
  const wide = document.documentElement.scrollWidth <= innerWidth;
  result.textContent = JSON.stringify({ said, wide, painted: canvases().map(isPainted) });
}

addEventListener("load", probe);
</script>
"""

FRAMES = "<script>window.requestAnimationFrame = (draw) => setTimeout(draw);</script>"
"""Before all else: without a screen a frame may never come, least of all on a busy machine."""


def in_chromium(page: Path, *, width: int) -> tuple[str, str]:
    """The document after its scripts have run, and what the console says."""
    assert CHROMIUM is not None
    done = subprocess.run(
        [
            CHROMIUM,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--enable-logging=stderr",
            "--v=0",
            f"--user-data-dir={page.parent / 'profile'}",
            f"--window-size={width},900",
            "--virtual-time-budget=60000",
            "--dump-dom",
            page.as_uri(),
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    console = "\n".join(line for line in done.stderr.splitlines() if "CONSOLE" in line)
    return done.stdout, console


@pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
@pytest.mark.parametrize("width", [400, 1200])
def test_a_browser_draws_the_page_and_reads_values_off(width: int, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    probed = to_html(sample("drive")).replace("</body>", f"{PROBE}</body>")
    assert "<head>" in probed
    page.write_text(probed.replace("<head>", f"<head>{FRAMES}", 1))
    dom, console = in_chromium(page, width=width)
    assert console == ""
    found = re.search(r'<pre id="result">(.*?)</pre>', dom)
    assert found is not None
    result = json.loads(found[1])
    assert result["painted"] == [True, True, True]
    assert result["wide"]
    said = {name: texts for name, *texts in result["said"]}
    near = re.match(r"drive (\d+\.\d) V$", said["value"][0])
    assert near is not None
    assert float(near[1]) == pytest.approx(25.0, abs=0.3)
    assert said["gap"][0] == "drive gap"
    assert said["invalid"][1] == "States drive: invalid"
    assert said["state"][1] == "States drive: On"
    assert "cell_1_2 invalid" in said["cell"][2]
    assert "cell_1_2 3.600 V" in said["spike"][2]
    times = {name: clock(texts[3]) for name, texts in said.items()}
    assert times["zoomed"] == pytest.approx(25.0, abs=0.3)  # half of it is left, around the middle
    assert times["moved"] == pytest.approx(15.0, abs=0.5)
    assert times["all"] == pytest.approx(99.9, abs=0.3)


def clock(text: str) -> float:
    """Seconds of a time like 1:02.5."""
    minutes, seconds = text.split(":")
    return 60 * int(minutes) + float(seconds)
