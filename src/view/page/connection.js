// SPDX-License-Identifier: GPL-3.0-or-later
// Reconnects when the server is gone, and sends this page's edits, frame and camera to a new server.

const kFirstWait = 250, kLongestWait = 4000;  // ms
export const kPause = 400;                    // ms without edits until a new stroke begins

export class Connection {
  // handlers: {text(message), frame(buffer), lost(), found()}
  constructor(handlers) {
    this.handlers = handlers;
    this.wait = kFirstWait;
    this.edits = [];
    this.isNew = true;
    this.waiting = {};
    this.waitingLook = null;
    this.open();
  }

  open() {
    const url = new URL("socket", location.href);
    url.protocol = url.protocol.replace("http", "ws");
    this.socket = new WebSocket(url);
    this.socket.binaryType = "arraybuffer";
    this.socket.onmessage = (event) => this.receive(event.data);
    this.socket.onclose = () => {
      this.handlers.lost();
      this.isNew = true;
      setTimeout(() => this.open(), this.wait);
      this.wait = Math.min(2 * this.wait, kLongestWait);
    };
  }

  receive(data) {
    if (typeof data !== "string") return this.handlers.frame(data);
    const message = JSON.parse(data);
    if (message.is === "scene") {
      if (this.isNew) {
        const isRestarted = message.revision === 1 && message.path === this.path;
        if (isRestarted && this.frame !== undefined && this.frame !== message.frame) this.toFrame = this.frame;
        if (isRestarted) this.toLook = this.lastLook;
        this.isNew = false;
        this.wait = kFirstWait;
        this.handlers.found();
        if (isRestarted && this.edits.length) {
          this.send({do: "restore", edits: this.edits});
          this.edits = [];  // sent once: a server may refuse them
          return;
        }
      }
      if (this.toFrame !== undefined) this.send({do: "frame", frame: this.toFrame});
      if (this.toLook) this.look(this.toLook);
      this.toFrame = this.toLook = undefined;
      this.edits = message.edits;
      this.path = message.path;
      this.frame = message.frame;
      this.lastLook = message.look;
    }
    this.handlers.text(message);
  }

  // Sends pending values first.
  send(message) {
    this.flush();
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  // Values of one stroke, sent together after a moment.
  set(values, stroke) {
    if (this.stroke !== stroke) this.flush();
    this.stroke = stroke;
    requestAnimationFrame(() => this.flush());
    Object.assign(this.waiting, values);
  }

  // The view's own camera: only the last one within a moment.
  look(camera) {
    this.waitingLook = camera;
    requestAnimationFrame(() => this.flush());
  }

  flush() {
    const values = this.waiting, look = this.waitingLook;
    this.waiting = {};
    this.waitingLook = null;
    if (Object.keys(values).length) this.send({do: "set", values, stroke: this.stroke});
    if (look) this.send({do: "look", ...look});
  }
}

export const newStroke = () => 1 + Math.floor(Math.random() * 2 ** 52);

// One stroke for successive turns of a wheel or presses of a key.
export function pausedStroke() {
  let stroke = 0, end = 0;
  return () => {
    stroke ||= newStroke();
    clearTimeout(end);
    end = setTimeout(() => { stroke = 0; }, kPause);
    return stroke;
  };
}
