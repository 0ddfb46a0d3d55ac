"use strict";
// Data, times and numbers: from base 64 to arrays, from values to places and texts.

const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const arrayOf = (kind, text) => new kind(bytesOf(text).buffer);
const data = JSON.parse(document.getElementById("data").textContent);
const length = Math.max(data.end - data.start, 1e-6);

function timesOf(text) {
  const ticks = arrayOf(Uint32Array, text);
  return Float64Array.from(ticks, (tick) => data.start + (data.end - data.start) * (tick / 4294967295));
}

function bitsOf(text) {
  const bytes = bytesOf(text);
  return (place) => (bytes[place >> 3] >> (7 - (place & 7))) & 1;
}

// The first place in an ascending array that is above a value.
function above(array, value, step = 1, offset = 0) {
  let low = 0, high = Math.floor(array.length / step);
  while (low < high) {
    const middle = (low + high) >> 1;
    if (array[middle * step + offset] > value) high = middle;
    else low = middle + 1;
  }
  return low;
}

// Whether a time lies in one of the spans, which are begins and ends in turn.
function within(spans, time) {
  const next = above(spans, time, 2);
  return next > 0 && spans[2 * next - 1] >= time;
}

const view = { from: data.start, to: data.start + length };

function show(from, to) {
  const least = Math.min(length, 0.005);
  let span = Math.min(Math.max(to - from, least), length);
  const middle = (from + to) / 2;
  from = Math.min(Math.max(middle - span / 2, data.start), data.start + length - span);
  view.from = from;
  view.to = from + span;
}

function zoom(factor, around = (view.from + view.to) / 2) {
  show(around - (around - view.from) * factor, around + (view.to - around) * factor);
}

const margin = { left: 56, right: 10 };
const xOf = (time, width) =>
  margin.left + ((time - view.from) / (view.to - view.from)) * (width - margin.left - margin.right);
const timeAt = (x, width) =>
  view.from + ((x - margin.left) / (width - margin.left - margin.right)) * (view.to - view.from);

const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10800, 21600, 43200, 86400];

function timeStep(least) {
  if (least < 1) return numberStep(least);
  return steps.find((step) => step >= least) || Math.ceil(least / 86400) * 86400;
}

function numberStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((each) => each * power).find((each) => each >= least * 0.999999);
}

const decimals = (step) => Math.max(0, Math.min(6, Math.ceil(-Math.log10(step) - 1e-9)));
const two = (number) => String(number).padStart(2, "0");

function ticks(from, to, step) {
  const found = [];
  for (let place = Math.ceil(from / step - 1e-9); place * step <= to + step * 1e-9; place++)
    found.push(place * step);
  return found;
}

// Time since the log's begin, as 12.5, 1:02 or 1:00:02.
function elapsed(time, digits) {
  const unit = 10 ** digits;
  const total = Math.round(Math.abs(time) * unit) / unit;
  const sign = time < 0 && total > 0 ? "-" : "";
  const whole = Math.floor(total + 1e-9);
  const rest = digits ? (total - whole).toFixed(digits).slice(1) : "";
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  if (h) return `${sign}${h}:${two(m)}:${two(s)}${rest}`;
  return data.end >= 60 || m ? `${sign}${m}:${two(s)}${rest}` : `${sign}${s}${rest}`;
}

function wallClock(time) {
  const when = new Date((data.begin + time) * 1000);
  const day = `${when.getFullYear()}-${two(when.getMonth() + 1)}-${two(when.getDate())}`;
  return `${day} ${two(when.getHours())}:${two(when.getMinutes())}:${two(when.getSeconds())}`;
}

const withUnit = (text, unit) => (unit ? `${text} ${unit === "degC" ? "°C" : unit}` : text);
