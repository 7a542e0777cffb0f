// SPDX-License-Identifier: GPL-3.0-or-later
// Connects the server with the image, the knobs and the status lines.
import {Ahead} from "./ahead.js";
import {Bookmarks} from "./bookmarks.js";
import {boxAround, cameraOf, framed, lookOf, orbit, rounded} from "./camera.js";
import {CameraInput} from "./camera_input.js";
import {Connection, newStroke} from "./connection.js";
import {Drop} from "./drop.js";
import {Gizmo} from "./gizmo.js";
import {Knobs, make} from "./knobs.js";
import {Overlay} from "./overlay.js";
import {draw, kErrorRange, parseFrame, valuesAt} from "./picture.js";
import {Snapshots} from "./snapshots.js";
import {Trade} from "./trade.js";

const one = (id) => document.getElementById(id);
const kLooksOpaque = 300;  // mean free paths through a body
const kLooksClear = 1;     // mean free paths
const kNoticed = 400;      // ms
const kRadiansASecond = .25;
const kTurnStep = 33;      // ms

const film = {aspect: 1, shownHeight: 1, place: (seen) => seen};
const state = {scene: null, camera: null, film, wipe: 0, revision: 0, edits: [], command: "", boxes: [], selected: null};
const display = {exposure: 0, transform: "soft", channel: ""};
let frame = null, waiting = null, layers = [];
let pinned = null, beside = null;  // images on the left of the wipe, and on its right instead of the newest one
let reference = null, waitingReference = null, behind = {trade: false, reference: ""};

// ---- the image ----------------------------------------------------------------------------------------------

function takeFilm() {
  const given = serverScene.film || {}, [width, height] = given.resolution || [512, 512];
  const [x0, y0, x1, y1] = given.crop || [0, 0, width, height];
  const pixel = given.pixel_aspect || 1;
  film.aspect = pixel * width / height;
  film.shownHeight = (y1 - y0) / height;
  film.place = ({x, y, depth}) => ({x: (x * width - x0) / (x1 - x0), y: (y * height - y0) / (y1 - y0), depth});
  film.shownAspect = pixel * (x1 - x0) / (y1 - y0);
  film.pixels = [x1 - x0, y1 - y0];
}

function fit() {
  const stage = one("stage").getBoundingClientRect(), aspect = film.shownAspect || 1;
  const height = Math.max(1, Math.min(stage.height, stage.width / aspect));
  Object.assign(one("frame").style, {width: `${height * aspect}px`, height: `${height}px`});
  updateOverlay();
}

// A reference belongs to one scene, and is hidden after an edit.
const leftPicture = () => pinned || (behind.reference && frame && reference?.revision === frame.revision ? reference : null);

function redraw() {
  const left = leftPicture(), right = beside || frame;
  if (frame) draw(right, one("picture"), display, left);
  if (left) draw(left, one("pinned"), display, right);
  one("legend").hidden = display.channel !== "error" || !frame;
  one("pinned").hidden = !left;
  state.wipe = left ? Number(one("wipe").value) : 0;
  one("pinned").style.clipPath = `inset(0 ${100 - state.wipe}% 0 0)`;
  inspect();
  updateOverlay();
}

function showFrame() {
  if (beside && waiting.revision !== frame.revision) {
    beside = null;
    snapshots.forget("right");
  }
  frame = waiting;
  waiting = null;
  if (frame.step === "final" && state.offersLayers !== frame.revision) offerLayers();
  redraw();
  connection.send({do: "shown", frame: frame.number});
  one("step").textContent = one("step").dataset.step = frame.step;
  one("step").dataset.revision = frame.revision;
  one("timing").textContent = `${(1000 * frame.seconds).toFixed(0)} ms, ${frame.width} × ${frame.height}`;
  if (frame.step === "final") one("live").textContent = "The image is final.";
}

function showReference() {
  reference = waitingReference;
  waitingReference = null;
  connection.send({do: "shown", frame: reference.number});
  redraw();
}

// Layers of the method's images.
function offerLayers() {
  const method = state.scene.settings?.method || "hierarchical";
  const names = ["", "R", "G", "B", "A", "diffuse", "specular", "albedo", "N", "P", "Z", method === "direct" ? "variance" : "irradiance"];
  if (!["lambert", "direct"].includes(method)) names.push("error");
  state.offersLayers = frame.revision;
  if (names.join() === layers.join()) return;
  layers = names;
  one("channel").replaceChildren(...names.map((name) => new Option(name || "colour", name)));
  one("channel").value = display.channel = names.includes(display.channel) ? display.channel : "";
}

