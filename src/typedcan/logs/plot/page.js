// Puts the page together, and answers to pointers and keys.

const drawers = { curves: drawCurves, bands: drawBands, heat: drawHeat };
const main = document.querySelector("main");
const axis = document.querySelector(".axis");
let cursor = null;  // time and, over a heat map, the strip and the share of its height
let waiting = false;

function element(tag, parent, text = "") {
  const made = parent.appendChild(document.createElement(tag));
  made.textContent = text;
  return made;
}

function marksOf(texts) {
  return Object.fromEntries(Object.entries(texts).map(([mark, text]) => [mark, timesOf(text)]));
}

function prepare(strip) {
  if (strip.kind === "heat") return prepareHeat(strip);
  for (const [at, curve] of (strip.curves || []).entries()) {
    curve.time = timesOf(curve.time);
    curve.value = arrayOf(curve.wide ? Float64Array : Float32Array, curve.value);
    curve.begins = bytesOf(curve.begins);
    curve.marks = marksOf(curve.marks);
    curve.colour = at % 8;
  }
  for (const band of strip.bands || []) {
    band.marks = marksOf(band.marks);
    band.states.forEach((state, at) => {
      state.spans = timesOf(state.spans);
      state.colour = at && 1 + ((at - 1) % 7);
    });
  }
}

function build(strip) {
  const section = element("section", main);
  strip.legend = element("div", section);
  strip.legend.className = "legend";
  strip.readings = [];
  if (strip.kind === "heat") buildHeatLegend(strip);
  else if (strip.kind === "bands") entry(strip, "States", null);
  else for (const curve of strip.curves) entry(strip, curve.name, curve.colour);
  const plot = element("div", section);
  plot.className = "plot";
  strip.canvas = element("canvas", plot);
  strip.canvas.tabIndex = 0;
  strip.canvas.setAttribute("role", "img");
  strip.canvas.setAttribute("aria-label", names(strip).join(", "));
  strip.line = element("div", plot);
  strip.line.className = "cursor";
  strip.part = element("div", plot);
  strip.part.className = "part";
  strip.line.hidden = strip.part.hidden = true;
  listen(strip);
}

const names = (strip) => strip.kind === "heat"
  ? [strip.name] : (strip.curves || strip.bands).map((each) => each.name);

function entry(strip, name, colour) {
  const span = element("span", strip.legend);
  if (colour !== null) element("i", span).style.background = `var(--c${colour})`;
  const title = element("b", span, name);
  if (strip.kind === "curves" && strip.unit) title.dataset.unit = withUnit("in", strip.unit);
  strip.readings.push(element("span", span));
}

function buildHeatLegend(strip) {
  entry(strip, strip.name, null);
  const scale = element("span", strip.legend);
  element("span", scale, `${heatValue(strip, strip.scale[0])} `);
  const ramp = element("i", scale);
  ramp.className = "ramp";
  const colours = stops.map((stop) => `rgb(${stop.join(",")})`).join(",");
  ramp.style.background = `linear-gradient(90deg, ${colours})`;
  element("span", scale, withUnit(heatValue(strip, strip.scale[1]), strip.unit));
  const [bottom, top] = strip.scale;
  const far = [strip.least < bottom && strip.least, strip.most > top && strip.most].filter((level) => level !== false);
  if (!far.length) return;
  const outside = element("span", strip.legend);
  element("i", outside).style.background = `rgb(${beyondColour.join(",")})`;
  element("span", outside, `to ${far.map((level) => withUnit(heatValue(strip, level), strip.unit)).join(" and ")}`);
}

function markAt(marks, time) {
  return Object.keys(marks).find((mark) => within(marks[mark], time));
}

function readCurve(curve, unit, time) {
  const mark = markAt(curve.marks, time), at = above(curve.time, time) - 1;
  const text = at < 0 ? "" : withUnit(curve.value[at].toFixed(curve.digits), unit);
  if (!mark) return text;
  // Marks that are close together are one: then there are values within.
  const spans = curve.marks[mark], begin = spans[2 * above(spans, time, 2) - 2];
  return at >= 0 && curve.time[at] > begin ? `${text}, some ${mark}` : mark;
}

function readBand(band, time) {
  const mark = markAt(band.marks, time);
  const found = band.states.filter((state) => within(state.spans, time));
  // Where one state ends and the next begins, the later one counts.
  found.sort((one, other) => beginOf(other, time) - beginOf(one, time));
  return mark || (found.length ? found[0].label : "");
}

const beginOf = (state, time) => state.spans[2 * above(state.spans, time, 2) - 2];

function read(strip) {
  const texts = strip.readings.map(() => "");
  if (cursor === null) return texts;
  if (strip.kind === "heat")
    return [readHeat(strip, cursor.time, cursor.strip === strip ? cursor.share : null)];
  if (strip.kind === "bands") {
    const band = cursor.strip === strip ? strip.bands[Math.floor(cursor.share * strip.bands.length)] : null;
    return [band ? `${band.name}: ${readBand(band, cursor.time)}` : ""];
  }
  return strip.curves.map((curve) => readCurve(curve, strip.unit, cursor.time));
}

