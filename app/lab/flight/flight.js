/* report.html of `toile fly`: data = {summary: summary.json, frames: frames.csv, units, stops, worst} (fly_report.c). */
const { summary, units } = data, { oracle, against, replay } = summary;
const frames = csv(data.frames), judged = frames.slice(summary.warm_up_frames), budget = summary.budget_ms;
const ms = value => fixed(value, value < 1000 ? 1 : 0, " ms");
const seconds = i => i / summary.frame_rate;

/* Values of every frame over time: {name: value of a frame}. */
const overTime = (values, options) => plot({ x_label: "seconds of the flight", y_label: "ms", x_tight: true,
  height: 300, shaded_to: seconds(summary.warm_up_frames), ...options,
  series: Object.entries(values).map(([name, value]) =>
    ({ name, line: true, points: frames.map((frame, i) => [seconds(i), value(frame)]) })) });

function showHead() {
  const { settings } = summary, count = judged.length;
  const title = !count ? `${frames.length} frames, all of them warm-up`
    : budget ? `${percent(summary.within_1_1x, 1)} of ${count} frames within 1.1 x ${budget} ms`
    : `${frames.length} frames, half of them within ${ms(summary.p50_ms)}`;
  begin(title, `toile fly: scene ${summary.scene}, ${settings["image.width"]} x ${settings["image.height"]} pixels, ` +
    `path ${summary.path}, ${summary.frames} of ${summary.frames_planned} frames at ${summary.frame_rate} a second; ` +
    `${summary.machine.gl}, ${summary.machine.cores} cores${summary.stopped ? "; " + summary.stopped : ""}`);
  show(tiles([
    [ms(budget), "budget"],
    [percent(summary.within_1_1x, 1), "of frames within 1.1 x budget"],
    [fixed(summary.over_budget_frames, 0), "frames over the budget"],
    [ms(summary.mean_ms), "mean frame"],
    [ms(summary.p50_ms), "median frame"],
    [ms(summary.p95_ms), "95 % of frames take at most"],
    [ms(summary.p99_ms), "99 % of frames take at most"],
    [ms(summary.worst_ms), "longest frame"],
    [ms(summary.cloth_median_ms), "for the cloth (median)"],
    [ms(summary.cpu_p50_ms), "CPU time of a frame, all threads (median)"],
    [fixed(summary.load, 2), "load of the machine"],
    [percent(summary.prediction_error_median, 1), "median error of predicted times"],
    [fixed(summary.error_estimate_mean, 3), "mean FLIP that levels add, estimated"],
    ...(oracle ? [[fixed(oracle.garment_flip_mean, 3), "FLIP of the garment"],
      [fixed(oracle.garment_flip_worst, 3), "FLIP of its worst 5 %"],
      [fixed(oracle.covered_flip_mean, 3), "mean FLIP of all covered pixels"],
      [percent(oracle.rel_rmse, 1), "relative RMSE of all covered pixels"]] : []),
    [fixed(summary.memory_bytes / MIB, 0, " MiB"), "held by the renderer"],
  ].filter(([value]) => value !== "-")));
  if (!replay) return;
  const { of, compared, different, first_different } = replay;
  paragraph(`A replay of the levels of ${of}: ${compared - different} of ${compared} images are the same to the bit` +
    (different ? `; the first that differs is frame ${first_different}.` : "."));
}

/* The largest time of the plots, from frames after the warm-up: the first frames create all resources and would
 * dominate the scale. */
const highest = judged.length ? 1.25 * Math.max(summary.worst_ms, budget || 0) : Infinity;

