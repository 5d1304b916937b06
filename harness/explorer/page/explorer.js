"use strict";
// The page of `driveline explore`: controls that make up a request, and the curves and metrics of its answer.

const HEIGHT = 160, BELOW = 46; // of a panel, and of the time below the last one, in pixels
const get = (id) => document.getElementById(id);
const tab = String(Math.random());
const controls = []; // each shows its part of a request: control.show(request)
const sliders = {}; // by the name of the knob
const hidden = new Set(); // curves that a click in a legend has hidden: "panel, label"
let settings, wanted, shown, held;
let plots = [], span;

function made(kind, parent, properties = {}) {
  const element = Object.assign(document.createElement(kind), properties);
  parent.append(element);
  return element;
}

function say(text, refused = false) {
  const status = get("status");
  if (status.textContent !== text) status.textContent = text;
  status.classList.toggle("refused", refused);
}

// --- what is asked ---

let next = null, busy = false;

// Changes the request and asks for its runs; while one is under way only the latest waits.
async function ask(change) {
  wanted = {...wanted, ...change};
  next = wanted;
  say("running ...");
  if (busy) return;
  busy = true;
  while (next) {
    const request = next;
    next = null;
    try {
      const response = await post({request});
      if (response.ok) take(decoded(await response.arrayBuffer()));
      else refuse(await response.text());
    } catch (error) {
      say("the explorer has ended, or cannot be reached", true);
      if (!(error instanceof TypeError)) throw error;
    }
  }
  busy = false;
}

const post = (content) => fetch("answer", {method: "POST", body: JSON.stringify({tab, ...content})});

function refuse(reason) {
  if (next) return;
  if (shown) wanted = shown.request;
  follow();
  say(`${reason.trim()}${shown ? "; what was set before stays" : ""}`, true);
}

function take(answer) {
  const moved = shown?.request.manoeuvre !== answer.request.manoeuvre;
  shown = answer;
  if (moved) span = answer.window;
  if (!next) {
    wanted = answer.request;
    follow();
    say("");
  }
  draw();
  get("hold").disabled = false;
}

// See answer_of in messages.py.
function decoded(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const answer = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  let place = 4 + length;
  const column = () => new Float32Array(buffer, (place += 4 * answer.rows) - 4 * answer.rows, answer.rows);
  answer.x = column();
  for (const panel of answer.panels) for (const curve of panel.curves) curve.y = column();
  answer.kept = answer.panels.map(column);
  return answer;
}

async function save(label) {
  say("writing ...");
  const response = await post({request: wanted, save: label});
  const text = (await response.text()).trim();
  say(response.ok ? `written: ${text}` : text, !response.ok);
}

// --- controls ---

function follow() {
  for (const control of controls) control.show(wanted);
  for (const [name, slider] of Object.entries(sliders)) {
    slider.disabled = shown !== undefined && !shown.turnable.includes(name);
    slider.parentElement.classList.toggle("off", slider.disabled);
  }
}

// An element that asks for a change when it is moved, and follows the request.
function bind(element, event, change, show) {
  element.addEventListener(event, () => ask(change(element)));
  controls.push({show: (request) => show(element, request)});
}

function choice(name, options) {
  for (const [value, textContent] of options) made("option", get(name), {value, textContent});
  bind(get(name), "change", (e) => ({[name]: e.value}), (e, request) => { e.value = request[name]; });
}

function checkbox(element, change, of) {
  bind(element, "change", (e) => change(e.checked), (e, request) => { e.checked = of(request); });
}

function slider(parent, knob, change, of) {
  const label = made("label", parent, {title: knob.meaning});
  const heading = made("span", label);
  const element = made("input", label, {type: "range", id: knob.name, min: knob.low, max: knob.high, step: "any"});
  const name = knob.unit ? `${knob.name} in ${knob.unit}` : knob.name;
  const tell = (value) => { heading.textContent = `${name}: ${Number(value.toPrecision(4))}`; };
  const turned = (e) => Number(Number(e.value).toPrecision(3));
  element.addEventListener("input", () => tell(turned(element)));
  bind(element, "input", (e) => change(turned(e)), (e, request) => {
    if (e !== document.activeElement || of(request) !== turned(e)) e.value = of(request);
    tell(of(request));
  });
  sliders[knob.name] = element;
}