function inspect() {
  const picture = beside || frame;
  if (!picture || one("x").value === "" || !film.pixels) return;
  const [x, y] = ["x", "y"].map((id, i) => Math.floor(Number(one(id).value) * (i ? picture.height : picture.width) / film.pixels[i]));
  const values = valuesAt(picture, x, y), text = (v) => Number(v.toPrecision(4)).toString();
  one("values").textContent = values
    ? `R G B A ${values.colour.map(text).join(" ")}${values.layer.length ? `; ${display.channel} ${values.layer.map(text).join(" ")}` : ""}` : "";
}

// ---- user input
// -----------------------------------------------------------------------------------------------

let serverScene = null;
const ahead = new Ahead(() => {
  takeValues();
  knobs.update(state.scene, state.edits);
  updateOverlay();
});

function takeValues() {
  state.scene = knobs.scene = ahead.of(serverScene);
  state.camera = cameraOf(state.scene);
}

function set(values, stroke) {
  connection.set(values, stroke);
  ahead.add(values);
  takeValues();
  updateOverlay();
}

// Undo and other replacements of the scene discard this page's pending edits.
function step(message) {
  connection.send(message);
  ahead.clear();
}

// Rotates the view's free camera; the scene keeps its own.
function turn(change) {
  const look = lookOf(change(state.camera));
  connection.look(look);
  ahead.add({look});
  takeValues();
  updateOverlay();
}

// Shows everything, or the selected shape.
function frameSelected() {
  const box = boxAround(state.boxes[gizmo.index()] ? [state.boxes[gizmo.index()]] : state.boxes);
  if (!box || !state.camera) return;
  const camera = framed(state.camera, film.aspect, box);
  if (camera.orthographic_height) set({"camera.orthographic_height": rounded(camera.orthographic_height)}, newStroke());
  turn(() => camera);
}

// Handles and tools for a shape, by its index; null: for none.
function select(index) {
  state.selected = index === null ? null : knobs.pathOf("shapes", index);
  for (const button of one("tools").querySelectorAll("[data-mode]")) button.disabled = index === null;
  gizmo.update();
}

function setMode(mode) {
  gizmo.setMode(mode);
  for (const button of one("tools").querySelectorAll("[data-mode]")) button.setAttribute("aria-pressed", String(button.dataset.mode === mode));
}

function takeSnapshot() {
  if (!frame || frame.revision !== state.revision) return tell("the image of these settings is not there yet", false);
  const shown = report?.revision === frame.revision ? report : null;
  snapshots.add(frame, display, {edits: state.edits, look: state.scene.look, frame: state.frame}, shown);
}

function recall({edits, look, frame: number}) {
  step({do: "recall", edits});
  if (number !== state.frame) step({do: "frame", frame: number});
  step(look ? {do: "look", ...look} : {do: "look_back"});
}

const pixelAt = (event) => {
  const box = one("picture").getBoundingClientRect();
  return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height].map((x, i) => Math.floor(x * film.pixels[i]));
};

// A click opens the settings of the shape below it.
function pick(event) {
  const [x, y] = pixelAt(event);
  if (x >= 0 && y >= 0) connection.send({do: "pick", x, y});
}

function tell(text, isGood = true) {
  one("told").textContent = one("told").title = text;
  one("told").classList.toggle("is-bad", !isGood);
}

async function copyCommand() {
  try {
    await navigator.clipboard.writeText(state.command);
    tell("copied: " + state.command);
  } catch {
    tell(state.command);  // to be copied by hand
  }
}

// A link to this page with the settings and the camera of now.
async function copyLink() {
  const link = new URL(location.href);
  link.hash = encodeURIComponent(JSON.stringify({edits: state.edits, look: state.scene.look, frame: state.frame}));
  try {
    await navigator.clipboard.writeText(link.href);
    tell("copied: " + link.href);
  } catch {
    tell(link.href);  // to be copied by hand
  }
}

// Settings of a link are set once, when the scene is there.
function takeLink() {
  if (location.hash.length < 2) return;
  const text = decodeURIComponent(location.hash.slice(1));
  history.replaceState(null, "", location.pathname + location.search);
  try {
    recall(JSON.parse(text));
  } catch {
    tell("the link has no settings", false);
  }
}

// Turns the free camera about the scene until the button is pressed again.
let turnedAt = 0;
function turnTable(now) {
  if (one("turntable").getAttribute("aria-pressed") !== "true") return void (turnedAt = 0);
  if (turnedAt && state.camera && now - turnedAt >= kTurnStep) {
    turn((camera) => orbit(camera, kRadiansASecond * (now - turnedAt) / 1000, 0));
    turnedAt = now;
  }
  turnedAt ||= now;
  requestAnimationFrame(turnTable);
}

