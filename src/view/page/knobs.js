// SPDX-License-Identifier: GPL-3.0-or-later
// One knob per scene value, from the server's table of keys.
import {rounded} from "./camera.js";
import {newStroke} from "./connection.js";
import {movedTo, placementOf, scaledTo, stepsOf, turnedTo, turnOf} from "./placement.js";

// Form of a medium's definition, and its keys.
const kForms = {
  preset: {name: "preset", keys: ["preset", "scatter_anisotropy"]},
  sigma_s_prime: {name: "reduced coefficients", keys: ["sigma_a", "sigma_s_prime", "scatter_anisotropy"]},
  sigma_s: {name: "coefficients and g", keys: ["sigma_a", "sigma_s", "g"]},
  subsurface_color: {name: "colour and radius",
    keys: ["subsurface_color", "subsurface_radius", "subsurface_radius_scale", "subsurface_scatter_anisotropy"]},
};
const kNumbers = ["number", "whole_number", "length"], kThrees = ["point", "triple"];
const kColours = ["color", "number_or_triple"];
// Visible if the scene has such values.
const kFuzz = ["fuzz_weight", "fuzz_color", "fuzz_roughness"];
const kOptional = [...kFuzz, "base_color", "specular_anisotropy", "specular_rotation", "tint", "texture_mix", "thickness", "fit"];
const kGloss = ["metalness", "specular_roughness", "specular_ior", "specular_weight", "specular_anisotropy", "specular_rotation", ...kFuzz];
const kLists = {resolution: ["width", "height"], crop: ["x0", "y0", "x1", "y1"], shift: ["right", "up"]};
const kEither = [["field_of_view", "orthographic_height"], ["aperture", "f_number"], ["focus_distance", "focus_point"]];
const unusedOf = (camera) => kEither.map(([usual, other]) => other in (camera || {}) ? usual : other);
const kThumbnail = 42, kThumbnailsARow = 5;  // in presets.png; sizes as in view.css
const kWidestLinear = 1000, kDecade = 1;

// Textures and spectra, shown as text.
const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
const objectsOf = (owner) => Object.keys(owner).filter((key) => isObject(owner[key]));
const kPhotometric = ["lm", "cd", "lx", "nit"];
function textOf(value) {
  const {texture, noise, spectrum, illuminant, blackbody} = value, unit = kPhotometric.find((key) => key in value);
  const colour = texture ?? noise ?? spectrum ?? illuminant ?? (blackbody ? `black body, ${blackbody} K` : unit ? "" : "spectrum");
  return [unit ? `${value[unit]} ${unit}` : "", colour].filter(Boolean).join(", ");
}

