// SPDX-License-Identifier: GPL-3.0-or-later
// The page of `opaline bench`: for each scene error against time, images, tables.

// A figure of results.csv, with all digits in its title.
const measured = (row, column) => {
  const value = report.rows[row][column];
  return value === null ? el("td", {class: "none"}, "–")
    : el("td", {"data-row": row, "data-column": column, title: value}, figure(value));
};

const addressOf = (file) => file.split("/").map(encodeURIComponent).join("/");
const imageOf = (exr, ending) => addressOf(exr.replace(/\.[^.]*$/, "") + ending);

const describePoint = (point) => {
  const row = report.rows[point.row], ratio = row.job_ratio_median;
  return `${row.rung}\n${figure(point.cpu)} s CPU${ratio === null ? "" : `, ${figure(ratio)} × lambert`}\n` +
    `error ${point.below_noise ? "below " : ""}${figure(100 * point.error)} %${point.on_front ? ", on the Pareto front" : ""}`;
};

const marks = [["circle"], ["rect"], ["rectRot"], ["triangle"], ["triangle", 180], ["triangle", 90]];

const tradeChart = (scene, state, pick, group) => {
  const series = scene.series.map(({name, points}) =>
    ({name, points: points.map((point) => ({x: point.cpu, y: 100 * point.error, text: describePoint(point), ...point}))}));
  const points = series.flatMap((one) => one.points);
  const lambert = report.rows.find((row) => row.scene === scene.scene && row.method === "lambert")?.job_cpu_median;
  const span = (values) => ({min: Math.min(...values) / 1.35, max: Math.max(...values) * 1.35});
  const x = {title: "CPU time of the whole job, s", ...span([...points.map((point) => point.x), ...(lambert ? [lambert] : [])])};
  const y = {title: "error of the worst channel, rms", unit: " %", ...span([...points.map((point) => point.y), 1])};
  return chart("Error against CPU time", () => ({
    x, y, legend: "bottom",
    datasets: [
      ...series.map(({name, points}, s) => {
        const [pointStyle, pointRotation = 0] = marks[s % marks.length], ink = seriesColour(s);
        return {label: name, data: points, borderColor: ink + "99", borderWidth: 1.5, pointStyle, pointRotation,
          pointRadius: ({raw}) => raw?.row === state.row ? 8 : 6, pointHoverRadius: 9, pointBorderColor: ink, pointBorderWidth: 1.5,
          pointBackgroundColor: ({raw}) => raw?.below_noise ? colour("paper") : ink};
      }),
      {label: "Pareto front", data: points.filter((point) => point.on_front).sort((a, b) => a.x - b.x), borderColor: colour("front"),
        borderWidth: 11, borderCapStyle: "round", borderJoinStyle: "round", pointStyle: "line", pointRadius: 0, pointHitRadius: 0, order: 10},
      ...(lambert ? [guide([{x: lambert, y: y.min}, {x: lambert, y: y.max}], "cost of lambert")] : []),
      guide([{x: x.min, y: 1}, {x: x.max, y: 1}]),
    ],
  }), {pick, group});
};

const shownError = (row) => row.error_worst < row.error_floor_worst
  ? `less than ${figure(row.error_floor_worst)} %` : `${figure(row.error_worst)} %`;

// The answer before the figures: how far the models are from random walks, or the cost of an error of 1 %.
const answer = (scene, rows) => {
  const bold = (text) => el("b", {}, text), line = el("p", {class: "answer"});
  if (scene.truth) {
    const models = rows.map((row) => report.rows[row])
      .filter((row) => row.error_worst !== null && (row.rung === "hierarchical" || row.method === "volume_diffusion"));
    models.forEach((row, i) => line.append(i ? "; " : "Against random walks: ", "error ", bold(shownError(row)), " for ",
      bold(`${figure(row.job_cpu_median)} s`), ` CPU (${row.rung === "hierarchical" ? "as the scene has it" : row.rung})`));
    return line;
  }
  const costs = scene.series.map(({name, method}, s) => ({name, method, ...scene.cpu_to_one_percent[s]}))
    .filter(({kind}) => kind !== "none").sort((a, b) => a.value - b.value);
  const best = costs.find(({method}) => method !== "direct"), direct = costs.find(({method}) => method === "direct");
  if (!best) return line.append("No setting here reaches an error of 1 %."), line;
  const lambert = report.rows[rows[0]];
  line.append("An error of 1 % costs ", bold(`${best.kind === "at_most" ? "at most " : ""}${figure(best.value)} s`), ` CPU (${best.name})`);
  if (lambert.method === "lambert" && lambert.job_cpu_median)
    line.append(", ", bold(figure(best.value / lambert.job_cpu_median)), " times a plain Lambert image");
  if (direct)
    line.append(`; direct takes ${direct.kind === "extrapolated" ? "about " : ""}${figure(direct.value)} s, `,
      bold(figure(direct.value / best.value)), " times as long");
  line.append(".");
  return line;
};

