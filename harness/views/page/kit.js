"use strict";
// Figures of panels that are data (figures.py): curves, zoom, legends, for reports and the explorer alike.

const HEIGHT = 170, BELOW = 46, LEFT = 72; // of a panel, of its abscissa and of its ordinate, in pixels
const DARK = {black: "#e8e8e8", "#0072B2": "#4ba6e0", "#882255": "#b8406f", "#cccccc": "#444444", "#999999": "#8f8f8f"};

const get = (id) => document.getElementById(id);

function made(kind, parent, properties = {}) {
  const element = Object.assign(document.createElement(kind), properties);
  parent?.append(element);
  return element;
}

// --- colours: of light paper, or on a dark screen others for what would not be seen ---

let printing = false;
const screen = matchMedia("(prefers-color-scheme: dark)");
const dark = () => screen.matches && !printing;
const tone = (color) => (dark() && DARK[color]) || color;
const figures = new Set();
const redraw = () => figures.forEach((each) => each.build());
screen.addEventListener("change", redraw);
for (const when of ["beforeprint", "afterprint"])
  addEventListener(when, () => { printing = when === "beforeprint"; redraw(); });

// --- numbers ---

// The first place in the ascending x of a value that is not below the limit.
function place(x, limit) {
  let low = 0, high = x.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (x[middle] < limit) low = middle + 1; else high = middle;
  }
  return low;
}

// What is compressed in base64, and with it the data of the page.
function unzipped(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")));
}
const unpacked = () => unzipped(get("data").textContent).json();

const decoded = (text) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);

// What is drawn of arrays between two abscissas, with a sample beyond both.
const seen = (x, [from, to]) => [Math.max(place(x, from) - 1, 0), Math.min(place(x, to) + 1, x.length)];

// Least and largest ordinate of the parts between two abscissas.
function extent(parts, window) {
  let [low, high] = [Infinity, -Infinity];
  const take = (value) => { if (value < low) low = value; if (value > high) high = value; };
  for (const part of parts) {
    if (part.kind === "level" && !part.upright) take(part.at);
    if (part.kind === "bars") take(0);
    if (part.kind === "arrow") [part.low, part.high].forEach(take);
    if (!part.x?.length || part.kind === "spans") continue;
    const [first, last] = seen(part.x, window);
    for (const y of part.kind === "band" ? [part.low, part.high] : [part.y]) for (let k = first; k < last; k++) take(y[k]);
  }
  return [low, high];
}

function ordinates(panel, parts, window) {
  let [low, high] = extent(parts, window);
  if (panel.scale === "log") [low, high] = low > 0 && high > low ? [low / 1.2, high * 1.2] : positive(parts, window);
  else if (!(low < high)) [low, high] = Number.isFinite(low) ? [low - 1, low + 1] : [0, 1];
  else [low, high] = [low - 0.06 * (high - low), high + 0.06 * (high - low)];
  const [least, most] = panel.bounds ?? [null, null];
  return [least ?? low, most ?? high];
}

// On a logarithmic axis only what is positive is seen.
function positive(parts, window) {
  const only = parts.filter((part) => part.y).map((part) => ({...part, y: part.y.map((y) => (y > 0 ? y : NaN))}));
  const [low, high] = extent(only, window);
  return Number.isFinite(low) ? [low / 1.2, high * 1.2] : [0.1, 10];
}

// --- drawing parts on the canvas of a figure ---

function positions(u, panel, xLog) {
  const {left, top, width, height} = u.bbox, {x, y} = u.scales;
  const along = (scale, log) => {
    const [low, high] = log ? [Math.log(scale.min), Math.log(scale.max)] : [scale.min, scale.max];
    return (value) => ((log ? Math.log(value) : value) - low) / (high - low);
  };
  const [over, up] = [along(x, xLog), along(y, panel.scale === "log")];
  return {X: (value) => left + width * over(value), Y: (value) => top + height * (1 - up(value)), left, top, width, height};
}

