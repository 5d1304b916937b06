"use strict";
// Runs the loops that are linked into the module; the same in a worker of the page and in Node.

const SIGNALS = {
  lines: ({times, values}) => {
    let k = 0; // times go on
    return (t) => {
      if (times[k] > t) k = 0;
      while (k + 1 < times.length && times[k + 1] <= t) k++;
      if (k === times.length - 1 || t < times[0]) return values[k];
      return ((values[k + 1] - values[k]) / (times[k + 1] - times[k])) * (t - times[k]) + values[k];
    };
  },
  held: ({interval, values}) => (t) => values[Math.min(Math.max(Math.floor(t / interval + 1e-6), 0), values.length - 1)],
  sampled: ({first, interval, values}) => (t) => values[Math.min(Math.round((t - first) / interval), values.length - 1)],
  flat_sine: ({mean, amplitude, frequency, steepness}) => (t) =>
    mean + amplitude * Math.min(Math.max(steepness * Math.sin(2 * Math.PI * frequency * t), -1), 1),
};

// A list, or base64 of doubles.
function numbers(data) {
  if (!data?.f8) return data;
  return new Float64Array(Uint8Array.from(atob(data.f8), (character) => character.charCodeAt(0)).buffer);
}

// A signal as a function of time in s.
function signal(data) {
  const of = SIGNALS[data.kind](Object.fromEntries(Object.entries(data).map(([name, value]) => [name, numbers(value)])));
  return data.kind === "flat_sine" ? of : (t) => of(Math.round(t * 1e9) / 1e9);
}

class Refused extends Error {}

class Loops {
  // The WebAssembly.Module, and what Python says of it (module.py).
  constructor(module, content) {
    this.content = content;
    this.code = new WebAssembly.Instance(module, {}).exports;
    this.code._initialize?.();
    this.columns = {}; // of the last run, which the next one overwrites
    this.given = new WeakMap(); // what a signal gives: few moves change an input
  }

  // A signal at times that are `ahead` behind those of all steps, and at the first one.
  values(signal, count, step, ahead) {
    const known = this.given.get(signal);
    if (known?.length === count + 1) return known;
    const found = new Float64Array(count + 1);
    for (let k = 0; k <= count; k++) found[k] = signal(k * step + ahead);
    this.given.set(signal, found);
    return found;
  }

  column(key, count) {
    if (this.columns[key]?.length !== count + 1) this.columns[key] = new Float64Array(count + 1);
    return this.columns[key];
  }

  // Why the module refused.
  message() {
    const bytes = new Uint8Array(this.code.memory.buffer, this.code.last_message());
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  require(status, doing) {
    if (status !== 0) throw new Refused(this.message() || doing);
  }

  // Parameters "instance.name", or "instance.name@t" from t s on; those that this loop lacks are of no account.
  *found(name, parameters, step) {
    const places = Object.entries(this.content.loops[name].instances);
    for (const [key, value] of Object.entries(parameters)) {
      const [path, since] = key.split("@"), [place, ...parameter] = path.split(".");
      const number = places.findIndex(([each]) => each === place);
      const declared = number < 0 ? undefined : this.content.fmus[places[number][1]].parameters[parameter.join(".")];
      if (declared) yield {at: since === undefined ? -1 : Math.ceil(Number(since) / step - 1e-6), number, declared, value};
    }
  }

  // The columns of a run, until the next one: a row for each k step. Yields between parts of it.
  *run(name, {parameters, inputs, duration, step}) {
    const loop = this.content.loops[name], number = Object.keys(this.content.loops).indexOf(name);
    const count = Math.floor(duration / step + 1e-6), most = this.content.rows - 1;
    const set = ({number: instance, declared, value}) =>
      this.require(this.code.set(number, instance, declared.kind, declared.reference, value), "a parameter is refused");
    this.require(this.code.begin(number), "the loop cannot begin");
    const given = [...this.found(name, parameters, step)], due = given.filter(({at}) => at >= 0).sort((a, b) => a.at - b.at);
    for (const each of given) if (each.at < 0) set(each);
    const signals = Object.entries(loop.inputs).map(([key, [offset, real]]) =>
      ({offset, real, values: this.values(inputs[key], count, step, key.startsWith("plant.") ? 0.5 * step : 0)}));
    const columns = Object.fromEntries(["time", ...Object.keys(loop.columns)].map((key) => [key, this.column(key, count)]));
    const width = loop.size / 8; // of a row, in doubles
    const table = new Float64Array(this.code.memory.buffer, this.code.rows(), width * this.content.rows);
    const whole = new Int32Array(table.buffer, table.byteOffset, 2 * table.length);
    const fill = (first, last) => {
      for (let k = first; k <= last; k++) table[(k - base) * width] = k * step;
      for (const {offset, real, values} of signals)
        if (real) for (let k = first; k <= last; k++) table[(k - base) * width + offset / 8] = values[k];
        else for (let k = first; k <= last; k++) whole[2 * (k - base) * width + offset / 4] = values[k];
    };
    const read = (first, last) => {
      for (const [key, offset] of Object.entries(loop.columns)) {
        const column = columns[key], place = offset / 8;
        for (let k = first; k <= last; k++) column[k] = table[(k - base) * width + place];
      }
    };
    let base = 0;
    fill(0, 0);
    this.require(this.code.start_run(number, count * step, step), "the loop does not start");
    read(0, 0);
    while (base < count) {
      while (due.length && due[0].at <= base) set(due.shift());
      const last = Math.min(base + most, count, due.length ? due[0].at : count), first = base;
      fill(first + 1, last);
      if (this.code.run_steps(number, last - first) !== last - first) throw new Refused(this.message() || "a step is refused");
      read(first + 1, last);
      table.copyWithin(0, (last - first) * width, (last - first + 1) * width);
      base = last;
      yield;
    }
    return columns;
  }
}

// What a function that yields gives at its end.
function finished(steps) {
  for (;;) {
    const {done, value} = steps.next();
    if (done) return value;
  }
}

if (typeof module !== "undefined") module.exports = {Loops, signal, Refused, finished};
