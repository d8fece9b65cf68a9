// The camera by mouse, keys and fingers: round what it looks at, aside, nearer. The picture follows; the text only when it is kept.

let isLooking = false;
const TURN = Math.PI, NEAR = 1.2, STEEPEST = 0.999;

const sum = (a, b, factor = 1) => a.map((value, axis) => value + factor * b[axis]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, factor) => a.map((value) => factor * value);
const unit = (a) => scaled(a, 1 / Math.hypot(...a));
// Rodrigues' formula.
const turned = (a, axis, angle) => sum(sum(scaled(a, Math.cos(angle)), cross(axis, a), Math.sin(angle)), axis, dot(axis, a) * (1 - Math.cos(angle)));
// As many digits as a picture can tell of.
const rounded = (a, size) => a.map((value) => Number((Math.abs(value) < 1e-9 * size ? 0 : value).toPrecision(7)));

// The place that was asked for last, until there is an answer.
let asked = null;
const lookNow = () => asked ?? model.camera.look;

function lookFrom(position, look_at, up) {
  const size = Math.hypot(...sum(position, look_at, -1)) + Math.hypot(...look_at);
  asked = { position: rounded(position, size), look_at: rounded(look_at, size), up };
  look(asked);
}

// Round what it looks at, which turns to the right as a hand would turn it, and the camera up, in radians. The view never gets upright.
function orbit(right, up) {
  const { position, look_at, up: above } = lookNow(), axis = unit(above);
  let away = turned(sum(position, look_at, -1), axis, -right);
  const across = unit(cross(axis, away)), higher = turned(away, across, -up);
  if (Math.abs(dot(unit(higher), axis)) < STEEPEST) away = higher;
  lookFrom(sum(look_at, away), look_at, above);
}

// To the right and up, in heights of what is seen at the distance of what it looks at.
function pan(right, up) {
  const { position, look_at, up: above } = lookNow(), away = sum(position, look_at, -1), distance = Math.hypot(...away);
  const seen = 2 * distance * Math.tan((model.camera.vertical_fov ?? 40) * Math.PI / 360);
  const across = unit(cross(above, away)), upward = unit(cross(away, across));
  const way = sum(scaled(across, right * seen), upward, up * seen);
  lookFrom(sum(position, way), sum(look_at, way), above);
}

// So many times as far from what it looks at.
function dolly(times) {
  const { position, look_at, up } = lookNow();
  lookFrom(sum(look_at, sum(position, look_at, -1), times), look_at, up);
}

function setLooking(to) {
  isLooking = to && !model?.camera?.fixed;
  renderCamera();
  tellCanvas();
}

function tellCanvas() {
  canvas.setAttribute("aria-label", isLooking
    ? "the picture; drag to move the camera round what it looks at, with Shift aside, turn the wheel to go nearer; arrows do the same, plus and minus go nearer and further"
    : "the picture as the scene is now; drag to move it, turn the wheel to zoom");
}

function renderCamera() {
  const camera = model?.camera;
  $("look").disabled = !camera || camera.fixed !== null;
  $("look").setAttribute("aria-pressed", String(isLooking));
  $("keep").disabled = $("back").disabled = !camera?.is_moved;
  $("place").textContent = !camera ? "" : camera.fixed ?? (camera.is_moved || isLooking ? `from ${camera.look.position.map((value) => Number(value.toPrecision(3))).join(", ")}` : "");
}

// ---- mouse, fingers and keys, before the picture has them ----

const touching = new Map();
// The canvas may change its height while the panel is told of the camera; a drag does not change its measure.
let height = 1;
const onPicture = (event) => [event.clientX / height, event.clientY / height];

function take(event) {
  event.preventDefault();
  event.stopImmediatePropagation();
}

const moves = {
  pointerdown(event) {
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    if (touching.size === 0) height = Math.max(1, canvas.getBoundingClientRect().height);
    touching.set(event.pointerId, onPicture(event));
  },
  pointermove(event) {
    const before = touching.get(event.pointerId), now = onPicture(event);
    if (!before) return false;
    const [right, down] = sum(now, before, -1), other = [...touching].find(([id]) => id !== event.pointerId)?.[1];
    touching.set(event.pointerId, now);
    if (other) {
      const apart = (at) => Math.max(0.01, Math.hypot(...sum(at, other, -1)));
      dolly(apart(before) / apart(now));
      // Each of two fingers counts half.
      pan(-right / 2, down / 2);
    } else if (event.shiftKey || (event.buttons & 6) !== 0) pan(-right, down);
    else orbit(right * TURN, down * TURN);
    return true;
  },
  pointerup: (event) => touching.delete(event.pointerId),
  pointercancel: (event) => touching.delete(event.pointerId),
  wheel: (event) => dolly(2 ** (event.deltaY / (event.deltaMode ? 10 : 300))),
  contextmenu() {},
};
for (const [kind, act] of Object.entries(moves)) {
  // A pointer that only points still reads pixels.
  document.addEventListener(kind, (event) => { if (isLooking && model && event.target === canvas && act(event) !== false) take(event); }, { capture: true, passive: false });
}

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName) || !model) return;
  if (event.key.toLowerCase() === "c") { take(event); setLooking(!isLooking); return; }
  if (!isLooking || event.target !== canvas) return;
  const [right, up] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key] ?? [0, 0];
  if (right || up) { take(event); if (event.shiftKey) pan(0.05 * right, 0.05 * up); else orbit(-right * Math.PI / 36, up * Math.PI / 36); }
  else if (["+", "=", "-"].includes(event.key)) { take(event); dolly(event.key === "-" ? NEAR : 1 / NEAR); }
  else if (event.key === "Escape") setLooking(false);
}, { capture: true });

$("look").addEventListener("click", () => setLooking(!isLooking));
$("keep").addEventListener("click", () => request("keep"));
$("back").addEventListener("click", () => look(null));
