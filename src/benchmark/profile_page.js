// SPDX-License-Identifier: GPL-3.0-or-later
// The page of `opaline profile`: the models beside random walks, in tables and, for each channel, in charts.

const wordsOf = (model) => model.replaceAll("_", " ");
const walkNames = {diffuse: "walks, diffuse light", normal: "walks, along the normal"};
const middle = (low, high) => Math.sqrt((low * low + high * high) / 2);

const totalOf = (channel, by, face) =>
  report.totals.find((row) => row.channel === channel.name && row.by === by && row.face === face);
const walkedTotal = (channel, entry, face) => totalOf(channel, `walks, ${entry}`, face);
const totalError = (channel, model, face) => {
  const walked = walkedTotal(channel, "diffuse", face).share;
  return walked > 0 ? totalOf(channel, model, face).share / walked - 1 : 0;
};

// Formats a value with the digits justified by its standard error.
const withError = ({share, share_error: error}) => {
  const digits = error > 0 ? Math.min(7, Math.max(3, 1 - Math.floor(Math.log10(error)))) : 4;
  return `${share.toFixed(digits)} ± ${error.toFixed(digits)}`;
};

const faceTable = (heading, face) => [el("h3", {}, heading), table(["", ...report.channels.map(({name}) => name)], [
  ...["diffuse", "normal"].map((entry) =>
    [nameCell(walkNames[entry], 0), ...report.channels.map((channel) => withError(walkedTotal(channel, entry, face)))]),
  ...report.models.map(([model, source], m) => [nameCell(wordsOf(model), m + 1, el("small", {}, source)),
    ...report.channels.map((channel) => {
      const {share, shape_difference: shape} = totalOf(channel, model, face), off = 100 * totalError(channel, model, face);
      return el("td", {}, share.toFixed(4), " ",
        el("small", {}, `${off < 0 ? "" : "+"}${off.toFixed(1)} %; shape ${(100 * shape).toFixed(1)} %`));
    })])])];

const answerOf = () => {
  const bold = (value) => el("b", {}, `${(100 * value).toFixed(1)} %`);
  const nearest = (errorOf) => {
    const [[error, model]] = report.models.map(([model]) => [Math.max(...report.channels.map((channel) => errorOf(channel, model))), model])
      .sort(([a], [b]) => a - b);
    return [wordsOf(model), " (within ", bold(error), ")"];
  };
  return el("p", {class: "answer"}, `Reflected fractions of transmitted diffuse light by random walks, in a ${report.shape} of ${report.medium}: `,
    ...report.channels.flatMap((channel, i) => [i ? ", " : "", bold(walkedTotal(channel, "diffuse", "back").share)]),
    ". Nearest total: ", ...nearest((channel, model) => Math.abs(totalError(channel, model, "back"))),
    "; nearest shape: ", ...nearest((channel, model) => totalOf(channel, model, "back").shape_difference), ".");
};

// Rings with a relative error of at most a half.
const isClear = (ring, entry = "diffuse") =>
  ring[`${entry}_profile`] > 0 && ring[`${entry}_profile_error`] < ring[`${entry}_profile`] / 2;
const place = (ring) => middle(ring.r_low, ring.r_high);

// Range of distances containing nearly all light.
const distancesOf = (rings, total) => {
  const clear = rings.filter((ring) => isClear(ring));
  const first = clear.find((ring) => ring.diffuse_within > 3e-3 * total);
  const last = clear.filter((ring) => ring.diffuse_within < (1 - 2e-4) * total).pop();
  const isWide = first && last && last.r_high > 2 * place(first);
  return {title: "distance r, mm", min: isWide ? place(first) : rings[0].r_high, max: isWide ? last.r_high : rings.at(-1).r_high};
};

const modelCurves = (points) => report.models.map(([model], m) => curve(wordsOf(model), m + 1, points(model)));
const walked = (entry, points) => dots(walkNames[entry], 0, points, entry === "normal");

const profileChart = (channel, face, legend, group) => {
  const rings = report.rings.filter((ring) => ring.channel === channel.name && ring.face === face);
  const x = distancesOf(rings, walkedTotal(channel, "diffuse", face).share);
  const walks = (entry) => rings.filter((ring) => isClear(ring, entry))
    .map((ring) => ({x: place(ring), y: ring[`${entry}_profile`], error: ring[`${entry}_profile_error`]}));
  const shown = walks("diffuse").filter((point) => point.x >= x.min && point.x <= x.max).map((point) => point.y);
  const y = {title: "fraction of the entered flux, 1/mm²", min: shown.length ? Math.min(...shown) / 2 : 1, max: shown.length ? 4 * Math.max(...shown) : 2};
  const where = face === "back" ? "" : " through the far face";
  return chart(`Exitance${where} by distance from the point of entry`, () => ({x, y, legend, datasets: [
    ...modelCurves((model) => rings.map((ring) => ({x: place(ring), y: ring[`${model}_profile`]})).filter((point) => point.y > 0)),
    walked("normal", walks("normal")), walked("diffuse", walks("diffuse"))]}), {group});
};

