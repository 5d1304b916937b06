"use strict";
// What a run is worth: the metrics of the page, as harness/metrics defines them. NaN where one makes no sense.

const TO_SETTLE = {span: 0.2, settled: 0.05, fitted: 0.9, least: 0.1}, WINDOW = [-0.2, 4], WITHHELD = 2;

// Of the columns of a run, and of these at the samples of the controller, T_s apart, for the manoeuvre, and a band in Hz.
function metrics(run, sampled, {t_0, dT}, T_s, band) {
  const t = sampled.time, T_gear = sampled["plant.T_gear"], demand = sampled["controller.T_driver"];
  const piece = (x, from, to) => x.slice(first(t, from - 1e-9), first(t, to + 1e-9, true));
  const windowed = (x) => (dT === null ? x : piece(x, t_0 + WINDOW[0], t_0 + WINDOW[1]));
  const e = added(demand, sampled["controller.T_ref"]), isStep = dT !== null && stays(demand, t, t_0, dT);
  return {
    settling_time: isStep ? settlingTime(T_gear, T_s, t_0, dT) : NaN,
    overshoot: isStep ? overshoot(t, T_gear, T_s, t_0, dT) : NaN,
    ...bandRms(windowed(T_gear), windowed(sampled["plant.a_body"]), T_s, band),
    impact_speed: impactSpeed(run, t_0),
    withheld_time: isStep ? -(sum(piece(e, t_0, t_0 + WITHHELD)) * T_s) / dT + 0 : NaN,
  };
}

// Of each column every so many-th row.
function atSamples(run, every) {
  return Object.fromEntries(Object.entries(run).map(([name, column]) => {
    const some = new Float64Array(Math.floor((column.length - 1) / every) + 1);
    for (let k = 0; k < some.length; k++) some[k] = column[k * every];
    return [name, some];
  }));
}

const sum = (x) => x.reduce((total, value) => total + value, 0);

// The first place in the ascending x of a value that is not below the limit, or that is above it.
function first(x, limit, above = false) {
  let low = 0, high = x.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (x[middle] < limit || (above && x[middle] === limit)) low = middle + 1; else high = middle;
  }
  return low;
}

// T_ref - T_driver, the demand delayed by the one sample that every controller needs.
const added = (T_driver, T_ref) => T_ref.map((value, k) => value - T_driver[Math.max(k - 1, 0)]);

// Whether the demand is constant before its step and at its height from some instant on.
function stays(demand, t, t_0, dT) {
  const end = t.at(-1), tolerance = 1e-6 * Math.abs(dT), near = (x, y) => Math.abs(x - y) <= tolerance;
  if (end < t_0 + TO_SETTLE.fitted || !(tolerance > 0)) return false;
  return demand.every((value, k) => (t[k] >= t_0 - 1e-9 || near(value, demand[0]))
    && (t[k] <= end - TO_SETTLE.fitted || near(value - demand[0], dT)));
}

function settlingTime(T_gear, T_s, t_0, dT) {
  const swing = amplitude(T_gear, Math.round(TO_SETTLE.span / T_s)), begin = Math.round(t_0 / T_s);
  const limit = TO_SETTLE.settled * Math.abs(dT);
  if (swing.at(-1) > limit) return NaN;
  for (let k = swing.length - 1; k >= begin; k--) if (swing[k] > limit) return (k - begin + 1) * T_s;
  return 0;
}

// Half of the peak to peak of so many samples from each one on.
function amplitude(x, length) {
  const swing = largest(x, length), below = largest(x.map((value) => -value), length);
  return swing.map((most, k) => (most + below[k]) / 2);
}

// The largest of so many neighbours: of twice as many again and again, then of two that overlap.
function largest(x, length) {
  const joined = (before, shift) => {
    const found = new Float64Array(Math.max(before.length - shift, 0));
    for (let k = 0; k < found.length; k++) found[k] = before[k] > before[k + shift] ? before[k] : before[k + shift];
    return found;
  };
  let width = 1;
  for (; 2 * width <= length; width *= 2) x = joined(x, width);
  return joined(x, length - width);
}

function overshoot(t, T_gear, T_s, t_0, dT) {
  const begin = Math.round(t_0 / T_s), [level, slope] = line(t, T_gear, first(t, t.at(-1) - TO_SETTLE.fitted + T_s / 2, true));
  const before = T_gear[Math.max(begin - 1, 0)], initial = Math.abs(before) >= 0.1 ? before : 0;
  const final = (k) => level + slope * t[k], way = final(begin) - initial;
  if (!(Math.abs(way) >= TO_SETTLE.least * Math.abs(dT))) return NaN;
  let most = 0;
  for (let k = begin; k < t.length; k++) most = Math.max(most, (T_gear[k] - final(k)) / way);
  return most;
}

// Level and slope of the straight line that is nearest to y(t) from a place on.
function line(t, y, begin) {
  const n = t.length - begin, middle = sum(t.slice(begin)) / n, mean = sum(y.slice(begin)) / n;
  let up = 0, down = 0;
  for (let k = begin; k < t.length; k++) {
    up += (t[k] - middle) * (y[k] - mean);
    down += (t[k] - middle) ** 2;
  }
  return [mean - (up / down) * middle, up / down];
}

