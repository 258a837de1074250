/* Plots as SVG: points, lines, areas or bars over two axes, with a legend. A point shows its name under the pointer, and
 * beside it where it is named and there is room.
 *
 * plot({x_label, y_label, x_log, y_log, caption, series: [{name, line, front, points: [[x, y, name, named]]}], ...}):
 * `line` joins the points, `front` is a dashed line without marks. Options: kind "lines", "steps" (each value holds
 * until the next point), "areas" (filled down to 0, later series behind earlier ones) or "bars" (`bar_width` in x);
 * `guides` [{y, name}], levels across the plot; `shaded_to`, the end in x of a shaded ground; `height`; `x_tight`, no
 * margin behind the largest x; `y_is_count`, ticks at whole numbers; `y_unlabelled`, neither ticks nor names in y.
 * Points that are not finite, or not positive on a logarithmic axis, are left out. */
const WIDTH = 760, LEFT = 66, RIGHT = 20, TOP = 14, BOTTOM = 52;
const LETTER_WIDTH = 6.3, LETTER_HEIGHT = 13; /* average of a name's letters */
const CURVE_POINTS = 40; /* a line with more points is drawn without marks */

/* SVG paths of the marks, of about equal area: disc, square, diamond, triangles, cross, bars. */
const MARKS = ["M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z", "M-4 -4H4V4H-4z", "M0 -5.5L5.5 0L0 5.5L-5.5 0z",
  "M0 -5.5L5 3.5H-5z", "M0 5.5L5 -3.5H-5z", "M-1.6 -5H1.6V-1.6H5V1.6H1.6V5H-1.6V1.6H-5V-1.6H-1.6z",
  "M-5.5 -2.5H5.5V2.5H-5.5z", "M-2.5 -5.5H2.5V5.5H-2.5z"];

/* An axis that holds all values and a margin, from one coordinate to another; a linear axis includes 0. */
function makeAxis(values, isLog, isTight, from, to) {
  const share = isTight ? 0 : 0.07;
  let low = Math.min(...values), high = Math.max(...values);
  if (low > high) {
    [low, high] = [1, 10];
  } else if (isLog) {
    const margin = high > low ? Math.max((high / low) ** share, 1.05) : 2;
    [low, high] = [low / margin, high * margin];
  } else {
    low = Math.min(low, 0);
    high = high > low ? high + share * (high - low) : low + 1;
  }
  const part = value => (isLog ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
  return { low, high, isLog, size: Math.abs(to - from), place: value => from + part(value) * (to - from) };
}

/* Ticks at 1, 2 and 5 times each power of ten. Over many decades only the powers of ten have labels. */
function logTicks({ low, high }) {
  const ticks = [], all = Math.log10(high / low) < 2.6;
  for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high); decade++)
    for (const step of [1, 2, 5]) {
      const value = step * 10 ** decade;
      if (value >= low && value <= high) ticks.push({ value, labelled: all || step === 1 });
    }
  return ticks;
}

/* Ticks at round steps, as many as fit with 40 units between them. */
function linearTicks({ low, high, size }, isCount) {
  const limit = Math.min(Math.max(Math.floor(size / 40), 2), 8);
  const decade = 10 ** Math.floor(Math.log10((high - low) / limit));
  let step = decade * [1, 2, 5, 10].find(factor => (high - low) / (factor * decade) <= limit);
  if (isCount) step = Math.max(step, 1);
  const ticks = [];
  for (let i = Math.ceil(low / step); i * step <= high; i++) ticks.push({ value: i * step, labelled: true });
  return ticks;
}

/* A range within one decade holds too few of the round numbers. */
function ticksOf(axis, isCount) {
  const ticks = axis.isLog ? logTicks(axis) : [];
  return ticks.length < 3 ? linearTicks(axis, isCount) : ticks;
}

const text = (kind, x, y, anchor, words) => svg("text", { class: kind, x, y, "text-anchor": anchor }, words);

