// A form made from the JSON Schema of scene files: what kinds of values a key takes, what it is when left out, and an example to begin with. Nothing
// here knows a material by name.

let schema = null, model = null;

// ---- the schema ----

function resolve(node) {
  let resolved = node;
  while (resolved?.$ref) {
    const { $ref, ...rest } = resolved;
    resolved = { ...schema.$defs[$ref.split("/").pop()], ...rest, definition: $ref };
  }
  return resolved ?? {};
}

// The values that a key takes, each of a form of its own; choices among texts and among tables with a type stay together.
function kinds(node) {
  const resolved = resolve(node);
  return resolved.anyOf && !resolved.properties ? resolved.anyOf.flatMap(kinds) : [resolved];
}

const variants = (node) => (node.oneOf ?? []).filter((one) => one.properties?.type?.const !== undefined);
const choices = (node) => node.enum ?? (node.oneOf?.every((one) => one.const !== undefined) ? node.oneOf.map((one) => one.const) : null);
const variantOf = (node, value) => variants(node).find((one) => one.properties.type.const === value?.type);
const isColour = (all) => all.some((kind) => kind.type === "array" && kind.minItems === 3) && all.some((kind) => kind.pattern);
const isTable = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

// True where a value is of this kind; ranges are left to gpt.
function fits(node, value) {
  return kinds(node).some((kind) => {
    if (variants(kind).length) return isTable(value) && variantOf(kind, value) !== undefined;
    const texts = choices(kind);
    if (texts) return texts.includes(value);
    switch (kind.type) {
      case "number": case "integer": return typeof value === "number";
      case "boolean": return typeof value === "boolean";
      case "string": return typeof value === "string" && (!kind.pattern || new RegExp(kind.pattern).test(value));
      case "array":
        return Array.isArray(value) && value.length >= (kind.minItems ?? 0) && value.length <= (kind.maxItems ?? Infinity) && value.every((item) => fits(kind.items, item));
      case "object":
        return isTable(value) && (kind.required ?? []).every((key) => key in value) && Object.keys(value).every((key) => key in (kind.properties ?? {}));
      default: return true;
    }
  });
}