// The rms of the parts of the gear torque and of the derivative of the acceleration within a band, the lines from first
// to last sample subtracted. Both are transformed at once, as real and imaginary part.
function bandRms(T, a, T_s, [least, most]) {
  const n = T.length, low = Math.ceil(least * n * T_s - 1e-9), high = Math.min(Math.floor(most * n * T_s + 1e-9), n >> 1);
  if (least * n * T_s < 1) return {gear_torque_rms: NaN, jerk_rms: NaN};
  const level = (x) => x.map((value, k) => value - (x[0] + ((x[n - 1] - x[0]) * k) / (n - 1)));
  const {real, imaginary} = transform(level(T), level(a));
  let [torque, jerk] = [0, 0];
  for (let k = low; k <= high; k++) {
    const [r, m, R, M] = [real[k], imaginary[k], real[n - k], imaginary[n - k]];
    torque += ((r + R) ** 2 + (m - M) ** 2) / 4;
    jerk += (((m + M) ** 2 + (r - R) ** 2) / 4) * ((2 * Math.PI * k) / (n * T_s)) ** 2;
  }
  const rms = (total) => (Math.sqrt(2) / n) * Math.sqrt(total);
  return {gear_torque_rms: rms(torque), jerk_rms: rms(jerk)};
}

// The discrete Fourier transform of x + j y: of any length a convolution of one that is a power of two (Bluestein).
function transform(x, y) {
  const n = x.length, {size, cos, sin, br, bi} = chirp(n), ar = new Float64Array(size), ai = new Float64Array(size);
  for (let k = 0; k < n; k++) {
    ar[k] = x[k] * cos[k] + y[k] * sin[k];
    ai[k] = y[k] * cos[k] - x[k] * sin[k];
  }
  powerOfTwo(ar, ai);
  for (let k = 0; k < size; k++) {
    const real = ar[k] * br[k] - ai[k] * bi[k];
    ai[k] = -(ar[k] * bi[k] + ai[k] * br[k]);
    ar[k] = real;
  }
  powerOfTwo(ar, ai); // of the conjugate: the inverse
  const real = new Float64Array(n), imaginary = new Float64Array(n);
  for (let k = 0; k < n; k++) {
    const r = ar[k] / size, i = -ai[k] / size;
    real[k] = r * cos[k] + i * sin[k];
    imaginary[k] = i * cos[k] - r * sin[k];
  }
  return {real, imaginary};
}

// What does not depend on the numbers, kept for the length that was asked for last.
let kept = {};

function chirp(n) {
  if (kept.n === n) return kept;
  const size = 2 ** Math.ceil(Math.log2(2 * n)), cos = new Float64Array(n), sin = new Float64Array(n);
  const br = new Float64Array(size), bi = new Float64Array(size);
  for (let k = 0; k < n; k++) {
    const angle = (Math.PI * ((k * k) % (2 * n))) / n;
    cos[k] = Math.cos(angle);
    sin[k] = Math.sin(angle);
    br[k] = br[(size - k) % size] = cos[k];
    bi[k] = bi[(size - k) % size] = sin[k];
  }
  powerOfTwo(br, bi);
  kept = {n, size, cos, sin, br, bi};
  return kept;
}

let turns = {};

// cos and -sin of the k-th part of a turn.
function turnsOf(n) {
  if (turns.n !== n) {
    turns = {n, cos: new Float64Array(n / 2), sin: new Float64Array(n / 2)};
    for (let k = 0; k < n / 2; k++) {
      turns.cos[k] = Math.cos((2 * Math.PI * k) / n);
      turns.sin[k] = -Math.sin((2 * Math.PI * k) / n);
    }
  }
  return turns;
}

// In place.
function powerOfTwo(real, imaginary) {
  const n = real.length, {cos, sin} = turnsOf(n);
  for (let i = 1, j = 0; i < n; i++) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      const r = real[i], m = imaginary[i];
      real[i] = real[j];
      imaginary[i] = imaginary[j];
      real[j] = r;
      imaginary[j] = m;
    }
  }
  for (let size = 2; size <= n; size *= 2) {
    const half = size / 2, stride = n / size;
    for (let begin = 0; begin < n; begin += size)
      for (let k = 0; k < half; k++) {
        const i = begin + k, j = i + half, c = cos[k * stride], s = sin[k * stride];
        const r = real[j] * c - imaginary[j] * s, m = real[j] * s + imaginary[j] * c;
        real[j] = real[i] - r;
        imaginary[j] = imaginary[i] - m;
        real[i] += r;
        imaginary[i] += m;
      }
  }
}

// The largest speed with which the teeth meet from t_0 on, in all rows of a run.
function impactSpeed(run, t_0) {
  const T = run["plant.T_gear"], last = T.length - 1;
  const speed = (k) => Math.abs(run["plant.omega_1"][k] - run["plant.omega_2"][k]);
  let most = 0, turns = 0, apart = false, loaded = -1;
  for (let k = 0; k <= last; k++) {
    if (T[k] === 0) continue;
    if (loaded >= 0 && Math.sign(T[k]) !== Math.sign(T[loaded])) {
      turns++;
      apart ||= k - loaded > 1;
    }
    loaded = k;
  }
  if (turns && !apart) return NaN;
  for (let k = 1; k < last - 1; k++) {
    const side = Math.sign(T[k + 1]);
    if (side === 0 || side === Math.sign(T[k]) || run.time[k] < t_0 - 1e-9) continue;
    const growth = T[k - 1] === 0 && T[k] === 0 ? speed(k) - speed(k - 1) : speed(k + 1) - speed(k);
    const rise = T[k + 2] - T[k + 1], since = rise * T[k + 1] > 0 ? T[k + 1] / rise : 0.5;
    most = Math.max(most, speed(k) + (1 - Math.min(Math.max(since, 0), 1)) * growth);
  }
  return most;
}

if (typeof module !== "undefined") module.exports = {metrics, atSamples, added};