function build() {
  choice("plant", settings.plants.map((name) => [name, name]));
  choice("manoeuvre", settings.manoeuvres);
  get("control").nextElementSibling.textContent = `control by ${settings.ours}`;
  checkbox(get("control"), (control) => ({control}), (request) => request.control);
  for (const name of settings.others) {
    const label = made("label", get("others"), {className: "switch"});
    const element = made("input", label, {type: "checkbox", id: name});
    label.append(name);
    const without = () => wanted.others.filter((each) => each !== name);
    checkbox(element, (on) => ({others: on ? [...without(), name] : without()}), (request) => request.others.includes(name));
  }
  const character = {name: "character", low: 0, high: 1, unit: "", meaning: "0 is sport, 1 is comfort"};
  slider(get("gains"), character, (value) => ({character: value}), (request) => request.character);
  for (const [kind, knobs] of Object.entries(settings.knobs)) {
    for (const knob of knobs) {
      const change = (value) => ({[kind]: {...wanted[kind], [knob.name]: value}});
      slider(get(kind), knob, change, (request) => request[kind][knob.name] ?? knob.value);
    }
  }
  const informed = made("label", get("car"), {className: "switch"});
  const known = made("input", informed, {type: "checkbox", id: "informed"});
  informed.append("the controllers know this car");
  checkbox(known, (on) => ({informed: on}), (request) => request.informed);
  const typed = made("label", get("car"), {textContent: "others, as plant.mu=0.3"});
  const text = made("input", typed, {type: "text", id: "typed"});
  bind(text, "change", (e) => ({typed: e.value}), (e, request) => { e.value = request.typed; });
  made("button", get("car"), {id: "hold", textContent: "hold this run", disabled: true}).addEventListener("click", hold);
  for (const label of settings.saves) {
    made("button", get("car"), {id: label, textContent: label}).addEventListener("click", () => save(label));
  }
}

// --- curves and metrics ---

// Keeps what is shown of the first controller beside what follows, or no longer.
function hold() {
  const [, cells] = shown.runs[1] ?? shown.runs[0];
  held = held ? undefined : {manoeuvre: shown.request.manoeuvre, kept: shown.kept, cells};
  get("hold").setAttribute("aria-pressed", held !== undefined);
  draw();
}

function draw() {
  const stays = held?.manoeuvre === shown.request.manoeuvre;
  const rows = stays ? [...shown.runs, [settings.held.label, held.cells]] : shown.runs;
  tabulate(rows);
  shown.panels.forEach(({label, curves}, k) => {
    const all = stays ? [{...settings.held, dash: [], width: 1.4, y: held.kept[k]}, ...curves] : curves;
    plot(k, label, all);
  });
}

function tabulate(rows) {
  const table = get("metrics");
  table.replaceChildren();
  const head = made("tr", table);
  made("th", head);
  for (const [textContent, title] of settings.columns) made("th", head, {textContent, title});
  for (const [name, cells] of rows) {
    const row = made("tr", table);
    made("td", row, {textContent: name});
    for (const [textContent, title] of cells) made("td", row, {textContent, title});
  }
}

function plot(k, label, curves) {
  const shape = curves.map((curve) => curve.label).join("\n"), data = [shown.x, ...curves.map((curve) => curve.y)];
  if (plots[k]?.shape === shape) {
    plots[k].batch(() => { plots[k].setData(data, false); zoom(plots[k]); });
    return;
  }
  plots[k]?.destroy();
  const series = curves.map((curve) => ({
    label: curve.label,
    stroke: curve.color,
    width: 1.4 * curve.width,
    dash: curve.dash.map((length) => 2 * length),
    points: {show: false},
    show: !hidden.has(`${k}, ${curve.label}`),
    value: (_, value) => (value == null ? "" : value.toFixed(2)),
  }));
  const last = k === settings.panels - 1;
  plots[k] = new uPlot({
    width: width(),
    height: HEIGHT + (last ? BELOW : 0),
    series: [{label: "time", value: (_, value) => (value == null ? "" : value.toFixed(3))}, ...series],
    scales: {x: {time: false, min: span[0], max: span[1]}},
    axes: [
      last ? {label: "time in s", labelSize: 16, size: BELOW - 18} : {size: 6, values: (_, at) => at.map(() => "")},
      {label, size: 46, labelSize: 18, labelFont: "12px system-ui"},
    ],
    cursor: {sync: {key: "time", setSeries: false}, drag: {x: true, y: false}, bind: {dblclick: () => () => turn(shown.window)}},
    hooks: {
      setScale: [(u, key) => { if (key === "x" && plots[k] === u) turn([u.scales.x.min, u.scales.x.max]); }],
      setSeries: [(u, i, change) => {
        if (i > 0 && change.show !== undefined) hidden[change.show ? "delete" : "add"](`${k}, ${u.series[i].label}`);
      }],
    },
  }, data, get(`figure ${k}`));
  plots[k].shape = shape;
}

const zoom = (u) => u.setScale("x", {min: span[0], max: span[1]});

// All panels show that span of time.
function turn(to) {
  if (to[0] === span[0] && to[1] === span[1]) return;
  span = to;
  for (const u of plots) if (u.scales.x.min !== to[0] || u.scales.x.max !== to[1]) zoom(u);
}

const width = () => get("figures").clientWidth;

new ResizeObserver(() => plots.forEach((u) => u.setSize({width: width(), height: u.height}))).observe(get("figures"));

(async () => {
  settings = await (await fetch("settings")).json();
  wanted = settings.request;
  for (let k = 0; k < settings.panels; k++) made("div", get("figures"), {id: `figure ${k}`});
  build();
  ask({});
})();
