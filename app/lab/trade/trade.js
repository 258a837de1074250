/* report.html of `toile trade`: data = what trade_write.c writes; `csv` holds trade.csv. Errors are FLIP of the
 * garment where by_flip, else relative RMSE. */
const rows = csv(data.csv), { by_flip } = data;
const find = (look, state, group) =>
  rows.filter(row => row.look === look && row.state === state && (!group || row.group === group));
const groupsOf = list => [...new Set(list.map(row => row.group))];
const timeOf = row => (data.by_wall ? row.wall_ms_per_frame : row.cpu_ms_per_frame);
const errorOf = row => (by_flip ? row.garment_flip : 100 * row.relative_rmse);
const mib = row => fixed(row.total_bytes / MIB, 1);

function showScatter({ name, title }) {
  const moving = find(name, "moving");
  if (!moving.length) return;
  const points = moving.map(row => [timeOf(row), errorOf(row), row.name, row.group === "presets", row]);
  const front = paretoFront(points);
  for (const point of front) point[3] = true;
  const series = groupsOf(moving).map(group => ({ name: group, points: points.filter(point => point[4].group === group) }));
  show(plot({ x_label: data.by_wall ? "wall time of a frame, ms" : "CPU ms a frame, all threads", x_log: true,
    y_label: by_flip ? "FLIP of the garment" : "relative RMSE, %", y_log: true,
    series: [...series, { name: "Pareto front", points: front, front: true }],
    caption: `${title[0].toUpperCase()}${title.slice(1)}, ${moving[0].width} x ${moving[0].height} pixels. Errors over ` +
      `${by_flip ? "the garment's" : "covered"} pixels against the reference.` }));
  show(table([["on the Pareto front", "CPU ms", "wall ms", ...(by_flip ? ["FLIP of the garment", "of its worst 5 %"]
    : ["rel. RMSE", "mean FLIP"]), "MiB"], ...front.map(([, , , , row]) =>
    [row.name, fixed(row.cpu_ms_per_frame, 1), fixed(row.wall_ms_per_frame, 1), ...(by_flip
      ? [fixed(row.garment_flip, 4), fixed(row.garment_flip_worst, 3)]
      : [percent(row.relative_rmse, 2), fixed(row.mean_flip, 4)]), mib(row)])]));
}

function showPictures({ name, title }) {
  const list = data.pictures.filter(picture => picture.look === name);
  if (!list.length) return;
  heading(`Side by side: ${title}`);
  show(pictures(list.map(({ name, png, error }) => ({ source: png, name, text: !error ? "ray traced"
    : by_flip ? `FLIP of the garment ${fixed(error.garment_flip, 3)}, of its worst 5 % ${fixed(error.garment_flip_worst, 3)}`
    : `${percent(error.rel_rmse, 1)} relative RMSE, FLIP ${fixed(error.flip_mean, 3)}` }))));
}

/* Curves over a column of the file; a quick run leaves single points, which make no line. */
function showCurves(x_label, y_label, curves, caption) {
  const series = curves.filter(curve => curve.points.length).map(curve => ({ ...curve, line: true }));
  if (series.some(curve => curve.points.length > 1))
    show(plot({ x_label, y_label, x_log: true, y_log: true, series, caption }));
}
const curve = (name, list, x, y) => ({ name, points: list.map(row => [row[x], y(row), row.name]) });

/* Error of the techniques that average over frames, while nothing moves. */
function showRest(look) {
  const averaging = find(look, "moving").filter(row => ["rounds", "presets"].includes(row.group))
    .map(row => [row, ...find(look, "rest", row.group).filter(rest => rest.name === row.name)])
    .filter(list => list.length > 2).slice(0, MARKS.length);
  if (!averaging.length) return;
  heading("At rest");
  showCurves("frames drawn since the motion stopped", "relative RMSE, %",
    averaging.map(list => curve(list[0].name, list, "draws", errorOf)),
    "Jittered directions, averaged while nothing moves. Glossiness 0.7.");
}

function showSweeps(look) {
  const sweep = (groups, x, y) => groups.map(group => curve(group, find(look, "moving", group), x, y));
  const regions = ["regions, paper", "regions, rays"], texels = "shadow map, texels a side";
  heading("Regions and shadow maps");
  showCurves("regions N", "CPU ms a frame", sweep(regions, "regions", timeOf),
    "Time against N, as the paper's figure 7 has it.");
  showCurves(texels, "CPU ms a frame", sweep(["map size"], "map_size_texels", timeOf), "Time against map size, N = 96.");
  showCurves("regions N", "relative RMSE, %", sweep(regions, "regions", errorOf),
    "Error against N, glossiness 0.7, in motion.");
  showCurves(texels, "relative RMSE, %", sweep(["map size"], "map_size_texels", errorOf),
    "Error against map size, N = 96, glossiness 0.7, in motion.");
}

/* One group's names, times under one appearance, and errors under all. */
function showGroup(group, look) {
  const shown = data.looks.filter(({ name }) => find(name, "moving", group).length);
  const sibling = (row, name, state) => find(name, state, group).filter(other => other.name === row.name).pop();
  const errors = row => !row ? "-" : by_flip ? `${fixed(row.garment_flip, 4)} / ${fixed(row.garment_flip_worst, 3)}`
    : `${percent(row.relative_rmse, 2)} / ${fixed(row.mean_flip, 3)}`;
  paragraph(group);
  show(table([["", "CPU ms", "wall ms", "at rest", "MiB", ...shown.flatMap(({ title }) => [`${title}, moving`, "at rest"])],
    ...find(look, "moving", group).map(row => {
      const rest = sibling(row, look, "rest");
      return [row.name, fixed(row.cpu_ms_per_frame, 1), fixed(row.wall_ms_per_frame, 1),
        rest ? fixed(rest.cpu_ms_per_frame, 1) : "-", mib(row),
        ...shown.flatMap(({ name }) => [errors(sibling(row, name, "moving")), errors(sibling(row, name, "rest"))])];
    })]));
}

begin(data.title, `toile trade --axis ${data.axis}: ${data.garment_triangles} garment triangles that move ` +
  `${fixed(1e3 * data.mean_step_m, 1)} mm a frame on average, environment ${data.environment}` +
  (data.complete ? "" : "; interrupted: what was measured until then"));
heading("Error against time, in motion");
paragraph(data.text);
data.looks.forEach(showScatter);
data.looks.forEach(showPictures);
if (data.sweep_look) {
  showRest(data.sweep_look);
  showSweeps(data.sweep_look);
}
for (const { title, text, items } of data.figures) {
  heading(title);
  if (text) paragraph(text);
  show(...items.map(figure));
}
heading("All figures");
paragraph(by_flip
  ? "Errors are FLIP of the picture as shown over the garment's pixels, and over the worst 5 % of them, against the " +
    "reference; times are medians."
  : "Errors are relative RMSE and mean FLIP over covered pixels against the reference; times are medians of process " +
    "CPU time; at rest, of the last frames averaged.");
for (const group of groupsOf(find(data.table_look, "moving"))) showGroup(group, data.table_look);
data.refusals.forEach(paragraph);
