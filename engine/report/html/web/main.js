// Draws every figure of the page at once, before a frame is shown. One that fails leaves the others, and the tables, as
// they are.

const DRAWINGS = { bars, heatmap, workspace, lines, scatter, robot };

for (const figure of document.querySelectorAll("figure[data-figure]")) {
  const data = report.figures[figure.dataset.figure];
  try {
    DRAWINGS[data.type](figure, data).fit();
  } catch (error) {
    reportError(error);
  }
}

setTexts(document.body);
