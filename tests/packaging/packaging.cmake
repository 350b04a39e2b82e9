# Installs this build to a fresh prefix, then configures, builds and runs a project that knows the package alone.
# A sanitized library needs its runtime at the consumer's link.
set(sanitize_flag "")
if(POESY_SANITIZE)
  set(sanitize_flag -fsanitize=${POESY_SANITIZE})
endif()
add_test(NAME packaging.downstream
         COMMAND ${CMAKE_COMMAND} -D BUILD=${PROJECT_BINARY_DIR} -D CONFIG=$<CONFIG> -D GENERATOR=${CMAKE_GENERATOR}
                 -D CXX=${CMAKE_CXX_COMPILER} -D LINK_FLAGS=${sanitize_flag} -D VERSION=${PROJECT_VERSION}
                 -D SOURCE=${CMAKE_CURRENT_SOURCE_DIR}/packaging/downstream
                 -D WORK=${CMAKE_CURRENT_BINARY_DIR}/packaging -P
                 ${CMAKE_CURRENT_SOURCE_DIR}/packaging/downstream.cmake)
set_tests_properties(packaging.downstream PROPERTIES LABELS install TIMEOUT 600)

# The program that tries a new user's first command in a bare root takes minutes and root's rights: .ci/run starts it.
add_test(NAME packaging.bare_root_finds_faults
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/packaging/bare_root_test.py)
set_tests_properties(packaging.bare_root_finds_faults PROPERTIES LABELS install)