function chooseChannel() {
  display.channel = one("channel").value;
  connection.send({do: "layer", name: display.channel.length > 1 || "NPZ".includes(display.channel) ? display.channel : ""});
  redraw();
}

// Image on the left of the wipe: a pinned image, or a reference.
function compare(picture, method) {
  if (picture !== snapshots.sides.left?.picture) snapshots.forget("left");
  pinned = picture;
  one("pin").setAttribute("aria-pressed", String(Boolean(pinned)));
  one("wipe").disabled = !pinned && !method;
  one("wipe").value = pinned || method ? 50 : 0;
  if (method !== behind.reference) askBehind({reference: method});
  redraw();
}

function askBehind(change) {
  behind = {...behind, ...change};
  one("reference").value = behind.reference;
  one("compared").hidden = !behind.reference;
  connection.send({do: "behind", ...behind});
}

function takePoint(point) {
  const isNew = (state.scene.settings?.method || "hierarchical") !== point.method;
  set({...(isNew ? {"settings.method": point.method} : {}), ...point.values}, newStroke());
}

// ---- server messages
// ------------------------------------------------------------------------------------------

function takeScene(message) {
  const isNewFile = state.path !== message.path;
  state.path = message.path;
  if (isNewFile) ahead.clear();
  serverScene = {...message.scene, look: message.look, floor: message.floor, environments: message.environments};
  Object.assign(state, {revision: message.revision, edits: message.edits, command: message.command});
  takeValues();
  takeFilm();
  document.title = `${message.file} · opaline view`;
  one("file").textContent = message.file;
  if (isNewFile) {
    snapshots.clear();
    beside = null;
    compare(null, "");
    bookmarks.open(message.path);
    select(null);
    one("name").value = message.file.replace(/(\.(json|glb|gltf|obj|ply|stl|off))?$/i, "-edited");
    setExposure(message.scene.film?.exposure || 0);
    one("transform").value = display.transform = message.scene.film?.view || "soft";
    takeLink();
  }
  one("undo").disabled = !message.undo;
  one("redo").disabled = !message.redo;
  one("reset").disabled = !message.edits.length;
  one("keep-look").disabled = one("look-back").disabled = !message.look;
  one("key-look").disabled = !message.look;
  one("whose-camera").textContent = message.look ? "free" : "scene";
  one("failed").hidden = true;
  takeFrames(message);
  knobs.update(state.scene, state.edits);
  if (gizmo.index() < 0) select(null);
  fit();
}

// A slider held by the user keeps its position.
function takeFrames({frames, frame: now}) {
  one("frames").hidden = one("key-look").hidden = frames.length < 2;
  Object.assign(state, {frames, frame: now});
  one("playhead").max = Math.max(0, frames.length - 1);
  if (!one("playhead").matches(":active")) one("playhead").value = Math.max(0, frames.indexOf(now));
  one("shown-frame").textContent = now;
}

// Warns of bodies with an unlikely size, each with a button for it.
function sizeWarnings(groups) {
  return groups.flatMap(({name, medium, thickness, mean_free_path: path}) => {
    const look = !(path > 0 && thickness > 0) ? "" : thickness > kLooksOpaque * path ? "opaque" : thickness < kLooksClear * path ? "like clear glass" : "";
    if (!look) return [];
    const index = state.scene.shapes.findIndex((shape) => shape.name === name);
    const button = make("button", {type: "button", textContent: "Set size", onclick: () => knobs.reveal(`shapes.${index}`)});
    return [make("li", {}, `${name} is ${thickness.toPrecision(3)} mm thick on average, ${(thickness / path).toPrecision(2)} mean free paths of ${medium}: it looks ${look}. `,
      ...(index < 0 ? ["Check its size (mm_per_unit, fit_size)."] : [button]))];
  });
}

const list = (texts) => texts.map((text) => make("li", {textContent: text}));
const paragraph = (text) => Object.assign(document.createElement("p"), {textContent: text});
let plan = {groups: [], stages: [], warnings: [], memory: ""}, report = null, overdue = 0;
let filing = null;  // the image shown when the rendering of a file began

// An image of an earlier scene is named as such, once a new one takes a while.
function noteWait() {
  clearTimeout(overdue);
  overdue = setTimeout(() => {
    if (frame && frame.revision < plan.revision) one("step").textContent = one("step").dataset.step = "waiting";
  }, kNoticed);
}

