const $ = (id) => document.getElementById(id);
const canvas = $("canvas"), screen = canvas.getContext("2d");
const picture = { width: 0, height: 0, number: 0, values: new Float32Array(0) };
const developed = document.createElement("canvas");
// The place of the picture's corner on the canvas, and screen pixels for one of its own. It fits until somebody moves it.
const place = { x: 0, y: 0, scale: 1, fits: true };
let state = null, wanted = "", layer = "", autoExposure = false, frame = 0, isStale = true, pointer = null;

// ---- news ----

async function follow() {
  let after = 0;
  for (;;) {
    while (document.hidden) await new Promise((resolve) => document.addEventListener("visibilitychange", resolve, { once: true }));
    try {
      const answer = await fetch(`state?after=${after}`);
      if (!answer.ok) throw new Error(answer.statusText);
      const first = state === null;
      state = await answer.json();
      after = state.version;
      if (first) takeDisplay();
      tell();
      await refresh();
      await pause(60);
    } catch {
      $("phase").textContent = "gpt has ended; this is what it showed last";
      $("phase").className = "failed";
      $("exr").disabled = true;
      after = 0;
      await pause(2000);
    }
  }
}

const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

function takeDisplay() {
  $("curve").value = state.tonemap;
  autoExposure = state.exposure === "auto";
  if (!autoExposure) $("exposure").value = state.exposure;
}

function tell() {
  const words = { preparing: "preparing the scene and compiling kernels", layers: "rendering layers, then the picture", rendering: "rendering", finished: "finished", stopped: "stopped", failed: "failed" };
  document.title = state.scene ? `${state.scene} – gpt` : "gpt";
  $("scene").textContent = state.scene || "gpt";
  $("phase").textContent = words[state.phase];
  $("phase").className = state.phase;
  const share = state.phase === "finished" ? 1 : state.total > 0 ? state.done / state.total : 0;
  $("progress").value = share;
  const [fewest, most] = state.samples, facts = [];
  if (state.width) facts.push(`${state.width}×${state.height}`, fewest === most ? `${fewest} spp` : `${fewest} to ${most} spp`);
  if (["layers", "rendering"].includes(state.phase) && share > 0) facts.push(`${Math.floor(100 * share)} %`);
  facts.push(`${state.seconds.toFixed(1)} s`);
  if (state.interval) facts.push(`within ${(100 * state.interval[0]).toPrecision(3)} % with ${100 * state.interval[1]} %`);
  if (state.error) facts.push(`relMSE ${state.error[0].toExponential(1)}, below ${state.error[1].toExponential(1)} with 95 %`);
  else if (state.noise !== null) facts.push(`relMSE about ${state.noise.toExponential(1)} or less`);
  if (state.round > 1) facts.push(`render ${state.round}`);
  if (state.device) facts.push(state.device);
  if (state.phase === "finished" && state.files.length) facts.push(`saved as ${state.files.join(", ")}`);
  $("facts").textContent = facts.join(" · ");
  $("facts").title = state.noise !== null ? "Relative mean squared error as gpt compare measures it, were all samples independent; those of sobol and the like do better" : "";
  $("message").hidden = !state.message;
  $("message").textContent = state.message;
  tellGroups();
  const known = [...$("layer").options].slice(3).map((option) => option.value);
  if (known.join() !== state.layers.join()) {
    [...$("layer").options].slice(3).forEach((option) => option.remove());
    state.layers.forEach((name) => $("layer").add(new Option(name, name)));
    $("layer").value = state.layers.includes(layer) || layer === "noise" || layer === "samples" ? layer : (layer = "");
  }
}

const isOfServer = () => layer !== "" && layer !== "noise" && layer !== "samples";

async function refresh() {
  const name = isOfServer() ? layer : "", key = `${state.picture}/${name}/${state.round}`;
  if (key === wanted || (!state.picture && !name)) return;
  const answer = await fetch(name ? `picture?layer=${encodeURIComponent(name)}` : "picture");
  if (!answer.ok) return;
  const buffer = await answer.arrayBuffer(), [width, height, number] = new Uint32Array(buffer, 0, 3);
  const isOther = width !== picture.width || height !== picture.height;
  Object.assign(picture, { width, height, number, values: new Float32Array(buffer, 12) });
  wanted = key;
  if (isOther) {
    developed.width = width;
    developed.height = height;
    if (place.fits) fit();
  }
  isStale = true;
  draw();
}