// The value that holds when a key is left out, as far as the schema says so.
function defaultOf(node) {
  const resolved = resolve(node);
  if (resolved.default !== undefined) return resolved.default;
  const found = /(?:^|[\s;,(])(-?\d+(?:\.\d+)?|"[^"]*"|true|false|\[[-\d., ]+\]) when left out/.exec(resolved.description ?? "");
  return found ? JSON.parse(found[1]) : undefined;
}

// The first entry that a key can name; none is a part of itself to begin with.
const firstName = (key, own) => model.lists[model.references[key]]?.find((entry) => entry.name !== own)?.name;

// A value to begin with.
function example(node, key = "", own = null) {
  const resolved = resolve(node), known = defaultOf(node), all = kinds(node);
  if (known !== undefined && isColour(all) && typeof known === "number") return [known, known, known];
  if (known !== undefined && fits(node, known)) return known;
  if (all.length > 1) return example(all[0], key, own);
  const kind = all[0], of = variants(kind);
  if (of.length) return exampleOfTable(of[0], { type: of[0].properties.type.const });
  const texts = choices(kind);
  if (texts) return texts[0];
  if (resolved.const !== undefined) return resolved.const;
  switch (kind.type) {
    case "number": case "integer": return kind.type === "integer" ? Math.max(1, kind.minimum ?? 1) : Math.min(kind.maximum ?? 0.5, Math.max(kind.minimum ?? 0.5, 0.5));
    case "boolean": return false;
    case "array": return Array.from({ length: kind.minItems ?? 1 }, () => example(kind.items, key, own));
    case "object": return exampleOfTable(kind, {});
    default: return firstName(key, own) ?? "";
  }
}

// A table with all that it needs; what it needs one of, the one that needs least.
function exampleOfTable(kind, given) {
  const table = { ...given };
  const add = (keys) => keys.forEach((key) => { if (!(key in table)) table[key] = example(kind.properties[key], key, given.name); });
  add(kind.required ?? []);
  for (const rule of [kind, ...(kind.allOf ?? [])]) {
    const ways = (rule.oneOf ?? []).map((way) => way.required ?? []);
    if (ways.length && !ways.some((way) => way.every((key) => key in table))) add(ways.reduce((least, way) => (way.length < least.length ? way : least)));
  }
  return table;
}

// A table of another type that keeps what both have. One that holds others of its own kind takes the old one in; one that is taken out comes alone.
function retyped(node, old, type) {
  const resolved = resolve(node), variant = variants(resolved).find((one) => one.properties.type.const === type);
  const inner = Object.entries(old).find(([key, value]) => isTable(value) && value.type === type && !(key in variant.properties));
  if (inner) return inner[1];
  const kept = { type };
  for (const [key, value] of Object.entries(old))
    if (key !== "type" && key in variant.properties && fits(variant.properties[key], value)) kept[key] = value;
  for (const key of variant.required ?? [])
    if (!(key in kept) && resolved.definition && resolve(variant.properties[key]).definition === resolved.definition) kept[key] = old;
  return exampleOfTable(variant, kept);
}

// ---- colours ----

const tidy = (number) => Number(number.toPrecision(6));
// Beyond 1 a colour is shown with its largest channel at 1.
const hex = (rgb) => `#${rgb.map((channel) => Math.round(255 * toSrgb(Math.min(1, Math.max(0, channel / Math.max(1, ...rgb))))).toString(16).padStart(2, "0")).join("")}`;
const linear = (text) => [1, 3, 5].map((at) => tidy(toLinear(parseInt(text.slice(at, at + 2), 16) / 255)));

// A value that is as near to another one as its kind allows.
function converted(all, kind, value, key) {
  if (isColour(all)) {
    const rgb = typeof value === "number" ? [value, value, value] : Array.isArray(value) ? value : typeof value === "string" ? linear(value) : null;
    if (rgb && kind.type === "array") return rgb;
    if (rgb && kind.type === "number") return tidy(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
    if (rgb && kind.pattern) return hex(rgb);
  }
  return example(kind, key);
}

// ---- elements ----

function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in element && !name.includes("-")) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const press = (text, label, act, more = {}) => make("button", { type: "button", textContent: text, title: label, "aria-label": label, onclick: act, ...more });
const option = (value, text = value, title = "") => make("option", { value, textContent: text, title });

// Controls that show values again when they are changed elsewhere, by undo say. One in which somebody types or drags is left alone until that is over.
let shown = [];
function show(element, path, update) {
  let isBusy = false;
  element.dataset.path ??= JSON.stringify(path);
  element.addEventListener("input", () => { isBusy = true; });
  element.addEventListener("change", () => { isBusy = false; });
  shown.push(() => { if (!isBusy) update(at(path)); });
  update(at(path));
  return element;
}
const at = (path) => path.reduce((value, step) => value?.[step], model.lists);

const kindName = (kind, all) => (isColour(all) && kind.type === "array" ? "linear RGB" : kind.pattern ? "sRGB hex" : kind.type === "object" ? (kind.required?.[0] ?? "table") : kind.type === "array" ? "list" : isColour(all) ? "grey" : kind.type);

// The controls of a value. `label` names them for those who cannot see where they stand.
function controls(node, path, label) {
  const all = kinds(node), key = path.findLast((step) => typeof step === "string");
  const box = make("div", { className: "controls" });
  if (all.length > 1) {
    const value = at(path), index = Math.max(0, all.findIndex((kind) => fits(kind, value)));
    const select = make("select", { "aria-label": `kind of ${label}`, onchange: () => set(path, converted(all, all[select.value], at(path), key)) }, ...all.map((kind, place) => option(place, kindName(kind, all))));
    select.value = index;
    select.dataset.path = JSON.stringify([...path, "kind"]);
    box.append(select, ...controlsOf(all[index], path, label, key, isColour(all)));
  } else box.append(...controlsOf(all[0], path, label, key, false));
  return box;
}

function controlsOf(kind, path, label, key, inColour) {
  const texts = choices(kind);
  if (variants(kind).length) return [variantControls(kind, path, label)];
  if (texts) return [selectOf(texts.map((text, index) => option(text, text, kind.oneOf?.[index].description ?? "")), path, label)];
  if (kind.type === "boolean") {
    const box = make("input", { type: "checkbox", "aria-label": label, onchange: () => set(path, box.checked) });
    return [show(box, path, (value) => { box.checked = value === true; })];
  }
  if (kind.type === "number" || kind.type === "integer") return slider(kind, path, label);
  if (kind.pattern) return [swatch(path, label, (value) => value, (text) => text), field(path, label)];
  if (kind.type === "string") {
    const list = model.references[key];
    if (!list) return [field(path, label)];
    const names = model.lists[list].map((entry) => entry.name);
    if (!names.includes(at(path))) names.unshift(at(path));
    return [selectOf(names.map((name) => option(name)), path, label)];
  }
  if (kind.type === "array" && kind.minItems === kind.maxItems && resolve(kind.items).type === "number") {
    const numbers = Array.from({ length: kind.minItems }, (_, index) => number(kind.items, [...path, index], `${label} ${inColour ? ["red", "green", "blue"][index] : index + 1}`));
    const toHex = (value) => (Array.isArray(value) ? hex(value) : "#000000");
    // The swatch keeps how bright a colour beyond 1 is.
    const fromHex = (text) => linear(text).map((channel) => tidy(channel * Math.max(1, ...at(path))));
    return inColour ? [swatch(path, label, toHex, fromHex), ...numbers] : numbers;
  }
  if (kind.type === "array") return [listControls(kind, path, label)];
  if (kind.type === "object") return [make("div", { className: "nest" }, ...rows(kind, path))];
  return [field(path, label)];
}

function selectOf(options, path, label) {
  const select = make("select", { "aria-label": label, onchange: () => set(path, select.value) }, ...options);
  return show(select, path, (value) => { select.value = value ?? ""; });
}

function field(path, label) {
  const text = make("input", { type: "text", "aria-label": label, onchange: () => set(path, text.value) });
  return show(text, path, (value) => { text.value = value ?? ""; });
}

function swatch(path, label, toHex, fromHex) {
  const picker = make("input", { type: "color", "aria-label": `${label}, as sRGB`, title: "sRGB; the numbers are linear" });
  dragging(picker, (gesture) => set(path, fromHex(picker.value), gesture));
  return show(picker, path, (value) => { picker.value = toHex(value) ?? "#000000"; });
}

function number(node, path, label) {
  const kind = resolve(node), input = make("input", { type: "number", step: kind.type === "integer" ? 1 : "any", "aria-label": label });
  if (Math.abs(kind.minimum ?? Infinity) < 1e9) input.min = kind.minimum;
  if ((kind.maximum ?? Infinity) < 1e9) input.max = kind.maximum;
  dragging(input, (gesture) => { if (input.value !== "") set(path, Number(input.value), gesture); });
  return show(input, path, (value) => { if (Number(input.value) !== value || input.value === "") input.value = value ?? ""; });
}

// The range of the schema where it is one that a hand can cover, else one about the value.
function slider(kind, path, label) {
  const value = Math.abs(at(path) ?? 0), soft = 10 ** Math.ceil(Math.log10(Math.max(1, 2 * value)));
  const low = kind.minimum ?? kind.exclusiveMinimum ?? -Infinity, high = kind.maximum ?? Infinity;
  const min = low > -1e9 ? low : -soft, max = high < 1e9 ? high : soft;
  const step = kind.type === "integer" ? 1 : (max - min) / 1000;
  const range = make("input", { type: "range", min, max, step, "aria-label": `${label}, slider` });
  const nonZero = (value) => (kind.exclusiveMinimum !== undefined && value <= kind.exclusiveMinimum ? min + step : value);
  dragging(range, (gesture) => set(path, tidy(nonZero(Number(range.value))), gesture));
  return [show(range, path, (value) => { range.value = value ?? min; }), number(kind, path, label)];
}

// All changes from the first movement until it is let go are one step for undo.
let gestures = 0;
function dragging(input, act) {
  let gesture = null;
  input.addEventListener("input", () => { gesture ??= `${Date.now()} ${++gestures}`; act(gesture); });
  input.addEventListener("change", () => { gesture = null; });
}

function variantControls(kind, path, label) {
  const select = make("select", { "aria-label": `type of ${label}`, onchange: () => set(path, retyped(kind.definition ? { $ref: kind.definition } : kind, at(path), select.value)) },
    ...variants(kind).map((one) => option(one.properties.type.const, one.properties.type.const, one.description ?? "")));
  show(select, [...path, "type"], (value) => { select.value = value ?? ""; });
  const variant = variantOf(kind, at(path));
  return make("div", { className: "nest" }, make("div", { className: "item" }, select), make("small", { className: "small", textContent: variant?.description ?? "" }), ...(variant ? rows(variant, path) : []));
}

function listControls(kind, path, label) {
  const items = at(path) ?? [], box = make("div", { className: "nest" });
  items.forEach((_, index) => {
    const own = [...path, index], name = `${label} ${index + 1}`;
    box.append(make("div", { className: "item" }, controls(kind.items, own, name),
      index > 0 ? press("↑", `move ${name} up`, () => change([{ do: "move", at: own, to: index - 1 }]), { className: "tiny" }) : null,
      items.length > (kind.minItems ?? 0) ? press("×", `remove ${name}`, () => change([{ do: "unset", at: own }]), { className: "tiny" }) : null));
  });
  if (items.length < (kind.maxItems ?? Infinity))
    box.append(press("add", `add to ${label}`, () => change([{ do: "insert", at: [...path, items.length], value: example(kind.items, path.findLast((step) => typeof step === "string")) }])));
  return box;
}

// A row for each key of a table: those that are set, then the others, folded up.
const HIDDEN = ["type", "name"];
function rows(kind, path) {
  const table = at(path) ?? {}, required = kind.required ?? [];
  const keys = Object.keys(kind.properties ?? {}).filter((key) => !HIDDEN.includes(key) || (key === "name" && path.length > 2));
  const stated = keys.filter((key) => key in table), others = keys.filter((key) => !(key in table));
  const head = (key, button) => make("div", { className: "head" }, make("span", { className: "name", textContent: key }), button);
  const about = (key) => make("small", { textContent: resolve(kind.properties[key]).description ?? "" });
  const rowOf = (key) => {
    const own = [...path, key], unset = required.includes(key) ? null : press("×", `leave out ${key}`, () => change([{ do: "unset", at: own }]), { className: "tiny" });
    return make("div", { className: "row", role: "group", "aria-label": key, "data-key": key }, head(key, unset), controls(kind.properties[key], own, key), about(key));
  };
  const unsetRow = (key) => {
    const known = defaultOf(kind.properties[key]), own = [...path, key];
    const begin = press("set", `set ${key}`, () => set(own, example(kind.properties[key], key)), { className: "tiny" });
    const words = known === undefined ? "not set" : `not set: ${typeof known === "string" ? known : JSON.stringify(known)}`;
    return make("div", { className: "row", role: "group", "aria-label": key, "data-key": key }, head(key, make("span", { className: "small", textContent: words })), begin, about(key));
  };
  const unknown = Object.keys(table).filter((key) => !(key in (kind.properties ?? {})) && !HIDDEN.includes(key)).map((key) =>
    make("div", { className: "row" }, head(key, press("×", `leave out ${key}`, () => change([{ do: "unset", at: [...path, key] }]), { className: "tiny" })), make("small", { textContent: "is no key of this type" })));
  const folded = others.length ? make("details", {}, make("summary", { textContent: `${others.length} more ${others.length === 1 ? "key" : "keys"}` }), ...others.map(unsetRow)) : null;
  if (folded) {
    const id = JSON.stringify(path);
    folded.dataset.path = id;
    folded.open = unfolded.has(id);
    folded.addEventListener("toggle", () => (folded.open ? unfolded.add(id) : unfolded.delete(id)));
  }
  return [...stated.map(rowOf), ...unknown, folded].filter((row) => row !== null);
}
const unfolded = new Set();

const set = (path, value, gesture = null) => change([{ do: "set", at: path, value }], gesture);
