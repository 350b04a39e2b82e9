# CHANGELOG.md as a Debian changelog, lines of at most 80 characters.
# awk -v version= (of the package) -v release= (Debian's) -v maintainer="Name <address>" -v now="date time" (UTC) -f changelog.awk CHANGELOG.md
#
# The newest version is an entry even before its date is known; an older one without a date was never released.

function flush_item(  count, words, k, line, indent) {
  if (item == "") return
  count = split(item, words, /[ \t]+/)
  line = "  *"
  indent = "   "
  for (k = 1; k <= count; ++k) {
    if (length(line) + 1 + length(words[k]) > 80 && line != indent) {
      print line
      line = indent
    }
    line = line " " words[k]
  }
  print line
  item = ""
}

function end_entry(  command, stamp) {
  flush_item()
  if (!inside) return
  command = "LC_ALL=C date --utc --rfc-email --date='" date "'"
  command | getline stamp
  close(command)
  printf "\n -- %s  %s\n", maintainer, stamp
  inside = 0
}

/^## \[/ {
  end_entry()
  known = $4 ~ /^[0-9]+-[0-9]+-[0-9]+$/
  inside = known || entries == 0
  if (!inside) next
  date = known ? $4 : now
  number = $2
  gsub(/[][]/, "", number)
  if (entries++ == 0) number = version
  printf "%spoesy (%s-%s) unstable; urgency=medium\n", (entries > 1 ? "\n" : ""), number, release
  next
}
!inside { next }
/^### / { flush_item(); printf "\n  [ %s ]\n", substr($0, 5); next }
/^- / { flush_item(); item = substr($0, 3); next }
/^ +[^ ]/ { sub(/^ +/, ""); item = item " " $0; next }
/^$/ { flush_item() }
END { end_entry() }
