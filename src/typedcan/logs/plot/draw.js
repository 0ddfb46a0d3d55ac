// Draws strips on canvases: curves, bands of states, heat maps, and the axis of time.

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const markStyles = {};
let palette = [];

// Hatches, one for each reason why there is no value, in the colours of light or dark.
function takeColours() {
  palette = [...Array(8).keys()].map((number) => style(`--c${number}`));
  for (const [mark, turn, step] of [["gap", 1, 7], ["invalid", -1, 6], ["abnormal", 0, 5]]) {
    const tile = document.createElement("canvas");
    tile.width = tile.height = step * 2;
    const pen = tile.getContext("2d");
    pen.scale(2, 2);
    pen.strokeStyle = style(`--${mark}`);
    pen.globalAlpha = 0.12;
    pen.fillStyle = pen.strokeStyle;
    pen.fillRect(0, 0, step, step);
    pen.globalAlpha = 0.75;
    pen.beginPath();
    for (const shift of turn ? [-step, 0, step] : [0]) {
      pen.moveTo(shift, turn > 0 ? step : turn < 0 ? 0 : step / 2);
      pen.lineTo(shift + step, turn > 0 ? 0 : turn < 0 ? step : step / 2);
    }
    pen.stroke();
    markStyles[mark] = tile;
  }
}

// A canvas cleared and ready, in units of CSS pixels; null while it has no size.
function prepared(canvas, height) {
  const width = canvas.clientWidth, scale = window.devicePixelRatio || 1;
  if (!width) return null;
  canvas.style.height = `${height}px`;
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  const pen = canvas.getContext("2d");
  pen.setTransform(canvas.width / width, 0, 0, canvas.height / height, 0, 0);
  pen.font = "11px system-ui, sans-serif";
  return { pen, width, height, scale, right: width - margin.right };
}

function hatch(pen, mark, x, y, width, height) {
  const pattern = pen.createPattern(markStyles[mark], "repeat");
  pattern.setTransform(new DOMMatrix().scale(0.5));
  pen.fillStyle = pattern;
  pen.fillRect(x, y, Math.max(width, 1.5), height);
}

// The spans that can be seen, as places on the canvas: begin and end.
function* seen(spans, width) {
  for (let at = above(spans, view.from, 2, 1); 2 * at < spans.length && spans[2 * at] <= view.to; at++) {
    const from = Math.max(xOf(spans[2 * at], width), margin.left);
    yield [from, Math.min(xOf(spans[2 * at + 1], width), width - margin.right)];
  }
}

function drawMarks(sheet, marks, top, height) {
  for (const [mark, spans] of Object.entries(marks))
    for (const [from, to] of seen(spans, sheet.width))
      hatch(sheet.pen, mark, from, top, to - from, height);
}

function inside(sheet, top, height, draw) {
  const { pen } = sheet;
  pen.save();
  pen.beginPath();
  pen.rect(margin.left, top, sheet.right - margin.left, height);
  pen.clip();
  draw(pen);
  pen.restore();
}

function timeTicks(width) {
  const room = width - margin.left - margin.right;
  const step = timeStep((view.to - view.from) / Math.max(2, Math.floor(room / 64)));
  return { step, places: ticks(view.from, view.to, step) };
}

function drawGrid(sheet, top, bottom) {
  const { pen, width } = sheet;
  pen.strokeStyle = style("--rule");
  pen.beginPath();
  for (const time of timeTicks(width).places) {
    const x = Math.round(xOf(time, width)) + 0.5;
    pen.moveTo(x, top);
    pen.lineTo(x, bottom);
  }
  pen.stroke();
}

function drawAxis(canvas) {
  const sheet = prepared(canvas, 24);
  if (!sheet) return;
  const { pen, width } = sheet;
  const { step, places } = timeTicks(width);
  pen.fillStyle = style("--ink");
  pen.textAlign = "center";
  const digits = decimals(step);
  for (const time of places) {
    const text = elapsed(time, digits), half = pen.measureText(text).width / 2;
    pen.fillText(text, Math.min(xOf(time, width), width - half - 1), 15);
  }
  pen.textAlign = "left";
  pen.fillStyle = style("--soft");
  pen.fillText(data.end >= 3600 ? "h:m:s" : data.end >= 60 ? "min:s" : "s", 2, 15);
}

