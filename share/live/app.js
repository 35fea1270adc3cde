// SPDX-License-Identifier: GPL-3.0-or-later
// The page: what the server tells goes to the panels, and buttons go to the server.
import { getJson, getText, listen, post } from "/server.js";
import { Tables, parse, pretty } from "/tables.js";
import { Curves } from "/curves.js";
import { Population } from "/population.js";
import { Candidate } from "/candidate.js";
import { Film } from "/film.js";
import { Maps } from "/maps.js";
import { Particles } from "/particles.js";
import { Settings } from "/settings.js";
import { Files } from "/files.js";

const at = (id) => document.getElementById(id);
const candidate = new Candidate(at("panels"));
const panels = [new Curves(at("panels")), candidate, new Population(at("panels")), new Maps(at("panels"))];
const tables = new Tables();
const particles = new Particles(at("particles"), { scene: at("scene"), frames: at("frames"), colours: at("colour"), types: at("types") });
const film = new Film(at("particles"), at("record"), () => (state.file.split("/").pop() || "mesofit").replace(/\.json$/, ""));
const settings = new Settings(at("settings"));
const files = new Files(at("files"), { fail: showMessage, settings: () => settings.text,
  open: (path) => thenView(() => post("open", { path })) });
let state = { phase: "", file: "" };

// Options of the command line, of which this page has its own.
const here = { "--force": "under Settings, the folder for the results and \"replace\"", "--resume": "\"Go on\"" };

function showMessage(text) {
  const option = Object.keys(here).find((name) => text?.includes(name));
  at("message").textContent = (text || "") + (option ? ` (here: ${here[option]})` : "");
  at("message").hidden = !text;
}

async function act(what) {
  try {
    showMessage("");
    await what();
  } catch (error) {
    showMessage(error.message);
  }
}

// Tabs --------------------------------------------------------------------------------------------

const tabs = ["view", "settings", "files", "log"];
let chosenTimes = 0;

function select(name, focus = false) {
  chosenTimes++;
  for (const tab of tabs) {
    const chosen = tab === name, button = at("tab-" + tab);
    button.setAttribute("aria-selected", chosen);
    button.tabIndex = chosen ? 0 : -1;
    at(tab).hidden = !chosen;
    if (chosen && focus)
      button.focus();
  }
  if (name === "files")
    files.show();
}

// Do something, and see it, unless a tab was chosen meanwhile.
async function thenView(what) {
  const before = chosenTimes;
  await what();
  if (chosenTimes === before)
    select("view");
}

for (const tab of tabs) {
  at("tab-" + tab).addEventListener("click", () => select(tab));
  at("tab-" + tab).addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (step)
      select(tabs[(tabs.indexOf(tab) + step + tabs.length) % tabs.length], true);
  });
}

// What the server tells ---------------------------------------------------------------------------

const phases = { choosing: "choose a file", looking: "results", ready: "ready", running: "running", paused: "paused",
  stopped: "stopped", ended: "ended", refused: "refused" };

async function takeState(next) {
  const before = state;
  state = next;
  at("phase").textContent = phases[state.phase] || state.phase;
  at("phase").dataset.phase = state.phase;
  at("subject").textContent = [state.file, state.folder && `→ ${state.folder}`].filter(Boolean).join(" ") || "nothing is chosen";
  at("version").textContent = "mesofit " + state.version;
  document.title = `${phases[state.phase] || ""} · ${state.file || state.folder || "mesofit"}`;
  if (state.message || state.phase !== before.phase)
    showMessage(state.message);
  showControls();
  showProgress();
  showVerdict();
  showEmpty();
  if (state.file !== before.file || (state.phase === "ready" && before.phase !== "ready"))
    await loadSubject();
  if (state.kind === "simulation" && isActive())
    particles.follow();
  else {
    particles.leave();
    film.end();
  }
  if (state.phase === "ended" && !state.stays)
    setTimeout(() => { stopListening(); showGone(state.message || "the run has ended, and mesofit with it"); }, 1500);
}

async function loadSubject() {
  panels.forEach((panel) => panel.clear());
  particles.clear();
  numbers = {};
  at("numbers").replaceChildren();
  showEmpty();
  if (state.file)
    await settings.load(await getText("text"));
  else
    settings.clear();
}

