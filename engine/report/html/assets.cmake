# cmake -D "SCRIPTS=a.js;b.js" -D STYLE=x.css -D PACKAGES=node_modules -D OUTPUT=assets.cpp -P assets.cmake
# Writes the C++ source behind assets.h, and beside it the assets as files.

# What would end the element in which the text is to stand, or the literal, ends the build instead.
function(check_inlines name text)
  string(TOLOWER "${text}" lower)
  foreach(end IN ITEMS "</script" "</style" "<!--" ")poesy\"")
    string(FIND "${lower}" "${end}" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${name} contains ${end} and cannot stand inside a page")
    endif()
  endforeach()
endfunction()

# package_script(OUT FILE PACKAGES...): a file of the first package, behind the licences of all that are bundled in it.
function(package_script out file)
  set(notice "")
  foreach(package IN LISTS ARGN)
    file(READ ${PACKAGES}/${package}/LICENSE licence)
    string(STRIP "${licence}" licence)
    string(APPEND notice "${package}:\n\n${licence}\n\n")
  endforeach()
  list(GET ARGN 0 first)
  file(READ ${PACKAGES}/${first}/${file} script)
  set(${out} "/*!\n${notice}*/\n${script}" PARENT_SCOPE)
endfunction()

# All of d3's own packages have one licence, but for those that are named here.
package_script(d3 dist/d3.min.js d3 d3-ease d3-geo d3-scale-chromatic d3-delaunay delaunator robust-predicates)
package_script(plot dist/plot.umd.min.js @observablehq/plot interval-tree-1d binary-search-bounds isoformat)
set(report "(() => {\n\"use strict\";\n")
foreach(path IN LISTS SCRIPTS)
  file(READ ${path} script)
  string(APPEND report "${script}\n")
endforeach()
string(APPEND report "})();\n")
file(READ ${STYLE} style)

get_filename_component(folder ${OUTPUT} DIRECTORY)
set(constants "")
set(branches "")
foreach(asset IN ITEMS d3:d3.js plot:plot.js report:report.js style:report.css)
  string(REPLACE ":" ";" asset ${asset})
  list(POP_FRONT asset variable name)
  check_inlines(${name} "${${variable}}")
  file(WRITE ${folder}/${name} "${${variable}}")
  string(APPEND constants "constexpr char ${variable}[] = R\"poesy(${${variable}})poesy\";\n\n")
  string(APPEND branches "  if (name == \"${name}\") return {${variable}, sizeof ${variable} - 1};\n")
endforeach()

file(WRITE ${OUTPUT} "#include \"engine/report/html/assets.h\"

#include \"engine/base/contract.h\"

namespace poesy {
namespace {

${constants}}  // namespace

std::string_view asset(std::string_view name) {
${branches}  POESY_EXPECTS(false);
  return {};
}

}  // namespace poesy
")
