// Light groups: a slider and a colour for each, by which the shown picture is weighed anew from the groups' own layers. Light is linear, so this is
// the picture that lamps of other strengths would make; `gpt regroup` writes the same one to a file.

const groups = { names: [], weights: new Map(), layers: new Map(), layered: 0, sum: null };

const tintOf = (colour) => [1, 3, 5].map((at) => toLinear(parseInt(colour.slice(at, at + 2), 16) / 255));
const weightOf = (name) => groups.weights.get(name) ?? { strength: 1, tint: "#ffffff" };
const isPlain = (name) => weightOf(name).strength === 1 && weightOf(name).tint === "#ffffff";
const isRegrouped = () => groups.names.length > 0 && !groups.names.every(isPlain);

// The controls for the groups that the render has. Weights stay where a group of the same name is in the next render.
function tellGroups() {
  const names = state.groups;
  if (names.join() === groups.names.join() && groups.layered === state.layered) return;
  const isSame = names.join() === groups.names.join();
  Object.assign(groups, { names, layered: state.layered, layers: new Map(), sum: null });
  $("groups").hidden = names.length === 0;
  if (!isSame) $("sliders").replaceChildren(...names.map(controlsOf));
  tellWeights();
  if (isRegrouped()) weighAnew();
}

function controlsOf(name) {
  const row = document.createElement("span"), label = document.createElement("label"), strength = document.createElement("input");
  const output = document.createElement("output"), tint = document.createElement("input");
  row.className = "group";
  strength.id = `strength-${name}`;
  label.htmlFor = strength.id;
  label.textContent = name;
  Object.assign(strength, { type: "range", min: 0, max: 4, step: 0.05, value: weightOf(name).strength });
  strength.setAttribute("aria-label", `strength of the light group ${name}`);
  output.htmlFor = strength.id;
  output.id = `factor-${name}`;
  Object.assign(tint, { id: `tint-${name}`, type: "color", value: weightOf(name).tint, title: `Tint of the light group ${name}` });
  tint.setAttribute("aria-label", `tint of the light group ${name}`);
  const change = () => {
    groups.weights.set(name, { strength: Number(strength.value), tint: tint.value });
    tellWeights();
    weighAnew();
  };
  strength.addEventListener("input", change);
  tint.addEventListener("input", change);
  row.append(label, strength, output, tint);
  return row;
}

function tellWeights() {
  for (const name of groups.names) {
    const { strength } = weightOf(name);
    $(`factor-${name}`).textContent = `× ${strength.toFixed(2)}`;
    $(`strength-${name}`).setAttribute("aria-valuetext", `${strength.toFixed(2)} times as bright`);
  }
  const flags = groups.names.filter((name) => !isPlain(name)).map((name) => {
    const { strength, tint } = weightOf(name);
    return `--group ${name}=${strength}${tint === "#ffffff" ? "" : `,${tint}`}`;
  });
  $("regroup").textContent = flags.length ? `gpt regroup ${flags.join(" ")}` : "as rendered";
}

// Adds up the groups by their weights, and shows the sum. Layers are fetched once, until the render has others.
async function weighAnew() {
  groups.sum = null;
  if (isRegrouped()) {
    const { names, layered, layers } = groups;
    for (const name of names) {
      if (layers.has(name)) continue;
      const answer = await fetch(`picture?layer=${encodeURIComponent(name)}`);
      if (!answer.ok) return;
      const buffer = await answer.arrayBuffer(), [width, height] = new Uint32Array(buffer, 0, 2);
      layers.set(name, { width, height, values: new Float32Array(buffer, 12) });
    }
    if (layered !== groups.layered) return;
    const first = layers.get(names[0]), sum = new Float32Array(first.values.length).fill(NaN);
    const weights = names.map((name) => tintOf(weightOf(name).tint).map((part) => part * weightOf(name).strength));
    for (let at = 0; at < sum.length; at += 5) {
      for (let c = 0; c < 3; c++) {
        let light = 0;
        for (let group = 0; group < names.length; group++) light += weights[group][c] * layers.get(names[group]).values[at + c];
        sum[at + c] = light;
      }
      sum[at + 3] = 0;
    }
    groups.sum = { width: first.width, height: first.height, values: sum };
  }
  restage();
}

// The numbers that are shown: the picture's, or the groups' sum in its place.
function shownValues() {
  const { sum } = groups;
  return layer === "" && isRegrouped() && sum && sum.width === picture.width && sum.height === picture.height ? sum.values : picture.values;
}

$("plain").addEventListener("click", () => {
  groups.weights.clear();
  $("sliders").replaceChildren(...groups.names.map(controlsOf));
  tellWeights();
  weighAnew();
});