function showFrames() {
  heading("Every frame");
  show(overTime({ frame: frame => Math.min(frame.total_ms, highest), cloth: frame => frame.cloth_ms }, {
    guides: budget ? [{ y: budget, name: `budget ${budget} ms` }] : [],
    caption: "Wall time from the choice of levels to the finished image. Shaded: warm-up, which is not judged" +
      (frames[0].total_ms > highest ? "; longer times are cut off." : "."),
  }));
  const bars = 40, width = Math.max(1.15 * summary.p95_ms, 1.2 * (budget || 0)) / bars;
  if (!(width > 0)) return;
  const counts = Array(bars).fill(0);
  for (const frame of judged) counts[Math.min(Math.floor(frame.total_ms / width), bars - 1)]++;
  show(plot({
    kind: "bars", bar_width: width, height: 260, y_is_count: true, x_label: "ms", y_label: "frames",
    caption: "The number of frames by their time" +
      (judged.some(frame => frame.total_ms >= bars * width) ? "; the last bar includes all longer frames." : "."),
    series: [{ name: "frames", points: counts.map((count, i) => [(i + 0.5) * width, count,
      `${short(i * width)} to ${short((i + 1) * width)} ms: ${count} frames`]) }],
  }));
}

function showStops() {
  if (!data.stops.length) return;
  heading("Along the path");
  show(pictures(data.stops.map(({ frame, png }) => ({ source: png, name: fixed(seconds(frame), 1, " s"),
    text: `frame ${frame}, ${ms(frames[frame].total_ms)}` }))));
}

const jobs = [...summary.jobs].sort((a, b) => b.total_ms - a.total_ms);
const jobTime = (frame, job) => frame[`job_${job.name}_ms`];

/* Stacked: the cloth at the bottom, the longest jobs above it, the remainder on top. */
function showJobs() {
  const layers = { cloth: frame => Math.min(frame.cloth_ms, highest) };
  const stack = (frame, count) => jobs.slice(0, count).reduce((sum, job) => sum + jobTime(frame, job), frame.cloth_ms);
  const shown = jobs.slice(0, MARKS.length - 2);
  shown.forEach((job, i) => { layers[job.name] = frame => Math.min(stack(frame, i + 1), highest); });
  layers["all else"] = frame => Math.min(Math.max(stack(frame, shown.length), frame.total_ms), highest);
  heading("Where the time went");
  show(overTime(layers, { kind: "areas", caption: "The times of the jobs, stacked: `toile plan` lists what each does." }));
  const all = judged.reduce((sum, frame) => sum + frame.total_ms, 0);
  show(table([["job", "median ms when it ran", "ran in", "of all time"], ...jobs.map(job => [job.name,
    fixed(job.median_ms, 2), percent(job.ran / judged.length, 0) + " of frames", percent(job.total_ms / all, 1)])]));
}

/* One lane for each control that changed, the first on top. */
function showLevels() {
  const reached = control => Math.max(...frames.map(frame => frame[control]));
  const controls = Object.keys(frames[0]).filter(key => key.startsWith("level_") && reached(key) > 0);
  heading("Quality that was reduced to keep the budget");
  if (!controls.length) return paragraph("Nothing: every frame was drawn as the settings ask for.");
  const lanes = {}, guides = controls.map((control, i) => ({ y: controls.length - 1 - i }));
  controls.forEach((control, i) => {
    lanes[`${control.slice("level_".length)}, up to ${reached(control)}`] =
      frame => guides[i].y + 0.72 * frame[control] / reached(control);
  });
  show(overTime(lanes, { kind: "steps", y_label: "levels", y_unlabelled: true, guides, height: 66 + 46 * controls.length,
    caption: "A control on its line has the quality of the settings; the distance above the line is the number of " +
      "levels by which it is reduced. Controls that are not shown were never reduced." }));
}

function showPredictions() {
  const points = frames.map((frame, i) => [frame.predicted_ms, frame.total_ms, `frame ${i}`])
    .filter((point, i) => i >= summary.warm_up_frames && Number.isFinite(point[0]));
  if (!points.length) return;
  const high = Math.max(...points.map(point => Math.max(point[0], point[1])));
  heading("Predicted and measured");
  show(plot({ x_label: "predicted, ms", y_label: "measured, ms", height: 400,
    series: [{ name: "frames", points }, { name: "as predicted", front: true, points: [[0, 0], [high, high]] }],
    caption: `Half of all frames were predicted within ${percent(summary.prediction_error_median, 1)}. Frames above ` +
      "the line took longer than predicted." }));
}

