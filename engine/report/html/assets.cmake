# cmake -D "SCRIPTS=a.js;b.js" -D "STYLES=x.css;y.css" -D BUNDLED=folder -D OUTPUT=assets.cpp -P assets.cmake
# Writes the C++ source of asset() in page.h, and beside it the assets as files.

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

file(READ ${BUNDLED}/d3.js d3)
file(READ ${BUNDLED}/plot.js plot)
set(report "(() => {\n\"use strict\";\n")
foreach(path IN LISTS SCRIPTS)
  file(READ ${path} script)
  string(APPEND report "${script}\n")
endforeach()
string(APPEND report "})();\n")
set(style "")
foreach(path IN LISTS STYLES)
  file(READ ${path} part)
  string(APPEND style "${part}\n")
endforeach()

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

file(WRITE ${OUTPUT} "#include \"engine/report/html/page.h\"

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