// From the lowest to the highest value that can be seen, with some room.
function extent(curves) {
  let low = Infinity, high = -Infinity;
  for (const curve of curves) {
    const last = Math.min(above(curve.time, view.to), curve.time.length - 1);
    for (let at = Math.max(above(curve.time, view.from) - 1, 0); at <= last; at++) {
      const value = curve.value[at];
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (low > high) return null;
  const room = (high - low) * 0.06 || Math.max(Math.abs(high) * 0.02, 10 ** -curves[0].digits * 2);
  return { low: low - room, high: high + room };
}

function drawCurves(strip) {
  const sheet = prepared(strip.canvas, strip.height);
  if (!sheet) return;
  const { pen, width } = sheet, top = 6, bottom = strip.height - 6;
  drawGrid(sheet, top, bottom);
  const lane = (bottom - top) / strip.curves.length;
  strip.curves.forEach((curve, at) => drawMarks(sheet, curve.marks, top + at * lane, lane));
  const range = extent(strip.curves);
  if (range) {
    const yOf = (value) => bottom - ((value - range.low) / (range.high - range.low)) * (bottom - top);
    drawValues(sheet, range, yOf);
    inside(sheet, top - 4, bottom - top + 8, () =>
      strip.curves.forEach((curve) => drawCurve(pen, curve, width, yOf)));
  }
  pen.strokeStyle = style("--axis");
  pen.strokeRect(margin.left + 0.5, top + 0.5, sheet.right - margin.left - 1, bottom - top - 1);
}

function drawValues(sheet, range, yOf) {
  const { pen } = sheet, step = numberStep((range.high - range.low) / Math.max(2, sheet.height / 28));
  pen.textAlign = "right";
  pen.fillStyle = style("--soft");
  pen.strokeStyle = style("--rule");
  for (const value of ticks(range.low, range.high, step)) {
    const y = Math.round(yOf(value)) + 0.5;
    pen.beginPath();
    pen.moveTo(margin.left, y);
    pen.lineTo(sheet.right, y);
    pen.stroke();
    pen.fillText(value.toFixed(decimals(step)).replace(/^-(0(\.0*)?)$/, "$1"), margin.left - 6, y + 4);
  }
}

function drawCurve(pen, curve, width, yOf) {
  const { time, value, begins } = curve;
  const first = Math.max(above(time, view.from) - 1, 0);
  const last = Math.min(above(time, view.to), time.length - 1);
  const dots = (last - first) * 9 < width;
  pen.strokeStyle = pen.fillStyle = palette[curve.colour];
  pen.lineWidth = 1.4;
  pen.lineJoin = "round";
  pen.beginPath();
  const alone = [];
  for (let at = first; at <= last; at++) {
    const x = xOf(time[at], width), y = yOf(value[at]);
    if (begins[at] || at === first) pen.moveTo(x, y);
    else pen.lineTo(x, y);
    if (dots || (begins[at] && (at + 1 === time.length || begins[at + 1]))) alone.push(x, y);
  }
  pen.stroke();
  for (let at = 0; at < alone.length; at += 2) pen.fillRect(alone[at] - 1.5, alone[at + 1] - 1.5, 3, 3);
  pen.lineWidth = 1;
}

const bandHeight = 18, bandRow = 36;

function drawBands(strip) {
  const sheet = prepared(strip.canvas, strip.bands.length * bandRow + 2);
  if (!sheet) return;
  strip.bands.forEach((band, at) => drawBand(sheet, band, at * bandRow));
}

function drawBand(sheet, band, top) {
  const { pen, width } = sheet, y = top + 15;
  pen.textAlign = "left";
  pen.fillStyle = style("--soft");
  pen.fillText(band.name, margin.left, top + 11);
  // Long ones first: thinned, a short one can lie on top of a long one.
  const pieces = band.states.flatMap((state) => [...seen(state.spans, width)].map(
    ([from, to]) => ({ state, from, to })));
  pieces.sort((one, other) => other.to - other.from - (one.to - one.from));
  for (const { state, from, to } of pieces) {
    pen.fillStyle = palette[state.colour];
    pen.globalAlpha = state.colour ? 0.45 : 0.2;
    pen.fillRect(from, y, Math.max(to - from, 1.5), bandHeight);
    pen.globalAlpha = 1;
    if (to - from > 3) pen.fillRect(from, y, 1, bandHeight);
  }
  drawMarks(sheet, band.marks, y, bandHeight);
  pen.fillStyle = style("--ink");
  for (const { state, from, to } of pieces) {
    const text = shortened(pen, state.label, to - from - 8);
    if (text) pen.fillText(text, from + 4, y + 13);
  }
}

function shortened(pen, text, room) {
  if (room < 14) return "";
  if (pen.measureText(text).width <= room) return text;
  let kept = text.length;
  while (kept && pen.measureText(`${text.slice(0, kept)}…`).width > room) kept--;
  return kept > 1 ? `${text.slice(0, kept)}…` : "";
}