function showControls() {
  const running = state.phase === "running", paused = state.phase === "paused", idle = !running && !paused;
  const simulates = state.kind === "simulation";
  const on = { start: idle && state.file !== "", resume: (idle && state.phase === "stopped") || paused, pause: running,
    step: (running || paused) && simulates, stop: running || paused };
  const focused = document.activeElement.id;
  for (const [id, enabled] of Object.entries(on))
    at(id).disabled = !enabled;
  if (focused in on && !on[focused]) // a keyboard goes on where it was
    at(Object.keys(on).find((id) => on[id]) || "tab-view").focus();
  at("start").textContent = ["ended", "stopped"].includes(state.phase) ? "Start again" : "Start";
  showChanges();
  at("step").hidden = at("speed-label").hidden = at("speed-value").hidden = !simulates;
}

// What the program tells of can be changed.
let numbers = {};
const changes = [...at("change").querySelectorAll("input")];
function showChanges() {
  for (const input of changes) {
    input.parentElement.hidden = !(input.dataset.number in numbers);
    input.placeholder = numbers[input.dataset.number]?.value ?? "";
  }
  at("change").hidden = !isActive() || changes.every((input) => input.parentElement.hidden);
}

// So many digits, and no power of ten where people write none.
function round(value, digits) {
  const text = value.toPrecision(digits);
  return text.includes("e+") && Math.abs(value) < 1e9 ? String(Number(text)) : text;
}

const isActive = () => ["running", "paused"].includes(state.phase);
const hasRun = () => isActive() || ["stopped", "ended"].includes(state.phase);

let progress = null;
function takeProgress(next) {
  progress = next;
  showProgress();
}

// How fast it is and how long it takes is of a run that goes on.
function showProgress() {
  const shown = hasRun() ? progress : null;
  at("bar").value = shown?.total > 0 ? shown.done / shown.total : 0;
  if (!shown) {
    at("progress-text").textContent = "";
    return;
  }
  const left = progress.left; // null: nobody knows
  const text = !Number.isFinite(left) ? "" : left < 100 ? `${left.toFixed(0)} s` : left < 6000 ? `${(left / 60).toFixed(0)} min` : `${(left / 3600).toFixed(1)} h`;
  const pace = state.phase === "running" ? `, ${round(progress.rate, 3)}/s${text && `, at most ${text} left`}` : "";
  at("progress-text").textContent = `${progress.text}  ${progress.done}/${progress.total} ${progress.unit}${pace}`;
}

function takeNumbers(next) {
  if (!hasRun())
    return; // of a run before this file was chosen
  numbers = next;
  const shown = Object.entries(numbers).map(([name, { value, unit }]) => {
    const box = document.createElement("div"), number = document.createElement("b"), label = document.createElement("span");
    number.textContent = value === null ? "unknown" : Number.isInteger(value) ? String(value) : round(value, 4);
    label.textContent = name + (unit && unit !== "1" ? ` [${pretty(unit)}]` : "");
    box.append(number, label);
    return box;
  });
  at("numbers").replaceChildren(...shown);
  showChanges();
  showEmpty();
}

function showEmpty() {
  const count = panels.reduce((sum, panel) => sum + panel.count, 0);
  at("empty").textContent = isActive() ? `The run is at work; its curves begin with the ${state.kind === "fit" ? "first iteration" : "second sample"}.`
    : (state.file ? "Nothing has been computed yet. Press Start, or choose another" : "Choose a") +
    " scene, run file or folder of results under Files.";
  at("empty").hidden = count > 0 || !at("scene").hidden;
  at("compare").hidden = count === 0;
}

// What a fit's summary says of it as a whole.
function verdictOf(summary) {
  if (!(summary.iterations > 0))
    return "";
  const digits = (name, count) => (Number.isFinite(summary[name]) ? summary[name].toPrecision(count) : "unknown");
  const text = `${summary.status.replaceAll("_", " ")}: ${summary.method}, ${summary.iterations} iterations, error ${digits("error", 3)}`;
  return summary.rdf_rmse > 0 ? `${text}; verification: rms of g(r) − target ${digits("rdf_rmse", 3)} ± ` +
    `${digits("rdf_rmse_error", 2)}, statistics alone ${digits("rdf_noise", 2)}` : text;
}