function showPlan() {
  one("warnings").replaceChildren(...sizeWarnings(plan.groups), ...list([...plan.warnings, ...(report?.warnings || [])]));
  const words = [...plan.groups.map((group) => group.text), ...plan.stages, plan.memory].map(paragraph), lines = [];
  if (report) {
    const table = document.createElement("table");
    table.innerHTML = "<tr><th>stage<th>wall<th>CPU</tr>";
    for (const cost of report.costs) {
      const row = table.insertRow();
      row.insertCell().textContent = cost.stage;
      for (const seconds of [cost.wall, cost.cpu]) Object.assign(row.insertCell(), {textContent: `${(1000 * seconds).toFixed(1)} ms`, className: "number"});
    }
    lines.push(table, ...report.reused.map(paragraph));
  }
  one("plan").replaceChildren(...lines, ...words);
}

const takes = {
  schema: (message) => knobs.take(message),
  scene: takeScene,
  plan: (message) => {
    plan = message;
    state.boxes = knobs.boxes = message.boxes;
    if (state.scene) knobs.update(state.scene, state.edits);
    report = null;
    noteWait();
    updateOverlay();
    one("error").textContent = "";
    showPlan();
  },
  report: (message) => {
    if (message.revision !== plan.revision) return;
    report = message;
    one("error").dataset.revision = message.revision;
    const percent = (error) => `${Number((100 * error).toPrecision(2))} %`;
    const errors = [[message.error, "settings"], [plan.model_error, "model"]].filter(([error]) => error > 0);
    const parts = errors.map(([error, of]) => `${of} error about ${percent(error)}`);
    if (plan.model_is_unknown) parts.push(plan.model_error > 0 ? "unknown for some bodies" : "model error unknown");
    one("error").textContent = errors.length === 2 && !plan.model_is_unknown
      ? `error about ${percent(Math.hypot(message.error, plan.model_error))} (${parts.join(", ")})` : parts.join(", ");
    showPlan();
  },
  work: ({stage, done, total}) => {
    one("work").textContent = stage ? `${stage}${total ? ` ${Math.min(100, Math.floor(100 * done / total))} %` : ""}` : "";
  },
  file: ({stage, done, total}) => {
    const isRendering = stage !== "";
    if (!isRendering) filing = null;
    else if (!filing) filing = {frame, isAsSeen: !state.scene.look && frame?.step === "final" && frame.revision === state.revision};
    one("cancel").hidden = !isRendering;
    one("cancel").textContent = `Cancel: ${stage}${total ? ` ${Math.min(100, Math.floor(100 * done / total))} %` : ""}`;
    one("render").disabled = one("render-png").disabled = isRendering;
  },
  failed: (message) => {
    if (message.revision !== state.revision) return;
    one("failed").textContent = message.text;
    one("failed").hidden = false;
  },
  // Another page may have requested something else.
  behind: ({trade, reference: method}) => {
    behind = {trade, reference: method};
    one("reference").value = method;
    one("compared").hidden = !method;
    one("compared").textContent = `${method}: rendering`;
    if (!pinned) one("wipe").disabled = !method;
    redraw();
  },
  trade: (message) => trade.show(message),
  reference: (message) => {
    const percent = (x) => `${Number((100 * x).toPrecision(2))} %`, each = message.method === "direct" ? "samples per pixel" : "walks per sample";
    one("compared").dataset.revision = message.revision;
    one("compared").textContent = `${message.method}: ${message.samples} ${each}, noise ${message.noise ? percent(message.noise) : "unknown"}; ` +
      `the final image differs by ${percent(message.difference)} (rms of the diffuse light over translucent pixels, without this noise)`;
  },
  picked: ({shape}) => {
    select(shape);
    if (shape !== null) knobs.reveal(`shapes.${shape}`);
  },
  // A refused edit is dropped: the scene message follows.
  told: (message) => {
    if (filing && message.text.startsWith("rendered ") && filing.isAsSeen && filing.frame === frame) takeSnapshot();
    if (!message.good) ahead.clear();
    tell(message.text, message.good);
  },
};