const ratioChart = (channel, group) => {
  const rings = report.rings.filter((ring) => ring.channel === channel.name && ring.face === "back");
  const x = distancesOf(rings, walkedTotal(channel, "diffuse", "back").share), clear = rings.filter((ring) => isClear(ring));
  return chart("Each model over the walks in diffuse light", () => ({x, y: {title: "model / walks", min: 0.2, max: 5}, datasets: [
    ...modelCurves((model) => clear.map((ring) => ({x: place(ring), y: ring[`${model}_profile`] / ring.diffuse_profile})).filter((point) => point.y > 0)),
    walked("diffuse", clear.map((ring) => ({x: place(ring), y: 1, error: ring.diffuse_profile_error / ring.diffuse_profile}))),
    guide([{x: x.min, y: 1}, {x: x.max, y: 1}])]}), {group});
};

const byCosine = (channel, name) => report.angles.filter((bin) => bin.channel === channel.name && bin[name] !== 0)
  .map((bin) => ({x: (Number(bin.cosine_low) + Number(bin.cosine_high)) / 2, y: bin[name], error: bin[`${name}_error`]}));
const cosine = (title) => ({title, min: 0, max: 1, isLinear: true});

const entryChart = (channel, group) => {
  const normal = walkedTotal(channel, "normal", "back");
  return chart("Albedo by angle of entry", () => ({x: cosine("cosine of the angle of entry, outside"),
    y: {title: "fraction of the entered flux", isLinear: true}, datasets: [
      ...modelCurves((model) => [0, 1].map((x) => ({x, y: totalOf(channel, model, "back").share}))),
      walked("normal", [{x: 1, y: normal.share, error: normal.share_error}]), walked("diffuse", byCosine(channel, "albedo_by_entry"))]}), {group});
};

const exitChart = (channel, group) => {
  const points = {normal: byCosine(channel, "exit_normal"), diffuse: byCosine(channel, "exit_diffuse")};
  const most = Math.max(1, ...[...channel.fresnel, ...points.normal, ...points.diffuse].map((point) => 1.05 * point.y));
  return chart("Radiance by angle of exit; the line is the Fresnel transmittance of all models", () => ({
    x: cosine("cosine of the angle of exit, outside"), y: {title: "radiance / Lambert emitter's", min: 0, max: Math.min(Math.ceil(5 * most) / 5, 3), isLinear: true},
    datasets: [curve("Fresnel transmittance, all models", 1, channel.fresnel), walked("normal", points.normal), walked("diffuse", points.diffuse),
      guide([{x: 0, y: 1}, {x: 1, y: 1}])]}), {group});
};

const pointSourceChart = ({classical, grosjean, reduced_mean_free_path: length}) => {
  const x = {title: "distance from the source, mm", min: length / 20, max: 50 * length};
  return chart("Fluence around a point source in an infinite medium, diffusion over the exact one (Case's singular eigenfunctions)", () => ({
    x, y: {title: "diffusion / exact", min: 0.2, max: 2}, legend: "bottom", datasets: [
      curve("classical diffusion", 1, classical), curve("Grosjean's diffusion, with uncollided light", 3, grosjean),
      guide([{x: x.min, y: 1}, {x: x.max, y: 1}])]}));
};

const channelSection = (channel) => {
  const {sigma_a, sigma_s, g, diffuse_mean_free_path: diffuse} = channel, group = [];
  const digits = (value) => Number(value.toPrecision(4));
  const section = el("section", {}, el("h2", {}, channel.name === "all" ? "All channels" : `Channel ${channel.name}`),
    el("p", {class: "sub"}, `σa ${digits(sigma_a)}, σs ${digits(sigma_s)} per mm, g ${digits(g)}; ` +
      (channel.reduced_mean_free_path ? `mean free path ${figure(channel.reduced_mean_free_path)} mm` : "") +
      (diffuse ? `, diffuse mean free path ${figure(diffuse)} mm` : "") +
      `; ${figure(channel.collisions)} collisions per walk, ${channel.walks} walks`));
  if (!(sigma_s > 0)) return section.append(el("p", {}, "This medium does not scatter.")), section;
  section.append(profileChart(channel, "back", "right", group), el("div", {class: "pair"}, ratioChart(channel, group),
    ...(report.is_slab ? [profileChart(channel, "through", undefined, group)] : []),
    entryChart(channel, group), exitChart(channel, group), pointSourceChart(channel)));
  return section;
};

if (report.command === "profile") {
  const totals = el("section", {}, el("h2", {}, "Totals"),
    el("p", {}, "Fractions of the light that entered. Behind a model: the error of its total against the walks in diffuse light, and the largest " +
      "difference, over all distances, of the fractions (each of its own total) that leave within that distance."),
    ...faceTable("Reflected", "back"), ...(report.is_slab ? faceTable("Transmitted", "through") : []));
  const title = `${report.medium}, ${report.shape}, eta ${Number(report.eta.toPrecision(4))}`;
  show(title, title, "Error of the diffusion models against random walks, which use no model: a beam enters a flat face, and the outgoing light is " +
    "counted by distance and angle. Bars are one standard error. No figure includes the specular reflection of the face.",
    answerOf(), totals, ...report.channels.map(channelSection), notes("totals.csv", "profile.csv", "angles.csv"));
}
