// SPDX-License-Identifier: GPL-3.0-or-later
// Elements, tables and charts of all reports. Text of the data reaches the page as text nodes alone.
"use strict";
const report = JSON.parse(document.getElementById("data").textContent);
const note = (key) => (report.notes.find(([name]) => name === key) ?? ["", ""])[1];

const el = (tag, attributes, ...children) => {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes ?? {})) node.setAttribute(name, value);
  node.append(...children);
  return node;
};

// Three digits: 0.0012, 0.0123, 1.23, 123, 12345.
const figure = (value) =>
  value === 0 ? "0" : value.toFixed(Math.min(4, Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value))))));

// Columns and cells are strings or elements; a column [head, unit] has its unit below.
const isCell = (cell) => /^T[DH]$/.test(cell.tagName);
const table = (columns, rows, name = "") => {
  const heads = columns.map((column) => isCell(column) ? column : el("th", {scope: "col"}, ...[column].flat().map((text, i) => i ? el("small", {}, text) : text)));
  const lines = rows.map((cells) => el("tr", {}, ...cells.map((cell) => isCell(cell) ? cell : el("td", {}, cell))));
  return el("div", {class: "scroll"},
    el("table", {class: name}, el("thead", {}, el("tr", {}, ...heads)), el("tbody", {}, ...lines)));
};

// A row's name behind the colour of its series.
const nameCell = (name, colour, ...more) =>
  el("th", {scope: "row"}, el("i", colour === undefined ? {} : {style: `background: var(--c${colour % 10})`}), name, ...more);

const notes = (...links) => el("section", {},
  el("h2", {}, "How it was measured"),
  el("dl", {}, ...report.notes.flatMap(([key, value]) => [el("dt", {}, key), el("dd", {}, value)])),
  el("p", {}, "All figures: ", ...links.flatMap((file, i) => [i ? ", " : "", el("a", {href: file}, file)]), "."));

const show = (title, heading, intro, ...sections) => {
  document.title = `${title} – opaline ${report.command}`;
  const threads = note("threads");
  const lead = `${note("version")}, ${note("cpu")}, ${threads} thread${threads === "1" ? "" : "s"}, ${note("date")}`;
  document.body.append(el("header", {}, el("h1", {}, heading), el("p", {class: "sub"}, lead), el("p", {}, intro)),
    el("main", {}, ...sections));
  drawn.forEach((draw) => draw());
};

// Charts

Object.assign(Chart.defaults.font, {size: 13, family: getComputedStyle(document.body).fontFamily});
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const seriesColour = (index) => colour(`c${index % 10}`);
const dashes = [[], [], [9, 4], [2, 4], [12, 4, 2, 4], [5, 3], [12, 3, 2, 3, 2, 3], [3, 2], [16, 3], [7, 2, 2, 2]];

// Points are {x, y} and, where known, {error}: one standard error, {text} for the tooltip, {row} of the data.
const curve = (label, index, data) =>
  ({label, data, borderColor: seriesColour(index), borderWidth: 2, borderDash: dashes[index % 10], pointStyle: "line",
    pointRadius: 0, pointHoverRadius: 0, pointHitRadius: 8});
const dots = (label, index, data, isHollow) =>
  ({label, data, showLine: false, borderColor: seriesColour(index), borderWidth: 1.2, pointRadius: 3,
    pointBackgroundColor: isHollow ? colour("paper") : seriesColour(index), order: -1});
const guide = (data, label = "") =>
  ({label, data, borderColor: colour("soft"), borderWidth: 1, borderDash: [2, 4], pointStyle: "line", pointRadius: 0,
    pointHitRadius: 0, order: 9});

// Round tick values: steps of 1, 2, 5; whole decades on long axes, all digits on short ones.
const roundTicks = (low, high) => {
  const ticks = (...digits) => {
    const all = [];
    for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high); ++decade)
      all.push(...digits.map((digit) => digit * 10 ** decade).filter((value) => value >= low && value <= high));
    return all;
  };
  const all = ticks(1, 2, 5);
  return all.length > 9 ? ticks(1) : all.length > 2 ? all : ticks(1, 2, 3, 4, 5, 6, 7, 8, 9);
};

// A logarithmic axis has `min` and `max`.
const axis = ({title, unit = "", min, max, isLinear}) => ({
  type: isLinear ? "linear" : "logarithmic", min, max, grace: "15%",
  title: {display: true, text: title, color: colour("ink")},
  grid: {color: colour("rule"), borderColor: colour("rule")},
  ticks: {color: colour("soft"), maxTicksLimit: 11, callback: (value) => Number(value.toPrecision(4)) + unit},
  afterBuildTicks: (scale) => { if (!isLinear) scale.ticks = roundTicks(min, max).map((value) => ({value})); },
});