const DRAW = {
  curve(ctx, part, {X, Y, width}, window, px) {
    const {x, y} = part, [first, last] = seen(x, window);
    ctx.lineWidth = 1.3 * part.width * px;
    ctx.setLineDash(part.dash.map((length) => 2 * length * px));
    ctx.beginPath();
    let down = false;
    if (last - first < 3 * width || part.held)
      for (let k = first; k < last; k++) {
        const [at, value] = [X(x[k]), Y(y[k])];
        if (!Number.isFinite(value) || !Number.isFinite(at)) { down = false; continue; }
        if (down && part.held) ctx.lineTo(at, Y(y[k - 1]));
        if (down) ctx.lineTo(at, value); else ctx.moveTo(at, value);
        down = true;
      }
    else // of each column of the screen the first, the extremes and the last
      for (let k = first; k < last;) {
        const column = Math.floor(X(x[k])), begin = k;
        let [low, high] = [k, k];
        for (; k < last && Math.floor(X(x[k])) === column; k++) {
          if (!(y[k] >= y[low])) low = k;
          if (!(y[k] <= y[high])) high = k;
        }
        for (const at of new Set([begin, ...[low, high].sort((a, b) => a - b), k - 1])) {
          const value = Y(y[at]);
          if (!Number.isFinite(value)) down = false;
          else if (down) ctx.lineTo(column, value);
          else { ctx.moveTo(column, value); down = true; }
        }
        if (k === begin) k++;
      }
    ctx.stroke();
  },
  points(ctx, part, {X, Y}, window, px) {
    const radius = (0.7 * part.size * px) / 2;
    ctx.beginPath();
    part.x.forEach((x, k) => {
      if (x < window[0] || x > window[1] || part.y[k] !== part.y[k]) return;
      ctx.moveTo(X(x) + radius, Y(part.y[k]));
      ctx.arc(X(x), Y(part.y[k]), radius, 0, 7);
    });
    ctx.fill();
  },
  band(ctx, part, {X, Y}, window) {
    const [first, last] = seen(part.x, window);
    ctx.globalAlpha = part.alpha;
    ctx.beginPath();
    for (let k = first; k < last; k++) ctx.lineTo(X(part.x[k]), Y(part.high[k]));
    for (let k = last; k-- > first;) ctx.lineTo(X(part.x[k]), Y(part.low[k]));
    ctx.fill();
  },
  bars(ctx, part, {X, Y}) {
    ctx.globalAlpha = part.alpha;
    part.x.forEach((x, k) => {
      const left = X(x - part.breadth / 2);
      ctx.fillRect(left, Y(Math.max(part.y[k], 0)), X(x + part.breadth / 2) - left, Math.abs(Y(part.y[k]) - Y(0)));
    });
  },
  spans(ctx, part, {X, top, height}, window, px) {
    ctx.globalAlpha = part.alpha;
    ctx.setLineDash([4 * px, 3 * px]);
    part.x.forEach((x, k) => {
      const [left, right] = [X(x), X(part.end[k])];
      if (part.outlined) ctx.strokeRect(left, top, right - left, height);
      else ctx.fillRect(left, top, Math.max(right - left, px), height);
    });
  },
  level(ctx, part, {X, Y, left, top, width, height}, window, px) {
    ctx.lineWidth = 1.3 * part.width * px;
    ctx.setLineDash(part.dash.map((length) => 2 * length * px));
    ctx.beginPath();
    if (part.upright) [top, top + height].forEach((y) => ctx.lineTo(X(part.at), y));
    else [left, left + width].forEach((x) => ctx.lineTo(x, Y(part.at)));
    ctx.stroke();
  },
  arrow(ctx, part, {X, Y}) {
    ctx.beginPath();
    for (const y of [part.low, part.high]) ctx.lineTo(X(part.x), Y(y));
    ctx.stroke();
  },
};
const BEHIND = {spans: 0, band: 1, bars: 2};

// --- figures ---

// Panels below each other that are zoomed together where they have the same abscissa.
class Stack {
  constructor(parent, x) {
    this.element = made("div", parent, {className: "stack"});
    this.x = x;
    this.hidden = new Set(); // "panel, label" of curves that a click has hidden
    this.panels = [];
  }