export const make = (name, properties = {}, ...children) => {
  const element = Object.assign(document.createElement(name), properties);
  element.append(...children);
  return element;
};
const plain = (markdown) => markdown.replace(/[`"]/g, "");
const toLinear = (x) => x <= .04045 ? x / 12.92 : ((x + .055) / 1.055) ** 2.4;
const toSrgb = (x) => x <= .0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - .055;
const fromHex = (hex) => [1, 3, 5].map((i) => toLinear(parseInt(hex.slice(i, i + 2), 16) / 255));
const toHex = (rgb) => "#" + rgb.map((x) => Math.round(255 * toSrgb(Math.max(0, Math.min(1, x)))).toString(16).padStart(2, "0")).join("");

function defaultOf(row) {
  const text = plain(row.default);
  if (row.type === "choice") return text;
  try {
    return JSON.parse(text.replace(/ .*/, (rest) => text.startsWith("[") ? rest : ""));
  } catch {
    return undefined;
  }
}
// As it fits a field; the scene keeps all digits.
const short = (value) => value === undefined || value === null ? "" : Number.isInteger(value) ? value : Number(value.toPrecision(4));
const threeOf = (value) =>
  typeof value === "string" ? fromHex(value) : Array.isArray(value) ? value : [value, value, value];

export class Knobs {
  // set(values, stroke): changes the scene; help(text): shows a line; step(message): asks the server for another change
  constructor(root, set, help, step) {
    Object.assign(this, {root, set, help, step, knobs: [], shape: "", opening: ""});
  }

  take(schema) {
    this.rows = new Map(schema.rows.map((row) => [`${row.section}.${row.key}`, row]));
    this.presets = new Map(schema.presets.map((preset) => [preset.name, preset]));
    this.shape = "";
  }

  // The path of an element of a list, by its name where that can stand in a path.
  pathOf(list, index) {
    const name = this.scene[list][index].name;
    return `${list}.${name && /^(?!\d+$)[\w-]+$/.test(name) ? name : index}`;  // digits alone are an index
  }

  formOf(medium) {
    return Object.keys(kForms).find((key) => key in medium) || "preset";
  }

  update(scene, edits) {
    this.scene = scene;
    if (!this.rows) return;
    const media = scene.media || {}, lights = scene.lights || [], shapes = scene.shapes || [];
    const shape = JSON.stringify([unusedOf(scene.camera), Object.entries(media).map(([name, m]) => [name, this.formOf(m), kOptional.filter((key) => key in m), objectsOf(m)]),
      lights.map((l) => [l.name, l.type, objectsOf(l)]), shapes.map((s) => [s.name, s.medium, [...kGloss, "emission"].filter((key) => key in s), objectsOf(s)])]);
    if (shape !== this.shape) this.build(scene);
    this.shape = shape;
    for (const knob of this.knobs) {
      knob.show(knob.value(scene));
      knob.root.classList.toggle("is-edited", edits.some((text) => [`${knob.path}=`, `${knob.path}.keyed.`].some((start) => text.startsWith(start))));
    }
  }

  build(scene) {
    const open = new Set([...this.root.querySelectorAll("details[open]")].map((d) => d.dataset.group));
    const first = !this.root.children.length;
    this.knobs = [];
    this.root.replaceChildren();
    const group = (name, title, rows) => {
      const details = make("details", {open: first ? /^(media|lights)/.test(name) : open.has(name) || name === this.opening}, make("summary", {textContent: title}), ...rows);
      details.dataset.group = name;
      this.root.append(details);
    };
    for (const name of Object.keys(scene.media || {})) group(`media.${name}`, `Medium ${name}`, this.mediumRows(name));
    (scene.lights || []).forEach((light, i) => group(`lights.${i}`, `Light ${light.name || i}`, this.rowsOf(`light.${light.type}`, this.pathOf("lights", i), (s) => s.lights[i], ["type", "name"]).concat(
      this.buttons([["Copy", {do: "lights", change: "copy", index: i}], ["Remove", {do: "lights", change: "remove", index: i}]]))));
    this.root.append(this.lightButtons());
    group("scene", "Scene", ["surroundings", "backdrop", "mm_per_unit"].map((key) => this.knob("scene", key, key, (s) => s[key])).concat(this.floorRow()));
    (scene.shapes || []).forEach((shape, i) => group(`shapes.${i}`, `Shape ${shape.name || i}`, [...this.materialRow(i), this.sizeRow(i),
      ...[...("medium" in shape ? [] : ["reflectance", ...kGloss.filter((key) => key in shape), "shadow_catcher"]), ...("emission" in shape ? ["emission"] : []), "normals", "visible"].map((key) =>
        this.knob("shape", key, `${this.pathOf("shapes", i)}.${key}`, (s) => s.shapes[i][key])), ...this.placementRows(i)]));
    group("camera", "Camera", this.rowsOf("camera", "camera", (s) => s.camera, unusedOf(scene.camera)));
    group("film", "Image", this.rowsOf("film", "film", (s) => s.film));
    group("settings", "Method", this.rowsOf("settings", "settings", (s) => s.settings, ["laboratory"]));
    group("laboratory", "Laboratory", this.rowsOf("settings.laboratory", "settings.laboratory", (s) => (s.settings || {}).laboratory));
  }

  buttons(messages) {
    return make("p", {className: "buttons"}, ...messages.map(([textContent, message]) =>
      make("button", {type: "button", textContent, onclick: () => this.step(message)})));
  }

  // The maps of the server's scene; a choice replaces all lights.
  lightButtons() {
    const root = this.buttons([["Add light", {do: "lights", change: "add", index: 0}]]);
    const choice = make("select", {ariaLabel: "Light by an environment map", title: "Replace all lights by an environment map beside the scene",
      onchange: () => this.step({do: "light_by", name: choice.value})});
    const show = (names) => {
      if (names.join("\n") === choice.dataset.names) return;
      choice.dataset.names = names.join("\n");
      choice.replaceChildren(new Option("Light by\u2026", ""), ...names.map((name) => new Option(name)));
      choice.hidden = !names.length;
    };
    root.append(choice);
    this.knobs.push({path: "environments", root, value: (s) => s.environments || [], show: (names) => { show(names); choice.value = ""; }});
    return root;
  }

  floorRow() {
    const input = make("input", {type: "checkbox", ariaLabel: "floor", onchange: () => this.step({do: "floor", on: input.checked})});
    const root = make("label", {className: "knob", title: "a diffuse floor just below all shapes"}, make("span", {className: "name", textContent: "floor"}), make("span", {className: "inputs"}, input));
    this.knobs.push({path: "floor", root, value: (s) => s.floor, show: (isOn) => { input.checked = Boolean(isOn); }});
    return root;
  }

  // Largest extent of a shape; the whole scene is scaled.
  sizeRow(i) {
    const size = () => {
      const box = this.boxes?.[i];
      return box ? Math.max(...box[1].map((x, k) => x - box[0][k])) * (this.scene.mm_per_unit ?? 1) : undefined;
    };
    const row = {key: "size", type: "number", unit: "mm", default: "", range: [1e-6, 1e9], slider: [0, 1],
      meaning: "largest extent of the shape; changes mm_per_unit, the size of the whole scene"};
    const knob = this.knob("scene", "mm_per_unit", `shapes.${i}.size`, size, {row,
      set: (wanted, stroke) => size() > 0 && wanted > 0 && this.set({mm_per_unit: rounded((this.scene.mm_per_unit ?? 1) * wanted / size())}, stroke)});
    this.knobs[this.knobs.length - 1].path = "mm_per_unit";
    return knob;
  }

  nameRow(name) {
    const input = make("input", {ariaLabel: `media.${name} name`, spellcheck: false, autocomplete: "off", onchange: () => {
      shown = null;
      this.opening = `media.${input.value}`;
      this.step({do: "rename_medium", name, to: input.value});
    }});
    let shown = null;  // a name stays while it is typed
    const root = make("label", {className: "knob", title: "name of the medium; shapes and layers of it follow"}, make("span", {className: "name", textContent: "name"}), input);
    this.knobs.push({path: `media.${name}.name`, root, value: () => name, show: () => {
      if (shown !== name) input.value = name;
      shown = name;
    }});
    return root;
  }

  // Last steps of the transform, as numbers.
  placementRows(i) {
    const path = `${this.pathOf("shapes", i)}.transform`, now = (scene) => placementOf(scene.shapes[i].transform);
    const row = (section, key, change, value, changed) => {
      const knob = this.knob(section, key, `${path}.${change.key ?? key}`, (s) => value(now(s)), {row: {type: "triple", unit: "", default: "", ...change},
        set: (numbers, stroke) => this.set({[path]: stepsOf(changed(now(this.scene), numbers))}, stroke)});
      this.knobs[this.knobs.length - 1].path = path;
      return knob;
    };
    return [row("shape.transform", "translate", {unit: "scene units"}, ({move}) => move, movedTo),
      row("shape.transform.rotate", "degrees", {key: "rotate", unit: "degrees", meaning: "rotates about the x axis, then y, then z"}, turnOf, turnedTo),
      row("shape.transform", "scale", {}, ({scale}) => scale, scaledTo)];
  }

  // Opens a group and moves to it.
  reveal(name) {
    const group = this.root.querySelector(`details[data-group="${name}"]`);
    if (!group) return;
    group.open = true;
    group.scrollIntoView({block: "start", behavior: "smooth"});
    group.firstElementChild.focus({preventScroll: true});
  }

  rowsOf(section, path, owner, without = []) {
    return [...this.rows.values()].filter((row) => row.section === section && !without.includes(row.key))
      .map((row) => this.knob(section, row.key, `${path}.${row.key}`, (s) => (owner(s) || {})[row.key]));
  }

  // Opaque, a medium of the scene, or a preset, added to the scene.
  materialRow(i) {
    const media = Object.keys(this.scene.media || {}), path = `${this.pathOf("shapes", i)}.medium`;
    const choose = (name) => {
      const added = name && !media.includes(name) ? {[`media.${name}`]: this.presets.get(name).chosen} : {};
      this.set(name ? {...added, [path]: name} : {[path.replace(/medium$/, "reflectance")]: .5}, newStroke());
    };
    const group = (label, names) => names.length ? [make("optgroup", {label}, ...names.map((name) => make("option", {textContent: name})))] : [];
    const presets = (isMeasured) => [...this.presets.values()].filter((preset) => preset.is_measured === isMeasured && !media.includes(preset.name)).map(({name}) => name);
    const select = make("select", {ariaLabel: path, onchange: () => choose(select.value)}, make("option", {value: "", textContent: "opaque"}),
      ...group("media of the scene", media), ...group("measured media", presets(true)), ...group("looks, by eye", presets(false)));
    const buttons = [...this.presets.keys()].map((name, at) => {
      const button = make("button", {type: "button", title: name, ariaLabel: `${path} ${name}`, onclick: () => choose(name)});
      button.style.backgroundPosition = `${-kThumbnail * (at % kThumbnailsARow)}px ${-kThumbnail * Math.floor(at / kThumbnailsARow)}px`;
      return button;
    });
    const root = make("label", {className: "knob", title: "opaque, or a translucent medium inside a closed mesh"},
      make("span", {className: "name", textContent: "material"}), select);
    this.knobs.push({path, root, value: (s) => s.shapes[i].medium, show: (medium) => {
      select.value = medium || "";
      for (const button of buttons) button.setAttribute("aria-pressed", String(button.title === medium));
    }});
    return [root, make("div", {className: "presets", role: "group", ariaLabel: "presets"}, ...buttons)];
  }

  mediumRows(name) {
    const medium = this.scene.media[name], form = this.formOf(medium), path = `media.${name}`;
    const select = make("select", {}, ...Object.entries(kForms).map(([key, {name: text}]) => make("option", {value: key, textContent: text})));
    select.value = form;
    select.onchange = () => this.set({[path]: this.converted(name, select.value)}, newStroke());
    return [this.nameRow(name), make("label", {className: "knob"}, make("span", {className: "name", textContent: "defined by"}), select),
      ...[...kForms[form].keys, "specular_ior", "specular_roughness", "specular_weight", "profile", ...kOptional.filter((key) => key in medium)].map((key) => this.knob("medium", key, `${path}.${key}`, (s) => s.media[name][key]))];
  }

  // The same medium in another form, or where there is no telling one to start from.
  converted(name, form) {
    const medium = this.scene.media[name], preset = this.presets.get(medium.preset) || {};
    const start = {sigma_a: preset.sigma_a || medium.sigma_a || .01};
    const made = {
      preset: {preset: "marble"},
      sigma_s_prime: {...start, sigma_s_prime: preset.sigma_s_prime || medium.sigma_s || 2},
      sigma_s: {...start, sigma_s: preset.sigma_s_prime || medium.sigma_s_prime || 2},
      subsurface_color: {subsurface_color: [.8, .7, .6], subsurface_radius: 1},
    }[form];
    const boundary = {specular_ior: medium.specular_ior || preset.specular_ior, specular_roughness: medium.specular_roughness ?? preset.specular_roughness};
    for (const [key, value] of Object.entries(boundary)) if (value && form !== "preset") made[key] = value;
    return {...made, ...(medium.profile ? {profile: medium.profile} : {}), ...(medium.fit ? {fit: medium.fit} : {})};
  }

  // change: other parts of the row, and a setter of the value
  knob(section, key, path, value, change = {}) {
    const row = {...this.rows.get(`${section}.${key}`), ...change.row};
    const knob = {path, row, value: (scene) => value(scene)};
    const set = change.set || ((now, stroke) => this.set({[path]: now}, stroke));
    const inputs = this.inputs(knob, (now, stroke = newStroke()) => set(now, stroke));
    const range = kNumbers.concat(kColours).includes(row.type) && Math.abs(row.range[1]) < 1e29 ? `, ${row.range[0]} to ${row.range[1]}` : "";
    const unit = row.unit || (["length", "point"].includes(row.type) ? "scene units" : "");
    const help = `${row.key}: ${plain(row.meaning)}${unit ? ` [${unit}]` : ""}${range}${row.default ? `; default ${plain(row.default)}` : ""}`;
    knob.root = make("div", {className: "knob", title: help}, make("span", {className: "name", textContent: row.key.replaceAll("_", " ")}), inputs);
    knob.root.role = "group";
    knob.root.setAttribute("aria-label", `${path}, ${unit}`);
    if (row.unit && row.unit.length < 14) inputs.append(make("span", {className: "unit", textContent: row.unit}));
    knob.root.addEventListener("focusin", () => this.help(help));
    knob.root.addEventListener("pointerenter", () => this.help(help));
    this.knobs.push(knob);
    return knob.root;
  }

  inputs(knob, set) {
    const {row} = knob, box = make("span", {className: "inputs"});
    if (isObject(knob.value(this.scene))) this.text(knob, box);
    else if (row.type === "flag") this.flag(knob, box, set);
    else if (row.type === "choice") this.choice(knob, box, set);
    else if (kNumbers.includes(row.type)) this.number(knob, box, set);
    else if (kColours.includes(row.type)) this.colour(knob, box, set);
    else if (row.type === "text") this.text(knob, box);
    else this.list(knob, box, set, kThrees.includes(row.type) ? ["x", "y", "z"] : kLists[row.key]);
    return box;
  }

  flag(knob, box, set) {
    const input = make("input", {type: "checkbox", ariaLabel: knob.row.key, onchange: () => set(input.checked)});
    knob.show = (value) => { input.checked = value ?? defaultOf(knob.row); };
    box.append(input);
  }

  // Files are those of the scene.
  text(knob, box) {
    const output = make("output", {ariaLabel: knob.row.key});
    knob.show = (value) => { output.textContent = isObject(value) ? textOf(value) : value ?? ""; };
    box.append(output);
  }

  choice(knob, box, set) {
    const select = make("select", {ariaLabel: knob.row.key, onchange: () => set(select.value)}, ...knob.row.choices.map((word) => make("option", {textContent: word})));
    knob.show = (value) => { select.value = value ?? defaultOf(knob.row); };
    box.append(select);
  }

  // Linear over a range that has ends, else over a decade to each side of the value that it is taken at.
  slider(row, now, change) {
    const isLinear = row.range[1] - row.range[0] <= kWidestLinear;
    const input = make("input", {type: "range", ariaLabel: `${row.key}, slider`, step: "any",
      min: isLinear ? row.slider[0] : -kDecade, max: isLinear ? row.slider[1] : kDecade});
    let stroke = 0, base = 1;
    const value = () => {
      const x = isLinear ? Number(input.value) : base * 10 ** Number(input.value);
      return row.type === "whole_number" ? Math.max(row.range[0], Math.round(x)) : rounded(x);
    };
    input.oninput = () => {
      if (!stroke) [stroke, base] = [newStroke(), now() || 1e-3];
      change(value(), stroke, base);
    };
    input.onchange = () => {
      if (stroke) change(value(), stroke, base);
      stroke = 0;
      if (!isLinear) input.value = 0;
    };
    return {input, show: (x) => { if (!stroke) input.value = isLinear ? x ?? row.range[0] : 0; }};
  }

  number(knob, box, set) {
    const {row} = knob;
    let now = 0, shown = null;  // a value stays while it is typed
    const input = make("input", {type: "number", ariaLabel: row.key, step: row.type === "whole_number" ? 1 : "any",
      placeholder: plain(row.default).slice(0, 20)});
    input.onchange = () => {
      shown = null;
      if (input.value !== "") set(Number(input.value));
    };
    const slider = this.slider(row, () => now, (value, stroke) => set(value, stroke));
    knob.show = (value) => {
      now = value ?? this.presetOf(knob)?.[row.key] ?? defaultOf(row);
      if (now !== shown) input.value = short(now);
      shown = now;
      slider.show(now);
    };
    box.append(slider.input, input);
  }

  // Values of a medium without keys of its own.
  presetOf(knob) {
    if (knob.row.section !== "medium") return undefined;
    return this.presets.get(this.scene.media[knob.path.split(".")[1]]?.preset) ?? {specular_ior: 1.3, specular_roughness: 0};
  }

  // One field a number; set(values): with the one that was typed and the others as the scene has them, `now()`, or as
  // they stand in their fields where it has none, once all are there.
  numbers(row, names, now, set) {
    const inputs = names.map((name, typed) => make("input", {type: "number", step: "any", ariaLabel: `${row.key} ${name}`, title: name,
      onchange: () => {
        const known = now() ?? [];
        const values = inputs.map((input, i) => i === typed || known[i] === undefined ? input.value : known[i]);
        if (values.every((value) => value !== "")) set(values.map(Number));
      }}));
    return inputs;
  }

  colour(knob, box, set) {
    const {row} = knob;
    const colourNow = () => threeOf(knob.value(this.scene) ?? defaultOf(row) ?? 0);
    const inputs = this.numbers(row, ["red", "green", "blue"], () => rounded(colourNow()), set);
    const top = () => Math.max(...colourNow()) || 1;
    const slider = this.slider({...row, type: "number"}, top, (value, stroke, base) => {
      slider.from ||= colourNow();
      set(rounded(slider.from.map((x) => base === 1e-3 ? value : x * value / Math.max(...slider.from))), stroke);
    });
    slider.input.addEventListener("change", () => { slider.from = null; });
    knob.show = () => {
      const now = colourNow();
      now.forEach((x, i) => { inputs[i].value = short(x); });
      slider.show(top());
      if (row.type === "color") swatch.value = toHex(now.map((x) => x / Math.max(row.range[1] <= 1 ? 1 : top(), 1e-30)));
    };
    const swatch = make("input", {type: "color", ariaLabel: `${row.key}, colour`});
    let stroke = 0;
    swatch.oninput = () => set(rounded(fromHex(swatch.value).map((x) => x * (row.range[1] <= 1 ? 1 : top()))), stroke ||= newStroke());
    swatch.onchange = () => { stroke = 0; };
    box.append(slider.input, ...(row.type === "color" ? [swatch] : []), make("span", {className: "three"}, ...inputs));
  }

  list(knob, box, set, names) {
    const listNow = () => knob.value(this.scene) ?? defaultOf(knob.row);
    const inputs = this.numbers(knob.row, names, listNow, set);
    knob.show = () => {
      const now = listNow() ?? [];
      inputs.forEach((input, i) => { input.value = short(now[i]); });
    };
    box.append(make("span", {className: "three"}, ...inputs));
  }
}
