// SPDX-License-Identifier: GPL-3.0-or-later
// Frames as they come over the line: whole, or over a slow one as a JPEG and then exactly, by the bands that changed.
import {kFloats} from "./picture.js";

const kSteps = ["moving", "sharper", "final", "reference"];
const kWhole = 0x314c504f, kJpeg = 0x324c504f, kBand = 0x334c504f, kHeader = 32;  // as src/view/view_frame.h has them
const kLogSlope = 16, kLargestHalf = 0x7bff, kOne = 0x3c00;

function headerOf(buffer) {
  const [mark, number, revision, step, width, height, channels, microseconds] = new Uint32Array(buffer, 0, 8);
  return {mark, number, revision, width, height, channels, step: kSteps[step], seconds: microseconds / 1e6};
}

function wholeFrame(header, buffer) {
  const pixels = header.width * header.height, {channels} = header;
  return {
    ...header, colours: new Uint16Array(buffer, kHeader, 4 * pixels),
    layer: channels ? new Float32Array(buffer, kHeader + 8 * pixels, channels * pixels) : null,
  };
}

// The bits of the largest half that is not above.
function halfBelow(value) {
  let low = 0, high = kLargestHalf;
  while (low < high) {
    const middle = low + high + 1 >> 1;
    if (kFloats[middle] <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}

async function jpegFrame(header, buffer) {
  const [largest] = new Float32Array(buffer, kHeader, 1);
  const file = new Blob([new Uint8Array(buffer, kHeader + 4)], {type: "image/jpeg"});
  const bitmap = await createImageBitmap(file, {colorSpaceConversion: "none"});
  const context = new OffscreenCanvas(header.width, header.height).getContext("2d");
  context.drawImage(bitmap, 0, 0);
  const bytes = context.getImageData(0, 0, header.width, header.height).data;
  const halves = Uint16Array.from({length: 256}, (_, byte) =>
    halfBelow(((1 + kLogSlope * largest) ** (byte / 255) - 1) / kLogSlope));
  return {...header, colours: Uint16Array.from(bytes, (byte, i) => i % 4 === 3 ? kOne : halves[byte]), layer: null};
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Values whose bytes lie in planes, those of `channels` channels one after the other; into pixels from `first` on.
function fromPlanes(planes, values, channels, first, pixels) {
  const size = values.BYTES_PER_ELEMENT, bytes = new Uint8Array(values.buffer);
  for (let channel = 0, plane = 0; channel < channels; ++channel)
    for (let byte = 0; byte < size; ++byte, plane += pixels)
      for (let p = 0, at = (first * channels + channel) * size + byte; p < pixels; ++p, at += channels * size)
        bytes[at] = planes[plane + p];
}

export class FrameReader {
  // take(frame): each whole picture, in the order of arrival
  constructor(take) {
    this.take = take;
    this.held = {};  // of what comes in bands, by whether it is of the reference
    this.last = Promise.resolve();
  }

  receive(buffer) {
    this.last = this.last.then(() => this.read(buffer)).then((frame) => frame && this.take(frame));
  }

  read(buffer) {
    const header = headerOf(buffer);
    if (header.mark === kWhole) return wholeFrame(header, buffer);
    if (header.mark === kJpeg) return jpegFrame(header, buffer);
    if (header.mark === kBand) return this.band(header, buffer);
    throw new Error("not a frame");
  }

  // The picture with its last band, which is of no rows.
  async band(header, buffer) {
    const [row, rows] = new Uint32Array(buffer, kHeader, 2), {width, height, channels} = header;
    const key = header.step === "reference";
    let held = this.held[key];
    if (!held || held.width !== width || held.height !== height || held.channels !== channels) {
      held = this.held[key] = {
        width, height, channels, colours: new Uint16Array(4 * width * height),
        layer: channels ? new Float32Array(channels * width * height) : null,
      };
    }
    if (!rows) return {...header, colours: held.colours.slice(), layer: held.layer && held.layer.slice()};
    const planes = await inflated(new Uint8Array(buffer, kHeader + 8)), pixels = rows * width;
    fromPlanes(planes, held.colours, 4, row * width, pixels);
    if (channels) fromPlanes(planes.subarray(8 * pixels), held.layer, channels, row * width, pixels);
    return null;
  }
}
