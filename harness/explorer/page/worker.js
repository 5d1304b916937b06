"use strict";
// Answers what a page asks for: one run of the loop, with what it is worth.

const ENABLE = [() => 0, () => 1];

class Answerer {
  // data: of content.py; code: bytes of the module.
  constructor(data, code) {
    this.data = data;
    this.loops = new Loops(new WebAssembly.Module(code), data.loops);
    this.followers = new Followers(this.loops, data.follow);
    this.followed = ["", {}];
    this.signals = new WeakMap();
    this.last = {};
  }

  manoeuvre({manoeuvre, plant, free, road}) {
    const found = manoeuvre === "free" ? freeManoeuvre(free) : this.data.manoeuvres[manoeuvre], own = found.plants?.[plant] ?? found;
    if (!road.slope) return own;
    const slope = signal(own.inputs["plant.slope"]), turned = (t) => slope(t) + road.slope;
    return {...own, inputs: {...own.inputs, "plant.slope": turned}};
  }

  // "instance.name" -> value for the loop with a controller, beside those of the manoeuvre; null: ours that is off.
  parameters(wanted, controller) {
    const {base, ours, loops} = this.data, name = `${wanted.plant} ${controller ?? ours}`;
    const detailed = this.data.follow.shafts.every((each) => each in loops.fmus[loops.loops[name].instances.plant].parameters);
    const turned = JSON.stringify([wanted.car, detailed]);
    if (turned !== this.followed[0]) this.followed = [turned, this.followers.changes(wanted.car, detailed)];
    const found = {...base[name]}, {mu} = wanted.road;
    for (const [instance, fmu] of Object.entries(loops.loops[name].instances)) {
      if (instance === "controller" && !wanted.informed) continue;
      for (const [key, value] of Object.entries(this.followed[1]))
        if (key in loops.fmus[fmu].parameters) found[`${instance}.${key}`] = value;
    }
    if (mu !== undefined) found["plant.mu"] = mu;
    if (controller === ours)
      for (const [key, value] of Object.entries(turnedGains(this.data, wanted))) found[`controller.${key}`] = value;
    return {...found, ...typed(wanted.typed)};
  }

  // A run with that controller, or without control where it is null; yields while it is under way.
  *answer(wanted, controller) {
    const {ours, step, T_s} = this.data, name = `${wanted.plant} ${controller ?? ours}`;
    const manoeuvre = this.manoeuvre(wanted), own = this.parameters(wanted, controller);
    this.require(name, own);
    const key = JSON.stringify([name, wanted.manoeuvre, wanted.manoeuvre === "free" && wanted.free, wanted.road, own]);
    if (this.last[controller] === key) return {same: true};
    const inputs = Object.fromEntries(Object.entries(manoeuvre.inputs).map(([input, data]) => [input, this.signal(data)]));
    inputs["controller.enable"] = ENABLE[Number(controller !== null)];
    const {duration, start} = manoeuvre;
    const run = yield* this.loops.run(name, {parameters: {...own, ...start, ...this.road(wanted)}, inputs, duration, step});
    this.last[controller] = key;
    const sampled = atSamples(run, Math.round(T_s / step));
    sampled["controller.added"] = added(sampled["controller.T_driver"], sampled["controller.T_ref"]);
    return {run: sampled, worth: metrics(run, sampled, manoeuvre, T_s)};
  }

  // The same function for the same data.
  signal(data) {
    if (typeof data === "function") return data;
    if (!this.signals.has(data)) this.signals.set(data, signal(data));
    return this.signals.get(data);
  }

  road({road, typed: text}) {
    return {...(road.mu === undefined ? {} : {"plant.mu": road.mu}), ...typed(text)};
  }

  // Refuses parameters that no loop has, or beyond their bounds.
  require(name, parameters) {
    const {fmus, loops} = this.data.loops;
    for (const [key, value] of Object.entries(parameters)) {
      const [path] = key.split("@"), [instance, own] = path.split(".");
      const every = Object.values(loops).map((loop) => fmus[loop.instances[instance]]?.parameters[own]).filter(Boolean);
      if (!every.length) throw new Refused(`there is no parameter ${path}`);
      const here = fmus[loops[name].instances[instance]].parameters[own];
      if (here && key.includes("@") && !here.tunable) throw new Refused(`${key}: ${path} cannot change in a run`);
      if (here && !(value >= (here.min ?? -Infinity) && value <= (here.max ?? Infinity)))
        throw new Refused(`${path} = ${value}: it must be ${here.min ?? "-inf"} to ${here.max ?? "inf"}`);
    }
  }
}

// --- as a worker: the latest question is answered, one that is under way for long is given up for it ---

const PATIENCE = 200, BREATH = 30; // in ms: of a run that is waited for, and between looks at what is new

function serve() {
  let answerer, next = null, busy = false;
  const pause = new MessageChannel(), resume = [];
  pause.port1.onmessage = () => resume.shift()();
  const breathe = () => new Promise((done) => { resume.push(done); pause.port2.postMessage(0); });
  async function work() {
    busy = true;
    while (next) {
      const {number, wanted, controller} = next, begun = performance.now();
      next = null;
      let answer, looked = begun;
      try {
        const steps = answerer.answer(wanted, controller);
        for (let step = steps.next(); ; step = steps.next()) {
          if (step.done) { answer = step.value; break; }
          const now = performance.now();
          if (now - looked < BREATH) continue;
          looked = now;
          await breathe();
          if (next && now - begun > PATIENCE) { answer = {given_up: true}; break; }
        }
      } catch (reason) {
        answer = {refused: reason.message};
      }
      const arrays = Object.values(answer.run ?? {}).map(({buffer}) => buffer);
      postMessage({number, controller, ...answer}, arrays);
    }
    busy = false;
  }
  self.onmessage = ({data: message}) => {
    if (message.code) {
      answerer = new Answerer(message.data, message.code);
      return;
    }
    next = message;
    if (!busy) work();
  };
}

if (typeof module !== "undefined") {
  for (const name of ["loop", "metrics", "follow", "settings"]) Object.assign(globalThis, require(`./${name}.js`));
  module.exports = {Answerer};
} else serve();
