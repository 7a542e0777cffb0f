// SPDX-License-Identifier: GPL-3.0-or-later
// Frames on a canvas. Exposure, view transform and channel selection are local to the page, without delay.

const kSteps = ["moving", "sharper", "final", "reference"];
const kMark = 0x314c504f, kHeader = 32;  // as in src/view/view_frame.h

function floatOfHalf(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = bits >> 10 & 31, fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return exponent ? sign * 2 ** (exponent - 15) * (1 + fraction / 1024) : sign * 2 ** -24 * fraction;
}
const kFloats = Float32Array.from({length: 65536}, (_, bits) => floatOfHalf(bits));

const srgb = (x) => x <= .0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - .055;
const toByte = (x) => Math.max(0, Math.min(255, Math.round(255 * x))) || 0;

// ---- views: as src/image/view_transform.cpp has them, of three numbers in place --------------------------------------

function softHighlights(c, start) {
  const peak = Math.max(c[0], c[1], c[2]), room = 1 - start;
  if (peak < start) return;
  const shown = 1 - room * room / (peak + room - start), kept = 1 / (.15 * (peak - shown) + 1);
  for (let i = 0; i < 3; ++i) c[i] = c[i] * (shown / peak * kept) + shown * (1 - kept);
}

function neutral(c) {
  const least = Math.min(c[0], c[1], c[2]), off = least < .08 ? least - least * least / .16 : .04;
  for (let i = 0; i < 3; ++i) c[i] -= off;
  softHighlights(c, .76);
}

const kInset = [.842479062253094, .0784335999999992, .0792237451477643, .0423282422610123, .878468636469772,
  .0791661274605434, .0423756549057051, .0784336, .879142973793104];
const kOutset = [1.19687900512017, -.0980208811401368, -.0990297440797205, -.0528968517574562, 1.15190312990417,
  -.0989611768448433, -.0529716355144438, -.0980434501171241, 1.15107367264116];
const kContrast = [15.5, -40.14, 31.96, -6.868, .4298, .1191, -.00232], kDarkest = -12.47393, kBrightest = 4.026069;

function multiply(m, c) {
  const [r, g, b] = c;
  for (let i = 0; i < 3; ++i) c[i] = m[3 * i] * r + m[3 * i + 1] * g + m[3 * i + 2] * b;
}

function agx(c) {
  multiply(kInset, c);
  for (let i = 0; i < 3; ++i) {
    const stops = Math.max(kDarkest, Math.min(kBrightest, Math.log2(Math.max(c[i], 1e-10))));
    const x = (stops - kDarkest) / (kBrightest - kDarkest);
    c[i] = kContrast.reduce((sum, factor) => sum * x + factor, 0);
  }
  multiply(kOutset, c);
  for (let i = 0; i < 3; ++i) c[i] = Math.max(c[i], 0) ** 2.2;
}

const kViews = {soft: (c) => softHighlights(c, .8), neutral, agx};
const kUnchangedBelow = {soft: .8, neutral: 0, agx: 0};
const kCurves = {srgb, linear: (x) => x, log: (x) => (Math.log2(Math.max(x, 1e-9)) + 8) / 16};

const shown = new Float64Array(3);
const shownByte = (i) => toByte(srgb(Math.max(0, Math.min(1, shown[i]))));
function show(transform, r, g, b) {
  shown[0] = r;
  shown[1] = g;
  shown[2] = b;
  kViews[transform](shown);
}

// The byte of a grey.
function greyCurve(transform) {
  if (kCurves[transform]) return (x) => toByte(kCurves[transform](x));
  return (x) => {
    show(transform, x, x, x);
    return shownByte(0);
  };
}

export function parseFrame(buffer) {
  const [mark, number, revision, step, width, height, channels, microseconds] = new Uint32Array(buffer, 0, 8);
  if (mark !== kMark) throw new Error("not a frame");
  const pixels = width * height;
  return {
    number, revision, width, height, channels, step: kSteps[step], seconds: microseconds / 1e6,
    colours: new Uint16Array(buffer, kHeader, 4 * pixels),
    layer: channels ? new Float32Array(buffer, kHeader + 8 * pixels, channels * pixels) : null,
  };
}

// R, G, B, A and the layer's values, or null outside.
export function valuesAt(frame, x, y) {
  if (!frame || x < 0 || y < 0 || x >= frame.width || y >= frame.height) return null;
  const pixel = y * frame.width + x;
  return {
    colour: Array.from(frame.colours.subarray(4 * pixel, 4 * pixel + 4), (bits) => kFloats[bits]),
    layer: frame.layer ? Array.from(frame.layer.subarray(frame.channels * pixel, frame.channels * (pixel + 1))) : [],
  };
}

// Bytes of all halves, as greys.
let table = null, tableKey = "";
function byteTable(transform, exposure) {
  const key = transform + exposure;
  if (key !== tableKey) {
    const gain = 2 ** exposure, curve = greyCurve(transform);
    table = Uint8Array.from(kFloats, (x) => curve(Math.max(0, x * gain)));
    tableKey = key;
  }
  return table;
}

const kOpaque = 0xff000000;

