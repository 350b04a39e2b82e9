# Joins published.csv with the exports of the three runs, whose folders are named converged, included and excluded.
BEGIN {
  FS = ","
  REFERENCE = "epsilon_1_1_z"  # the error that Table 10 sets to 1 degree
  ROUNDING = 1e-8              # mm/mm or mm/deg: an index below this is 0 to rounding
  INDEX = "linear_deformation [mm per mm or deg]"
}
FNR == 1 {
  parts = split(FILENAME, path, "/")
  run = path[parts - 1]
  table = path[parts]
  at = 0
  for (k = 1; k <= NF; ++k) if ($k == INDEX) at = k
  if (table == "global.csv" && !at) {
    print "comparison.awk: no column '" INDEX "' in " FILENAME > "/dev/stderr"
    failed = 1
    exit 1
  }
  next
}
table == "table10.csv" { order[++count] = $1; published[$1] = $2; next }
table == "global.csv" { mu[run, $1] = $at; next }
{
  settled = table ~ /_(converged|stagnated)\.csv$/
  for (k = 2; k <= NF; ++k) {
    solves[run, $1] += $k
    if (!settled) unsettled[run, $1] += $k
  }
}
function index_of(run, error) { return mu[run, error] < ROUNDING ? "0" : sprintf("%.4g", mu[run, error]) }
function share(run, error) { return sprintf("%.3f", 100 * unsettled[run, error] / solves[run, error]) }
function tolerance(run, error) {
  return mu[run, error] < ROUNDING ? "-" : sprintf("%.4f", mu[run, REFERENCE] / mu[run, error])
}
function share_of_all(run,   p, part, all) {
  for (p = 1; p <= count; ++p) {
    part += unsettled[run, order[p]]
    all += solves[run, order[p]]
  }
  return sprintf("%.3f", 100 * part / all)
}
END {
  if (failed) exit 1
  print "Linear index mu in mm/mm or mm/deg; samples that did not settle, in %; tolerance mu_ref/mu in mm or deg."
  print "Written by ./regenerate; the columns are explained in README.md."
  print ""
  format = "%-13s  %-6s  %9s %9s %9s  %9s %6s  %9s %9s %9s %9s\n"
  printf format, "", "", "mu", "mu", "mu", "%", "%", "tolerance", "tolerance", "tolerance", "tolerance"
  printf format, "error", "unit", "converged", "included", "excluded", "converged", "cap_50", "published", "converged", "included",
    "excluded"
  for (p = 1; p <= count; ++p) {
    e = order[p]
    printf format, e, (e ~ /^delta/ ? "mm/mm" : "mm/deg"),
      index_of("converged", e), index_of("included", e), index_of("excluded", e),
      share("converged", e), share("excluded", e),
      sprintf("%.4f", published[e]), tolerance("converged", e), tolerance("included", e), tolerance("excluded", e)
  }
  printf "%-13s  %-6s  %9s %9s %9s  %9s %6s\n", "all", "", "", "", "", share_of_all("converged"), share_of_all("excluded")
}
