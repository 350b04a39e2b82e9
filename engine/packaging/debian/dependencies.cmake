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
