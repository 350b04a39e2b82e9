# Run at build time (cmake -P): writes OUTPUT from version.cpp.in, only when it would change.
# Needs SOURCE_DIR (of the project), OUTPUT and the variables that version.cpp.in names, but for POESY_GIT_COMMIT.
set(POESY_GIT_COMMIT unknown)
find_program(GIT git)
# An unpacked archive may lie inside somebody else's checkout: only a checkout of this project counts.
if(GIT AND EXISTS "${SOURCE_DIR}/.git")
  execute_process(COMMAND "${GIT}" describe --always --dirty --abbrev=40 --exclude=* WORKING_DIRECTORY "${SOURCE_DIR}"
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(POESY_GIT_COMMIT "${commit}")
  endif()
endif()
# The year in which the version was released, for citations.
file(STRINGS "${SOURCE_DIR}/CITATION.cff" POESY_YEAR REGEX "^date-released: ")
string(REGEX MATCH "[0-9][0-9][0-9][0-9]" POESY_YEAR "${POESY_YEAR}")
configure_file("${CMAKE_CURRENT_LIST_DIR}/version.cpp.in" "${OUTPUT}" @ONLY)
