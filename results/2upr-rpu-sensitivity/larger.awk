# A study of the same machine with k times the lengths, poses' z and length errors: what it is called in another unit.
BEGIN { l_A = 60; l_B = 150; c = 25; d = 115; z_0 = -200 } # mm, Table 4
function mm(length_mm) { return sprintf("\"%.17g mm\"", k * length_mm) }
/^model = / {
  print
  print "geometry = { l_A = " mm(l_A) ", l_B = " mm(l_B) ", c = " mm(c) ", d = " mm(d) ", z_0 = " mm(z_0) " }"
  next
}
/^workspace = / { gsub(/"-300 mm"/, mm(-300)); gsub(/"-180 mm"/, mm(-180)) }
/^(linear|background) = / { gsub(/"1 mm"/, mm(1)) }
{ print }