// ---- drawing ----

function draw() {
  if (!frame) frame = requestAnimationFrame(() => { frame = 0; paint(); });
}

function paint() {
  const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
  const width = Math.max(1, Math.round(box.width * ratio)), height = Math.max(1, Math.round(box.height * ratio));
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    if (place.fits) fit();
  }
  if (isStale && picture.width) develop();
  screen.setTransform(1, 0, 0, 1, 0, 0);
  screen.clearRect(0, 0, width, height);
  if (picture.width) {
    screen.imageSmoothingEnabled = place.scale < 1;
    screen.imageSmoothingQuality = "high";
    screen.setTransform(place.scale, 0, 0, place.scale, place.x, place.y);
    screen.drawImage(developed, 0, 0);
    $("zoom").textContent = `${Math.round(100 * place.scale)} %`;
  }
  $("stops").textContent = `${Number($("exposure").value).toFixed(1)} EV`;
  $("auto").setAttribute("aria-pressed", autoExposure);
  read();
}

function develop() {
  isStale = false;
  const context = developed.getContext("2d"), image = context.createImageData(picture.width, picture.height), bytes = image.data;
  const values = shownValues(), pixels = picture.width * picture.height;
  const isRadiance = layer === "" || groups.names.includes(layer) || ["Albedo", "Direct", "Indirect", "Emission"].includes(layer);
  if (isRadiance) {
    if (autoExposure && layer === "") $("exposure").value = meter(values).toFixed(1);
    const show = developer($("curve").value, layer === "Albedo" ? 0 : Number($("exposure").value));
    for (let pixel = 0, at = 0; pixel < pixels; pixel++, at += 5) show(values[at], values[at + 1], values[at + 2], bytes, 4 * pixel);
  } else if (layer === "noise") {
    // Standard errors as shares of the luminance, over four decades.
    for (let pixel = 0, at = 0; pixel < pixels; pixel++, at += 5) {
      const share = values[at + 4] / Math.max(1e-9, luminance(values, at));
      bytes.set([...heat(share > 0 ? 1 + Math.log10(share) / 4 : 0), 255], 4 * pixel);
    }
  } else if (layer === "N") {
    for (let pixel = 0, at = 0; pixel < pixels; pixel++, at += 5)
      bytes.set([127.5 + 127.5 * values[at], 127.5 + 127.5 * values[at + 1], 127.5 + 127.5 * values[at + 2], 255], 4 * pixel);
  } else {
    const first = layer === "samples" ? 3 : 0, planes = layer === "samples" ? [3, 3, 3] : [0, 1, 2];
    let low = Infinity, high = -Infinity;
    for (let at = first; at < values.length; at += 5) {
      if (values[at] < low) low = values[at];
      if (values[at] > high) high = values[at];
    }
    if (layer === "samples") low = 0;
    const factor = high > low ? 255 / (high - low) : 0;
    for (let pixel = 0, at = 0; pixel < pixels; pixel++, at += 5)
      bytes.set([...planes.map((plane) => (values[at + plane] - low) * factor), 255], 4 * pixel);
  }
  context.putImageData(image, 0, 0);
}

const luminance = (values, at) => 0.2126 * values[at] + 0.7152 * values[at + 1] + 0.0722 * values[at + 2];

// Stops that make the geometric mean middle grey; black does not count.
function meter(values) {
  let sum = 0, count = 0;
  for (let at = 0; at < values.length; at += 5) {
    const value = luminance(values, at);
    if (value > 1e-12 && value < Infinity) { sum += Math.log2(value); count++; }
  }
  return count ? Math.max(-20, Math.min(20, Math.log2(0.18) - sum / count)) : 0;
}

