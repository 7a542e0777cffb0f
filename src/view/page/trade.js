// SPDX-License-Identifier: GPL-3.0-or-later
// Error against time of this scene's settings, one selectable point each.

const kWidth = 340, kHeight = 190, kLeft = 44, kRight = 12, kTop = 12, kBottom = 30;

const svg = (name, attributes, text = "") => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.textContent = text;
  return element;
};

export const few = (x) => Number(x.toPrecision(2)).toString();
export const secondsText = (s) => s < .1 ? `${few(1000 * s)} ms` : `${few(s)} s`;
const errorText = (e) => `${few(100 * e)} %`;

// 1, 2 and 5 times powers of ten within a range; the powers alone where those are many.
function ticksOf(low, high) {
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power)
    for (const digit of [1, 2, 5]) ticks.push(digit * 10 ** power);
  const within = ticks.filter((x) => x >= low && x <= high);
  return within.length <= 7 ? within : within.filter((x) => Number.isInteger(Math.round(1e6 * Math.log10(x)) / 1e6));
}

// Logarithmic axis with a margin. from, to: pixels of the ends.
function axisOf(values, from, to) {
  const low = Math.min(...values) / 1.3, high = Math.max(...values) * 1.3;
  const at = (x) => from + (to - from) * Math.log(x / low) / Math.log(high / low);
  return {at, ticks: ticksOf(low, high)};
}

export const nameOf = (point) => point.method === "lambert" ? "lambert"
  : `${point.samples.toLocaleString("en")} samples, tolerance ${point.values["settings.tolerance"]}`;

// Dominated settings, slower and less accurate than another, are not offered. Times are noisy: differences
// below a twentieth are ignored.
const isNoChoice = (point, points) =>
  points.some((other) => 1.05 * other.seconds < point.seconds && 1.05 * other.error < point.error);

export class Trade {
  // root: receives the chart; take(point): called for a chosen point
  constructor(root, take) {
    Object.assign(this, {root, take});
  }

  // message: of the server
  show(message) {
    const focused = this.root.querySelector(":focus")?.dataset.index;
    this.root.replaceChildren();
    if (!message.points.length) {
      this.root.append(Object.assign(document.createElement("p"),
        {textContent: message.whole ? "No translucent object is visible." : "Trying settings…"}));
      return;
    }
    const chart = svg("svg", {viewBox: `0 0 ${kWidth} ${kHeight}`, class: "trade", role: "group", "aria-label": "Error against time"});
    const x = axisOf(message.points.map((p) => p.seconds), kLeft, kWidth - kRight);
    const y = axisOf(message.points.map((p) => p.error), kHeight - kBottom, kTop);
    for (const tick of x.ticks) {
      chart.append(svg("line", {class: "grid", x1: x.at(tick), x2: x.at(tick), y1: kTop, y2: kHeight - kBottom}),
        svg("text", {x: x.at(tick), y: kHeight - kBottom + 13, "text-anchor": "middle"}, secondsText(tick)));
    }
    for (const tick of y.ticks) {
      chart.append(svg("line", {class: "grid", x1: kLeft, x2: kWidth - kRight, y1: y.at(tick), y2: y.at(tick)}),
        svg("text", {x: kLeft - 4, y: y.at(tick) + 4, "text-anchor": "end"}, errorText(tick)));
    }
    chart.append(svg("text", {x: kWidth - kRight, y: kHeight - 3, "text-anchor": "end"}, "CPU time per image"),
      svg("text", {x: kLeft - 4, y: kTop - 3, "text-anchor": "end"}, "error"));
    const summed = message.points.filter((p) => p.method !== "lambert" && !isNoChoice(p, message.points));
    chart.append(svg("polyline", {class: "curve", points: summed.map((p) => `${x.at(p.seconds)},${y.at(p.error)}`).join(" ")}));
    message.points.forEach((point, index) => {
      const mark = this.mark(point, index, x.at(point.seconds), y.at(point.error), index === message.now);
      mark.classList.toggle("poor", isNoChoice(point, message.points));
      chart.append(mark);
    });
    this.root.append(chart);
    this.root.querySelector(`[data-index="${focused}"]`)?.focus();
  }

  mark(point, index, x, y, isNow) {
    const text = `${nameOf(point)}: ${secondsText(point.seconds)}, error ${errorText(point.error)}${isNow ? "; in use" : ""}`;
    const mark = svg("circle", {cx: x, cy: y, r: 6, role: "button", tabindex: 0, "data-index": index, "aria-label": text, "aria-pressed": isNow});
    mark.append(svg("title", {}, text));
    mark.onclick = () => this.take(point);
    mark.onkeydown = (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      this.take(point);
    };
    return mark;
  }
}
