// Heat maps: of many cycles in one pixel, the reading that is farthest from the others is shown.

const stops = [[68, 1, 84], [65, 68, 135], [42, 120, 142], [34, 168, 132], [122, 209, 81], [253, 231, 37]];

function heatColour(share) {
  const place = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const at = Math.min(Math.floor(place), stops.length - 2), rest = place - at;
  return stops[at].map((part, number) => Math.round(part + (stops[at + 1][number] - part) * rest));
}

const packedColour = ([red, green, blue]) => ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
const heatTable = Uint32Array.from([...Array(256).keys()], (level) => packedColour(heatColour(level / 255)));
const beyondColour = [255, 45, 111];
const beyond = packedColour(beyondColour);
const none = 65535;

function prepareHeat(strip) {
  strip.spans = timesOf(strip.spans);
  strip.low = arrayOf(Uint16Array, strip.low);
  strip.high = strip.high === null ? strip.low : arrayOf(Uint16Array, strip.high);
  strip.isInvalid = strip.invalid === null ? () => 0 : bitsOf(strip.invalid);
  const count = strip.rows.length, columns = strip.spans.length / 2;
  strip.middle = new Float64Array(columns);
  strip.least = strip.most = strip.scale[0];
  for (let column = 0; column < columns; column++) {
    const values = [];
    for (let row = 0, at = column * count; row < count; row++, at++) {
      if (strip.low[at] === none) continue;
      values.push((strip.low[at] + strip.high[at]) / 2);
      strip.least = Math.min(strip.least, strip.low[at]);
      strip.most = Math.max(strip.most, strip.high[at]);
    }
    values.sort((one, other) => one - other);
    strip.middle[column] = values.length ? values[values.length >> 1] : 0;
  }
}

const heatHeight = (strip) => Math.min(Math.max(strip.rows.length * 5, 60), 360);

function drawHeat(strip) {
  const height = heatHeight(strip), sheet = prepared(strip.canvas, height + 8);
  if (!sheet) return;
  const { pen, width, scale } = sheet, top = 4;
  const room = sheet.right - margin.left;
  hatch(pen, "gap", margin.left, top, room, height);
  inside(sheet, top, height, () => {
    for (const [from, to] of seen(strip.spans, width)) {
      pen.fillStyle = style("--back");
      pen.fillRect(from, top, Math.max(to - from, 1), height);
      pen.globalAlpha = 0.7;
      pen.fillStyle = style("--invalid");
      pen.fillRect(from, top, Math.max(to - from, 1), height);
      pen.globalAlpha = 1;
      hatch(pen, "invalid", from, top, to - from, height);
    }
    const image = heatImage(strip, Math.max(1, Math.round(room * scale)), width, scale);
    pen.imageSmoothingEnabled = false;
    pen.drawImage(image, margin.left, top, room, height);
  });
  drawRows(sheet, strip, top, height);
  pen.strokeStyle = style("--axis");
  pen.strokeRect(margin.left + 0.5, top + 0.5, room - 1, height - 1);
}

// One pixel per column of the screen and row of the map, times the height that invalid ones show.
const parts = 4;

function heatImage(strip, across, width, scale) {
  const count = strip.rows.length, image = new ImageData(across, count * parts);
  const shown = new Float32Array(across * count), lacking = new Uint8Array(across * count);
  const farthest = new Float32Array(across * count).fill(-1);
  const { spans, low, high, middle } = strip;
  for (let column = above(spans, view.from, 2, 1); 2 * column < spans.length && spans[2 * column] <= view.to; column++) {
    const first = Math.max(Math.round((xOf(spans[2 * column], width) - margin.left) * scale), 0);
    const last = Math.min(Math.max(Math.round((xOf(spans[2 * column + 1], width) - margin.left) * scale), first + 1), across);
    for (let row = 0, at = column * count; row < count; row++, at++) {
      const least = low[at], most = high[at], bad = strip.isInvalid(at);
      const above = most - middle[column], below = middle[column] - least;
      const value = above >= below ? most : least, distance = Math.max(above, below);
      for (let x = first; x < last; x++) {
        const place = row * across + x;
        lacking[place] |= bad;
        if (least === none || distance <= farthest[place]) continue;
        farthest[place] = distance;
        shown[place] = value;
      }
    }
  }
  const [bottom, top] = strip.scale, words = new Uint32Array(image.data.buffer);
  for (let row = 0; row < count; row++)
    for (let x = 0; x < across; x++) {
      const place = row * across + x, value = shown[place];
      if (farthest[place] < 0) continue;
      const far = value < bottom || value > top;
      const colour = far ? beyond : heatTable[Math.round(((value - bottom) / (top - bottom || 1)) * 255)];
      const high = lacking[place] ? parts - 2 : parts;
      // What lies beyond the colours is three pixels wide, to be seen.
      for (let part = 0; part < high; part++)
        for (let near = Math.max(x - far, 0); near <= Math.min(x + far, across - 1); near++)
          if (near <= x || farthest[row * across + near] >= 0) words[(row * parts + part) * across + near] = colour;
      if (far) x = Math.min(x + 1, across);
    }
  const canvas = document.createElement("canvas");
  canvas.width = across;
  canvas.height = count * parts;
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

function drawRows(sheet, strip, top, height) {
  const { pen } = sheet, count = strip.rows.length, each = height / count;
  pen.textAlign = "right";
  pen.fillStyle = style("--soft");
  let below = -Infinity;
  strip.rows.forEach((row, number) => {
    const y = top + (number + 0.5) * each + 4;
    if (y - below < 13) return;
    below = y;
    pen.fillText(row.replace(/^[a-z]+_/, "").replace("_", "."), margin.left - 6, y);
  });
}

const heatValue = (strip, level) => (strip.base + level * strip.step).toFixed(strip.digits);

// What a heat map says at a time, of the row at that height or of all.
function readHeat(strip, time, share) {
  const column = above(strip.spans, time, 2) - 1;
  if (column < 0 || strip.spans[2 * column + 1] < time) return "gap";
  const count = strip.rows.length;
  const rows = share === null ? [...strip.rows.keys()] : [Math.min(Math.floor(share * count), count - 1)];
  let least = none, most = -1, bad = 0;
  for (const row of rows) {
    const at = column * count + row;
    bad += strip.isInvalid(at);
    if (strip.low[at] === none) continue;
    least = Math.min(least, strip.low[at]);
    most = Math.max(most, strip.high[at]);
  }
  const name = share === null ? "" : `${strip.rows[rows[0]]} `;
  if (most < 0) return `${name}invalid`;
  const text = least === most
    ? heatValue(strip, least) : `${heatValue(strip, least)} … ${heatValue(strip, most)}`;
  return `${name}${withUnit(text, strip.unit)}${bad ? ", some invalid" : ""}`;
}
