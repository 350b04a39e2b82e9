# cmake -D BUILD= -D CONFIG= -D GENERATOR= -D CXX= -D LINK_FLAGS= -D VERSION= -D SOURCE= -D WORK= -P downstream.cmake
function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG} --prefix ${prefix})

file(GLOB_RECURSE leaked ${prefix}/include/*.cpp ${prefix}/include/*/engine/app/*)
if(leaked)
  message(FATAL_ERROR "installed, but not part of the public interface: ${leaked}")
endif()

set(described bash-completion/completions/poesy zsh/site-functions/_poesy)
find_program(HELP2MAN help2man)
if(HELP2MAN)
  list(APPEND described man/man1/poesy.1)
endif()
foreach(file IN LISTS described)
  file(SIZE ${prefix}/share/${file} size)
  if(size EQUAL 0)
    message(FATAL_ERROR "empty: ${file}")
  endif()
endforeach()

run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G ${GENERATOR} -D CMAKE_BUILD_TYPE=${CONFIG}
    -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_EXE_LINKER_FLAGS=${LINK_FLAGS}
    -D POESY_EXPECTED_VERSION=${VERSION})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/downstream)
run(${prefix}/bin/poesy --version)

# The installed program names the gallery that is installed with it.
execute_process(COMMAND ${prefix}/bin/poesy models OUTPUT_VARIABLE models COMMAND_ERROR_IS_FATAL ANY)
string(FIND "${models}" "  ${prefix}/share/poesy/mechanisms/3-rps/3-rps.toml\n" found)
if(found EQUAL -1)
  message(FATAL_ERROR "poesy models does not name the installed gallery: ${models}")
endif()
