// The panel: which entries there are, the tree of the chosen one, and requests for changes, one after the other.

// The choice: an entry by its list and name, and within its tree a node, by the path of the name that leads to it.
const chosen = { list: "material", name: null, via: null };

// ---- requests ----

const queue = [];
let isAsking = false;

// Asks for changes; a later one of the same gesture takes the place of one that still waits.
function change(changes, gesture = null) {
  const last = queue.at(-1);
  if (gesture !== null && last?.gesture === gesture) last.body.changes = changes;
  else queue.push({ path: "edit", gesture, body: { changes, gesture } });
  ask();
}

// Asks for a place of the camera, or with null for that of the text; a later one takes the place of one that still waits.
function look(to) {
  const last = queue.at(-1);
  if (last?.path === "look") last.body.look = to;
  else queue.push({ path: "look", body: { look: to } });
  ask();
}

function request(path, body = {}) {
  queue.push({ path, body });
  ask();
}

async function ask() {
  if (isAsking) return;
  isAsking = true;
  while (queue.length) {
    const { path, body } = queue.shift();
    try {
      const answer = await fetch(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ revision: model.revision, ...body }) });
      if (answer.ok) {
        model = await answer.json();
        say(path === "save" ? `${model.file} is saved.` : "");
      } else await refused(path, answer.status, await answer.text());
    } catch {
      say("gpt has ended; nothing can be changed or saved any more.");
    }
    if (!queue.some((one) => one.path === "look")) asked = null;
    render();
  }
  isAsking = false;
}

async function refused(path, status, words) {
  say(words);
  if (path === "save" && status === 409 && words.includes("another program")) {
    $("say").append(" ", press("save all the same", "save over what the other program wrote", () => request("save", { overwrite: true })));
    return;
  }
  model = await (await fetch("document")).json();
}

function say(words) { $("say").textContent = words; }

// ---- the panel ----

const entries = (list) => model.lists[list] ?? [];
const indexOf = (list, name) => entries(list).findIndex((entry) => entry.name === name);
const itemSchema = (list) => resolve(schema.properties[list].items);

// The entry whose form is shown, by its path; null where nothing is.
function nodePath() {
  const name = chosen.via ? at(chosen.via) : chosen.name, index = indexOf(chosen.list, name);
  return index < 0 ? null : [chosen.list, index];
}

function choose(list, name, via = null) {
  Object.assign(chosen, { list, name, via });
  render(true);
}

