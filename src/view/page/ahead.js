// SPDX-License-Identifier: GPL-3.0-or-later
// Edits of this page take precedence over the server's scene until a moment after the last edit: incoming
// scenes may be older, and the next edit builds on them.
import {kPause} from "./connection.js";

// Copy of a scene, or of a part of it, with the value at a path as in `--set`.
function withValue(owner, [key, ...rest], value) {
  const copy = Array.isArray(owner) ? [...owner] : {...owner};
  const named = Array.isArray(owner) ? owner.findIndex((element) => element.name === key) : -1;
  const at = named < 0 ? key : named;
  copy[at] = rest.length ? withValue(copy[at], rest, value) : value;
  return copy;
}

export class Ahead {
  // over(): called once the server's scene takes precedence again, except after `clear`, when the server
  // sends it anyway
  constructor(over) {
    Object.assign(this, {over, values: {}, end: 0});
  }

  add(values) {
    for (const [path, value] of Object.entries(values)) {
      for (const old of Object.keys(this.values)) if (`${old}.`.startsWith(`${path}.`)) delete this.values[old];
      this.values[path] = value;
    }
    clearTimeout(this.end);
    this.end = setTimeout(() => {
      this.clear();
      this.over();
    }, kPause);
  }

  clear() {
    clearTimeout(this.end);
    this.values = {};
  }

  of(scene) {
    return Object.entries(this.values).reduce((all, [path, value]) => withValue(all, path.split("."), value), scene);
  }
}