function showCursor() {
  const clock = document.querySelector(".clock");
  const digits = Math.max(decimals((view.to - view.from) / 1000), 0);
  const shown = cursor !== null && cursor.time >= view.from && cursor.time <= view.to;
  clock.textContent = "";
  if (shown) {
    const wall = data.begin === null ? "" : ` · ${wallClock(cursor.time)}`;
    clock.textContent = `${elapsed(cursor.time, digits)}${data.end < 60 ? " s" : ""}${wall}`;
  }
  for (const strip of data.strips) {
    strip.line.hidden = !shown;
    if (shown) strip.line.style.left = `${xOf(cursor.time, strip.canvas.clientWidth)}px`;
    read(strip).forEach((text, at) => { strip.readings[at].textContent = text ? ` ${text}` : ""; });
  }
}

function draw() {
  waiting = false;
  for (const strip of data.strips) drawers[strip.kind](strip);
  drawAxis(axis);
  showCursor();
}

function redraw() {
  if (!waiting) requestAnimationFrame(draw);
  waiting = true;
}

const actions = {
  in: () => zoom(0.5), out: () => zoom(2), all: () => show(data.start, data.start + length),
};
const shift = (share) => show(view.from + share * (view.to - view.from), view.to + share * (view.to - view.from));
const keys = {
  "+": actions.in, "=": actions.in, "-": actions.out, 0: actions.all,
  ArrowLeft: () => shift(-0.2), ArrowRight: () => shift(0.2),
};

// One pointer moves or, with Shift, marks a part; two zoom.
function listen(strip) {
  const { canvas } = strip, pointers = new Map();
  let partFrom = null;
  const place = (event) => event.clientX - canvas.getBoundingClientRect().left;
  const timeOf = (event) => timeAt(place(event), canvas.clientWidth);
  const follow = (event) => {
    const box = canvas.getBoundingClientRect();
    const time = Math.min(Math.max(timeOf(event), view.from), view.to);
    const share = Math.min(Math.max((event.clientY - box.top) / box.height, 0), 0.999999);
    cursor = { time, strip, share };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, place(event));
    if (event.shiftKey) partFrom = timeOf(event);
    follow(event);
    redraw();
  });
  canvas.addEventListener("pointermove", (event) => {
    const width = canvas.clientWidth;
    if (partFrom !== null) markPart(strip, partFrom, timeOf(event));
    else if (pointers.size) {
      const before = [...pointers.values()].map((x) => timeAt(x, width));
      pointers.set(event.pointerId, place(event));
      const now = [...pointers.values()].map((x) => timeAt(x, width));
      if (before.length === 2) pinch(before, now);
      else show(view.from + before[0] - now[0], view.to + before[0] - now[0]);
      redraw();
    }
    follow(event);
    if (!waiting) showCursor();
  });
  const end = (event) => {
    pointers.delete(event.pointerId);
    if (partFrom === null) return;
    const to = timeOf(event);
    strip.part.hidden = true;
    if (Math.abs(to - partFrom) > (view.to - view.from) / 100)
      show(Math.min(partFrom, to), Math.max(partFrom, to));
    partFrom = null;
    redraw();
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("wheel", (event) => {
    const sideways = Math.abs(event.deltaX) > Math.abs(event.deltaY);
    if (!sideways && !event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    if (sideways) shift(event.deltaX / canvas.clientWidth);
    else zoom(Math.exp(Math.max(-60, Math.min(60, event.deltaY)) * 0.01), timeOf(event));
    redraw();
  }, { passive: false });
  canvas.addEventListener("dblclick", (event) => {
    zoom(0.5, timeOf(event));
    redraw();
  });
}

function pinch(before, now) {
  const factor = (before[1] - before[0]) / (now[1] - now[0] || 1e-9);
  if (!Number.isFinite(factor) || factor <= 0) return;
  const from = before[0] - (now[0] - view.from) * factor;
  show(from, from + (view.to - view.from) * factor);
}

function markPart(strip, from, to) {
  const [left, right] = [from, to].map((time) => xOf(time, strip.canvas.clientWidth)).sort((a, b) => a - b);
  strip.part.hidden = false;
  strip.part.style.left = `${left}px`;
  strip.part.style.width = `${right - left}px`;
}

function buildKey() {
  const key = document.querySelector(".key");
  const words = { gap: "no frame for more than 5 periods", invalid: "invalid", abnormal: "abnormal" };
  const used = new Set(data.strips.flatMap((strip) => strip.kind === "heat"
    ? ["gap", "invalid"] : (strip.curves || strip.bands).flatMap((each) => Object.keys(each.marks))));
  key.textContent = "";
  for (const mark of data.marks.filter((each) => used.has(each))) {
    const span = element("span", key), sample = element("canvas", span);
    span.append(words[mark]);
    sample.width = 56;
    sample.height = 24;
    const pen = sample.getContext("2d");
    pen.scale(2, 2);
    hatch(pen, mark, 0, 0, 28, 12);
  }
}

function begin() {
  const spanText = `${elapsed(data.start, 0)} to ${elapsed(data.end, 0)}`;
  const since = data.begin === null ? "of the log" : `since ${wallClock(0)}`;
  document.querySelector(".span").textContent = `${spanText} ${data.end < 60 ? "s " : ""}${since}`;
  for (const note of data.notes) element("li", document.querySelector(".notes"), note);
  takeColours();
  data.strips.forEach(prepare);
  data.strips.forEach((strip) => {
    strip.height = strip.kind === "curves" ? 150 : 0;
    build(strip);
  });
  buildKey();
  for (const button of document.querySelectorAll("button"))
    button.addEventListener("click", () => { actions[button.dataset.do](); redraw(); });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
    redraw();
  });
  new ResizeObserver(redraw).observe(main);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    takeColours();
    buildKey();
    redraw();
  });
  draw();
}

begin();
