"use strict";
// The page of `driveline explore`: settings, which its link carries, and the runs that they ask for.

const OFF = "without control", LATE = 400; // ms after which a run is announced
let data, start, wanted, stack;
let held = [], shown = null; // shown: what is drawn: {wanted, runs: {controller: {run, worth}}}
const controls = []; // each shows its part of the settings
const knobs = {}; // by name

function say(text, refused = false) {
  get("status").textContent = text;
  get("status").classList.toggle("refused", refused);
}

// --- runs: each controller has a worker, the latest settings are asked for ---

const workers = new Map(); // by the name of the controller; null: without control
let asked = 0, answered = 0, waiting = null, kept = new Map();

function worker(controller) {
  if (!workers.has(controller)) {
    const one = new Worker(URL.createObjectURL(new Blob([get("worker").textContent], {type: "text/javascript"})));
    const {code, ...loops} = data.loops;
    one.onmessage = ({data: answer}) => took(answer);
    one.onerror = (event) => say(`the worker has ended: ${event.message}`, true);
    workers.set(controller, unzipped(code).arrayBuffer().then((bytes) => { one.postMessage({code: bytes, data: {...data, loops}}); return one; }));
  }
  return workers.get(controller);
}

const controllers = ({control, others}) => [null, ...(control ? [data.ours] : []), ...others];

// Changes the settings and asks for the runs; while others are under way only the latest wait.
function ask(change, by) {
  wanted = {...wanted, ...change};
  waiting = {wanted, by, since: performance.now()};
  if (!underWay || performance.now() - underWay.since > LATE) go();
  follow();
  link();
}

let underWay = null;

async function go() {
  underWay = {...waiting, number: ++asked, left: new Set(controllers(waiting.wanted)), answers: new Map()};
  waiting = null;
  const mine = underWay;
  setTimeout(() => { if (underWay === mine) say("running ..."); }, LATE);
  const all = await Promise.all([...mine.left].map(async (controller) => [controller, await worker(controller)]));
  for (const [controller, one] of all) one.postMessage({number: mine.number, wanted: mine.wanted, controller});
}

function took(answer) {
  const {number, controller} = answer;
  if (answer.run) kept.set(controller, answer);
  if (!underWay || number !== underWay.number) return;
  underWay.answers.set(controller, answer.same ? {...kept.get(controller), warnings: answer.warnings} : answer);
  underWay.left.delete(controller);
  if (underWay.left.size) return;
  const done = underWay, refusal = [...done.answers.values()].find(({refused}) => refused);
  underWay = null;
  if (refusal) refuse(refusal.refused, done.by);
  else if (![...done.answers.values()].some((each) => each.given_up)) take(done);
  if (waiting) go();
}

function refuse(reason, by) {
  if (waiting) return;
  say(`${reason}${shown ? "; the curves are of what was set before" : ""}`, true);
  if (by && knobs[by]) knobs[by].refuse(reason);
}

function take({wanted: of, answers}) {
  const moved = !shown || shown.wanted.manoeuvre !== of.manoeuvre || shown.duration !== length(of);
  shown = {wanted: of, duration: length(of), runs: new Map(controllers(of).map((controller) => [controller, answers.get(controller)]))};
  const warnings = new Set([unread, ...[...shown.runs.values()].flatMap((each) => each.warnings)].filter(Boolean));
  if (!waiting) {
    say([...warnings].join("; "), warnings.size > 0);
    unread = "";
  }
  draw(moved ? window_of(of) : undefined);
}

const length = (of) => (of.manoeuvre === "free" ? of.free.duration : data.manoeuvres[of.manoeuvre].duration);

function window_of(of) {
  if (of.manoeuvre !== "free") return data.manoeuvres[of.manoeuvre].window;
  const found = stepOf(of.free.T_driver);
  return found ? [Math.max(found[0] - 0.1, 0), Math.min(found[0] + 1.4, of.free.duration)] : [0, of.free.duration];
}

// --- curves and metrics ---

