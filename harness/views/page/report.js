"use strict";
// A report: its figures, which show what is chosen in a control or by a click on a row of a table.

const controls = new Map(); // by their titles

function control(title, choices, parent) {
  if (!controls.has(title)) {
    const label = made("label", parent, {className: "choice", textContent: `${title} `});
    const select = made("select", label);
    for (const name of choices) made("option", select, {value: name, textContent: name});
    const one = {select, show: [], choices};
    select.addEventListener("change", () => choose(one, select.value));
    controls.set(title, one);
  }
  return controls.get(title);
}

function choose(one, name) {
  one.select.value = name;
  for (const show of one.show) show(name);
  for (const row of document.querySelectorAll("tr[data-choice]"))
    if (one.choices.includes(row.dataset.choice)) row.classList.toggle("chosen", row.dataset.choice === name);
}

function draw(element, {control: title, x, windows, choices}, arrays) {
  const names = Object.keys(choices), stack = new Stack(null, x);
  const filled = (part) => Object.fromEntries(Object.entries(part).map(([name, value]) =>
    [name, part.kind !== "level" && part.kind !== "arrow" && ["x", "y", "low", "high", "end"].includes(name) ? arrays[value] : value]));
  const show = (name) => stack.set(choices[name].map((panel) => ({...panel, parts: panel.parts.map(filled)})), windows[name] ?? x.window);
  if (title) {
    const one = control(title, names, element);
    one.show.push(show);
  }
  element.append(stack.element);
  show(names[0]);
}

(async () => {
  const {arrays, figures: all} = await unpacked(), read = arrays.map(decoded);
  all.forEach((figure, k) => draw(get(`figure ${k}`), figure, read));
  for (const one of controls.values()) choose(one, one.select.value);
  for (const row of document.querySelectorAll("tr[data-choice]")) {
    const one = [...controls.values()].find(({choices}) => choices.includes(row.dataset.choice));
    if (!one) continue;
    const click = () => {
      choose(one, row.dataset.choice);
      one.select.scrollIntoView({behavior: "smooth", block: "start"});
    };
    row.tabIndex = 0;
    row.addEventListener("click", click);
    row.addEventListener("keydown", (event) => { if (event.key === "Enter") click(); });
  }
  document.body.dataset.drawn = "all";
})();
