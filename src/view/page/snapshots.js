// SPDX-License-Identifier: GPL-3.0-or-later
// Strip of images kept by the page, each with its edits, its cost and its error: to go back to, and to compare.
import {make} from "./knobs.js";
import {draw} from "./picture.js";
import {few, secondsText} from "./trade.js";

const kMost = 12, kMostBytes = 2 ** 29;  // the oldest ones go
const kHeight = 64;

function thumbnailOf(picture, display) {
  const full = document.createElement("canvas"), height = kHeight, width = Math.max(1, Math.round(height * picture.width / picture.height));
  draw(picture, full, {...display, channel: ""});
  const thumbnail = make("canvas", {width, height});
  thumbnail.getContext("2d").drawImage(full, 0, 0, width, height);
  return thumbnail;
}

export class Snapshots {
  // root: the strip; recall(snapshot): shows its scene again; compare({left, right}): pictures beside the wipe
  constructor(root, recall, compare) {
    Object.assign(this, {root, recall, compare, all: [], count: 0, sides: {left: null, right: null}});
  }

  // frame: an image; scene: {edits, look, frame}; report: of this image, or null
  add(frame, display, scene, report) {
    const picture = {...frame, layer: null, channels: 0, colours: frame.colours.slice()};
    const cost = report && secondsText(report.costs.reduce((sum, {cpu}) => sum + cpu, 0));
    const texts = report ? [cost, ...(report.error > 0 ? [`${few(100 * report.error)} %`] : [])] : [frame.step];
    this.all.push({...scene, picture, number: ++this.count, text: texts.join(", "), thumbnail: thumbnailOf(frame, display)});
    const bytes = () => this.all.reduce((sum, one) => sum + one.picture.colours.byteLength, 0);
    while (this.all.length > kMost || (this.all.length > 1 && bytes() > kMostBytes)) this.remove(this.all[0]);
    this.show();
    this.root.lastChild.scrollIntoView({block: "nearest", inline: "end"});
  }

  remove(snapshot) {
    this.all = this.all.filter((other) => other !== snapshot);
    for (const side of ["left", "right"]) if (this.sides[side] === snapshot) this.put(side, null);
    this.show();
  }

  clear() {
    this.all = [];
    this.forget("left");
    this.forget("right");
  }

  // Puts a snapshot on a side of the wipe, or takes it away.
  put(side, snapshot) {
    this.sides[side] = this.sides[side] === snapshot ? null : snapshot;
    this.compare({[side]: this.sides[side]?.picture ?? null});
    this.show();
  }

  // Another picture is on this side now.
  forget(side) {
    this.sides[side] = null;
    this.show();
  }

  show() {
    this.root.hidden = !this.all.length;
    this.root.replaceChildren(...this.all.map((snapshot) => this.card(snapshot)));
  }

  card(snapshot) {
    const {number, edits, text} = snapshot, name = `Snapshot ${number}`;
    const title = `${name}: ${text || "no costs yet"}\n${edits.join("\n") || "no edits"}\nClick to restore`;
    const side = (word) => {
      const button = make("button", {type: "button", textContent: word, title: `${name} on the ${word} of the wipe`, onclick: () => this.put(word, snapshot)});
      button.setAttribute("aria-label", `${name} on the ${word} of the wipe`);
      button.setAttribute("aria-pressed", String(this.sides[word] === snapshot));
      return button;
    };
    const restore = make("button", {type: "button", className: "restore", title, onclick: () => this.recall(snapshot)}, snapshot.thumbnail);
    restore.setAttribute("aria-label", `Restore snapshot ${number}, ${text}`);
    const gone = make("button", {type: "button", textContent: "×", title: `Remove snapshot ${number}`, onclick: () => this.remove(snapshot)});
    gone.setAttribute("aria-label", `Remove snapshot ${number}`);
    return make("figure", {}, restore, make("figcaption", {}, make("b", {textContent: number}), ` ${text}`),
      make("span", {className: "sides"}, side("left"), side("right"), gone));
  }
}