function draw(window) {
  const off = shown.runs.get(null).run, on = shown.runs.get(data.ours)?.run, runs = {off, on};
  const stays = held.filter((each) => each.manoeuvre === manoeuvre_key(shown.wanted));
  const curve = (run, name, label, color, dash, width) =>
    ({kind: "curve", x: run.time, y: run[name], label, color, dash, width, held: false});
  const panels = data.panels.map(({label, curves}, k) => ({
    label,
    parts: [
      ...stays.map((each) => curve(each.run, curves.find(({name, run}) => name !== "controller.T_driver" && (run === "on" || k === 0)).name,
        each.label, each.color, [], 1.4)),
      ...curves.filter(({run}) => runs[run]).map((c) => curve(runs[c.run], c.name, c.label, c.color, c.dashes, c.width)),
      ...(k ? [] : shown.wanted.others.map((name) => curve(shown.runs.get(name).run, "plant.T_gear", `with ${name}`, data.others[name], [], 1))),
    ],
  }));
  stack.set(panels, window);
  tabulate([...[...shown.runs].map(([name, {worth}]) => [name ?? OFF, worth]), ...stays.map(({label, worth}) => [label, worth])]);
  get("hold").disabled = held.length >= data.held.length;
  get("release").disabled = !held.length;
  document.body.dataset.drawn = ++answered;
}

function tabulate(rows) {
  const table = get("metrics");
  table.replaceChildren();
  const head = made("tr", made("thead", table)), body = made("tbody", table);
  made("th", head);
  for (const {heading, meaning} of data.metrics) made("th", head, {textContent: heading, title: meaning});
  for (const [name, worth] of rows) {
    const row = made("tr", body);
    made("td", row, {textContent: name});
    for (const {name: metric, factor, decimals} of data.metrics) {
      const value = worth[metric];
      made("td", row, {textContent: value !== value ? "-" : (Math.round(value * factor * 10 ** decimals) / 10 ** decimals + 0).toFixed(decimals)});
    }
  }
}

const manoeuvre_key = (of) => JSON.stringify([of.manoeuvre, of.manoeuvre === "free" && of.free]);

function hold() {
  const {run, worth} = shown.runs.get(data.ours) ?? shown.runs.get(null), color = data.held[held.length];
  held.push({run, worth, color, label: `held ${held.length + 1}`, manoeuvre: manoeuvre_key(shown.wanted)});
  draw();
}

// --- the link: only what is not as at the start ---

function written(of) {
  const found = new URLSearchParams();
  for (const name of ["plant", "manoeuvre", "typed"]) if (of[name] !== start[name]) found.set(name, of[name]);
  for (const name of ["control", "informed"]) if (of[name] !== start[name]) found.set(name, of[name] ? "on" : "off");
  if (of.others.length) found.set("with", of.others.join(","));
  if (of.character !== 0.5) found.set("character", of.character);
  for (const kind of ["gains", "car", "road"]) for (const [name, value] of Object.entries(of[kind])) found.set(name, value);
  if (of.manoeuvre === "free") {
    const {T_driver, T_brake, v_0, duration} = of.free;
    found.set("demand", as_text(T_driver));
    found.set("brake", as_text(T_brake));
    found.set("v_0", v_0);
    found.set("duration", duration);
  }
  return `#${found}`;
}

let unread = ""; // what the link had that the page does not take

function read(hash) {
  const given = new URLSearchParams(hash.slice(1)), found = structuredClone(start), known = new Set(), left = [];
  // Where the link has it: the setting becomes what `as` makes of its text, and is left where that is undefined.
  const put = (name, as, of = found, key = name) => {
    known.add(name);
    if (!given.has(name)) return;
    const value = as(given.get(name));
    if (value === undefined) left.push(`${name}=${given.get(name)}`); else of[key] = value;
  };
  const one_of = (all) => (text) => (all.includes(text) ? text : undefined);
  put("plant", one_of(data.plants));
  put("manoeuvre", one_of([...Object.keys(data.manoeuvres), "free"]));
  for (const name of ["control", "informed"]) put(name, (text) => ({on: true, off: false})[text]);
  put("typed", (text) => text);
  put("with", (text) => (text.split(",").every((name) => name in data.others) ? text.split(",") : undefined), found, "others");
  for (const {name, kind, least, most} of Object.values(knobs)) {
    const within = (text) => (text.trim() && text >= least && text <= most ? Number(text) : undefined);
    put(name, within, kind ? found[kind] : found);
  }
  for (const [name, key] of [["demand", "T_driver"], ["brake", "T_brake"]]) put(name, (text) => parsed(text) || undefined, found.free, key);
  for (const name of ["v_0", "duration"]) put(name, (text) => number_of(name, text)?.[name], found.free);
  left.push(...[...given.keys()].filter((name) => !known.has(name)));
  unread = left.length ? `left out of the link: ${left.join(", ")}` : "";
  return found;
}

let linked;

