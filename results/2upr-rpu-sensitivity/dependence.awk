# Lays out the indices of folders METRIC_AS/global.csv, METRIC published or platform, AS metre, decimetre, millimetre or
# small, with shares not converged (solves_*.csv) and Kendall's taus: lines METRIC|AS|OF|TAU of taus.txt, OF metres (the
# ranking by the same metric in metres) or platform (by the platform's metric in the same unit).
BEGIN {
  FS = ","
  split("metre decimetre millimetre small", as, " ")
  larger["metre"] = larger["small"] = 1
  larger["decimetre"] = 10
  larger["millimetre"] = 1000
  response["published"] = "linear_deformation"
  response["platform"] = "gap"
  ROUNDING = 1e-8 # mm or deg per mm or deg: an index below this is 0 to rounding
}
FNR == 1 {
  parts = split(FILENAME, path, "/")
  table = path[parts]
  if (table == "taus.txt") FS = "|"
  split(path[parts - 1], of, "_")
  metric = of[1]
  unit = of[2]
  for (k = 1; k <= NF; ++k) column[$k] = k
  if (table == "global.csv") {
    long = column[response[metric] "_corrected [mm per mm or deg]"]
    angle = column["angular_deformation_corrected [deg per mm or deg]"]
    if (!long || !angle) { print "dependence.awk: a column is missing in " FILENAME > "/dev/stderr"; failed = 1; exit 1 }
  }
  if (table != "taus.txt") next
}
table == "taus.txt" { tau[$1, $2, $3] = $4; next }
table == "global.csv" {
  if (!(($1) in known)) { known[$1]; order[++count] = $1 }
  per_length = $1 ~ /^delta/
  index_of[metric, "long", unit, $1] = $long / (per_length ? 1 : larger[unit])
  index_of[metric, "angle", unit, $1] = $angle * (per_length ? larger[unit] : 1)
  next
}
{
  for (k = 2; k <= NF; ++k) {
    solves[metric, unit] += $k
    if (table !~ /_(converged|stagnated)\.csv$/) unsettled[metric, unit] += $k
  }
}
function shown(value) { return value < ROUNDING ? "0" : sprintf("%.4g", value) }
function line(first, cells,   k, text) {
  text = sprintf("%-29s", first)
  for (k = 1; k <= 8; ++k) text = text sprintf(k == 5 ? "  %10s" : " %10s", cells[k])
  sub(/ +$/, "", text)
  print text
}
function add_taus(metric, of, label,   k, cells) {
  for (k = 1; k <= 4; ++k) cells[k] = tau[metric, as[k], of]
  line(label, cells)
}
function block(metric, name,   k, p, cells) {
  print ""
  for (k = 1; k <= 4; ++k) { cells[k] = name; cells[k + 4] = "angular" }
  line(metric " metric", cells)
  for (k = 1; k <= 4; ++k) cells[k] = cells[k + 4] = as[k]
  line("error", cells)
  for (p = 1; p <= count; ++p) {
    for (k = 1; k <= 4; ++k) {
      cells[k] = shown(index_of[metric, "long", as[k], order[p]])
      cells[k + 4] = shown(index_of[metric, "angle", as[k], order[p]])
    }
    line(order[p], cells)
  }
  for (k = 5; k <= 8; ++k) cells[k] = ""
  for (k = 1; k <= 4; ++k) cells[k] = sprintf("%.3f", 100 * unsettled[metric, as[k]] / solves[metric, as[k]])
  line("not converged, %", cells)
  add_taus(metric, "metres", "tau with the ranking in metre")
}
END {
  if (failed) exit 1
  print "What an index depends on. The study with its lengths in metre, decimetre and millimetre: one machine, one set of errors."
  print "small: in metres, each error a hundredth, 0.01 mm or 0.01 deg. All indices in mm or deg per mm or deg."
  print "Written by ./regenerate; README.md says what is seen."
  block("published", "linear")
  add_taus("published", "platform", "tau with the platform's")
  block("platform", "gap")
}
