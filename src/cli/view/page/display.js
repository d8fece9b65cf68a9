"use strict";
// From radiance to bytes of sRGB, as gpt's previews show it: a matrix, a curve for each channel, another matrix, and what the screen expects.
// Curves are tables over the upper bits of a number, so that a picture takes milliseconds.

// sRGB of a linear number from 0 to 1, and back (IEC 61966-2-1).
const toSrgb = (linear) => (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
const toLinear = (coded) => (coded <= 0.04045 ? coded / 12.92 : ((coded + 0.055) / 1.055) ** 2.4);

const TABLE_SHIFT = 13;
const STEPS = 4095;
const INSET = [0.842479062253094, 0.0784335999999992, 0.0792237451477643, 0.0423282422610123, 0.878468636469772, 0.0791661274605434,
  0.0423756549057051, 0.0784336, 0.879142973793104];

function inverse([a, b, c, d, e, f, g, h, i]) {
  const A = e * i - f * h, B = f * g - d * i, C = d * h - e * g, determinant = a * A + b * B + c * C;
  return [A, c * h - b * i, b * f - c * e, B, a * i - c * g, c * d - a * f, C, b * g - a * h, a * e - b * d].map((x) => x / determinant);
}

function srgb(linear) {
  const value = Math.min(1, Math.max(0, linear));
  return 255 * toSrgb(value);
}

function hable(x) {
  const curve = (x) => (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
  return curve(2 * x) / curve(11.2);
}

// The sigmoid of AgX through its pivot, of a value on the scale of stops.
function agx(value) {
  const x = Math.min(1, Math.max(0, (Math.log2(Math.max(1e-10, value) / 0.18) + 10) / 16.5)), pivot = 10 / 16.5;
  const upper = x >= pivot, along = upper ? x - pivot : pivot - x, length = upper ? 1 - pivot : pivot, power = upper ? 3.25 : 3;
  // The arm's scale makes it end at the corner.
  const scale = ((2 * length / 0.5) ** power - 1) ** (-1 / power) * length * 2;
  const t = (2 * along) / scale;
  const bent = scale * t / (1 + t ** power) ** (1 / power);
  return upper ? 0.5 + bent : 0.5 - bent;
}

function developer(curve, stops) {
  const gain = 2 ** stops, entries = (0x7f800000 >>> TABLE_SHIFT) + 1, table = new Float32Array(entries);
  const bits = new Uint32Array(1), number = new Float32Array(bits.buffer);
  const shape = { clip: srgb, filmic: (x) => srgb(hable(x)), agx }[curve];
  for (let entry = 0; entry < entries; entry++) {
    bits[0] = entry << TABLE_SHIFT;
    table[entry] = shape(Math.min(1e30, number[0] * gain));
  }
  const look = (value) => {
    number[0] = value > 0 ? Math.min(value, 1e30) : 0;
    return table[bits[0] >>> TABLE_SHIFT];
  };
  if (curve !== "agx") return (r, g, b, bytes, at) => {
    bytes[at] = look(r); bytes[at + 1] = look(g); bytes[at + 2] = look(b); bytes[at + 3] = 255;
  };
  const outset = inverse(INSET), last = Uint8Array.from({ length: STEPS + 1 }, (_, step) => Math.round(srgb((step / STEPS) ** 2.2)));
  const [a, b, c, d, e, f, g, h, i] = INSET, [o, p, q, s, t, u, v, w, x] = outset;
  const encode = (value) => last[Math.round(STEPS * Math.min(1, Math.max(0, value)))];
  return (red, green, blue, bytes, at) => {
    red = red > 0 ? red : 0; green = green > 0 ? green : 0; blue = blue > 0 ? blue : 0;
    const R = look(a * red + b * green + c * blue), G = look(d * red + e * green + f * blue), B = look(g * red + h * green + i * blue);
    bytes[at] = encode(o * R + p * G + q * B);
    bytes[at + 1] = encode(s * R + t * G + u * B);
    bytes[at + 2] = encode(v * R + w * G + x * B);
    bytes[at + 3] = 255;
  };
}

function heat(share) {
  const stops = [[0, 0, 4], [81, 18, 124], [183, 55, 121], [252, 137, 97], [252, 253, 191]];
  const place = Math.min(3.999, Math.max(0, 4 * share)), index = Math.floor(place), rest = place - index;
  return stops[index].map((low, c) => low + (stops[index + 1][c] - low) * rest);
}
