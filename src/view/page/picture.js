// SPDX-License-Identifier: GPL-3.0-or-later
// Frames on a canvas: exposure, view transform and channels are this page's own, and so at once.

export const kSteps = ["moving", "sharper", "final"];
const kMark = 0x314c504f;

function floatOfHalf(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = bits >> 10 & 31, fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return exponent ? sign * 2 ** (exponent - 15) * (1 + fraction / 1024) : sign * 2 ** -24 * fraction;
}
const kFloats = Float32Array.from({length: 65536}, (_, bits) => floatOfHalf(bits));

const srgb = (x) => x <= .0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - .055;
const kTransforms = {
  srgb,
  soft: (x) => srgb(x / (1 + x)),
  linear: (x) => x,
  log: (x) => (Math.log2(Math.max(x, 1e-9)) + 8) / 16,
};
const toByte = (x) => Math.max(0, Math.min(255, Math.round(255 * x))) || 0;

export function parseFrame(buffer) {
  const [mark, number, revision, step, width, height, channels, microseconds] = new Uint32Array(buffer, 0, 8);
  if (mark !== kMark) throw new Error("not a frame");
  const pixels = width * height;
  return {
    number, revision, width, height, step: kSteps[step], seconds: microseconds / 1e6,
    colours: new Uint16Array(buffer, 32, 4 * pixels),
    layer: channels ? new Float32Array(buffer, 32 + 8 * pixels, channels * pixels) : null, channels,
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

// Bytes of all halves.
let table = null, tableKey = "";
function byteTable(transform, exposure) {
  const key = transform + exposure;
  if (key !== tableKey) {
    const gain = 2 ** exposure, curve = kTransforms[transform];
    table = Uint8Array.from(kFloats, (x) => toByte(curve(Math.max(0, x * gain))));
    tableKey = key;
  }
  return table;
}

const kOpaque = 0xff000000;

function drawColours(frame, out, display) {
  const bytes = byteTable(display.transform, display.exposure), halves = frame.colours;
  const single = ["R", "G", "B"].indexOf(display.channel);
  for (let p = 0, h = 0; p < out.length; ++p, h += 4) {
    if (display.channel === "A") {
      out[p] = kOpaque | toByte(kFloats[halves[h + 3]]) * 0x10101;
    } else if (single >= 0) {
      out[p] = kOpaque | bytes[halves[h + single]] * 0x10101;
    } else {
      out[p] = kOpaque | bytes[halves[h + 2]] << 16 | bytes[halves[h + 1]] << 8 | bytes[halves[h]];
    }
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
  const gain = 2 ** display.exposure, curve = kTransforms[display.transform];
  return (x) => toByte(curve(Math.max(0, x * gain)));
}

function drawLayer(frame, out, display) {
  const curve = layerCurve(frame, display), n = frame.channels, values = frame.layer;
  for (let p = 0, v = 0; p < out.length; ++p, v += n) {
    const r = curve(values[v]);
    out[p] = kOpaque | (n < 3 ? r * 0x10101 : curve(values[v + 2]) << 16 | curve(values[v + 1]) << 8 | r);
  }
}

// display: {exposure, transform, channel}; the channel is R, G, B, A, empty for the colours, or a layer's name.
export function draw(frame, canvas, display) {
  if (canvas.width !== frame.width || canvas.height !== frame.height) {
    canvas.width = frame.width;
    canvas.height = frame.height;
  }
  const context = canvas.getContext("2d"), image = context.createImageData(frame.width, frame.height);
  const out = new Uint32Array(image.data.buffer);
  const isLayer = display.channel.length > 1 || "NPZ".includes(display.channel);
  if (display.channel && isLayer && frame.layer) drawLayer(frame, out, display);
  else drawColours(frame, out, display);
  context.putImageData(image, 0, 0);
}