// If only numbers and colours differ, fields show them; else the panel is built anew.
let outline = "";
function render(isForced = false) {
  if (!model || !schema) return;
  if (indexOf(chosen.list, chosen.name) < 0) Object.assign(chosen, { list: "material", name: entries("material")[0]?.name ?? null, via: null });
  if (chosen.via && nodePath() === null) chosen.via = null;
  $("file").textContent = model.file;
  $("unsaved").textContent = model.unsaved ? "● not saved" : "";
  $("undo").disabled = !model.can_undo;
  $("redo").disabled = !model.can_redo;
  renderCamera();
  const now = JSON.stringify([chosen, model.lists], (_, value) => (typeof value === "number" ? 0 : /^#[0-9a-f]{6}$/i.test(value) ? "#" : value));
  if (now === outline && !isForced) { shown.forEach((update) => update()); return; }
  outline = now;
  shown = [];
  const focus = document.activeElement?.closest("#panel") ? { path: document.activeElement.dataset.path, label: document.activeElement.getAttribute("aria-label") } : null;
  const scrolled = document.querySelector(".list")?.scrollTop ?? 0;
  renderEntries();
  renderTree();
  renderNode();
  document.querySelectorAll(".list").forEach((list) => { list.scrollTop = scrolled; });
  if (focus && document.activeElement === document.body) {
    const same = [...document.querySelectorAll("#panel [aria-label]")].filter((one) => one.getAttribute("aria-label") === focus.label);
    (same.find((one) => one.dataset.path === focus.path) ?? same[0] ?? $("node-title")).focus({ preventScroll: true });
  }
}

function renderEntries() {
  $("entries").replaceChildren(...model.editable.flatMap((list) => {
    const schema_ = itemSchema(list), types = variants(schema_);
    const buttons = entries(list).map((entry) => {
      const button = press("", `${list} ${entry.name}`, () => choose(list, entry.name), { "aria-current": String(chosen.list === list && chosen.name === entry.name) });
      button.replaceChildren(make("span", { textContent: entry.name }), make("span", { className: "kind", textContent: entry.type ?? "" }));
      return make("li", {}, button);
    });
    const name = make("input", { type: "text", placeholder: "name", "aria-label": `name of the new ${list}`, size: 10 });
    const type = types.length ? make("select", { "aria-label": `type of the new ${list}` }, ...types.map((one) => option(one.properties.type.const))) : null;
    const add = () => {
      const chosenName = name.value.trim() || freeName(list);
      if (indexOf(list, chosenName) >= 0) { say(`There is a ${list} named ${chosenName}.`); return; }
      const variant = type ? types.find((one) => one.properties.type.const === type.value) : schema_;
      const value = exampleOfTable(variant, type ? { name: chosenName, type: type.value } : { name: chosenName });
      change([{ do: "insert", at: [list, entries(list).length], value }]);
      Object.assign(chosen, { list, name: chosenName, via: null });
    };
    return [make("h2", { textContent: `${list[0].toUpperCase()}${list.slice(1)}s`.replace("iums", "ia") }), make("ul", { className: "list" }, ...buttons),
      make("div", { className: "tools" }, name, type, press("add", `add a ${list}`, add))];
  }));
}

function freeName(list) {
  for (let number = 1; ; number++) if (indexOf(list, `${list} ${number}`) < 0) return `${list} ${number}`;
}

// An entry, and below it those that it names in the same list.
function renderTree() {
  const branch = (name, via, above) => {
    const index = indexOf(chosen.list, name), entry = entries(chosen.list)[index];
    const inside = Object.values(entry ?? {}).filter((value) => isTable(value) && typeof value.type === "string").map((value) => value.type);
    const isHere = JSON.stringify(chosen.via) === JSON.stringify(via);
    const button = press("", `node ${name}`, () => choose(chosen.list, chosen.name, via), { "aria-current": String(isHere), disabled: !entry });
    button.replaceChildren(make("span", { textContent: name }), make("span", { className: "kind", textContent: [entry?.type ?? "", ...inside].join(" · ") }));
    const names = entry && !above.includes(name) ? namesIn(entry, [chosen.list, index]) : [];
    return make("li", {}, button, names.length ? make("ul", {}, ...names.map(([below, path]) => branch(below, path, [...above, name]))) : null);
  };
  $("tree").replaceChildren(...(chosen.name === null ? [] : [branch(chosen.name, null, [])]));
}

// Names of entries of the same list, each with its path.
function namesIn(entry, path) {
  return Object.entries(entry).filter(([key]) => model.references[key] === path[0]).flatMap(([key, value]) =>
    Array.isArray(value) ? value.map((name, index) => [name, [...path, key, index]]) : [[value, [...path, key]]]);
}

function renderNode() {
  const path = nodePath(), entry = path && at(path);
  $("node-title").textContent = entry ? `${path[0]} ${entry.name}` : "Nothing is chosen";
  if (!entry) { $("node-tools").replaceChildren(); $("form").replaceChildren(); return; }
  const [list, index] = path, schema_ = itemSchema(list), types = variants(schema_), variant = types.length ? variantOf(schema_, entry) : schema_;
  const tools = [];
  if (types.length) {
    const select = make("select", { id: "type", "aria-label": "type", onchange: () => set(path, retyped(schema.properties[list].items, at(path), select.value)) },
      ...types.map((one) => option(one.properties.type.const, one.properties.type.const, one.description ?? "")));
    tools.push(show(select, [...path, "type"], (value) => { select.value = value ?? ""; }));
  }
  if (list === "material") tools.push(press("wrap in a blend", "wrap in a blend", () => change([{ do: "wrap", at: chosen.via ?? path }])));
  if (index > 0) tools.push(press("↑", "move up in the file", () => change([{ do: "move", at: path, to: index - 1 }])));
  if (index + 1 < entries(list).length) tools.push(press("↓", "move down in the file", () => change([{ do: "move", at: path, to: index + 1 }])));
  tools.push(press("remove", `remove ${entry.name}`, () => change([{ do: "unset", at: path }])));
  $("node-tools").replaceChildren(...tools);
  $("form").replaceChildren(make("small", { className: "small", textContent: variant?.description ?? "" }), ...(variant ? rows(variant, path) : []));
}

// ---- keys, and news of the picture ----

$("undo").addEventListener("click", () => request("undo"));
$("redo").addEventListener("click", () => request("redo"));
$("save").addEventListener("click", () => request("save"));
document.addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
  const key = event.key.toLowerCase(), act = key === "z" ? (event.shiftKey ? "redo" : "undo") : key === "y" ? "redo" : key === "s" ? "save" : null;
  if (!act) return;
  event.preventDefault();
  // A text that is being typed counts as entered.
  if (document.activeElement?.tagName === "INPUT") document.activeElement.dispatchEvent(new Event("change"));
  request(act);
});
window.addEventListener("beforeunload", (event) => { if (model?.unsaved) event.preventDefault(); });

// Mistakes in the scene are told beside the fields. The picture of another page's change brings that change.
$("mistake").append($("message"));
$("node-title").tabIndex = -1;
tellCanvas();

async function begin() {
  [schema, model] = await Promise.all(["schema", "document"].map(async (path) => (await fetch(path)).json()));
  render(true);
  for (let round = state?.round ?? 0; ; await pause(500)) {
    if (isAsking || queue.length || state === null || state.round === round) continue;
    round = state.round;
    const news = await fetch("document").then((answer) => answer.json()).catch(() => null);
    if (news && !isAsking && (news.revision > model.revision || JSON.stringify(news.camera) !== JSON.stringify(model.camera))) { model = news; render(); }
  }
}
begin();
