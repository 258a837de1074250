/* The parts of a report: elements, tables, tiles, pictures. Texts of the data become text nodes and attributes, never
 * markup. plot.js draws plots; the script of the command (flight.js, trade.js ...) follows and builds the page. */
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);

function complete(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}
const html = (name, attributes, ...children) => complete(document.createElement(name), attributes, children);
const svg = (name, attributes, ...children) =>
  complete(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);

const show = (...nodes) => document.body.append(...nodes);
const heading = text => show(html("h2", {}, text));
const paragraph = text => show(html("p", {}, text));

function begin(title, subtitle) {
  document.title = title;
  show(html("h1", {}, title), html("p", { class: "subtitle" }, subtitle));
}

/* "-" where there is no number. */
const fixed = (value, digits, unit = "") => (Number.isFinite(value) ? value.toFixed(digits) + unit : "-");
const percent = (share, digits) => fixed(share === null ? NaN : 100 * share, digits, " %");
const short = (value, digits = 4) => {
  const rounded = Number(value.toPrecision(digits)), size = Math.abs(rounded);
  return size && (size < 1e-4 || size >= 1e6) ? rounded.toExponential() : String(rounded);
};
const MIB = 1024 * 1024;

/* The rows of a CSV file as objects. Fields without quotes are numbers where they can be; empty ones are NaN. */
function csv(text) {
  const value = field => {
    if (field.startsWith('"')) return field.slice(1, -1).replaceAll('""', '"');
    return field === "" ? NaN : Number.isNaN(Number(field)) ? field : Number(field);
  };
  const lines = text.trim().split("\n").map(line => line.match(/(?<=^|,)("([^"]|"")*"|[^,]*)/g));
  const [heads, ...rows] = lines;
  return rows.map(row => Object.fromEntries(heads.map((head, i) => [head, value(row[i])])));
}

/* The first row holds the heads of the columns, the first column those of the rows. */
function table(rows) {
  const line = (cells, isHead) =>
    html("tr", {}, ...cells.map((cell, i) => html(isHead || i === 0 ? "th" : "td", {}, String(cell))));
  return html("div", { class: "scroll" },
    html("table", {}, html("thead", {}, line(rows[0], true)),
      html("tbody", {}, ...rows.slice(1).map(row => line(row, false)))));
}

/* The main figures in large type: [value, name]. */
const tiles = pairs => html("ul", { class: "tiles" },
  ...pairs.map(([value, name]) => html("li", {}, html("b", {}, value), name)));

const caption = (name, text) => html("figcaption", {}, html("b", {}, name), text);
/* Pictures side by side: {source, name, text}. */
const pictures = list => html("div", { class: "pictures" }, ...list.map(({ source, name, text }) =>
  html("figure", {}, html("img", { alt: name, src: source }), caption(name, text))));
/* A picture as wide as the page, loaded when the reader scrolls to it. A click opens it in full size. */
const widePicture = ({ file, width, height }, name, text) => html("figure", { class: "wide" },
  html("a", { href: file }, html("img", { loading: "lazy", width, height, alt: name, src: file })),
  caption(name, text));

/* A figure that the program measured (app/report/figures.h): a plot or a table. */
const figure = item => ("series" in item ? plot({ ...item })
  : table([item.columns.map(column => column.head), ...item.rows.map(row =>
      row.map((cell, i) => (i ? fixed(cell, item.columns[i].digits) : cell)))]));