const background = {id: "background", beforeDraw: ({ctx, width, height}) => {
  ctx.fillStyle = colour("paper");
  ctx.fillRect(0, 0, width, height);
}};
const errorBars = {id: "errorBars", beforeDatasetDraw: ({ctx, chartArea: area, scales: {x, y}, data}, {index}) => {
  const set = data.datasets[index];
  ctx.save();
  ctx.beginPath();
  ctx.rect(area.left, area.top, area.width, area.height);
  ctx.clip();
  ctx.beginPath();
  for (const point of set.data.filter(({error}) => error > 0)) {
    ctx.moveTo(x.getPixelForValue(point.x), y.getPixelForValue(Math.max(point.y - point.error, y.min)));
    ctx.lineTo(x.getPixelForValue(point.x), y.getPixelForValue(point.y + point.error));
  }
  ctx.strokeStyle = set.borderColor;
  ctx.stroke();
  ctx.restore();
}};

const listed = (chart) => Chart.defaults.plugins.legend.labels.generateLabels(chart).filter(({text}) => text).map((item) => {
  const {borderDash, pointBackgroundColor: fill, pointBorderColor} = chart.data.datasets[item.datasetIndex];
  return {...item, fontColor: colour("ink"), lineDash: borderDash?.map((length) => length / 2),
    fillStyle: typeof fill === "function" ? pointBorderColor : item.fillStyle};
});

const drawn = [];  // functions drawing the charts, repeated for the other colour scheme
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => drawn.forEach((draw) => draw()));

// describe(): {x, y, datasets, legend}, with the legend's position, called for each colour scheme pick(row):
// called for a chosen point group: charts sharing hidden and visible series with this chart's legend
const chart = (title, describe, {pick, group = []} = {}) => {
  const canvas = el("canvas", {tabindex: 0, role: "img", "aria-label": title}), status = el("p", {role: "status", class: "unseen"});
  const isWide = describe().legend;
  const text = (point, label) => {
    const {x, y} = describe(), digits = (value) => Number(value.toPrecision(3));
    return point.text ?? `${label}\n${x.title}: ${digits(point.x)}\n${y.title}: ${digits(point.y)}${point.error ? ` ± ${digits(point.error)}` : ""}`;
  };
  let now = null;
  const toggle = (event, item) => {
    for (const one of group.map((get) => get())) {
      const index = one.data.datasets.findIndex((set) => set.label === item.text);
      if (index >= 0) one.setDatasetVisibility(index, item.hidden);
      one.update();
    }
  };
  const draw = () => {
    const {x, y, datasets, legend} = describe();
    now?.destroy();
    now = new Chart(canvas, {
      type: "line", data: {datasets}, plugins: [background, errorBars],
      options: {
        animation: false, maintainAspectRatio: false, scales: {x: axis(x), y: axis(y)},
        interaction: {mode: "nearest", intersect: true},
        onClick: (event, [hit]) => { if (hit) pick?.(datasets[hit.datasetIndex].data[hit.index].row); },
        plugins: {
          legend: {display: Boolean(legend), position: innerWidth > 1000 ? legend : "bottom", onClick: toggle,
            labels: {usePointStyle: true, boxHeight: 10, padding: 12, font: {size: 12}, generateLabels: listed}},
          tooltip: {displayColors: false, yAlign: "bottom", caretPadding: 8, callbacks: {title: () => "", label: ({raw, dataset}) => text(raw, dataset.label).split("\n")}},
        },
      },
    });
  };
  group.push(() => now);
  drawn.push(draw);

  let place = -1;
  canvas.addEventListener("keydown", (event) => {
    const sets = now.data.datasets;
    const points = sets.flatMap(({label, data, pointHitRadius}, datasetIndex) =>
      label && pointHitRadius !== 0 && now.isDatasetVisible(datasetIndex) ? data.map((_, index) => ({datasetIndex, index})) : []);
    const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[event.key];
    if (points.length === 0 || (!step && (event.key !== "Enter" || place < 0))) return;
    event.preventDefault();
    if (step) place = (Math.max(place, step < 0 ? 0 : -1) + step + points.length) % points.length;
    const {datasetIndex, index} = points[place], point = sets[datasetIndex].data[index];
    if (!step) return pick?.(point.row);
    now.setActiveElements([points[place]]);
    now.tooltip.setActiveElements([points[place]], now.getDatasetMeta(datasetIndex).data[index]);
    now.update();
    status.textContent = text(point, sets[datasetIndex].label);
  });
  return el("figure", {}, el("div", {class: isWide ? "chart wide" : "chart"}, canvas), status, el("figcaption", {}, title));
};
