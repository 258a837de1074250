/* Runs the page of a report (app/report/page/) without a browser: elements are plain objects, and reads of the data are
 * noted, so that a key that is written but not shown, and one that is read but not written, are found. */
"use strict";
const fs = require("fs"), path = require("path"), vm = require("vm");

/* Keys that are written only where they apply. */
const optional = new Set(["oracle", "replay", "against", "strip"]);

class Node {
  constructor(name, text = "") {
    Object.assign(this, { name, text, attributes: {}, children: [] });
  }
  setAttribute(key, value) {
    this.attributes[key] = String(value);
  }
  append(...children) {
    this.children.push(...children.map(child => (child instanceof Node ? child : new Node("#text", String(child)))));
  }
  get textContent() {
    return this.text + this.children.map(child => child.textContent).join("");
  }
  all() {
    return [this, ...this.children.flatMap(child => child.all())];
  }
  /* The elements of a name; with a class. */
  find(name, kind) {
    return this.all().filter(node => node.name === name && (!kind || (node.attributes.class || "").split(" ").includes(kind)));
  }
}

/* The data, whose reads are noted in `notes`: paths of the keys that are there and of those that were read. Items of an
 * array share a path. */
function watched(value, where, notes) {
  if (value === null || typeof value !== "object") return value;
  const isArray = Array.isArray(value);
  if (!isArray) for (const key of Object.keys(value)) notes.written.add(`${where}.${key}`);
  const children = new Map();
  return new Proxy(value, {
    get(target, key) {
      if (typeof key === "symbol" || (isArray && !(key in target && /^\d+$/.test(key)))) return target[key];
      const at = isArray ? `${where}[]` : `${where}.${key}`;
      if (!isArray && !(key in target) && !optional.has(key)) notes.missing.add(at);
      notes.read.add(at);
      if (!children.has(key)) children.set(key, watched(target[key], at, notes));
      return children.get(key);
    },
  });
}

/* Runs scripts with the data; returns the body, the title, and the scripts' own names. */
function run(scripts, data, names = []) {
  const body = new Node("body"), notes = { written: new Set(), read: new Set(), missing: new Set() };
  const document = { body, title: "", createElement: name => new Node(name), createElementNS: (_, name) => new Node(name),
    getElementById: () => ({ textContent: "" }) };
  const context = vm.createContext({ document, JSON: { parse: () => watched(data, "", notes) } });
  const results = vm.runInContext(`${scripts}\n;({ ${names.join(", ")} })`, context);
  return { body, title: document.title, notes, results };
}

/* A page as written: its data and its script. Throws where the elements of the file are not those of page.html. */
function load(file) {
  const text = fs.readFileSync(file, "utf8");
  const page = /^<!DOCTYPE html>\s*<html lang="en">\s*<head>[^]*<style>[^]*<\/style>\s*<\/head>\s*<body>\s*<script type="application\/json" id="data">\n([^<]*)\n<\/script>\s*<script>\n([^]*)<\/script>\s*<\/body>\s*<\/html>\s*$/;
  const parts = text.match(page);
  if (!parts || text.match(/<\/?script/g).length !== 4) throw new Error("the file is no page with data and one script");
  return { data: JSON.parse(parts[1]), script: parts[2] };
}

/* All that is wrong with a page that shows at least `plots` plots. */
function faults(file, plots) {
  const { data, script } = load(file), { body, title, notes } = run(script, data), found = [];
  const texts = [title, ...body.all().flatMap(node => [node.text, ...Object.values(node.attributes)])];
  for (const key of notes.missing) found.push(`reads ${key}, which is not written`);
  for (const key of notes.written) if (!notes.read.has(key)) found.push(`does not show ${key}`);
  for (const text of texts)
    if (/(^|[^\w])(NaN|undefined|null|-?Infinity|\[object \w+\])($|[^\w])/.test(text)) found.push(`shows "${text}"`);
  if (!title || body.find("h1").length !== 1) found.push("has no title");
  if (body.find("svg", "plot").length < plots) found.push(`has ${body.find("svg", "plot").length} plots`);
  for (const { attributes } of [...body.find("img"), ...body.find("a")]) {
    const address = attributes.src || attributes.href;
    if (/^data:image\/png;base64,iVBORw0KGgo[A-Za-z0-9+/]+=*$/.test(address)) continue;
    if (/[:/]/.test(address) || !fs.existsSync(path.join(path.dirname(file), address))) found.push(`shows no picture ${address}`);
  }
  return found;
}

module.exports = { run, load, faults };

if (require.main === module) {
  const found = faults(process.argv[2], Number(process.argv[3] || 0));
  for (const fault of found) console.log(fault);
  process.exit(found.length ? 1 : 0);
}