// While a slider moves the present entry of the history follows.
function link() {
  clearTimeout(linked);
  linked = setTimeout(() => history.replaceState(null, "", written(wanted)), 150);
}

// What follows is a new entry.
function enter() {
  clearTimeout(linked);
  history.pushState(null, "", written(wanted));
}

addEventListener("popstate", () => ask(read(location.hash)));

// --- settings ---

function follow() {
  for (const show of controls) show(wanted);
  get("free").hidden = wanted.manoeuvre !== "free";
}

// An element that asks for a change, which is an entry of the history.
function bind(element, event, change, show) {
  element.addEventListener(event, () => {
    const changed = change(element);
    if (!changed) return;
    enter();
    ask(changed);
  });
  controls.push((of) => show(element, of));
}

function choice(name, options) {
  for (const [value, textContent] of options) made("option", get(name), {value, textContent});
  bind(get(name), "change", (e) => ({[name]: e.value}), (e, of) => { e.value = of[name]; });
}

function checkbox(parent, id, text, change, of) {
  const label = made("label", parent, {className: "switch"}), element = made("input", label, {type: "checkbox", id});
  label.append(text);
  bind(element, "change", (e) => change(e.checked), (e, settings) => { e.checked = of(settings); });
}

function knob(parent, {name, low, high, least, most, value, unit, meaning}, kind, idle) {
  const row = made("div", parent, {className: "knob", title: meaning}), id = `knob ${name}`;
  made("span", row, {textContent: unit ? `${name} in ${unit}` : name, id: `${id} name`});
  const typed = made("input", row, {id: `${id} value`, inputmode: "decimal"});
  const back = made("button", row, {type: "button", textContent: "↺", title: `${name} as at the start, ${short(value)}`});
  const range = made("input", row, {type: "range", id, min: low, max: high, step: "any"});
  const refusal = made("p", row, {className: "refusal"});
  refusal.setAttribute("role", "alert");
  for (const element of [typed, range]) element.setAttribute("aria-labelledby", `${id} name`);
  const of = (settings) => (kind ? settings[kind][name] ?? value : settings[name]);
  const change = (to) => {
    if (!kind) return {[name]: to};
    const {[name]: _, ...others} = wanted[kind];
    return {[kind]: to === value ? others : {...others, [name]: to}};
  };
  const refuse = (reason) => {
    refusal.textContent = reason;
    typed.setAttribute("aria-invalid", Boolean(reason));
  };
  const turn = (to) => {
    if (!(to >= least && to <= most)) return refuse(`${short(least)} to ${short(most)}${unit ? ` ${unit}` : ""} is allowed`);
    refuse("");
    return ask(change(to), name);
  };
  let entered = false; // by keys, since it has the focus
  range.addEventListener("pointerdown", enter);
  range.addEventListener("blur", () => { entered = false; });
  range.addEventListener("keydown", ({key}) => {
    if (entered || !/^(Arrow|Page|Home|End)/.test(key)) return;
    enter();
    entered = true;
  });
  range.addEventListener("input", () => turn(Number(Number(range.value).toPrecision(3))));
  typed.addEventListener("change", () => {
    enter();
    turn(typed.value.trim() === "" ? NaN : Number(typed.value));
  });
  back.addEventListener("click", () => turn(value));
  controls.push((settings) => {
    const now = of(settings);
    if (document.activeElement !== range || Math.abs(range.value - now) > 0.01 * (high - low)) range.value = now;
    if (document.activeElement !== typed || typed.getAttribute("aria-invalid") !== "true") typed.value = short(now);
    row.classList.toggle("changed", now !== value);
    row.classList.toggle("idle", idle(settings));
  });
  knobs[name] = {name, kind, least, most, refuse};
}

// Whether a parameter changes nothing of what is shown.
function idle(name, settings, of_gains) {
  const {loops, fmus} = data.loops, has = (loop, instance) => name in fmus[loops[loop].instances[instance]].parameters;
  const loop = `${settings.plant} ${data.ours}`;
  if (of_gains) return !settings.control || !has(loop, "controller");
  const elsewhere = ["plant", "motor", "can"].some((instance) => has(loop, instance));
  const follows = data.follow.shafts.every((each) => each in fmus[loops[loop].instances.plant].parameters);
  return !elsewhere && !(follows && ["C", "J_2"].includes(name)) && !(settings.informed && has(loop, "controller"));
}

