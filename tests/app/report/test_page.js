/* The page of reports: what plots draw of awkward values and of their options, the Pareto front against its definition,
 * tables of a CSV file, names that are markup, and sentences of the gallery that follow their figures. */
"use strict";
const assert = require("assert"), fs = require("fs"), path = require("path");
const { run } = require("./page.js");

const source = file => fs.readFileSync(path.join(__dirname, "../../../app", file), "utf8");
const parts = source("report/page/page.js") + source("report/page/plot.js");
const names = ["plot", "paretoFront", "csv", "table", "figure", "pictures", "fixed", "percent"];
const page = run(parts, {}, names).results;
const texts = node => node.all().flatMap(one => [one.text, ...Object.values(one.attributes)]);

function frontIsWhatNothingBeats() {
  let seed = 7;
  const points = Array.from({ length: 200 }, () => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return [seed >>> 26, (seed >>> 20) & 63];
  });
  points[3][1] = NaN;
  const front = page.paretoFront(points);
  assert(front.length > 1);
  for (const point of points) {
    const beaten = !Number.isFinite(point[1]) || points.some(([x, y]) =>
      x <= point[0] && y <= point[1] && (x < point[0] || y < point[1]));
    const twin = front.some(([x, y]) => x === point[0] && y === point[1]); /* of equal points one stands for all */
    assert.notStrictEqual(beaten, twin, `${point}`);
  }
  for (let i = 1; i < front.length; i++) assert(front[i][0] > front[i - 1][0]);
}

function awkwardValuesAreLeftOut() {
  const points = [[NaN, 1, "a"], [0, 1, "b"], [-3, 2, "c"], [5, Infinity, "d"], [null, 2, "e"], [7, 9, "<e & \"f\">", true]];
  const marks = options => page.plot({ x_label: "x", y_label: "y", caption: "", ...options });
  for (const [x_log, y_log, list, count] of [[true, true, points, 1], [false, false, points, 3], [true, false, [], 0]]) {
    const figure = marks({ x_log, y_log, series: [{ name: "all", line: true, points: list }] });
    const titles = figure.find("title").map(title => title.textContent);
    assert.strictEqual(titles.length, count);
    if (count) assert(titles.includes("<e & \"f\"> (7, 9)"));
    for (const text of texts(figure)) assert(!/NaN|Infinity|null/.test(text), text);
  }
}

/* The drawing's frame is from 66 to 740. */
function optionsAreDrawn() {
  const points = [[0, 1, "a"], [1, 2, "b"], [2, 1, "c"]];
  const series = [{ name: "one", line: true, points }, { name: "two", line: true, points }];
  for (const kind of ["lines", "steps", "areas", "bars"]) {
    const figure = page.plot({ kind, series, x_label: "x", y_label: "y", caption: "below", bar_width: 0.5,
      guides: [{ y: 4, name: "budget <4>" }], shaded_to: 1, height: 300, x_tight: true });
    const count = (name, kind) => figure.find(name, kind).length, joined = kind === "lines" || kind === "steps";
    const [shade] = figure.find("rect", "shade");
    assert.strictEqual(Number(shade.attributes.x), 66);
    assert.strictEqual(Number(shade.attributes.width), 337); /* up to 1 of 2 on a tight axis: half of it */
    assert.strictEqual(count("path", "guide"), 1);
    assert(figure.find("text", "name").some(text => text.textContent === "budget <4>")); /* above all points */
    assert.strictEqual(count("path", "line"), joined ? 2 : 0);
    assert.strictEqual(count("path", "area"), kind === "areas" ? 2 : 0);
    assert.strictEqual(count("rect", "mark"), kind === "bars" ? 6 : 0);
    assert.strictEqual(figure.find("svg", "plot")[0].find("path", "mark").length, joined ? 6 : 0);
    if (kind === "bars") /* half a unit of x wide, about 1 */
      assert.deepStrictEqual(["x", "width"].map(key => Number(figure.find("rect", "mark")[1].attributes[key])), [318.75, 168.5]);
    if (kind === "areas") assert.deepStrictEqual(figure.find("path", "area").map(path => path.attributes.class), ["area s1", "area s0"]);
    assert(figure.find("ul", "legend")[0].textContent.includes("one"));
    assert(figure.textContent.endsWith("below"));
  }
  /* Points lie where their axes say: the axis in x is tight, that in y reaches 7 % over the guide. */
  const figure = page.plot({ series, x_label: "x", y_label: "y", caption: "", guides: [{ y: 4, name: "" }], height: 300, x_tight: true });
  const floor = 300 - 52, at = y => floor - y / 4.28 * (floor - 14);
  const drawn = figure.find("path", "line")[0].attributes.d;
  assert.strictEqual(drawn, `M66.0 ${at(1).toFixed(1)}L403.0 ${at(2).toFixed(1)}L740.0 ${at(1).toFixed(1)}`);
}

