// What the page's worker makes of settings: node answers.js FOLDER SCRIPTS.
const {readFileSync, writeFileSync} = require("node:fs"), {gunzipSync} = require("node:zlib"), {join} = require("node:path");
const [folder, scripts] = process.argv.slice(2);
const {Answerer} = require(join(scripts, "worker.js"));
const {data, questions, demands} = JSON.parse(readFileSync(join(folder, "asked.json")));
const answerer = new Answerer(data, gunzipSync(Buffer.from(data.loops.code, "base64")));

const answers = questions.map(({wanted, controller}, number) => {
  const settings = {control: true, others: [], gains: {}, car: {}, road: {}, character: 0.5, informed: true, typed: "", free: data.free, ...wanted};
  try {
    const answer = finished(answerer.answer(settings, controller));
    if (answer.run) writeFileSync(join(folder, `${number} plant.T_gear`), answer.run["plant.T_gear"]);
    return {same: Boolean(answer.same), worth: answer.worth, warnings: answer.warnings, gains: turnedGains(data, settings)};
  } catch (reason) {
    return {refused: reason.message};
  }
});
writeFileSync(join(folder, "answers.json"), JSON.stringify({answers, steps: demands.map(stepOf)}));