  // Shows panels, and of the abscissa a window; none: as before.
  set(panels, window) {
    if (window) this.window = this.whole = window;
    const words = panels.flatMap(({ticks}) => Object.values(ticks ?? {})); // the abscissas stand below each other
    this.left = Math.max(LEFT - 16, ...words.map((word) => 6.2 * word.length + 14));
    panels.forEach((panel, k) => {
      const below = panels[k + 1], own = panel.x ?? this.x;
      const ends = !below || (below.x ?? this.x).label !== own.label || Boolean(panel.x);
      this.panels[k] ??= new Figure(this, k);
      this.panels[k].set(panel, own, ends);
    });
    for (const figure of this.panels.splice(panels.length)) figure.remove();
  }

  turn(window) {
    this.window = window;
    for (const figure of this.panels) figure.zoom();
  }
}

class Figure {
  constructor(stack, number) {
    Object.assign(this, {stack, number, shape: ""});
    this.element = made("figure", stack.element, {tabIndex: 0});
    this.caption = made("figcaption", this.element);
    this.legend = made("div", this.element, {className: "legend"});
    this.canvas = made("div", this.element);
    this.element.addEventListener("pointerdown", () => { stack.dragged = this; });
    this.element.addEventListener("keydown", (event) => this.key(event));
    this.resized = new ResizeObserver(() => {
      if (this.plot && this.canvas.clientWidth && this.plot.width !== this.canvas.clientWidth)
        this.plot.setSize({width: this.canvas.clientWidth, height: this.plot.height});
    });
    this.resized.observe(this.canvas);
    figures.add(this);
  }

  remove() {
    this.resized.disconnect();
    this.plot?.destroy();
    this.element.remove();
    figures.delete(this);
  }

  get shared() { return !this.panel.x; }
  get window() { return this.shared ? this.stack.window : this.own; }
  get whole() { return this.shared ? this.stack.whole : this.axis.window; }
  get shown() {
    const behind = (part) => BEHIND[part.kind] ?? 3;
    const parts = this.panel.parts.filter((part) => !this.stack.hidden.has(this.key_of(part)));
    return parts.sort((a, b) => behind(a) - behind(b));
  }
  key_of(part) { return `${this.number}, ${part.label}`; }

  set(panel, axis, ends) {
    const shape = JSON.stringify([panel.label, panel.scale, panel.ticks, axis, ends, panel.x && 1, this.stack.left]);
    Object.assign(this, {panel, axis, ends});
    const fits = 6.4 * panel.label.length < HEIGHT * (panel.height ?? 1); // else it stands above
    const heading = [panel.heading, fits ? "" : panel.label, panel.note].filter(Boolean).join(", ");
    this.label = fits ? panel.label : "";
    if (this.caption.textContent !== heading) this.caption.textContent = heading;
    this.list();
    if (shape !== this.shape) {
      this.own = axis.window;
      this.shape = shape;
      this.build();
    } else this.zoom();
  }