function read() {
  if (!pointer || !picture.width) return;
  const x = Math.floor((pointer.x - place.x) / place.scale), y = Math.floor((pointer.y - place.y) / place.scale);
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) { $("readout").textContent = "Point at a pixel for its values."; return; }
  const at = 5 * (y * picture.width + x), values = shownValues();
  const numbers = [0, 1, 2].map((c) => values[at + c].toPrecision(5)).join("  ");
  const error = values[at + 4], samples = values[at + 3];
  const rest = isOfServer() || values !== picture.values ? "" : `   luminance ${luminance(values, at).toPrecision(4)}${error >= 0 ? ` ± ${error.toPrecision(2)}` : ""}   ${samples} samples`;
  $("readout").textContent = `${x}, ${y}   ${numbers}${rest}`;
}

// ---- place ----

function fit() {
  const scale = Math.min(canvas.width / picture.width, canvas.height / picture.height);
  // Small pictures are shown by whole numbers of pixels.
  place.scale = scale >= 2 ? Math.floor(scale) : scale;
  place.x = (canvas.width - place.scale * picture.width) / 2;
  place.y = (canvas.height - place.scale * picture.height) / 2;
  place.fits = true;
}

function zoom(factor, x = canvas.width / 2, y = canvas.height / 2) {
  const scale = Math.min(256, Math.max(1 / 64, place.scale * factor));
  place.x = x - (x - place.x) * (scale / place.scale);
  place.y = y - (y - place.y) * (scale / place.scale);
  place.scale = scale;
  place.fits = false;
  draw();
}

function onCanvas(event) {
  const box = canvas.getBoundingClientRect();
  return { x: ((event.clientX - box.left) / box.width) * canvas.width, y: ((event.clientY - box.top) / box.height) * canvas.height };
}

const fingers = new Map();
canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, onCanvas(event));
});
canvas.addEventListener("pointermove", (event) => {
  pointer = onCanvas(event);
  const before = fingers.get(event.pointerId);
  if (before) {
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const distance = (a) => Math.hypot(a.x - other.x, a.y - other.y);
      zoom(distance(pointer) / Math.max(1, distance(before)), other.x, other.y);
    } else {
      place.x += pointer.x - before.x;
      place.y += pointer.y - before.y;
      place.fits = false;
    }
    fingers.set(event.pointerId, pointer);
  }
  draw();
});
for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, (event) => fingers.delete(event.pointerId));
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  const { x, y } = onCanvas(event);
  zoom(2 ** (-event.deltaY / (event.deltaMode ? 10 : 300)), x, y);
}, { passive: false });

// ---- tools ----

function restage() { isStale = true; draw(); }
$("exposure").addEventListener("input", () => { autoExposure = false; restage(); });
$("auto").addEventListener("click", () => { autoExposure = !autoExposure; restage(); });
$("curve").addEventListener("change", restage);
$("layer").addEventListener("change", async () => { layer = $("layer").value; if (state) await refresh(); restage(); });
$("in").addEventListener("click", () => zoom(2));
$("out").addEventListener("click", () => zoom(0.5));
$("fit").addEventListener("click", () => { fit(); draw(); });
$("one").addEventListener("click", () => zoom(1 / place.scale));
$("png").addEventListener("click", () => developed.toBlob((blob) => save(blob, "png"), "image/png"));
$("exr").addEventListener("click", async () => {
  $("exr").disabled = true;
  try {
    const answer = await fetch("picture.exr");
    if (answer.ok) save(await answer.blob(), "exr");
  } finally { $("exr").disabled = false; }
});

function save(blob, ending) {
  if (!blob) return;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = `${state?.scene || "picture"}-${state ? state.samples[0] : 0}spp.${ending}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT"].includes(event.target.tagName)) return;
  const step = 40 * (window.devicePixelRatio || 1);
  const move = (x, y) => { place.x += x * step; place.y += y * step; place.fits = false; draw(); };
  const keys = {
    "+": () => zoom(2), "=": () => zoom(2), "-": () => zoom(0.5), 0: () => { fit(); draw(); }, 1: () => zoom(1 / place.scale),
    a: () => $("auto").click(), ArrowLeft: () => move(1, 0), ArrowRight: () => move(-1, 0), ArrowUp: () => move(0, 1), ArrowDown: () => move(0, -1),
  };
  const act = keys[event.key];
  if (act) { event.preventDefault(); act(); }
});
window.addEventListener("resize", draw);
new ResizeObserver(draw).observe(canvas);