let verdict = "", judged = "";
async function takeVerdict(listing) {
  const file = listing.in === "result" && listing.files.find((each) => each.name === "summary.json");
  const stamp = file ? `${state.folder}/${file.seconds}/${file.size}` : "";
  if (stamp !== judged)
    verdict = file ? verdictOf(await getJson("file", { in: "result", path: "summary.json" })) : "";
  judged = stamp;
  showVerdict();
}

function showVerdict() {
  at("verdict").textContent = verdict;
  at("verdict").hidden = verdict === "" || isActive() || state.phase === "ready";
}

// One listing at a time, and then the newest.
let newest = null, busy = false;
async function takeTables(listing) {
  newest = listing;
  if (busy)
    return;
  busy = true;
  try {
    while (newest) {
      const now = newest;
      newest = null;
      const changed = await tables.update(now);
      panels.forEach((panel) => panel.update(changed));
      showEmpty();
      await takeVerdict(now);
    }
  } finally {
    busy = false;
  }
}

// Events in their order: a new subject clears the panels before its tables come.
let queue = Promise.resolve();
const takers = { state: takeState, progress: takeProgress, numbers: takeNumbers, tables: takeTables,
  candidate: (next) => { candidate.take(hasRun() ? next : {}); showEmpty(); } };
function take(name, text) {
  queue = queue.then(async () => {
    if (name === "log")
      at("lines").textContent = text;
    else if (takers[name])
      await takers[name](JSON.parse(text));
  }).catch((error) => showMessage(error.message));
}

function showGone(text) {
  at("phase").textContent = "gone";
  at("phase").dataset.phase = "gone";
  showMessage(text);
  particles.leave();
  at("change").hidden = true;
  for (const id of ["start", "resume", "pause", "step", "stop"])
    at(id).disabled = true;
}

const stopListening = listen(take, (error, failures) => {
  const refused = /token|127\.0\.0\.1|site/.test(error.message);
  if (refused || failures > 2)
    showGone(refused ? error.message : "mesofit does not answer: it has ended, or the tunnel is closed");
}, () => state.phase === "ended" && !state.stays);

// What the buttons ask for ------------------------------------------------------------------------

const wish = (body) => post("wish", {}, JSON.stringify(body));
at("start").addEventListener("click", () => act(() => thenView(() => post("start", settings.query(), settings.text))));
at("resume").addEventListener("click", () => act(() => (state.phase === "paused" ? wish({ wish: "go" })
  : post("start", { ...settings.query(), resume: "1" }, settings.text))));
at("pause").addEventListener("click", () => act(() => wish({ wish: "pause" })));
at("step").addEventListener("click", () => act(() => wish({ wish: "step", steps: 1 })));
at("stop").addEventListener("click", () => act(() => wish({ wish: "stop" })));
at("speed").addEventListener("input", () => {
  const value = Number(at("speed").value), free = value >= 5, speed = free ? 0 : Math.round(Math.pow(10, value));
  at("speed-value").textContent = free ? "as fast as it can" : `${speed} steps/s`;
  act(() => wish({ wish: "speed", speed }));
});
// What is no number goes as it is: the program says what is wrong with it.
at("change").addEventListener("submit", (event) => {
  const body = { wish: "change" };
  event.preventDefault();
  for (const input of changes) {
    const text = input.value.trim();
    if (text && !input.parentElement.hidden)
      body[input.dataset.key] = Number.isFinite(Number(text)) ? Number(text) : text;
  }
  act(async () => { await wish(body); at("change").reset(); });
});
at("colour").addEventListener("change", () => particles.choose("colour", at("colour").value));
at("slice").addEventListener("input", () => particles.choose("slice", Number(at("slice").value)));
at("slice-at").addEventListener("input", () => particles.choose("sliceAt", Number(at("slice-at").value)));
at("bead").addEventListener("input", () => particles.choose("bead", Number(at("bead").value)));

// Tables of the same names in another folder of results, dashed beside these.
at("compare-go").addEventListener("click", () => act(async () => {
  const folder = at("other").value.trim().replace(/\/$/, ""), other = new Map();
  if (folder)
    for (const file of await getJson("files", { path: folder }))
      if (/^(potential|omega|memory|rdf)(?!.*_(history|flat|now))[^.]*\.tsv$/.test(file.name))
        other.set(file.name, parse(await getText("file", { path: folder + "/" + file.name })));
  if (panels[0].compare(other) === 0 && folder)
    showMessage(`${folder} has none of the curves here in the same units`);
}));

showControls();