  build() {
    this.plot?.destroy();
    const {panel, axis} = this, color = dark() ? "#c8c8c8" : "#333333", grid = {stroke: dark() ? "#333" : "#e4e4e4", width: 1};
    const style = {stroke: color, grid, ticks: grid, font: "12px system-ui", labelFont: "12px system-ui"};
    const ticks = Object.keys(panel.ticks ?? {}).map(Number).sort((a, b) => a - b);
    const worded = ticks.length ? {splits: () => ticks, values: () => ticks.map((tick) => panel.ticks[tick])} : {};
    const distr = (scale) => (scale === "log" ? {distr: 3} : {});
    const [low, high] = ordinates(panel, this.shown, this.window), height = HEIGHT * (panel.height ?? 1);
    const width = printing ? 680 : this.canvas.clientWidth || 600;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${panel.label} over ${axis.label}`);
    this.plot = new uPlot({
      width,
      height: height + (this.ends ? BELOW - 8 : 0),
      legend: {show: false},
      series: [{}, {paths: () => null, points: {show: false}}],
      scales: {
        x: {time: false, auto: false, min: this.window[0], max: this.window[1], ...distr(axis.scale)},
        y: {auto: false, min: low, max: high, ...distr(panel.scale)},
      },
      axes: [
        {...style, ...(this.ends ? {label: axis.label, labelSize: 16, size: BELOW - 16} : {size: 6, values: (_, at) => at.map(() => "")})},
        {...style, ...worded, label: this.label, labelSize: 16, size: this.stack.left},
      ],
      padding: [8, 12, null, null],
      cursor: {
        points: {show: false},
        sync: this.shared ? {key: this.axis.label, setSeries: false} : undefined,
        drag: {x: true, y: false, setScale: false},
        bind: {dblclick: () => () => this.turn(this.whole)},
      },
      hooks: {
        draw: [(u) => this.draw(u)],
        setCursor: [(u) => this.tell(u.cursor.left >= 0 ? u.posToVal(u.cursor.left, "x") : undefined)],
        setSelect: [(u) => {
          const {left, width: wide} = u.select;
          const own = this.stack.dragged === this; // the others only follow its cursor
          u.setSelect({left: 0, width: 0, top: 0, height: 0}, false);
          if (own && wide > 3) this.turn([left, left + wide].map((at) => u.posToVal(at, "x")));
        }],
      },
    }, [this.window, [null, null]], this.canvas);
  }

  draw(u) {
    const {ctx} = u, px = devicePixelRatio, where = positions(u, this.panel, this.axis.scale === "log");
    const window = [u.scales.x.min, u.scales.x.max];
    ctx.save();
    ctx.beginPath();
    ctx.rect(where.left, where.top, where.width, where.height);
    ctx.clip();
    for (const part of this.shown) {
      ctx.save();
      ctx.strokeStyle = ctx.fillStyle = tone(part.color ?? "black");
      ctx.lineWidth = px;
      DRAW[part.kind](ctx, part, where, window, px);
      ctx.restore();
    }
    ctx.restore();
  }

  zoom() {
    const [min, max] = this.window, [low, high] = ordinates(this.panel, this.shown, this.window);
    this.plot.batch(() => {
      this.plot.setScale("x", {min, max});
      this.plot.setScale("y", {min: low, max: high});
      this.plot.redraw(false, true);
    });
  }

  turn(window) {
    if (this.shared) this.stack.turn(window);
    else {
      this.own = window;
      this.zoom();
    }
  }

  key(event) {
    if (event.target !== this.element) return;
    const [low, high] = this.window, length = high - low;
    const windows = {
      "+": [low + length / 4, high - length / 4], "-": [low - length / 2, high + length / 2], 0: this.whole,
      ArrowLeft: [low - length / 8, high - length / 8], ArrowRight: [low + length / 8, high + length / 8],
    };
    if (!windows[event.key]) return;
    event.preventDefault();
    this.turn(windows[event.key]);
  }

  // The legend: a button for each part with a name, which hides it.
  list() {
    const parts = this.panel.parts.filter((part) => part.label), labels = parts.map((part) => part.label + part.color).join("\n");
    if (labels === this.labels) return;
    this.labels = labels;
    this.legend.replaceChildren();
    this.values = parts.map((part) => {
      const button = made("button", this.legend, {type: "button"});
      const swatch = made("i", button);
      swatch.style.borderColor = `light-dark(${part.color}, ${DARK[part.color] ?? part.color})`;
      swatch.style.borderTopStyle = part.dash?.length ? "dashed" : "solid";
      made("span", button, {textContent: part.label});
      const press = () => button.setAttribute("aria-pressed", !this.stack.hidden.has(this.key_of(part)));
      button.addEventListener("click", () => {
        const {hidden} = this.stack, key = this.key_of(part);
        hidden[hidden.has(key) ? "delete" : "add"](key);
        press();
        this.zoom();
      });
      press();
      return made("output", button);
    });
  }

  // The values under the pointer.
  tell(at) {
    const parts = this.panel.parts.filter((part) => part.label);
    this.values.forEach((output, k) => {
      const {x, y, kind} = parts[k], found = at === undefined || kind !== "curve" ? undefined : y[Math.min(place(x, at), x.length - 1)];
      output.textContent = found === undefined || found !== found ? "" : Number(found.toPrecision(4));
    });
  }
}