const viewer = (scene, rows, select) => {
  if (!rows.length) return [];
  const picture = el("img", {class: "picture", alt: "image at the chosen setting"});
  const errors = el("img", {class: "errors", alt: "error of the image at the chosen setting"});
  const wipe = el("input", {type: "range", min: 0, max: 100, value: 50}), percent = el("output", {}, "50 %");
  const root = el("div", {class: "viewer", style: `--shape: ${scene.resolution.join("/")}`},
    el("p", {class: "controls"}, el("label", {}, "Setting ", select), el("label", {}, "Wipe ", wipe), percent),
    el("div", {class: "pair"},
      el("figure", {}, el("div", {class: "wipe"}, el("img", {class: "reference", src: addressOf(scene.reference_picture), alt: "reference"}),
        picture, el("span", {class: "edge"})), el("figcaption", {}, "left: the setting; right: the reference")),
      el("figure", {}, errors, el("figcaption", {}, "error against the reference, whose noise is included",
        el("span", {class: "scale", style: `background: linear-gradient(to right, ${report.error_colours.join(", ")})`}),
        el("span", {class: "scale-ends"}, ...["0.01 %", "0.1 %", "1 %", "10 %", "100 %"].map((text) => el("span", {}, text)))))));
  wipe.addEventListener("input", () => {
    root.style.setProperty("--wipe", `${wipe.value}%`);
    percent.textContent = `${wipe.value} %`;
  });
  const change = () => {
    picture.src = imageOf(report.rows[select.value].picture, ".png");
    errors.src = imageOf(report.rows[select.value].picture, "-error.png");
  };
  select.append(...rows.map((row) => el("option", {value: row}, report.rows[row].rung)));
  select.value = rows.find((row) => report.rows[row].rung === "hierarchical") ?? rows[0];
  select.addEventListener("change", change);
  change();
  return [el("h3", {}, "Image and error"), root];
};

const estimate = ({kind, value}, scale) => kind === "none" ? el("td", {class: "none"}, "–")
  : ({at_most: "≤ ", extrapolated: "≈ "}[kind] ?? "") + figure(scale * value);

const targetTable = (scene, {targets, estimates}, unit, targetScale, scale) =>
  table(["setting", ...targets.map((target) => `${Number((targetScale * target).toPrecision(4))} ${unit}`)],
    scene.series.map(({name}, s) => [nameCell(name, s), ...estimates[s].map((one) => estimate(one, scale))]));

const tradeTables = (scene) => scene.series.length === 0 ? [] : [
  el("h3", {}, "Equal error"), el("p", {}, "CPU seconds to an error of"), targetTable(scene, scene.equal_error, "%", 100, 1),
  el("h3", {}, "Equal time"), el("p", {}, "Error, %, after CPU seconds"), targetTable(scene, scene.equal_time, "s", 1, 100),
  el("p", {class: "small"}, "Figures between two settings lie on the straight line of the chart (logarithm of the error over " +
    "logarithm of the time). ≤: the nearest setting is better already, or noise hides its error. ≈: ", el("em", {}, "direct"),
    " beyond its last setting, where the error falls with the root of the shading time. –: not reached.")];

const budgetTable = (scene) => {
  const parts = report.budget.filter((part) => part.scene === scene.scene);
  const most = Math.max(0.01, ...parts.map((part) => part.error_worst ?? 0)), decade = 10 ** Math.floor(Math.log10(most));
  const end = [1, 2, 5, 10].map((digit) => digit * decade).find((value) => value >= most * (1 - 1e-9));
  const words = (text, span = 1) => el("td", {class: "words", colspan: span}, text);
  const cells = (part) => part.failure ? [words(part.failure, 4)] : [figure(part.error_worst),
    el("td", {class: "bar"}, el("i", {style: `width: ${Math.max(0, 100 * part.error_worst / end)}%`})),
    (part.signed_worst > 0 ? "+" : "") + figure(part.signed_worst), figure(part.p99_worst)];
  return parts.length === 0 ? [] : [el("h3", {}, "Sources of error"),
    el("p", {}, "Each part alone: the scene's own setting against the converged one; worst channel. The parts need not add up."),
    table(["part", el("th", {class: "words"}, "change"), ["error", "%"], el("th", {class: "bar"}, `0 to ${Number(end.toPrecision(4))} %`), ["signed", "%"], ["p99", "%"]],
      parts.map((part) => [el("th", {scope: "row"}, part.part), words(part.setting), ...cells(part)])),
    el("p", {class: "small"}, "The model's part is measured against the diffusion equation solved inside the bodies, " +
      "which itself has an error of some percent.")];
};

