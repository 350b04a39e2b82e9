# Read by cpack once for each kind of package (CPACK_PROJECT_CONFIG_FILE).
#
# The version is the newest of CHANGELOG.md: 0.2.0 when it has a date, and 0.2.0~dev, which is older, before.
file(STRINGS ${CPACK_POESY_SOURCE}/CHANGELOG.md newest REGEX "^## \\[[0-9.]+\\] - " LIMIT_COUNT 1)
if(NOT newest MATCHES "\\[([0-9.]+)\\] - (.*)$")
  message(FATAL_ERROR "CHANGELOG.md has no line '## [VERSION] - DATE'")
endif()
set(CPACK_PACKAGE_VERSION ${CMAKE_MATCH_1})
if(NOT CMAKE_MATCH_2 MATCHES "^[0-9]+-[0-9]+-[0-9]+$")
  string(APPEND CPACK_PACKAGE_VERSION "~dev")
elseif(NOT CPACK_PACKAGE_VERSION VERSION_EQUAL CPACK_POESY_VERSION)
  message(FATAL_ERROR "CHANGELOG.md releases ${CPACK_PACKAGE_VERSION}, and the program says ${CPACK_POESY_VERSION}")
endif()
set(CPACK_PACKAGE_FILE_NAME poesy-${CPACK_PACKAGE_VERSION}-${CPACK_SYSTEM_NAME}-${CPACK_POESY_PROCESSOR})

if(CPACK_GENERATOR STREQUAL "DEB")
  include(${CMAKE_CURRENT_LIST_DIR}/debian/dependencies.cmake)
  poesy_development_packages(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
  if(CPACK_POESY_PYTHON_VERSION)
    poesy_python_packages(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS)
    string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
           ", poesy (= ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
  endif()
  set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian/finish.cmake)
else()
  # As one piece: of components the archive holds only what was installed, not what the script adds.
  set(CPACK_ARCHIVE_COMPONENT_INSTALL OFF)
  list(GET CPACK_INSTALL_CMAKE_PROJECTS 0 build)
  set(CPACK_INSTALL_CMAKE_PROJECTS "${build};poesy;program;/")
  set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/tarball/finish.cmake)
endif()
