# python3 is looked up when the tests run: quickstart installs it for the tests, after the first configuring perhaps.
add_test(NAME architecture.include_table
         COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/architecture/include_table.py ${PROJECT_SOURCE_DIR})
add_test(NAME architecture.include_table_finds_violations
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/include_table_test.py)
add_test(NAME architecture.kind_names
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/kind_names.py ${PROJECT_SOURCE_DIR})
add_test(NAME architecture.kind_names_finds_violations
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/kind_names_test.py)
add_test(NAME architecture.readme_commands
         COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/architecture/readme_commands.py $<TARGET_FILE:poesy>)
add_test(NAME architecture.readme_commands_finds_violations
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/readme_commands_test.py $<TARGET_FILE:poesy>)
add_test(NAME architecture.page_links
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/page_links.py ${PROJECT_SOURCE_DIR})
add_test(NAME architecture.page_links_finds_violations
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/page_links_test.py)
add_test(NAME architecture.type_names
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/type_names.py ${PROJECT_SOURCE_DIR})
add_test(NAME architecture.type_names_finds_violations
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/type_names_test.py)
add_test(NAME architecture.index_arithmetic
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/index_arithmetic.py ${PROJECT_SOURCE_DIR})
add_test(NAME architecture.index_arithmetic_finds_it
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/index_arithmetic_test.py)
add_test(NAME architecture.ctest_lines
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/ctest_lines.py ${PROJECT_BINARY_DIR})
add_test(NAME architecture.ctest_lines_finds_violations
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/ctest_lines_test.py)
add_test(NAME architecture.kernels_for_gpu
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/kernels_for_gpu.py ${PROJECT_SOURCE_DIR})
add_test(NAME architecture.kernels_for_gpu_finds_violations
         COMMAND python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/architecture/kernels_for_gpu_test.py)
set_tests_properties(architecture.kernels_for_gpu PROPERTIES SKIP_RETURN_CODE 77)
set_tests_properties(architecture.include_table architecture.include_table_finds_violations
                     architecture.kind_names architecture.kind_names_finds_violations
                     architecture.ctest_lines architecture.ctest_lines_finds_violations
                     architecture.index_arithmetic architecture.index_arithmetic_finds_it
                     architecture.readme_commands architecture.readme_commands_finds_violations
                     architecture.page_links architecture.page_links_finds_violations
                     architecture.type_names architecture.type_names_finds_violations
                     architecture.kernels_for_gpu architecture.kernels_for_gpu_finds_violations
                     PROPERTIES LABELS architecture)

# Every public header compiles alone, with nothing but what the exported targets offer: one source a header.
# A sanitizer checks nothing here: these sources are only compiled.
if(POESY_SANITIZE)
  return()
endif()
file(GLOB_RECURSE public_headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/engine/*.h
     ${PROJECT_SOURCE_DIR}/models/*.h)
list(FILTER public_headers EXCLUDE REGEX "^engine/(app|python)/")
foreach(header IN LISTS public_headers)
  string(MAKE_C_IDENTIFIER ${header} name)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n")
  list(APPEND header_sources ${source})
endforeach()
add_library(public_headers_alone OBJECT ${header_sources})
target_link_libraries(public_headers_alone PRIVATE poesy_engine poesy_models poesy_options)
target_compile_options(public_headers_alone PRIVATE -O0)
# Where all is built at once, two libraries are read once for all of them: a header that needs them, or what they include,
# and does not say so is found by a build without POESY_UNITY. It is a target of its own there, which takes minutes.
if(POESY_UNITY)
  set_target_properties(public_headers_alone PROPERTIES EXCLUDE_FROM_ALL ON)
  target_precompile_headers(public_headers_alone PRIVATE <Eigen/Core> <toml++/toml.h>)
endif()