function build() {
  choice("plant", data.plants.map((name) => [name, name]));
  choice("manoeuvre", [["free", "free: drawn by hand"], ...Object.entries(data.manoeuvres).map(([name, {description}]) => [name, `${name}: ${description}`])]);
  controls.push((of) => {
    for (const option of get("manoeuvre").options)
      option.disabled = option.value !== "free" && !data.manoeuvres[option.value].possible.includes(of.plant);
  });
  get("control").nextElementSibling.textContent = `control by ${data.ours}`;
  bind(get("control"), "change", (e) => ({control: e.checked}), (e, of) => { e.checked = of.control; });
  for (const name of Object.keys(data.others))
    checkbox(get("others"), name, name, (on) => ({others: on ? [...wanted.others, name] : wanted.others.filter((each) => each !== name)}),
      (of) => of.others.includes(name));
  const character = {name: "character", low: 0, high: 1, least: 0, most: 1, value: 0.5, unit: "", meaning: "0 is sport, 1 is comfort"};
  knob(get("gains"), character, null, (of) => !of.control);
  for (const [kind, all] of Object.entries(data.knobs))
    for (const each of all) knob(get(kind), each, kind, (of) => idle(each.name, of, kind === "gains"));
  const slope = {name: "slope", low: -0.15, high: 0.15, least: -0.4, most: 0.4, value: 0, unit: "rad", meaning: "added to that of the manoeuvre"};
  knob(get("road"), slope, "road", () => false);
  checkbox(get("car"), "informed", "the controllers know this car", (on) => ({informed: on}), (of) => of.informed);
  bind(get("typed"), "change", (e) => ({typed: e.value}), (e, of) => { e.value = of.typed; });
  by_hand();
  get("hold").addEventListener("click", hold);
  get("release").addEventListener("click", () => { held = []; draw(); });
  get("reset").addEventListener("click", () => { enter(); ask(structuredClone(start)); });
  get("save car").addEventListener("click", () => save("car.toml", "A car", car_entries()));
  get("save gains").addEventListener("click", () => save("gains.toml", `Gains of ${data.ours}`, {...data.files.gains, ...gains()}));
  for (const [name, {guid, sources}] of Object.entries(data.loops.fmus)) {
    const row = made("tr", get("inside").querySelector("tbody"));
    for (const textContent of [name, guid, sources]) made("td", row, {textContent, className: "word"});
  }
}

// --- the manoeuvre that is drawn by hand ---

const as_text = (points) => points.map(([t, value]) => `${short(t)}, ${short(value)}`).join("; ");

// Points in ascending time; null if it is no text of such.
function parsed(text) {
  const points = text.split(";").filter((part) => part.trim()).map((part) => part.split(",").map((each) => (each.trim() ? Number(each) : NaN)));
  const good = points.length && points.every((point, k) => point.length === 2 && point.every(Number.isFinite) && point[0] >= 0
    && (k === 0 || point[0] >= points[k - 1][0]));
  return good ? points : null;
}

const BOUNDS = {v_0: [0, 70], duration: [1, 60]};

function number_of(name, text) {
  const value = Number(text), [low, high] = BOUNDS[name];
  return text.trim() && value >= low && value <= high ? {[name]: value} : null;
}

function by_hand() {
  const asking = (change) => change && {free: {...wanted.free, ...change}};
  const refused = (change, text) => {
    get("free refusal").textContent = change ? "" : text;
    return asking(change);
  };
  for (const [name, key] of [["demand", "T_driver"], ["brake", "T_brake"]])
    bind(get(name), "change", (e) => {
      const points = parsed(e.value);
      return refused(points && {[key]: points}, `${name}: points in ascending time, as in 0, -12; 1, -12; 1, 100`);
    }, (e, of) => { e.value = as_text(of.free[key]); });
  for (const name of ["v_0", "duration"])
    bind(get(name), "change", (e) => refused(number_of(name, e.value), `${name}: ${BOUNDS[name].join(" to ")} is allowed`),
      (e, of) => { e.value = of.free[name]; });
  controls.push((of) => { if (of.manoeuvre === "free") sketch(of.free); });
  get("drawn").addEventListener("dblclick", (event) => {
    if (event.target.tagName === "circle") return;
    move([...wanted.free.T_driver, place_of(event)], true);
  });
}

const x_of = (t) => (300 * t) / wanted.free.duration, y_of = (T) => 60 - (55 * T) / data.most;

