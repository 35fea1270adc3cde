// SPDX-License-Identifier: GPL-3.0-or-later
// The working folder: look, open, edit, save, download.
import { ask, download, getJson, post } from "/server.js";

const element = (name, more = {}, ...inside) => {
  const made = Object.assign(document.createElement(name), more);
  made.append(...inside);
  return made;
};
const button = (text, act) => {
  const made = element("button", { type: "button", textContent: text });
  made.addEventListener("click", act);
  return made;
};
const sizeText = (bytes) => (bytes < 1000 ? `${bytes} B` : bytes < 1e6 ? `${(bytes / 1000).toFixed(1)} kB` : `${(bytes / 1e6).toFixed(1)} MB`);
const join = (folder, name) => (folder ? folder + "/" + name : name);

// Bytes of a file that are shown at most.
const shownBytes = 200000;

// The beginning of a file: no more is loaded than is shown.
async function readBeginning(query) {
  const reader = (await ask("file", query)).body.getReader(), pieces = [];
  let size = 0;
  for (;;) {
    const { value, done } = await reader.read();
    if (done || size + value.length > shownBytes) {
      const bytes = new Uint8Array(await new Blob(done ? pieces : [...pieces, value]).slice(0, shownBytes).arrayBuffer());
      await reader.cancel();
      return { bytes, whole: done };
    }
    pieces.push(value);
    size += value.length;
  }
}

// A text and how its lines end, or why it cannot be edited: what is saved must have the bytes of before, but for the changes.
function readText({ bytes, whole }) {
  const decode = (name, fatal) => new TextDecoder(name, { fatal, ignoreBOM: true }).decode(bytes);
  if (!whole)
    return { text: decode("utf-8", false), why: `the first ${sizeText(shownBytes)} alone are shown` };
  try {
    const text = decode("utf-8", true), ends = [...new Set(text.match(/\r\n|\r|\n/g))];
    if (ends.length > 1 || text.includes("\0"))
      return { text, why: ends.length > 1 ? "its lines end in different ways" : "it has NUL bytes" };
    return { text, end: ends[0] || "\n" };
  } catch {
    return { text: decode("windows-1252", false), why: "it is not UTF-8" };
  }
}

export class Files {
  constructor(place, { open, fail, settings }) {
    Object.assign(this, { place, open, fail, settings, root: "work", folder: "", wished: { root: "work", folder: "" }, asked: 0 });
  }

  async act(what, isWanted = () => true) {
    try {
      await what();
    } catch (error) {
      if (!isWanted())
        return;
      this.wished = { root: this.root, folder: this.folder };
      this.fail(error.message);
    }
  }

  // Answers may come in another order than they were asked for: the last wish is shown.
  async show(root = this.wished.root, folder = this.wished.folder) {
    const number = ++this.asked, isWanted = () => number === this.asked;
    this.wished = { root, folder };
    await this.act(async () => {
      const list = await getJson("files", { in: root, path: folder });
      if (!isWanted())
        return;
      Object.assign(this, { root, folder });
      this.build(list);
    }, isWanted);
  }

  build(list) {
    list.sort((a, b) => b.folder - a.folder || a.name.localeCompare(b.name));
    const rows = list.map((file) => this.row(file));
    this.view = element("div");
    this.place.replaceChildren(this.crumbs(list), element("table", {}, element("tbody", {}, ...rows)), this.view);
    if (this.root === "work")
      this.place.append(this.saver());
  }

  crumbs(list) {
    const bar = element("div", { className: "tools crumbs" });
    bar.append(button("working folder", () => this.show("work", "")), button("results", () => this.show("result", "")));
    const parts = this.folder ? this.folder.split("/") : [];
    parts.forEach((part, k) => bar.append(button(part, () => this.show(this.root, parts.slice(0, k + 1).join("/")))));
    if (list.some((file) => file.name === "used.json" || file.name === "summary.json")) {
      if (this.root === "work")
        bar.append(button("show these results", () => this.act(() => this.open(this.folder))));
      bar.append(button("download as zip", () => this.act(() => download("zip", { in: this.root, path: this.folder }, "results.zip"))));
    }
    return bar;
  }

  row(file) {
    const whole = join(this.folder, file.name), acts = element("td");
    const name = button(file.name + (file.folder ? "/" : ""), () => (file.folder ? this.show(this.root, whole) : this.look(file.name, whole)));
    if (!file.folder && this.root === "work" && file.name.endsWith(".json"))
      acts.append(button("open", () => this.act(() => this.open(whole))), " ");
    if (!file.folder)
      acts.append(button("download", () => this.act(() => download("file", { in: this.root, path: whole }, file.name))));
    return element("tr", {}, element("td", {}, name), element("td", { className: "size", textContent: file.folder ? "" : sizeText(file.size) }), acts);
  }

  async look(name, whole) {
    const number = ++this.asked, isWanted = () => number === this.asked;
    await this.act(async () => {
      const heading = element("h2", { textContent: name });
      if (/\.(png|svg)$/.test(name)) {
        const picture = element("img", { className: "figure", alt: "figure " + name });
        picture.src = URL.createObjectURL(await (await ask("file", { in: this.root, path: whole })).blob());
        if (!isWanted())
          return;
        this.view.replaceChildren(heading, picture);
      } else {
        const { text, end, why } = readText(await readBeginning({ in: this.root, path: whole }));
        if (!isWanted())
          return;
        const shown = element("textarea", { value: text, spellcheck: false, readOnly: this.root !== "work" || !end });
        shown.setAttribute("aria-label", "contents of " + name);
        this.view.replaceChildren(heading, shown);
        if (why)
          this.view.append(element("p", { textContent: `Not to be edited here: ${why}.` }));
        else if (!shown.readOnly)
          this.view.append(button("save " + name, () => this.act(() => this.save(whole, shown.value.replaceAll("\n", end), true))));
      }
      this.view.scrollIntoView({ block: "nearest" });
    }, isWanted);
  }

  async save(whole, contents, replace) {
    await post("file", { path: whole, ...(replace ? { replace: "1" } : {}) }, contents);
    await this.show();
  }

  // The settings under a new name, or a file of this computer's.
  saver() {
    const name = element("input", { type: "text", placeholder: "new.json", size: 20 }), upload = element("input", { type: "file" });
    upload.addEventListener("change", () => this.act(async () => {
      if (upload.files[0])
        await this.save(join(this.folder, upload.files[0].name), upload.files[0], false);
    }));
    return element("div", { className: "tools" }, element("label", {}, "save the settings here as ", name),
      button("save", () => this.act(() => this.save(join(this.folder, name.value.trim()), this.settings(), false))),
      element("label", {}, "load a file into this folder ", upload));
  }
}
