// Runs manoeuvres with the module of a page: node run_loops.js FOLDER, which has asked.json and gets answers.json.
const {readFileSync, writeFileSync} = require("node:fs"), {gunzipSync} = require("node:zlib"), {join} = require("node:path");
const [folder, scripts] = process.argv.slice(2).map((path) => require("node:path").resolve(path));
const {Loops, signal, finished} = require(join(scripts, "loop.js")), {metrics, atSamples} = require(join(scripts, "metrics.js"));
const {Followers} = require(join(scripts, "follow.js"));
const {loops: content, cases, cars, T_s, step, band} = JSON.parse(readFileSync(join(folder, "asked.json")));
const loops = new Loops(new WebAssembly.Module(gunzipSync(Buffer.from(content.code, "base64"))), content);

function tried(work) {
  try {
    return work();
  } catch (reason) {
    return {refused: reason.message};
  }
}

const runs = cases.map(({loop, manoeuvre, parameters, control}, number) => tried(() => {
  const inputs = Object.fromEntries(Object.entries(manoeuvre.inputs).map(([name, data]) => [name, signal(data)]));
  inputs["controller.enable"] = () => control;
  const run = finished(loops.run(loop, {parameters: {...manoeuvre.start, ...parameters}, inputs, duration: manoeuvre.duration, step}));
  for (const [name, column] of Object.entries(run)) writeFileSync(join(folder, `${number} ${name}`), column);
  return metrics(run, atSamples(run, Math.round(T_s / step)), manoeuvre, T_s, band);
}));
const followed = cars.map(({known, turned}) => tried(() => new Followers(loops, known).changes(turned, true)));
writeFileSync(join(folder, "answers.json"), JSON.stringify({runs, followed}, (_, value) => (Number.isNaN(value) ? null : value)));