// Opaque, of light after exposure.
function pixelOf(transform, r, g, b) {
  show(transform, Math.max(0, r), Math.max(0, g), Math.max(0, b));
  return kOpaque | shownByte(2) << 16 | shownByte(1) << 8 | shownByte(0);
}

function drawColours(frame, out, display) {
  const bytes = byteTable(display.transform, display.exposure), halves = frame.colours;
  const single = ["R", "G", "B"].indexOf(display.channel), gain = 2 ** display.exposure;
  const unchangedBelow = kUnchangedBelow[display.transform] ?? Infinity;
  for (let p = 0, h = 0; p < out.length; ++p, h += 4) {
    if (display.channel === "A") {
      out[p] = kOpaque | toByte(kFloats[halves[h + 3]]) * 0x10101;
    } else if (single >= 0) {
      out[p] = kOpaque | bytes[halves[h + single]] * 0x10101;
    } else {
      const r = gain * kFloats[halves[h]], g = gain * kFloats[halves[h + 1]], b = gain * kFloats[halves[h + 2]];
      out[p] = Math.max(r, g, b) < unchangedBelow
        ? kOpaque | bytes[halves[h + 2]] << 16 | bytes[halves[h + 1]] << 8 | bytes[halves[h]]
        : pixelOf(display.transform, r, g, b);
    }
  }
}

// Relative error in false colours, by its logarithm.
export const kErrorRange = [[.001, [13, 20, 90]], [.003, [0, 90, 170]], [.01, [0, 160, 140]], [.03, [120, 200, 60]],
  [.1, [250, 210, 40]], [.3, [235, 90, 30]], [1, [190, 10, 40]]];
function errorPixel(error) {
  const after = Math.min(kErrorRange.length - 1, Math.max(1, kErrorRange.findIndex(([end]) => error < end))) || 1;
  const [[low, a], [high, b]] = [kErrorRange[error < 1 ? after - 1 : kErrorRange.length - 2], kErrorRange[error < 1 ? after : kErrorRange.length - 1]];
  const t = Math.max(0, Math.min(1, Math.log(Math.max(error, 1e-9) / low) / Math.log(high / low)));
  return kOpaque | [2, 1, 0].reduce((bits, c) => bits << 8 | Math.round(a[c] + t * (b[c] - a[c])), 0);
}

// The image's own estimate; without one, its difference from the other side of the wipe. Background is black.
function drawError(frame, out, other) {
  const of = (h) => kFloats[frame.colours[h]] + kFloats[frame.colours[h + 1]] + kFloats[frame.colours[h + 2]];
  for (let p = 0; p < out.length; ++p) {
    const h = 4 * p, light = of(h), n = frame.channels;
    let error = 0;
    for (let c = 0; c < 3; ++c)
      error += frame.layer ? frame.layer[n * p + Math.min(c, n - 1)] : Math.abs(kFloats[frame.colours[h + c]] - kFloats[other.colours[h + c]]);
    out[p] = frame.colours[h + 3] ? errorPixel(error / Math.max(light, 1e-9)) : kOpaque;
  }
}

// Positions, normals and depths by their range, light as light.
function layerCurve(frame, display) {
  if (display.channel === "N") return (x) => toByte(.5 + .5 * x);
  if (display.channel === "P" || display.channel === "Z") {
    let low = Infinity, high = -Infinity;
    for (let i = 0; i < frame.layer.length; ++i) {
      if (!frame.colours[4 * Math.floor(i / frame.channels) + 3]) continue;
      low = Math.min(low, frame.layer[i]);
      high = Math.max(high, frame.layer[i]);
    }
    return (x) => toByte((x - low) / (high - low));
  }
  const gain = 2 ** display.exposure, curve = greyCurve(display.transform);
  return (x) => curve(Math.max(0, x * gain));
}

function drawLayer(frame, out, display) {
  const curve = layerCurve(frame, display), n = frame.channels, values = frame.layer, gain = 2 ** display.exposure;
  const isViewed = n === 3 && !"NP".includes(display.channel) && display.transform in kViews;
  for (let p = 0, v = 0; p < out.length; ++p, v += n) {
    if (isViewed) {
      out[p] = pixelOf(display.transform, gain * values[v], gain * values[v + 1], gain * values[v + 2]);
      continue;
    }
    const r = curve(values[v]);
    out[p] = kOpaque | (n < 3 ? r * 0x10101 : curve(values[v + 2]) << 16 | curve(values[v + 1]) << 8 | r);
  }
}

// display: {exposure, transform, channel}; the channel is R, G, B, A, empty for the colours, or a layer's name. other: the
// image on the other side of the wipe, or null.
export function draw(frame, canvas, display, other = null) {
  if (canvas.width !== frame.width || canvas.height !== frame.height) {
    canvas.width = frame.width;
    canvas.height = frame.height;
  }
  const context = canvas.getContext("2d"), image = context.createImageData(frame.width, frame.height);
  const out = new Uint32Array(image.data.buffer);
  const isLayer = display.channel.length > 1 || "NPZ".includes(display.channel);
  const hasError = frame.layer || (other?.width === frame.width && other.height === frame.height);
  if (display.channel === "error" && hasError) drawError(frame, out, other);
  else if (display.channel && isLayer && frame.layer) drawLayer(frame, out, display);
  else drawColours(frame, out, display);
  context.putImageData(image, 0, 0);
}