function ticksAreRound() {
  const labels = (values, options) => page.plot({ x_label: "", y_label: "", caption: "", y_unlabelled: true, ...options,
    series: [{ name: "", points: values.map(x => [x, 1]) }] }).find("text", "tick").map(text => text.textContent);
  assert.deepStrictEqual(labels([0, 10]), ["0", "2", "4", "6", "8", "10"]);
  assert.deepStrictEqual(labels([1e-6, 1e-3], { x_log: true }), ["1e-6", "1e-5", "0.0001", "0.001"]);
  assert.deepStrictEqual(labels([1, 100], { x_log: true }), ["1", "2", "5", "10", "20", "50", "100"]);
  assert.deepStrictEqual(labels([1, 1e6], { x_log: true }), ["1", "10", "100", "1000", "10000", "100000", "1e+6"]);
}

function filesAreTables() {
  const rows = page.csv('name,look,error,time\n"a, ""b""",g=0.7,1e-3,\n"7",x,-2,3\n');
  assert.deepStrictEqual(JSON.stringify(rows), JSON.stringify([{ name: 'a, "b"', look: "g=0.7", error: 0.001, time: NaN },
    { name: "7", look: "x", error: -2, time: 3 }]));
  assert(Number.isNaN(rows[0].time));
  assert.strictEqual(page.fixed(null, 1), "-");
  assert.strictEqual(page.percent(null, 1), "-");
  assert.strictEqual(page.percent(0.256, 1), "25.6 %");
  const table = page.figure({ columns: [{ head: "size", digits: 0 }, { head: "MiB", digits: 2 }], rows: [["16", 1.234], ["32", null]] });
  assert.deepStrictEqual(table.find("tr").map(row => row.children.map(cell => cell.textContent)),
    [["size", "MiB"], ["16", "1.23"], ["32", "-"]]);
}

/* Names are texts: no element comes of them. */
function markupIsText() {
  const name = "</script><img src=x onerror=alert(1)>";
  const list = page.pictures([{ source: "a.png", name, text: name }]);
  assert.deepStrictEqual(list.all().filter(node => !node.name.startsWith("#")).map(node => node.name),
    ["div", "figure", "img", "figcaption", "b"]);
  assert.strictEqual(list.textContent, name + name);
}

/* The same claim about other figures is another sentence. */
function sentencesFollowFigures() {
  const claim = { nearer: "Newton", farther: "8 bits", source: "[1]" };
  const section = (errors, look = null) => ({ solid: "torus", claims: [claim], by_flip: false, is_exact: true, motion: "camera",
    motion_step: 2, entries: ["none", "8 bits", "Newton", "16 bits"].map((technique, i) =>
      ({ technique, look, error: [errors[i], errors[i]] })) });
  const gallery = run(parts + source("lab/gallery/gallery.js"), { sections: [], complete: true },
    ["orderWords", "claimWords", "motionWords"]).results;
  for (const [errors, order, verdict] of [
    [[0.3, 0.051, 0.032, 0.001], '"16 bits" is nearest', "3.2 % against 5.1 %, it is;"],
    [[0.3, 0.032, 0.051, 0.001], '"16 bits" is nearest', "5.1 % against 3.2 %, it is not;"],
    [[0.001, 0.032, 0.032, 0.3], '"none" is nearest', "3.2 % against 3.2 %, they are equal;"],
    [[0.3, 0.001, 0.001001, 0.3], '"8 bits" and "Newton" are equally near', "they are equal;"],
    [[0.1, 0.1, 0.1, 0.1], "All are equally near", "they are equal;"]]) {
    assert(gallery.orderWords(section(errors), 1, null).includes(order));
    assert(gallery.claimWords(section(errors), claim).includes(verdict));
  }
  const lit = section([0.4, 0.3, 0.2, 0.1], "far lamp");
  assert(gallery.orderWords(lit, 0, "far lamp").startsWith("On the torus, far lamp: 16 bits: 10 %; Newton: 20 %; "));
  assert(gallery.claimWords(lit, claim).includes("sheet (far lamp) 20 % against 30 %, it is."));
  assert.strictEqual(gallery.claimWords(lit, { ...claim, farther: "other" }), null);
  assert.strictEqual(gallery.orderWords({ ...lit, entries: lit.entries.slice(1, 2) }, 0, "far lamp"), null);
  const motion = (change, exact_change) => gallery.motionWords(lit, { change, exact_change });
  assert(motion(2, 1).startsWith("The camera turns by 2 degrees from picture to picture: pixels change by 2 levels"));
  assert(motion(2, 1).includes("more than the exact picture's, which change by 1."));
  assert(motion(1, 2).includes("less than") && motion(1, 1.001).includes("as much as"));
}

for (const test of [frontIsWhatNothingBeats, awkwardValuesAreLeftOut, optionsAreDrawn, ticksAreRound, filesAreTables,
  markupIsText, sentencesFollowFigures]) {
  test();
  console.log(`ok     ${test.name}`);
}
