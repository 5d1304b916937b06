"use strict";
// What settings of the page mean for a run: text, gains, and the manoeuvre that is drawn by hand.

const short = (value) => String(Number(value.toPrecision(6)));

// One of the words that the command line has for parameters too, with what stands there in braces.
const said = (words, what, of) => words[what].replace(/\{(\w+)\}/g, (_, name) => (typeof of[name] === "number" ? short(of[name]) : of[name]));

// What is typed, as in "plant.mu=0.3, controller.k_d@2=1.5", by the rules of --set.
function typed(text, words) {
  const found = {};
  for (const part of text.split(",").map((each) => each.trim()).filter(Boolean)) {
    const [name, given, ...more] = part.split("=").map((each) => each.trim());
    const truth = {true: 1, false: 0}[given?.toLowerCase()], value = truth ?? Number(given);
    if (!/^[^.]+\../.test(name) || (truth === undefined && !new RegExp(`^(${words.real})$`, "i").test(given)) || more.length)
      throw new Refused(said(words, "form", {text: `'${part}'`, form: words[name.includes("@") ? "changed" : "constant"]}));
    if (!Number.isFinite(value)) throw new Refused(said(words, "finite", {text: `'${part}'`}));
    if ((found[name] ?? value) !== value) throw new Refused(said(words, "twice", {name, before: found[name], value}));
    found[name] = value;
  }
  return found;
}

// Name and time of "instance.parameter@t".
function parted(key) {
  const [name, ...since] = key.split("@").map((each) => each.trim()), [instance, ...own] = name.split(".");
  return {name, instance, own: own.join("."), since: since.length ? Number(since.join("@") || NaN) : undefined};
}

// The gains that were turned, and by the character, as far as sliders go.
function turnedGains({knobs, sport, comfort}, {gains, character}) {
  if (character === 0.5) return gains;
  const [end, share] = character > 0.5 ? [comfort, 2 * character - 1] : [sport, 1 - 2 * character];
  const found = {};
  for (const {name, low, high, value} of knobs.gains) {
    const now = gains[name] ?? value, by = now * (end[name] ?? 1) ** share;
    found[name] = Math.min(Math.max(by, Math.min(low, now)), Math.max(high, now));
    if (found[name] === value && !(name in gains)) delete found[name];
  }
  return found;
}

// Instant and height of the one step of a demand of straight lines, as harness/manoeuvres/demand_shape.py has it.
function stepOf(points) {
  const changes = points.slice(1).map((_, k) => k).filter((k) => points[k + 1][1] !== points[k][1]);
  if (!changes.length || points[changes.at(-1) + 1][0] - points[changes[0]][0] > 0.5) return null;
  const way = points.at(-1)[1] - points[0][1];
  if (!changes.every((k) => (points[k + 1][1] - points[k][1]) * way > 0)) return null;
  return [points[changes[0]][0], way];
}

// A manoeuvre of points (instant in s, value) of demand and brake.
function freeManoeuvre({T_driver, T_brake, v_0, duration}) {
  const lines = (points) => ({kind: "lines", times: points.map(([t]) => t), values: points.map(([, value]) => value)});
  const held = T_brake.every(([, value]) => value === T_brake[0][1]), [t_0, dT] = (held && stepOf(T_driver)) || [0, null];
  return {
    duration, t_0, dT,
    start: {"plant.v_0": v_0, "plant.T_0": signal(lines(T_driver))(0)},
    inputs: {"controller.T_driver": lines(T_driver), "plant.T_brake": lines(T_brake), "plant.slope": lines([[0, 0]])},
  };
}

if (typeof module !== "undefined") {
  for (const name of ["signal", "Refused"]) globalThis[name] ??= require("./loop.js")[name];
  module.exports = {short, said, typed, parted, turnedGains, stepOf, freeManoeuvre};
}
