/* index.html of `toile sheet`: data = what write_page of cmd_sheet.c writes. */
begin(data.title, data.note);
for (const row of data.rows) {
  heading(row.title);
  show(pictures(row.pictures.map(({ file, name, group }) => ({ source: file, name, text: group }))));
  if (row.refused) paragraph("Refused: the run's messages say why.");
}