function place_of(event) {
  const box = get("drawn").getBoundingClientRect();
  const t = ((event.clientX - box.left) / box.width) * wanted.free.duration;
  const T = ((60 - (120 * (event.clientY - box.top)) / box.height) / 55) * data.most;
  return [Math.round(20 * Math.min(Math.max(t, 0), wanted.free.duration)) / 20, Math.round(Math.min(Math.max(T, -data.most), data.most))];
}

function move(points, entry) {
  if (entry) enter();
  ask({free: {...wanted.free, T_driver: points.toSorted(([a], [b]) => a - b)}});
}

function sketch({T_driver, duration}) {
  const svg = get("drawn"), focused = [...svg.querySelectorAll("circle")].indexOf(document.activeElement);
  const of = (kind, properties) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", kind);
    for (const [name, value] of Object.entries(properties)) element.setAttribute(name, value);
    svg.append(element);
    return element;
  };
  svg.replaceChildren();
  of("line", {x1: 0, x2: 300, y1: 60, y2: 60});
  of("text", {x: 2, y: 10}).textContent = `${data.most} N.m`;
  of("text", {x: 298, y: 116, "text-anchor": "end"}).textContent = `${duration} s`;
  const last = T_driver.at(-1), corners = [...T_driver, [duration, last[1]]];
  of("polyline", {points: corners.map(([t, T]) => `${x_of(t)},${y_of(T)}`).join(" ")});
  T_driver.forEach(([t, T], k) => {
    const circle = of("circle", {cx: x_of(t), cy: y_of(T), r: 5, tabindex: 0, "aria-label": `${t} s, ${T} N.m`});
    const others = T_driver.filter((_, j) => j !== k), to = (point) => [...T_driver.slice(0, k), point, ...T_driver.slice(k + 1)];
    circle.addEventListener("keydown", (event) => {
      const steps = {ArrowLeft: [-0.05, 0], ArrowRight: [0.05, 0], ArrowUp: [0, 2], ArrowDown: [0, -2]}[event.key];
      if (event.key === "Delete" && others.length) move(others, true);
      else if (steps) move(to([Math.max(Number((t + steps[0]).toFixed(3)), 0), T + steps[1]]), !event.repeat);
      else return;
      event.preventDefault();
    });
    circle.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      circle.focus();
      enter();
      const drag = (moved) => { // between its neighbours
        const [at, value] = place_of(moved), low = T_driver[k - 1]?.[0] ?? 0, high = T_driver[k + 1]?.[0] ?? duration;
        move(to([Math.min(Math.max(at, low), high), value]));
      };
      addEventListener("pointermove", drag);
      addEventListener("pointerup", () => removeEventListener("pointermove", drag), {once: true});
    });
  });
  svg.querySelectorAll("circle")[focused]?.focus();
}

// --- files that other commands take ---

// The car with what was turned; shafts follow from a C that was.
function car_entries() {
  const stays = Object.entries(data.files.car).filter(([name]) => !("C" in wanted.car && data.follow.shafts.includes(name)));
  return {...Object.fromEntries(stays), ...wanted.car};
}

function gains() {
  return Object.fromEntries(data.knobs.gains.map(({name, value}) => [name, turnedGains(data, wanted)[name] ?? value]));
}

function save(name, what, entries) {
  const units = Object.fromEntries(Object.values(data.knobs).flat().map((each) => [each.name, [each.unit, each.meaning].filter(Boolean).join(", ")]));
  const lines = Object.entries(entries).map(([key, value]) =>
    `${key} = ${toml(value)}${units[key] ? `  # ${units[key]}` : ""}`);
  const text = `# ${what}, by driveline explore (driveline-damping ${data.version}).\n\n${lines.join("\n")}\n`;
  const link = made("a", document.body, {href: URL.createObjectURL(new Blob([text], {type: "application/toml"})), download: name});
  link.click();
  link.remove();
}

function toml(value) {
  if (typeof value !== "number") return JSON.stringify(value);
  const text = String(Number(value.toPrecision(6)));
  return /[.e]/.test(text) ? text : `${text}.0`;
}

// --- the beginning ---

(async () => {
  data = await unpacked();
  start = {
    plant: data.plants[0], manoeuvre: Object.keys(data.manoeuvres)[0], control: true, others: [], gains: {}, car: {}, road: {},
    character: 0.5, informed: true, typed: "", free: data.free,
  };
  stack = new Stack(get("figures"), {label: "time in s", window: [0, 1], scale: "linear"});
  wanted = structuredClone(start);
  build();
  if (innerWidth < 760) for (const id of ["gains", "car", "road"]) get(id).open = false;
  wanted = read(location.hash);
  ask({});
})();
