/* report.html of `toile trade --axis cloth`: data = what trade_cloth_write.c writes; `csv` and `fit` hold trade.csv and
 * fit.csv. */
const rows = csv(data.csv), solvers = [...new Set(rows.map(row => row.solver))];
const mm = (metres, digits = 4) => (Number.isFinite(metres) ? short(1e3 * metres, digits) : "-");

/* Points by solver, and the Pareto front. Returns the front. */
function showChart(list, x, y, nameOf, options) {
  const points = list.map(row => [row[x], 1e3 * row[y], nameOf(row), options.named, row])
    .filter(point => Number.isFinite(point[0]) && point[1] > 0);
  const front = paretoFront(points);
  if (!points.length) return front;
  for (const point of front) point[3] = true;
  const series = solvers.map(solver =>
    ({ name: solver, line: options.named, points: points.filter(point => point[4].solver === solver) }));
  show(plot({ x_label: options.x_label, y_label: "RMS of positions, mm", x_log: true, y_log: true, caption: options.caption,
    series: [...series, { name: "Pareto front", points: front, front: true }] }));
  return front;
}

function showAllSizes() {
  heading("All solvers, sizes and settings");
  paragraph("Down and left is better. A level sheet, clamped by an edge, falls for 0.5 s without damping; compared with " +
    `${data.truth_side} x ${data.truth_side} vertices solved by the reference at half its own step (whose step still ` +
    `moves it by ${mm(data.truth_error_m, 2)} mm). Detail that a mesh is too coarse for counts as error.`);
  const front = showChart(rows, "cpu_ms_per_s", "rms_total_error_m", row => `${row.name}, ${row.side}\u00b2`,
    { named: false, x_label: "CPU ms per simulated second",
      caption: "Every mark is one solver at one size with one setting; the dashed line joins those that nothing else " +
        "beats in both." });
  show(table([["on the Pareto front", "CPU ms / s", "RMS mm"], ...front.map(([x, y, name]) =>
    [name, fixed(x, 1), fixed(y, 3)])]));
}

/* A figure of the reference itself, and of others the distance from it. */
function showFit() {
  const fit = csv(data.fit), figures = Object.keys(fit[0] || {}).filter(key => key.endsWith("_off_mm"))
    .map(key => key.slice(0, -"_off_mm".length));
  if (!fit.length) return;
  heading("What each setting does to the fit, in millimetres");
  paragraph("Built-in garments at rest on the form: the height of the hem above the ground, the lengths of openings as " +
    "worn, and the ease, which is the girth of the cloth at rest minus the body's. The first row has the figures of the " +
    "reference, all others how far they are from it.");
  for (const garment of new Set(fit.map(row => row.garment))) {
    const own = fit.filter(row => row.garment === garment);
    const cell = (row, key) => (row === own[0] ? fixed(row[`${key}_mm`], 1)
      : (row[`${key}_off_mm`] >= 0 ? "+" : "") + fixed(row[`${key}_off_mm`], 1));
    paragraph(garment);
    show(table([["", "edges mm", "particles", "CPU s to rest", "rms strain", ...figures.map(key => key.replaceAll("_", " "))],
      ...own.map(row => [row.name, row.edge_mm, row.particles,
        fixed(1e-3 * row.cpu_ms, 1) + (row.settled ? "" : ", not at rest"), percent(row.rms_strain, 2),
        ...figures.map(key => cell(row, key))])]));
  }
}

function showSizes() {
  heading("Size by size");
  paragraph("A drape comes to rest as a garment does before its first frame: by relaxation of the exact energy; `preview` then rests in motion. " +
    "Of equal drapes that are each other's mirror image the nearer one counts. What lies on the reference itself has no " +
    "place on a logarithmic axis.");
  for (const side of new Set(rows.map(row => row.side))) {
    const own = rows.filter(row => row.side === side), name = row => row.name;
    showChart(own, "cpu_ms_per_s", "rms_error_m", name, { named: true, x_label: "CPU ms per simulated second",
      caption: `${side} x ${side} vertices, falling: against the same mesh, converged in time, after 0.5 s.` });
    showChart(own, "rest_cpu_ms", "rest_rms_error_m", name, { named: true, x_label: "CPU ms to come to rest",
      caption: `${side} x ${side} vertices at rest, held by two corners: against the reference's rest.` });
  }
}

function showAll() {
  heading("All figures");
  show(table([["", "vertices", "substep", "CPU ms / s", "RMS mm", "with mesh mm", "CPU ms to rest", "rest RMS mm",
    "energy over the reference's", "largest strain"], ...rows.map(row => [row.name, `${row.side}\u00b2`,
    `${mm(row.substep_s, 3)} ms`, fixed(row.cpu_ms_per_s, 1), mm(row.rms_error_m), mm(row.rms_total_error_m),
    fixed(row.rest_cpu_ms, 0), mm(row.rest_rms_error_m),
    Number.isFinite(row.rest_excess_energy_j) ? `${short(row.rest_excess_energy_j, 2)} J` : "-",
    percent(row.rest_largest_strain, 2)])]));
}

begin("The trade of cloth: error against time", "toile trade --axis cloth: a sheet of 1 m of the default fabric, CPU time " +
  "of one core" + (data.complete ? "" : "; interrupted: what was measured until then"));
showAllSizes();
showFit();
showSizes();
showAll();
data.refusals.forEach(paragraph);