/* The part of a frame whose time exceeds its own median most. */
function explain(frame) {
  const parts = jobs.map(job => [job.name, jobTime(frame, job), job.median_ms]).filter(part => part[1] > 0);
  const rest = frame.total_ms - frame.cloth_ms - parts.reduce((sum, part) => sum + part[1], 0);
  parts.unshift(["cloth", frame.cloth_ms, summary.cloth_median_ms]);
  const excess = part => part[1] - part[2], [longest] = parts.sort((a, b) => excess(b) - excess(a));
  return rest > excess(longest) ? `${ms(frame.total_ms)}. Outside of all jobs: ${ms(rest)}`
    : `${ms(frame.total_ms)}. Farthest above its median: ${longest[0]}, ${ms(longest[1])} instead of ${ms(longest[2])}`;
}

function showWorst() {
  if (!data.worst.length) return;
  heading("The longest frames");
  show(pictures(data.worst.map((png, i) => ({ source: png, name: `frame ${summary.worst_frames[i]}`,
    text: explain(frames[summary.worst_frames[i]]) }))));
}

function showOracle() {
  if (!oracle) return;
  heading("Error against the reference");
  const garment = oracle.garment_frames
    ? `FLIP of the garment in ${oracle.garment_frames} of them, as shown: mean ${fixed(oracle.garment_flip_mean, 4)} ` +
      `(largest of a frame ${fixed(oracle.garment_flip_max, 4)}), of its worst 5 % of pixels ` +
      `${fixed(oracle.garment_flip_worst, 4)}.`
    : "None of them shows the garment.";
  const columns = { "FLIP of the garment": "garment_flip", "of its worst 5 %": "garment_flip_worst",
    "FLIP of all covered pixels": "covered_flip", "relative RMSE of all covered pixels": "relative_rmse",
    "estimated error of the levels": "error_estimate" };
  const values = Object.entries(columns).map(([name, column]) => [name, frame => frame[column]]);
  show(overTime(Object.fromEntries(values), { y_label: "error",
    caption: `${oracle.frames} frames against the ray-traced reference. ${garment} Over all covered pixels, of which ` +
      `the ground may be the larger part: mean FLIP ${fixed(oracle.covered_flip_mean, 4)} (largest ` +
      `${fixed(oracle.covered_flip_max, 4)}), relative RMSE ${percent(oracle.rel_rmse, 2)}.` }));
}

function showAgainst() {
  if (!against) return;
  heading("Against an earlier flight");
  paragraph(`Medians of this flight over those of ${against.folder}, frame by frame along the same path. The interval ` +
    "includes the noise within each run, but not a machine that was busier in one of them: where wall and CPU time " +
    "of the frame disagree, no row has a verdict.");
  show(table([["", "this, ms", "that, ms", "ratio", "95 % interval", ""], ...against.rows.map(row =>
    [row.name, fixed(row.this_ms, 2), fixed(row.that_ms, 2), fixed(row.ratio, 3),
      `${fixed(row.low, 3)} to ${fixed(row.high, 3)}`, row.verdict])]));
  if (against.regressions.length) paragraph(`Slower: ${against.regressions.join(", ")}.`);
}

function showSettings() {
  const rows = Object.entries(summary.settings).map(([option, value]) => [option, option in units ? `${value} ${units[option]}` : value]);
  show(html("details", {}, html("summary", {}, "The settings as they were read"), table([["option", "value"], ...rows])));
}

showHead();
showFrames();
showStops();
showJobs();
showLevels();
showPredictions();
showWorst();
showOracle();
showAgainst();
showSettings();
