// SPDX-License-Identifier: GPL-3.0-or-later
// The settings of a scene or run file beside their reference, to be edited before a start.
import { getJson } from "/server.js";

// Which key of an object says which of a group it is.
const chief = { conservative: "law", dissipative: "law", dynamics: "integrator", method: "name" };

const element = (name, more = {}, ...inside) => {
  const made = Object.assign(document.createElement(name), more);
  made.append(...inside);
  return made;
};

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

// Units of a file that says which it speaks, in the place of the reference's; the longer names first.
const spoken = {
  "nm-ps": [["k_B T_0/lambda^d", "bar"], ["k_B T_0", "kJ/mol"], ["T_0", "K"], ["lambda", "nm"], ["tau", "ps"], [/\bmu\b/g, "u"]],
  "angstrom-fs": [["k_B T_0/lambda^d", "atm"], ["k_B T_0", "kcal/mol"], ["T_0", "K"], ["lambda", "Å"], ["tau", "fs"], [/\bmu\b/g, "g/mol"]],
};

// A field as that file speaks: its limits and defaults are reduced numbers, of which 0 alone is the same.
function speak(field, file) {
  const system = isObject(file.units) ? file.units.system : file.units, dimensions = (file.scene || file).dimensions || 3;
  const words = spoken[system] || [], own = field.unit || "";
  const unit = words.reduce((text, [from, to]) => text.replaceAll(from, to), own).replace("^d", words.length ? `^${dimensions}` : "^d");
  if (unit === own)
    return field;
  const known = (value, other) => (Math.abs(value) < 1e-300 ? value : other);
  return { ...field, unit, minimum: known(field.minimum, -Infinity), maximum: known(field.maximum, Infinity),
    default: known(field.default, null) };
}

function rangeText(field) {
  const low = field.minimum, high = field.maximum, tiny = low > 0 && low < 1e-300;
  if (field.type !== "number" && field.type !== "integer")
    return "";
  const least = tiny ? "above 0" : low > -1e300 ? `from ${low}` : "";
  return (least + (high < 1e300 ? ` to ${high}` : "")).trim();
}

export class Settings {
  constructor(place) {
    this.place = place;
    this.topics = null;
    this.text = "";
    this.value = null;
    this.edited = false;
  }

  async load(text) {
    this.topics = this.topics || await getJson("topics");
    this.original = this.text = text;
    this.edited = false;
    this.read();
    this.build();
  }

  read() {
    try {
      this.value = JSON.parse(this.text);
      return "";
    } catch (error) {
      this.value = null;
      return error.message;
    }
  }

  change() {
    this.text = JSON.stringify(this.value, null, 4) + "\n";
    this.edited = true;
    this.raw.value = this.text;
  }

  find(name) {
    return this.topics.find((topic) => topic.name === name);
  }

  // The fields of an object, and the topics of the objects in it.
  describe(name, value) {
    const key = chief[name], own = this.find(name);
    const chosen = key && isObject(value) ? this.topics.find((topic) => topic.group === name && topic.name === value[key]) : null;
    const together = [own, chosen].filter(Boolean);
    return { fields: Object.assign({}, ...together.map((topic) => topic.fields)),
      objects: Object.assign({}, ...together.map((topic) => topic.objects)),
      choices: key ? this.topics.filter((topic) => topic.group === name).map((topic) => topic.name) : [], key };
  }

  build() {
    const isFit = isObject(this.value) && "target" in this.value;
    this.raw = element("textarea", { value: this.text, spellcheck: false });
    this.raw.setAttribute("aria-label", "the file as text");
    this.raw.addEventListener("change", () => { this.text = this.raw.value; this.edited = true; const fault = this.read(); this.fault.textContent = fault; if (!fault) this.build(); });
    this.fault = element("p", { role: "status" });
    this.folder = element("input", { type: "text", id: "result-folder", placeholder: "out, beside the file", value: this.folder?.value || "" });
    this.force = element("input", { type: "checkbox", id: "result-force", checked: this.force?.checked || false });
    this.place.replaceChildren(
      element("p", { textContent: "What is changed here counts for the next start; the file itself stays as it is. Empty fields have their defaults." }),
      element("div", { className: "tools" }, element("label", {}, "folder for the results ", this.folder),
        element("label", {}, this.force, " replace what is there")),
      ...(isObject(this.value) ? [this.group(isFit ? "run" : "scene", isFit ? "run" : "scene", this.value, true)] : []),
      element("details", {}, element("summary", { textContent: "The file as text" }), this.raw, this.fault));
  }

  group(title, topic, value, open) {
    const known = this.describe(topic, value), box = element("details", { open });
    box.append(element("summary", { textContent: title }));
    if (known.key)
      box.append(this.line(known.key, { type: "choice", choices: known.choices.join("|"), help: "which one; its own settings follow", unit: "" }, value, true));
    for (const [name, field] of Object.entries(known.fields))
      box.append(this.line(name, field, value));
    for (const [name, inner] of Object.entries(value)) {
      if (!isObject(inner))
        continue;
      const topicOfInner = known.objects[name] || (this.find(name) ? name : "") || (known.key ? topic : "");
      if (topicOfInner || Object.keys(inner).length)
        box.append(this.group(name, topicOfInner || name, inner, false));
    }
    return box;
  }

  line(name, told, value, rebuild = false) {
    const field = speak(told, this.value);
    const id = "field-" + name + "-" + Math.random().toString(36).slice(2, 8), now = value[name];
    const input = field.choices && field.type === "choice" ? element("select", { id },
      ...(field.required ? [] : [element("option", { value: "", textContent: "—" })]),
      ...field.choices.split("|").map((choice) => element("option", { value: choice, textContent: choice })))
      : element("input", { id, type: "text", inputMode: ["number", "integer"].includes(field.type) ? "decimal" : "text",
        placeholder: field.required ? "required" : field.type === "text" || field.type === "file" ? "" : this.defaultText(field) });
    input.value = now === undefined ? "" : Array.isArray(now) ? now.join(", ") : isObject(now) ? "" : String(now);
    input.disabled = isObject(now);
    input.dataset.name = name;
    input.addEventListener("change", () => {
      this.store(value, name, field, input.value.trim());
      this.change();
      if (rebuild || name === "units")
        this.build();
    });
    const range = rangeText(field);
    return element("div", { className: "field" }, element("label", { htmlFor: id, textContent: name + (field.unit ? ` [${field.unit}]` : "") }), input,
      element("small", { textContent: [field.help, range].filter(Boolean).join("; ") }));
  }

  defaultText(field) {
    if (field.choices)
      return field.choices.split("|")[field.default] || "";
    return field.default === null || field.default === undefined ? "" : String(field.default);
  }

  // What is no number stays a text: the program says what is wrong with it.
  store(value, name, field, text) {
    const number = (part) => (part !== "" && Number.isFinite(Number(part)) ? Number(part) : part);
    if (text === "")
      delete value[name];
    else if (field.type === "lengths" || field.type === "choices" || Array.isArray(value[name]))
      value[name] = text.split(",").map((part) => number(part.trim()));
    else if (["number", "integer", "seed"].includes(field.type))
      value[name] = number(text);
    else
      value[name] = text;
  }

  query() {
    return { folder: this.folder ? this.folder.value.trim() : "", ...(this.force && this.force.checked ? { force: "1" } : {}) };
  }

  clear() {
    this.text = "";
    this.place.replaceChildren(element("p", { textContent: "Choose a scene or a run file under Files." }));
  }
}
