// Binary frames of the server (kind 1: bins), little endian; see docs/developers/scope_protocol.md.

export const kIncomplete = 1;
export const kAnswer = 2;
export const kCapture = 4;

const kBins = 1;
const kHeaderBytes = 40;
const kBytesPerValue = 8;

// {id, run, flags, t0, width, bins, min: [Float64Array...], max: [...]}, one of each a channel in the order
// asked. Throws when the bytes are not such a frame.
export function decodeBins(buffer) {
  if (buffer.byteLength < kHeaderBytes)
    throw new Error(`a frame of ${buffer.byteLength} bytes: its header has ${kHeaderBytes}`);
  const view = new DataView(buffer);
  const kind = view.getUint32(0, true);
  if (kind !== kBins) throw new Error(`a frame of kind ${kind}: known is ${kBins}`);
  const bins = view.getUint32(32, true);
  const channels = view.getUint32(36, true);
  const expected = kHeaderBytes + 2 * kBytesPerValue * bins * channels;
  if (buffer.byteLength !== expected) {
    throw new Error(`a frame of ${buffer.byteLength} bytes: ${channels} channels of ${bins} bins take ${expected}`);
  }
  const frame = {
    id: view.getUint32(4, true),
    run: view.getUint32(8, true),
    flags: view.getUint32(12, true),
    t0: view.getFloat64(16, true),
    width: view.getFloat64(24, true),
    bins,
    min: [],
    max: [],
  };
  let at = kHeaderBytes;
  for (let channel = 0; channel < channels; channel += 1) {
    frame.min.push(new Float64Array(buffer, at, bins));
    frame.max.push(new Float64Array(buffer, at + bins * kBytesPerValue, bins));
    at += 2 * bins * kBytesPerValue;
  }
  return frame;
}

// The inverse, for tests and stand-ins of the server.
export function encodeBins({ id, run, flags = 0, t0, width, min, max }) {
  const channels = min.length;
  const bins = channels === 0 ? 0 : min[0].length;
  const buffer = new ArrayBuffer(kHeaderBytes + 2 * kBytesPerValue * bins * channels);
  const view = new DataView(buffer);
  [kBins, id, run, flags].forEach((value, i) => view.setUint32(4 * i, value, true));
  view.setFloat64(16, t0, true);
  view.setFloat64(24, width, true);
  view.setUint32(32, bins, true);
  view.setUint32(36, channels, true);
  for (let channel = 0; channel < channels; channel += 1) {
    const at = kHeaderBytes + 2 * channel * bins * kBytesPerValue;
    new Float64Array(buffer, at, bins).set(min[channel]);
    new Float64Array(buffer, at + bins * kBytesPerValue, bins).set(max[channel]);
  }
  return buffer;
}
