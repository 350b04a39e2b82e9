# Files of a target that are compiled together (POESY_UNITY): headers and templates are then read once for many files.
#
# Files share a group when no two of them define the same name in their namespaces without a name; the same alias of the
# same type may be in several. So nobody needs to mind which files are compiled together. Compiled alone are files with
# options beyond those of their room, kernels, generated files, and those with
# `using namespace`.
set(POESY_UNITY_FILES 40)  # of a group, at most: more save little and take memory

# List of the names that a source defines for itself: in namespaces without a name, and as macros.
function(poesy_internal_names out text)
  string(REGEX MATCHALL "\n#define [A-Za-z_0-9]+" definitions "${text}")
  while(text MATCHES "\nnamespace {\n")
    string(FIND "${text}" "\nnamespace {\n" begin)
    string(SUBSTRING "${text}" ${begin} -1 text)
    string(FIND "${text}" "\n}  // namespace\n" length)
    string(SUBSTRING "${text}" 0 ${length} space)
    string(SUBSTRING "${text}" ${length} -1 text)
    string(REGEX REPLACE "\\[\\[[a-z_]+\\]\\] |\ntemplate <[^\n]*|( final)? : public [^\n{]*|\nnamespace {|\nusing [^\n]*" "" space "${space}")
    # In lines that are not indented, what stands before a parameter, a value or a body ends with the name.
    string(REGEX MATCHALL "\n(struct|class|enum class|enum) [A-Za-z_0-9]+" types "${space}")
    string(REGEX MATCHALL "\n[A-Za-z_][^][\n(){}=;]*" others "${space}")
    list(FILTER others EXCLUDE REGEX "^\n[A-Z_]+$")  # macros of GoogleTest, whose names differ in a program anyway
    list(APPEND definitions ${types} ${others})
  endwhile()
  set(names)
  foreach(definition IN LISTS definitions)
    string(REGEX MATCHALL "[A-Za-z_0-9]+" words "${definition}")
    list(POP_BACK words name)
    list(APPEND names ${name})
  endforeach()
  list(REMOVE_DUPLICATES names)
  set(${out} "${names}" PARENT_SCOPE)
endfunction()

# List of the aliases of types that a source defines, each as a text "Vector3 = lie::Vector3<double>".
function(poesy_aliases out text)
  string(REGEX MATCHALL "\nusing [A-Za-z_0-9]+ = [^][;\n]*" lines "${text}")
  list(TRANSFORM lines REPLACE "\nusing " "")
  set(${out} "${lines}" PARENT_SCOPE)
endfunction()

# Names of those aliases that are not among the known ones.
function(poesy_other_aliases out aliases known)
  if(known)
    list(REMOVE_ITEM aliases ${known})
  endif()
  list(TRANSFORM aliases REPLACE " = .*" "")
  set(${out} "${aliases}" PARENT_SCOPE)
endfunction()

# Whether two lists have a name in common.
function(poesy_share out one two)
  set(${out} FALSE PARENT_SCOPE)
  foreach(name IN LISTS one)
    if(name AND name IN_LIST two)
      set(${out} TRUE PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# Whether a file's own text must be compiled alone, or has options of its own.
function(poesy_is_alone out target path text)
  get_source_file_property(options ${path} TARGET_DIRECTORY ${target} COMPILE_OPTIONS)
  set(${out} FALSE PARENT_SCOPE)
  if(options OR text MATCHES "\nusing namespace ")
    set(${out} TRUE PARENT_SCOPE)
  endif()
endfunction()

# poesy_unity(TARGET): every file goes to the first group that takes it. Called when all files of the target are known.
function(poesy_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC takes the files of a group for headers, whose types must not depend on a namespace without a name.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
    # With 512 MB before it looks for garbage, GCC takes a tenth less time for a group.
    target_compile_options(${target} PRIVATE --param=ggc-min-heapsize=524288)
  endif()
  get_target_property(sources ${target} SOURCES)
  get_target_property(folder ${target} SOURCE_DIR)
  foreach(source IN LISTS sources)
    get_filename_component(path ${source} ABSOLUTE BASE_DIR ${folder})
    get_source_file_property(generated ${path} TARGET_DIRECTORY ${target} GENERATED)
    if(generated OR source MATCHES "TARGET_OBJECTS")
      continue()
    endif()
    file(READ ${path} text)
    poesy_is_alone(alone ${target} ${path} "${text}")
    if(alone)
      continue()
    endif()
    poesy_internal_names(names "${text}")
    poesy_aliases(aliases "${text}")
    foreach(number RANGE 1 99)
      set(group ${number})
      if(NOT DEFINED files_${group})
        set(files_${group} 0)
      endif()
      poesy_other_aliases(own "${aliases}" "${aliases_${group}}")
      poesy_other_aliases(others "${aliases_${group}}" "${aliases}")
      poesy_share(clash "${names};${own}" "${names_${group}};${others}")
      if(files_${group} LESS POESY_UNITY_FILES AND NOT clash)
        break()
      endif()
    endforeach()
    math(EXPR files_${group} "${files_${group}} + 1")
    list(APPEND names_${group} ${names})
    list(APPEND aliases_${group} ${aliases})
    set_source_files_properties(${path} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP group_${group})
  endforeach()
endfunction()