function plot(options) {
  const { kind = "lines", height = 430, guides = [], series } = options;
  const usable = ([x, y]) => Number.isFinite(x) && Number.isFinite(y) &&
    (!options.x_log || x > 0) && (!options.y_log || y > 0);
  const lines = series.map((one, s) => ({ ...one, style: "s" + (s % MARKS.length), mark: MARKS[s % MARKS.length],
    points: one.points.filter(usable) }));
  const all = lines.flatMap(line => line.points);
  const right = WIDTH - RIGHT, floor = height - BOTTOM;
  const x = makeAxis(all.map(point => point[0]), options.x_log, options.x_tight, LEFT, right);
  const y = makeAxis([...all.map(point => point[1]), ...guides.map(guide => guide.y)], options.y_log, false, floor, TOP);
  const drawing = svg("svg", { class: "plot", viewBox: `0 0 ${WIDTH} ${height}`, role: "img" });
  const occupied = []; /* boxes of marks and names so far */

  function drawAxes() {
    for (const { value, labelled } of ticksOf(x, false)) {
      drawing.append(svg("path", { class: "grid", d: `M${x.place(value)} ${TOP}V${floor}` }));
      if (labelled) drawing.append(text("tick", x.place(value), floor + 16, "middle", short(value)));
    }
    for (const { value, labelled } of options.y_unlabelled ? [] : ticksOf(y, options.y_is_count)) {
      drawing.append(svg("path", { class: "grid", d: `M${LEFT} ${y.place(value)}H${right}` }));
      if (labelled) drawing.append(text("tick", LEFT - 7, y.place(value) + 4, "end", short(value)));
    }
    const label = text("axis", 0, 0, "middle", options.y_label);
    label.setAttribute("transform", `translate(15 ${(TOP + floor) / 2}) rotate(-90)`);
    drawing.append(svg("path", { class: "frame", d: `M${LEFT} ${TOP}V${floor}H${right}` }),
      text("axis", (LEFT + right) / 2, height - 10, "middle", options.x_label), label);
  }

  /* Joins the points; an area is closed along the lower end of y. */
  function drawLine({ points, style, front }) {
    if (!points.length) return;
    let d = "";
    for (const [px, py] of points) {
      const at = [x.place(px).toFixed(1), y.place(py).toFixed(1)];
      d += !d ? `M${at[0]} ${at[1]}` : kind === "steps" ? `H${at[0]}V${at[1]}` : `L${at[0]} ${at[1]}`;
    }
    if (kind === "areas") d += `V${floor}H${x.place(points[0][0]).toFixed(1)}Z`;
    const name = front ? "front" : (kind === "areas" ? "area " : "line ") + style;
    drawing.append(svg("path", { class: name, d }));
  }

  function drawBars({ points, style }) {
    for (const [px, py, name] of points) {
      const from = x.place(px - options.bar_width / 2), top = y.place(py);
      drawing.append(svg("rect", { class: "mark " + style, x: from, y: top, height: floor - top,
        width: x.place(px + options.bar_width / 2) - from }, svg("title", {}, name)));
    }
  }

  function drawMarks({ points, style, mark, name: own }) {
    for (const [px, py, name = own] of points) {
      const at = [x.place(px), y.place(py)];
      occupied.push([at[0] - 4, at[1] - 4, at[0] + 4, at[1] + 4]);
      drawing.append(svg("path", { class: "mark " + style, d: mark, transform: `translate(${at[0]} ${at[1]})` },
        svg("title", {}, `${name} (${short(px)}, ${short(py)})`)));
    }
  }

  /* Writes a name beside its point, at the first of eight places where it covers no mark or other name. */
  function drawName([px, py, name]) {
    const at = [x.place(px), y.place(py)], width = LETTER_WIDTH * name.length, gap = 7;
    for (const [sx, sy] of [[1, 0], [-1, 0], [0, -1], [0, 1], [1, -1], [-1, -1], [1, 1], [-1, 1]]) {
      const left = sx > 0 ? at[0] + gap : sx < 0 ? at[0] - gap - width : at[0] - width / 2;
      const middle = at[1] + sy * (gap + LETTER_HEIGHT / 2);
      const box = [left, middle - LETTER_HEIGHT / 2, left + width, middle + LETTER_HEIGHT / 2];
      const covers = occupied.some(other => box[0] < other[2] && box[2] > other[0] && box[1] < other[3] && box[3] > other[1]);
      if (covers || box[0] < LEFT || box[2] > WIDTH || box[1] < 0 || box[3] > floor) continue;
      occupied.push(box);
      drawing.append(text("name", left, middle + 4, "start", name));
      return;
    }
  }

  if (options.shaded_to > x.low)
    drawing.append(svg("rect", { class: "shade", x: LEFT, y: TOP, height: floor - TOP,
      width: x.place(Math.min(options.shaded_to, x.high)) - LEFT }));
  /* Areas are drawn before the grid, so that its lines show on them; other series are drawn after it. */
  if (kind === "areas") [...lines].reverse().forEach(drawLine);
  drawAxes();
  for (const line of lines) {
    if (kind === "bars") drawBars(line);
    if (line.front || (line.line && kind !== "areas" && kind !== "bars")) drawLine(line);
  }
  const marked = lines.filter(line => !line.front && !(line.line && line.points.length > CURVE_POINTS));
  if (kind === "lines" || kind === "steps") marked.forEach(drawMarks);
  for (const guide of guides) {
    drawing.append(svg("path", { class: options.y_unlabelled ? "grid" : "guide", d: `M${LEFT} ${y.place(guide.y)}H${right}` }));
    if (!options.y_unlabelled) drawing.append(text("name", right - 4, y.place(guide.y) - 5, "end", guide.name));
  }
  for (const line of lines.filter(line => !line.front)) line.points.filter(point => point[3]).forEach(drawName);

  const legend = html("ul", { class: "legend" }, ...lines.map(line => html("li", {},
    svg("svg", { viewBox: "-9 -7 18 14", width: 18, height: 14, "aria-hidden": "true" },
      svg("path", line.front ? { class: "front", d: "M-8 0H8" } : { class: "mark " + line.style, d: line.mark })),
    " " + line.name)));
  return html("figure", {}, ...(lines.length > 1 || kind === "lines" ? [legend] : []), drawing,
    html("figcaption", {}, options.caption));
}

/* The Pareto front of points whose x and y are both better when smaller: those for which no other has a smaller y at a
 * smaller or equal x, in order of rising x. */
function paretoFront(points) {
  let lowest = Infinity;
  return points.filter(([x, y]) => Number.isFinite(x) && Number.isFinite(y))
    .sort((a, b) => a[0] - b[0] || a[1] - b[1])
    .filter(([, y]) => y < lowest && ((lowest = y), true));
}
