/* gallery.html of `toile gallery`: data = what gallery_write.c writes. Sentences that compare are made from the figures
 * alone, so that they cannot contradict them. */
const OBJECTS = 2; /* the solid and the sheet */
const EQUAL_RATIO = 1.01; /* the last digits of an error depend on which samples lie on an outline */
const NO_ERROR = 5e-6;

const isEqual = (a, b) => Math.abs(a - b) < NO_ERROR || Math.max(a, b) < EQUAL_RATIO * Math.min(a, b);
const errorWords = (section, error) => (section.by_flip ? `FLIP ${short(error, 3)}` : `${short(100 * error, 3)} %`);
const objectName = (section, object) => (object ? "sheet" : section.solid);
const looksOf = section => [...new Set(section.entries.map(entry => entry.look))];

/* The techniques from the smallest error to the largest, on one object and under one appearance; null where there are
 * less than two to compare. */
function orderWords(section, object, look) {
  const list = section.entries.filter(entry => entry.look === look).sort((a, b) => a.error[object] - b.error[object]);
  if (list.length < 2) return null;
  const errors = list.map(entry => entry.error[object]);
  const near = isEqual(errors[0], errors[errors.length - 1])
    ? list.length === 2 ? "Both are equally near." : "All are equally near."
    : isEqual(errors[0], errors[1]) ? `"${list[0].technique}" and "${list[1].technique}" are equally near.`
    : `"${list[0].technique}" is nearest.`;
  return `On the ${objectName(section, object)}${look ? ", " + look : ""}: ` +
    list.map((entry, i) => `${entry.technique}: ${errorWords(section, errors[i])}`).join("; ") + ". " + near;
}

/* Whether the figures agree with a claim, wherever both its techniques were drawn; null where they were not. */
function claimWords(section, { nearer, farther, source }) {
  const verdicts = [];
  for (const entry of section.entries.filter(entry => entry.technique === nearer)) {
    const other = section.entries.find(other => other.technique === farther && other.look === entry.look);
    for (let object = 0; other && object < OBJECTS; object++) {
      const [a, b] = [entry.error[object], other.error[object]];
      verdicts.push(`${objectName(section, object)}${entry.look ? ` (${entry.look})` : ""} ${errorWords(section, a)} against ` +
        `${errorWords(section, b)}, ${isEqual(a, b) ? "they are equal" : a < b ? "it is" : "it is not"}`);
    }
  }
  return verdicts.length ? `${source} expects "${nearer}" to be nearer than "${farther}": ${verdicts.join("; ")}.` : null;
}

/* What moves in an entry's strip, and how much its frames change. */
function motionWords(section, { change, exact_change }) {
  const step = short(section.motion_step), turns = `turns by ${step} degrees`;
  const moved = { camera: `The camera ${turns}`, lamp: `The lamp ${turns}`, cloth: `The sheet falls for ${step} frames`,
    sky: `The environment plays ${step} frame${section.motion_step > 1 ? "s" : ""}` }[section.motion];
  const compared = isEqual(change, exact_change) ? "as much as" : change > exact_change ? "more than" : "less than";
  return `${moved} from picture to picture: pixels change by ${short(change, 3)} levels of 255 in the mean, ${compared} ` +
    `the ${section.is_exact ? "exact" : "other"} picture's, which change by ${short(exact_change, 3)}.`;
}

function showEntry(section, entry) {
  const errors = entry.error.map((error, object) => `${errorWords(section, error)} on the ${objectName(section, object)}`);
  show(widePicture(entry.image, `${entry.technique}${entry.look ? ", " + entry.look : ""}`, `${section.is_exact ? "error" : "difference"} ${errors.join(", ")}; ` +
    `${entry.time_ms.map(time => fixed(time, 1)).join(" and ")} ms CPU${entry.kept ? " (of an earlier run)" : ""}`));
  if (entry.strip) show(widePicture(entry.strip, "in motion", motionWords(section, entry)));
}

/* Times of the entries over their number of regions, of those that have the usual size of maps, and over that size, of
 * those that have the usual number of regions. */
function showTimes(entries) {
  const usual = key => entries.map(entry => entry[key])
    .reduce((best, value, _, all) => (all.filter(other => other === value).length > all.filter(other => other === best).length ? value : best));
  const curve = (name, x, fixedKey) => ({ name, line: true,
    points: entries.filter(entry => entry[fixedKey] === usual(fixedKey)).map(entry => [entry[x], entry.time_ms[0]])
      .sort((a, b) => a[0] - b[0]) });
  show(plot({ x_label: "regions, or texels", y_label: "ms CPU a frame of the solid", x_log: true, y_log: true,
    series: [curve("by number of regions", "regions", "map_size"), curve("by texels of a map's side", "map_size", "regions")],
    caption: "Time of a frame, as measured in this run: of 6 to 384 regions, each with a map of the usual size; and of " +
      "the usual number of regions with maps of several sizes." }));
}

begin("The gallery of techniques", `toile gallery: ${data.sections.reduce((sum, section) => sum + section.entries.length, 0)} ` +
  "settings, each on a solid and on a draped sheet: the exact picture, the technique, their difference, and where they " +
  "differ most" + (data.complete ? "" : "; interrupted: what was drawn until then"));
paragraph("Errors are relative RMSE over covered pixels, or mean FLIP where edges matter, against the exact picture that " +
  "each section names. Each difference has a scale of its own, in linear radiance: the largest of the three channels. " +
  "Times are process CPU time of a whole frame, all threads: compare them with one another within one run, not with other " +
  "machines. Sentences that compare are made from the figures.");
for (const section of data.sections) {
  heading(section.title);
  paragraph(`${section.source}. ${section.text}`);
  paragraph(`${section.is_exact ? "Exact picture" : "No exact picture"}: ${section.exact_text}.`);
  for (const look of looksOf(section))
    for (let object = 0; object < OBJECTS; object++) {
      const words = orderWords(section, object, look);
      if (words) paragraph(words);
    }
  for (const words of section.claims.map(claim => claimWords(section, claim))) if (words) paragraph(words);
  for (const entry of section.entries) showEntry(section, entry);
  if (section.shows_times && section.entries.length > 1) showTimes(section.entries);
  show(...section.figures.map(figure));
}
