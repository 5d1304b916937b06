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
    if (found.possible && !found.possible.includes(plant))
      throw new Refused(`${manoeuvre} has a road that ${plant} does not have; ${found.possible.join(" and ") || "no plant here"} can drive it`);
    if (!road.slope) return own;
    const slope = signal(own.inputs["plant.slope"]), turned = (t) => slope(t) + road.slope;
    return {...own, inputs: {...own.inputs, "plant.slope": turned}};
  }

  // "instance.name" -> value for the loop with a controller, beside those of the manoeuvre; null: ours that is off.
  parameters(wanted, controller) {
    const {base, ours, loops} = this.data, name = `${wanted.plant} ${controller ?? ours}`;
    const detailed = this.data.follow.shafts.every((each) => each in loops.fmus[loops.loops[name].instances.plant].parameters);
    const turned = JSON.stringify([wanted.car, detailed]);
    if (turned !== this.followed[0]) {
      this.followed = [turned, this.followers.changes(wanted.car, detailed)];
      this.band = this.followers.band(wanted.car, this.followed[1], detailed);
    }
    const found = {...base[name]}, {mu} = wanted.road;
    for (const [instance, fmu] of Object.entries(loops.loops[name].instances)) {
      if (instance === "controller" && !wanted.informed) continue;
      for (const [key, value] of Object.entries(this.followed[1]))
        if (key in loops.fmus[fmu].parameters) found[`${instance}.${key}`] = value;
    }
    if (mu !== undefined) found["plant.mu"] = mu;
    if (controller === ours)
      for (const [key, value] of Object.entries(turnedGains(this.data, wanted))) found[`controller.${key}`] = value;
    return found;
  }

  // A run with that controller, or without control where it is null; yields while it is under way.
  *answer(wanted, controller) {
    const {ours, step, T_s} = this.data, name = `${wanted.plant} ${controller ?? ours}`;
    const manoeuvre = this.manoeuvre(wanted), asked = typed(wanted.typed, this.data.words);
    const own = {...this.parameters(wanted, controller), ...asked};
    const {duration, start} = manoeuvre, parameters = {...own, ...start, ...this.data.set, ...this.road(wanted), ...asked};
    const warnings = [...this.warnings(name, wanted, asked, Math.floor(duration / step + 1e-6) - 1)];
    this.requireBounds(name, own);
    if (parameters["plant.v_0"] > 0 && parameters["plant.T_0"] !== start["plant.T_0"])
      warnings.push(this.said("torque", {T_0: parameters["plant.T_0"], demand: start["plant.T_0"]}));
    const key = JSON.stringify([name, wanted.manoeuvre, wanted.manoeuvre === "free" && wanted.free, wanted.road, own]);
    if (this.last[controller] === key) return {same: true, warnings};
    const inputs = Object.fromEntries(Object.entries(manoeuvre.inputs).map(([input, data]) => [input, this.signal(data)]));
    inputs["controller.enable"] = ENABLE[Number(controller !== null)];
    const run = yield* this.loops.run(name, {parameters, inputs, duration, step});
    this.last[controller] = key;
    const sampled = atSamples(run, Math.round(T_s / step));
    sampled["controller.added"] = added(sampled["controller.T_driver"], sampled["controller.T_ref"]);
    return {run: sampled, worth: metrics(run, sampled, manoeuvre, T_s, this.band), warnings};
  }

  // The same function for the same data.
  signal(data) {
    if (typeof data === "function") return data;
    if (!this.signals.has(data)) this.signals.set(data, signal(data));
    return this.signals.get(data);
  }

  road({road}) {
    return road.mu === undefined ? {} : {"plant.mu": road.mu};
  }

  said(what, of) {
    return said(this.data.words, what, of);
  }

  declared(name, {instance, own}) {
    const {fmus, loops} = this.data.loops;
    return fmus[loops[name].instances[instance]]?.parameters[own];
  }

  // Refuses what is typed and cannot be in a run whose last step has that number; yields what is hardly meant.
  *warnings(name, {plant, gains, car, road}, asked, last) {
    const {loops: {loops}, step} = this.data, {instances} = loops[name], refuse = (what, of) => { throw new Refused(this.said(what, of)); };
    const changes = new Set();
    for (const [key, value] of Object.entries(asked)) {
      const path = parted(key), {name: parameter, instance, own, since} = path, file = `${instances[instance]}.fmu`;
      if (!(instance in instances)) refuse("instance", {name: key, instance});
      const others = Object.keys(loops).filter((loop) => this.declared(loop, path)), here = this.declared(name, path);
      const plants = this.data.plants.filter((each) => others.some((loop) => loop.startsWith(`${each} `)));
      if (!others.length) refuse("lacks", {name: key, file, causality: "parameter", parameter: own});
      if (!plants.includes(plant)) refuse("elsewhere", {name: key, plant, parameter: own, others: plants.join(" or ")});
      if (!here) yield this.said("without", {name: key, controllers: instances[instance]});
      if (since === undefined) {
        const slider = instance === "controller" && own in gains ? gains : own in road ? road : car;
        if (slider[own] !== undefined && slider[own] !== value) yield `${key} = ${value} is typed and goes before the slider, ${short(slider[own])}`;
        continue;
      }
      if (Number.isNaN(since)) refuse("time", {name: key, time: `'${key.split("@")[1].trim()}'`});
      if (here && !here.tunable) refuse("fixed", {name: key, file, parameter: own});
      if (!(since >= 0 && since <= (last + 1e-6) * step)) refuse("late", {name: key, last: last * step});
      const change = `${parameter} ${Math.ceil(since / step - 1e-6)}`;
      if (changes.has(change)) refuse("same_step", {name: key, parameter});
      changes.add(change);
    }
  }

  // Refuses parameters beyond their bounds.
  requireBounds(name, parameters) {
    for (const [key, value] of Object.entries(parameters)) {
      const path = parted(key), {min, max, unit} = this.declared(name, path) ?? {}, [low, high] = [min ?? "-inf", max ?? "inf"];
      const file = `${this.data.loops.loops[name].instances[path.instance]}.fmu`;
      if (!(value >= (min ?? -Infinity) && value <= (max ?? Infinity))) throw new Refused(`${path.name} = ${short(value)}: ${this.said("bounds", {file, low, high, unit})}`);
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
