# Debian packages by the files that they hold, as dpkg on this machine knows them.

# poesy_package_of(OUT FILE): the package that installed a file. Fails for a file of no package.
function(poesy_package_of out file)
  file(REAL_PATH "${file}" file)
  string(REGEX REPLACE "^/usr/lib" "/lib" before_merging ${file})  # where /lib is a link, packages may name either
  execute_process(COMMAND dpkg-query --search ${file} ${before_merging} OUTPUT_VARIABLE found ERROR_QUIET)
  if(NOT found MATCHES "^([a-z0-9.+-]+)[:,]")
    message(FATAL_ERROR "'${file}' is of no Debian package: ${found}")
  endif()
  set(${out} ${CMAKE_MATCH_1} PARENT_SCOPE)
endfunction()

# poesy_development_packages(OUT): what libpoesy-dev depends on. Computed: a package for each find_dependency of
# poesy-config.cmake.in, by the file that this build found (CPACK_POESY_FILE_OF_NAME), in the version asked for there.
function(poesy_development_packages out)
  file(STRINGS ${CPACK_POESY_SOURCE}/engine/poesy-config.cmake.in lines REGEX "^find_dependency\\(")
  set(depends)
  foreach(line IN LISTS lines)
    string(REGEX MATCH "^find_dependency\\(([A-Za-z0-9]+) ([0-9.]+)" _ "${line}")
    set(name ${CMAKE_MATCH_1})
    set(version ${CMAKE_MATCH_2})
    if(NOT CPACK_POESY_FILE_OF_${name})
      message(FATAL_ERROR "packages.cmake names no file of '${name}', for: ${line}")
    endif()
    poesy_package_of(package ${CPACK_POESY_FILE_OF_${name}})
    list(APPEND depends "${package} (>= ${version})")
  endforeach()
  list(JOIN depends ", " depends)
  set(${out} "${depends}" PARENT_SCOPE)
endfunction()

# poesy_python_packages(DEPENDS RECOMMENDS): of python3-poesy. Computed: the Python that the module was built for and no other,
# since its binary interface changes with the second number; and a package for each dependency in pyproject.toml, of which
# matplotlib is needed for pictures alone.
function(poesy_python_packages depends_out recommends_out)
  string(REGEX MATCH "^([0-9]+)\\.([0-9]+)" _ ${CPACK_POESY_PYTHON_VERSION})
  math(EXPR next "${CMAKE_MATCH_2} + 1")
  set(depends "python3 (>= ${CMAKE_MATCH_1}.${CMAKE_MATCH_2}~)" "python3 (<< ${CMAKE_MATCH_1}.${next})")
  set(recommends)
  file(STRINGS ${CPACK_POESY_SOURCE}/engine/python/pyproject.toml line REGEX "^dependencies = \\[")
  string(REGEX MATCHALL "[a-z0-9]+>=[0-9.]+" needed "${line}")
  if(NOT needed)
    message(FATAL_ERROR "pyproject.toml has no line of dependencies such as \"numpy>=1.24\"")
  endif()
  foreach(one IN LISTS needed)
    string(REGEX REPLACE "^(.*)>=(.*)$" "python3-\\1 (>= \\2)" package ${one})
    if(package MATCHES "^python3-matplotlib ")
      list(APPEND recommends ${package})
    else()
      list(APPEND depends ${package})
    endif()
  endforeach()
  list(JOIN depends ", " depends)
  list(JOIN recommends ", " recommends)
  set(${depends_out} "${depends}" PARENT_SCOPE)
  set(${recommends_out} "${recommends}" PARENT_SCOPE)
endfunction()
