// Draws every figure of the page before a frame is shown, and fits the tables. If a figure fails, the other figures and
// the tables are still drawn.

const DRAWINGS = { bars, heatmap, workspace, lines, scatter, robot, whatIf };

for (const figure of document.querySelectorAll("figure[data-figure]")) {
  const data = report.figures[figure.dataset.figure];
  try {
    DRAWINGS[data.type](figure, data).fit();
  } catch (error) {
    reportError(error);
  }
}

setTexts(document.body);
for (const wrap of document.querySelectorAll(".table-wrap")) new FittedTable(wrap).fit();
