# Batches, one translation unit per instruction set, with the options of the kernels in models/CMakeLists.txt.
function(poesy_batch isa)
  add_library(batch_${isa} OBJECT models/simd/batch.cpp)
  target_compile_definitions(batch_${isa} PRIVATE POESY_BATCH=${isa}_batch)
  target_compile_options(batch_${isa} PRIVATE -O3 -ffp-contract=off ${ARGN})
  target_include_directories(batch_${isa} PRIVATE ${PROJECT_SOURCE_DIR} ${HIGHWAY_INCLUDE_DIR})
  target_link_libraries(batch_${isa} PRIVATE poesy_options)
  list(APPEND batches batch_${isa})
  set(batches ${batches} PARENT_SCOPE)
endfunction()
set(batches)
set(avx2 -mavx2 -mfma -mbmi -mbmi2 -mf16c -maes -mpclmul)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  poesy_batch(avx2 ${avx2})
  poesy_batch(avx512 ${avx2} -mavx512f -mavx512bw -mavx512dq -mavx512vl -mavx512cd)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  poesy_batch(neon)
endif()
poesy_test(simd_test LABELS property SOURCES models/simd/isa_test.cpp models/simd/math_test.cpp
           LINKS poesy_models ${batches})
# Contraction would fuse what the plain batch must round twice.
set_source_files_properties(models/simd/math_test.cpp PROPERTIES COMPILE_OPTIONS -ffp-contract=off)

poesy_test(assembly_test LABELS property SOURCES models/assembly_test.cpp LINKS poesy_models DATA)
poesy_test(kernel_test LABELS property SOURCES models/chain/block_lanes_test.cpp models/chain/block_solver_test.cpp
           models/chain/platform_motion_test.cpp
           LINKS poesy_models)
