"use strict";
// What follows from a car, by the data of follow.py: the solver of it, and powers.

class Followers {
  constructor(loops, data) {
    this.loops = loops;
    this.data = data;
    this.fmus = Object.keys(loops.content.fmus);
    this.kept = new Map();
  }

  // What follows from the car that was given.
  before(detailed) {
    if (!this.kept.has(detailed)) this.kept.set(detailed, this.all(this.data.known, this.data.powers.known, detailed));
    return this.kept.get(detailed);
  }

  // What is to be set where entries of the car are turned. Throws where there is no such car. detailed: what the
  // validation vehicle alone has is wanted too.
  changes(turned, detailed) {
    const {known, powers, shafts, usual} = this.data;
    if (!Object.keys(turned).length) return {};
    const stays = Object.fromEntries(Object.entries(known).filter(([name]) => !("C" in turned && shafts.includes(name))));
    const before = this.before(detailed), after = this.all({...stays, ...turned}, "C" in turned ? powers.without : powers.known, detailed);
    const changed = Object.entries(after).filter(([name, value]) => before[name] !== value);
    const back = Object.keys(before).filter((name) => !(name in after)).map((name) => [name, usual[name]]);
    return Object.fromEntries([...changed, ...back]);
  }

  // That of the drive train of the car, in Hz; where nothing is told of it that of the default car.
  band(turned, changes, detailed) {
    const {known, usual, band} = this.data;
    if (![known, turned].some((told) => Object.keys(told).length)) return band.unturned;
    const {C, J_1, J_2} = {...usual, ...this.before(detailed), ...changes};
    const frequency = Math.sqrt(C * (1 / J_1 + 1 / J_2)) / (2 * Math.PI);
    return band.edges.map((edge) => Number(((edge * frequency) / band.frequency).toFixed(1)));
  }

  // The entries with what follows from them.
  all(car, powers, detailed) {
    const {shafts, apart, furthest, usual} = this.data, has = shafts.some((name) => name in car);
    let found = {...car}, factor = 1;
    if (has && !("C" in car)) {
      const wanted = this.frequency("detailed", this.detailed(car, powers, 1)) / apart;
      found.C = this.solved(car, "design", (C) => this.frequency("design", {...car, C}), wanted, ...this.data.C);
    } else if (detailed && !has && Object.keys(car).length) {
      const wanted = this.frequency("design", car) * apart;
      const of = (by) => this.frequency("detailed", this.detailed(car, powers, by));
      const bounds = this.loops.content.fmus[this.data.detailed.fmu].parameters;
      const low = Math.max(1 / furthest, ...shafts.map((name) => bounds[name].min / usual[name]));
      const high = Math.min(furthest, ...shafts.map((name) => bounds[name].max / usual[name]));
      factor = this.solved({C: usual.C, ...car}, "detailed", of, wanted, low, high);
    }
    if (detailed) found = {...this.detailed(car, powers, factor), ...found};
    found = Object.fromEntries(Object.entries(found).map(([name, value]) =>
      [name, name in car ? value : Number(value.toPrecision(this.data.digits))]));
    return Object.fromEntries(Object.entries(found).filter(([name, value]) => name in car || value !== usual[name]));
  }

  // The car with what follows in the validation vehicle, for a factor on what is elastic.
  detailed(car, powers, factor) {
    const found = {...car}, now = {...car, factor};
    for (const [name, {value, of}] of Object.entries(powers)) {
      found[name] = value;
      for (const [source, [was, power]] of Object.entries(of)) found[name] *= ((now[source] ?? was) / was) ** power;
    }
    return found;
  }

  // In Hz, at which the drive train of a car swings in a plant.
  frequency(which, car) {
    const {fmu, names, here, load, torque, states, state} = this.data[which], {code, content} = this.loops;
    const number = this.fmus.indexOf(fmu), declared = content.fmus[fmu], full = {...car, ...here};
    const T = torque[0] + torque[1] * (car[load] ?? this.data.usual[load]);
    this.loops.require(code.begin_mode(number), `${fmu} cannot begin`);
    for (const [name, value] of Object.entries({...full, T_0: T})) {
      const of = declared.parameters[name];
      if (of && (names.includes(name) || name in here || name === "T_0"))
        this.loops.require(code.set_of_mode(number, of.kind, of.reference, value), `${name} = ${value} is refused`);
    }
    return code.mode_frequency(number, states, state, declared.torque, T);
  }

  // The value between low and high at which a frequency that grows with it is the one that is wanted.
  solved(car, which, frequency, wanted, low, high) {
    const missed = (x) => Math.log(frequency(Math.exp(x)) / wanted);
    let [a, b] = [Math.log(low), Math.log(high)], before = this.found?.[low] ?? (a + b) / 2, was = missed(before), next = before - 2 * was;
    for (let k = 0; k < 8 && next >= a && next <= b; k++) {
      const x = next, now = missed(x);
      if (now === was) break;
      next = x - (now * (x - before)) / (now - was);
      [before, was] = [x, now];
      if (Math.abs(next - x) > 1e-6) continue;
      this.found = {[low]: next}; // the next car is not far
      return Math.exp(next);
    }
    const [least, most] = [frequency(low), frequency(high)], Hz = (f) => Number(f.toPrecision(3));
    if (least <= wanted && wanted <= most) {
      while (b - a > 1e-10) {
        const middle = (a + b) / 2;
        if (missed(middle) < 0) a = middle; else b = middle;
      }
      const x = (a + b) / 2, leaps = Math.abs(missed(x)) > this.data.close; // to another mode
      if (!leaps) return Math.exp(x);
    }
    const given = ["C", ...this.data.shafts].filter((name) => name in car).map((name) => `${name} = ${Hz(car[name])} N.m/rad`);
    throw new Refused(`${given.join(", ")}: the frequency of the drive train would have to be ${Hz(wanted)} Hz, and that of ` +
      `${this.data[which].fmu} can be ${Hz(least)} to ${Hz(most)} Hz`);
  }
}

if (typeof module !== "undefined") {
  globalThis.Refused ??= require("./loop.js").Refused;
  module.exports = {Followers};
}