const connection = new Connection({
  text: (message) => takes[message.is]?.(message),
  frame: (buffer) => {
    const news = parseFrame(buffer);
    if (news.step === "reference") {
      if (!waitingReference) requestAnimationFrame(showReference);
      waitingReference = news;
    } else {
      if (!waiting) requestAnimationFrame(showFrame);
      waiting = news;
    }
  },
  lost: () => { one("lost").hidden = false; },
  found: () => {
    one("lost").hidden = true;
    if (display.channel) chooseChannel();
    if (behind.trade || behind.reference) askBehind({});
  },
});
const knobs = new Knobs(one("panel"), set, (text) => { one("help").textContent = text; one("told").textContent = ""; }, step);
const pathOf = (list, index) => knobs.pathOf(list, index);
const overlay = new Overlay(one("overlay"), state, set, pathOf);
const gizmo = new Gizmo(one("overlay"), state, set, pathOf);
const updateOverlay = () => {
  overlay.update();
  gizmo.update();
};
const canvas = one("picture");
const cameraInput = new CameraInput(canvas, state, {turn, set, pathOf, click: pick});
const bookmarks = new Bookmarks(one("views"), (look) => step({do: "look", ...look}), tell);
const snapshots = new Snapshots(one("snapshots"), recall, ({left, right}) => {
  if (right !== undefined) beside = right;
  if (left !== undefined) compare(left, "");
  else redraw();
});

const trade = new Trade(one("points"), takePoint);

function setExposure(stops) {
  one("exposure").value = display.exposure = stops;
  one("stops").textContent = stops;
}

const drop = new Drop(document.body, step, tell);
one("open").onclick = () => one("files").click();
one("files").onchange = () => {
  drop.open([...one("files").files].map((file) => ({name: file.name, file})));
  one("files").value = "";
};
for (const word of ["undo", "redo", "reset"]) one(word).onclick = () => step({do: word});
one("show-keys").onclick = () => one("keys").showModal();
one("keep-look").onclick = () => step({do: "keep_look"});
one("look-back").onclick = () => step({do: "look_back"});
one("key-look").onclick = () => step({do: "key_look"});
one("store-view").onclick = () => bookmarks.store(lookOf(state.camera));
one("snapshot").onclick = takeSnapshot;
one("frame-selected").onclick = frameSelected;
for (const button of one("tools").querySelectorAll("[data-mode]")) button.onclick = () => setMode(button.dataset.mode);
one("copy").onclick = copyCommand;
one("save").onclick = () => connection.send({do: "save", name: one("name").value + ".json"});
one("render").onclick = () => connection.send({do: "render", name: one("name").value + ".exr"});
one("render-png").onclick = () => connection.send({do: "render", name: one("name").value + ".png"});
one("cancel").onclick = () => connection.send({do: "cancel_render"});
one("link").onclick = copyLink;
one("turntable").onclick = () => {
  const isOn = one("turntable").getAttribute("aria-pressed") !== "true";
  one("turntable").setAttribute("aria-pressed", String(isOn));
  if (isOn) requestAnimationFrame(turnTable);
};
one("pin").onclick = () => compare(pinned ? null : frame, "");
one("reference").onchange = () => compare(null, one("reference").value);
one("choose").onsubmit = (event) => {
  event.preventDefault();
  connection.send({do: "choose", error: Number(one("target").value) / 100});
};
one("trade").ontoggle = () => askBehind({trade: one("trade").open});
one("legend").replaceChildren(...kErrorRange.map(([error, colour]) => {
  const mark = make("span", {textContent: `${100 * error} %`});
  mark.style.background = `rgb(${colour.join()})`;
  return mark;
}));
one("exposure").oninput = () => { setExposure(Number(one("exposure").value)); redraw(); };
one("transform").onchange = () => { display.transform = one("transform").value; redraw(); };
one("channel").onchange = chooseChannel;
one("wipe").oninput = redraw;
one("playhead").oninput = () => step({do: "frame", frame: state.frames[Number(one("playhead").value)]});
for (const id of ["x", "y"]) one(id).oninput = inspect;
canvas.addEventListener("pointermove", (event) => {
  if (!film.pixels || cameraInput.isDragging) return;
  [one("x").value, one("y").value] = pixelAt(event);
  inspect();
});
const kKeys = {f: frameSelected, s: takeSnapshot, w: () => setMode("move"), e: () => setMode("turn"), r: () => setMode("scale"),
  escape: () => select(null), "?": () => one("keys").showModal()};
addEventListener("keydown", (event) => {
  const isTyped = event.target.matches("select, input:not([type=range], [type=checkbox])");
  if (isTyped || event.ctrlKey || event.altKey || event.metaKey || one("keys").open || !state.camera) return;
  const number = /^Digit([1-9])$/.exec(event.code)?.[1];
  if (number && event.shiftKey) bookmarks.store(lookOf(state.camera), number);
  else if (number) bookmarks.go(number);
  else kKeys[event.key.toLowerCase()]?.();
});
addEventListener("keydown", (event) => {
  if (!event.ctrlKey || event.key.toLowerCase() !== "z" || event.target.matches("input[type=number], #name")) return;
  event.preventDefault();
  step({do: event.shiftKey ? "redo" : "undo"});
});
new ResizeObserver(fit).observe(one("stage"));