const frameTable = (rows, colourOf) => [el("h3", {}, "Frames of one shot"),
  el("p", {}, "CPU seconds per frame if only the camera moves. Stages that do not depend on the camera run once."),
  table(["setting", "once", "each frame", "over 1", "24", "240 frames"],
    rows.filter((row) => report.rows[row].frame_cpu_median !== null).map((row) => [nameCell(report.rows[row].rung, colourOf(row)),
      measured(row, "once_cpu_median"), measured(row, "frame_cpu_median"),
      ...[1, 24, 240].map((frames) => figure(report.rows[row].frame_cpu_median + report.rows[row].once_cpu_median / frames))]))];

const settingColumns = [["samples", "", "samples"], ["CPU", "s", "job_cpu_median"], ["min", "s", "job_cpu_min"],
  ["max", "s", "job_cpu_max"], ["job", "× lambert", "job_ratio_median"], ["shading", "s", "shading_cpu_median"],
  ["shading", "× lambert", "shading_ratio_median"], ["peak", "MB", "job_memory_median"], ["error", "%", "error_worst"],
  ["noise floor", "%", "error_floor_worst"], ["signed", "%", "signed_worst"], ["p99", "%", "p99_worst"], ["p99 noise", "%", "p99_noise_worst"]];

const settingTable = (rows, colourOf) => [el("h3", {}, "All settings"),
  el("p", {}, "Medians; errors of the worst channel, negative where noise hides them. An error below its noise floor has no meaning."),
  table(["setting", ...settingColumns.map(([head, unit]) => [head, unit])], rows.map((row) => [nameCell(report.rows[row].rung, colourOf(row)),
    ...(report.rows[row].failure ? [el("td", {class: "words", colspan: settingColumns.length}, `failed: ${report.rows[row].failure}`)]
      : settingColumns.map(([, , column]) => measured(row, column)))]), "dense")];

const sceneSection = (scene) => {
  const rows = report.rows.flatMap((row, r) => row.scene === scene.scene ? [r] : []);
  const pictured = rows.filter((row) => scene.reference_picture && report.rows[row].picture);
  const series = scene.series.flatMap(({points}, s) => points.map(({row}) => [row, s]));
  const colourOf = (row) => new Map(series).get(row);
  const select = el("select", {}), images = viewer(scene, pictured, select), state = {row: Number(select.value || -1)}, group = [];
  select.addEventListener("change", () => { state.row = Number(select.value); group.forEach((get) => get().update()); });
  const pick = (row) => {
    if (!pictured.includes(row)) return;
    select.value = row;
    select.dispatchEvent(new Event("change"));
  };
  return el("section", {class: "scene"}, el("h2", {}, scene.title),
    el("p", {class: "sub"}, `${scene.resolution.join(" × ")} pixels; reference: ${scene.reference}, ` +
      `each half with ${figure(scene.reference_half_noise)} % of noise`),
    answer(scene, rows), ...(series.length ? [tradeChart(scene, state, pick, group),
      el("p", {class: "small"}, "Lower left is better. A hollow mark has an error below the noise of the reference, and stands at that noise. " +
        "Click a mark to see its image; in the chart the arrow keys step through the marks and Enter chooses one.")]
      : [el("p", {}, "No setting has an error.")]),
    ...images, ...tradeTables(scene), ...budgetTable(scene), ...frameTable(rows, colourOf), ...settingTable(rows, colourOf));
};

if (report.command === "bench") {
  const compare = el("p", {}, "This command reproduces an error, with an image of this folder and the two halves named above: ",
    el("code", {}, "opaline compare IMAGE --halves HALF1 HALF2"));
  show(report.scenes.map(({title}) => title).join(", "), "Speed and error",
    "Cost of each setting, and error of its image against a converged one of the same diffusion model. The error of the model itself is " +
      (report.scenes.some(({truth}) => truth) ? "in the sections against random walks."
        : "the part of that name (--truth measures it by random walks)."),
    ...report.scenes.map(sceneSection), notes("results.csv", "budget.csv", "results.json"), compare);
}
