// Draws every figure of the page. One that fails leaves the others, and the tables, as they are.

const DRAWINGS = { bars, heatmap, workspace, lines, scatter };

for (const figure of document.querySelectorAll("figure[data-figure]")) {
  const data = report.figures[figure.dataset.figure];
  try {
    DRAWINGS[data.type](figure, data);
  } catch (error) {
    reportError(error);
  }
}
