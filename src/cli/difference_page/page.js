"use strict";
for (const viewer of document.querySelectorAll(".viewer")) start(viewer);

function start(viewer) {
  const data = JSON.parse(viewer.querySelector("script").textContent);
  const { width, height } = data;
  const a = halves(bytes(data.a)), b = halves(bytes(data.b)), eye = bytes(data.flip);
  const canvas = viewer.querySelector("canvas"), context = canvas.getContext("2d");
  canvas.width = width;
  canvas.height = height;
  const image = context.createImageData(width, height);
  const exposure = viewer.querySelector(".exposure"), zoom = viewer.querySelector(".zoom");
  const readout = viewer.querySelector(".readout");
  const scores = new Float32Array(width * height);
  for (const [x, y, w, h, z] of data.tiles)
    for (let row = y; row < y + h; row++) scores.fill(z, row * width + x, row * width + x + w);
  const modes = ["a", "b", "flip", "difference", "z", "eye"];
  let mode = "b", second = false, timer = 0;

  function draw() {
    const gain = 2 ** exposure.value, pixels = image.data;
    const shown = mode === "a" || (mode === "flip" && !second) ? a : b;
    for (let pixel = 0; pixel < width * height; pixel++) {
      let color;
      if (mode === "difference") color = [0, 1, 2].map((c) => 127.5 + 127.5 * tanh(gain * 4 * (b[3 * pixel + c] - a[3 * pixel + c])));
      else if (mode === "z") color = score(scores[pixel]);
      else if (mode === "eye") color = heat(eye[pixel] / 255);
      else color = [0, 1, 2].map((c) => 255 * encoded(gain * shown[3 * pixel + c]));
      pixels.set([color[0], color[1], color[2], 255], 4 * pixel);
    }
    context.putImageData(image, 0, 0);
    for (const button of viewer.querySelectorAll("[data-mode]")) button.setAttribute("aria-pressed", button.dataset.mode === mode);
    viewer.querySelector("output").textContent = `${exposure.value} EV`;
  }

  function scale() {
    // Small pictures are shown by whole numbers of pixels.
    const room = viewer.clientWidth - 2;
    const fit = width > room ? room / width : Math.max(1, Math.floor(Math.min(room, 640) / width));
    const factor = fit * 2 ** zoom.value;
    canvas.style.width = `${width * factor}px`;
    canvas.style.height = `${height * factor}px`;
  }

  function choose(wanted) {
    mode = wanted;
    clearInterval(timer);
    if (mode === "flip") timer = setInterval(() => { second = !second; draw(); }, 500);
    draw();
  }

  function read(event) {
    const box = canvas.getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) / box.width) * width), y = Math.floor(((event.clientY - box.top) / box.height) * height);
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    const pixel = y * width + x;
    const values = (plane) => [0, 1, 2].map((c) => plane[3 * pixel + c].toPrecision(4).padStart(10)).join(" ");
    readout.textContent =
      `pixel ${x},${y}   z ${scores[pixel].toFixed(2)}   ꟻLIP ${(eye[pixel] / 255).toFixed(3)}\n` +
      data.labels.map((label, index) => `${label.padEnd(10)}${values(index ? b : a)}`).join("\n");
  }

  function show(x, y, w, h) {
    const scroller = viewer.querySelector(".scroller"), factor = canvas.getBoundingClientRect().width / width;
    scroller.scrollTo({ left: (x + w / 2) * factor - scroller.clientWidth / 2, top: (y + h / 2) * factor - scroller.clientHeight / 2 });
    draw();
    context.strokeStyle = "#ff0";
    context.strokeRect(x - 0.5, y - 0.5, w + 1, h + 1);
    viewer.scrollIntoView({ block: "nearest" });
  }

  for (const button of viewer.querySelectorAll("[data-mode]")) button.addEventListener("click", () => choose(button.dataset.mode));
  exposure.addEventListener("input", draw);
  zoom.addEventListener("input", scale);
  window.addEventListener("resize", scale);
  canvas.addEventListener("pointermove", read);
  canvas.addEventListener("pointerdown", read);
  canvas.addEventListener("keydown", (event) => modes["123456".indexOf(event.key)] && choose(modes["123456".indexOf(event.key)]));
  for (const item of viewer.parentElement.querySelectorAll("[data-region]"))
    item.addEventListener("click", () => show(...item.dataset.region.split(",").map(Number)));
  scale();
  draw();
}

function bytes(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

function halves(raw) {
  const view = new DataView(raw.buffer), values = new Float32Array(raw.length / 2);
  for (let index = 0; index < values.length; index++) {
    const half = view.getUint16(2 * index, true), exponent = (half >> 10) & 31, fraction = half & 1023;
    const size = exponent === 31 ? (fraction ? NaN : Infinity) : exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -24 * fraction;
    values[index] = half & 0x8000 ? -size : size;
  }
  return values;
}

function encoded(linear) {
  const value = linear > 0 ? Math.min(1, linear) : 0;
  return value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;
}

function tanh(value) {
  return Number.isNaN(value) ? 1 : Math.tanh(value);
}

// Red is more than the first picture, blue is less; full colour at six standard errors.
function score(z) {
  const strength = Math.min(1, Math.abs(z) / 6), rest = 245 * (1 - strength);
  return z > 0 ? [245 - 40 * strength, rest, rest] : [rest, rest, 245 - 20 * strength];
}

function heat(value) {
  const stops = [[0, 0, 4], [81, 18, 124], [183, 55, 121], [252, 137, 97], [252, 253, 191]];
  const place = Math.min(3.999, 4 * value), index = Math.floor(place), share = place - index;
  return stops[index].map((low, c) => low + (stops[index + 1][c] - low) * share);
}
