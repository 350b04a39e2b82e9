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

# The programs that use a bare root take minutes and root's rights: .ci/run starts them.
foreach(name IN ITEMS bare_root package_check use_python container_check)
  add_test(NAME packaging.${name}_finds_faults
           COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/packaging/${name}_test.py)
  set_tests_properties(packaging.${name}_finds_faults PROPERTIES LABELS install)
endforeach()
add_test(NAME packaging.changelog COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/packaging/changelog_test.py)
set_tests_properties(packaging.changelog PROPERTIES LABELS install)
