# Packages by CPack, from a build folder in which `poesy` and `poesy_completion_and_man` are built:
#
#   cpack -G DEB    poesy_VERSION_ARCH.deb, the program with its data, and libpoesy-dev_VERSION_ARCH.deb; where the build has
#                   POESY_PYTHON_MODULE and poesy_solver is built, python3-poesy_VERSION_ARCH.deb, both parts of poesy in Python
#   cpack -G TGZ    the program with its data, for other distributions. Configured by the preset portable it needs the C and
#                   the C++ library alone: HDF5 is in the program, since other distributions have it under other names and
#                   Debian's needs forty libraries more, and the others lie beside it.
#
# What differs between the two is in generator.cmake, which cpack reads for each.
set(POESY_MAINTAINER "The poesy developers <maintainers@poesy.example>" CACHE STRING "Who answers for the packages")

set(CPACK_PACKAGE_NAME poesy)
set(CPACK_PACKAGE_VENDOR "The poesy developers")
set(CPACK_PACKAGE_CONTACT ${POESY_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "which errors of a parallel robot matter, and how much")
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
    WORLD_EXECUTE)
set(CPACK_THREADS 0)  # as many as there are processors

set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"Monte Carlo sensitivity engine for precision parallel robots: which
manufacturing and assembly errors matter, how much, where in the workspace,
and how tight must each be? Errors are drawn by the thousand, every robot is
solved at every pose, on all processors, and errors are ranked with confidence
intervals. It also finds the yield under limits, Sobol' indices, and
tolerances at least cost.
.
With the program come its manual page, completion for bash and zsh, a gallery
of mechanisms and the studies of a published analysis.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"Monte Carlo sensitivity engine for precision parallel robots.
.
This package has the static libraries, their headers and files for CMake:
find_package(poesy), targets poesy::engine and poesy::models.")

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME poesy)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS bash-completion)
if(POESY_MPI)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS openmpi-bin)  # mpirun
endif()
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpoesy-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS cmake)

if(POESY_PYTHON_MODULE)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"Monte Carlo sensitivity engine for precision parallel robots.
.
This package has the Python package poesy, which runs the program, reads its
results as xarray Datasets, ranks errors and draws them, and the compiled
module poesy_solver, which solves NumPy arrays of errors.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-poesy)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/debian/python/postinst
      ${CMAKE_CURRENT_LIST_DIR}/debian/python/prerm)
  set(CPACK_POESY_PYTHON_VERSION ${Python_VERSION})
endif()

# What generator.cmake and the scripts behind it need to know of the build.
set(CPACK_POESY_SOURCE ${PROJECT_SOURCE_DIR})
set(CPACK_POESY_VERSION ${PROJECT_VERSION})
set(CPACK_POESY_BINDIR ${CMAKE_INSTALL_BINDIR})
set(CPACK_POESY_LIBDIR ${CMAKE_INSTALL_LIBDIR})
set(CPACK_POESY_DATADIR ${CMAKE_INSTALL_DATADIR})
set(CPACK_POESY_MANDIR ${CMAKE_INSTALL_MANDIR})
set(CPACK_POESY_DOC ${CMAKE_INSTALL_DATADIR}/doc)
set(CPACK_POESY_OBJDUMP ${CMAKE_OBJDUMP})
set(CPACK_POESY_PROCESSOR ${CMAKE_SYSTEM_PROCESSOR})
string(REGEX MATCH "^[0-9]+" CPACK_POESY_GCC ${CMAKE_CXX_COMPILER_VERSION})
# A file of each library that a program built with poesy's own must find again (poesy-config.cmake.in) ...
foreach(name IN ITEMS Eigen3 TBB Boost fmt tomlplusplus)
  set(CPACK_POESY_FILE_OF_${name} ${${name}_CONFIG})
endforeach()
find_file(POESY_HDF5_HEADER hdf5.h HINTS ${HDF5_INCLUDE_DIRS} NO_DEFAULT_PATH)
set(CPACK_POESY_FILE_OF_HDF5 ${POESY_HDF5_HEADER})
set(CPACK_POESY_FILE_OF_OpenSSL ${OPENSSL_INCLUDE_DIR}/openssl/crypto.h)
# ... and of each whose code, from its headers, is in the program, which therefore carries its notice. Boost's licence asks
# for none in programs.
set(CPACK_POESY_COMPILED_IN ${Eigen3_CONFIG} ${CLI11_CONFIG} ${nlohmann_json_CONFIG}
    ${RANDOM123_INCLUDE_DIR}/Random123/philox.h ${HIGHWAY_INCLUDE_DIR}/hwy/highway.h)
# The same of the module for Python.
set(CPACK_POESY_COMPILED_IN_MODULE ${Eigen3_CONFIG} ${RANDOM123_INCLUDE_DIR}/Random123/philox.h
    ${HIGHWAY_INCLUDE_DIR}/hwy/highway.h ${pybind11_DIR}/pybind11Config.cmake)
# The preset portable links these statically, and has the program look for others beside itself.
if(HDF5_USE_STATIC_LIBRARIES)
  list(APPEND CPACK_POESY_COMPILED_IN ${HDF5_C_LIBRARY_hdf5} ${HDF5_C_LIBRARY_sz} ${HDF5_C_LIBRARY_z}
       ${OPENSSL_CRYPTO_LIBRARY})
endif()
if(CMAKE_INSTALL_RPATH MATCHES "/lib/poesy$")
  set(CPACK_POESY_BRINGS_LIBRARIES ON)
endif()

set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/generator.cmake)
include(CPack)
