# The target `lint`, and a step lint/NAME for each of its parts: the rules of the tree (tests/lint/lint_tree.py), formatting, clang-tidy, every kernel and every public
# header by itself. It counts with the clang of .ci/pinned: another one formats otherwise and has other checks. Such a
# clang-format or clang-tidy is left out, and what such a clang warns of is information.
set(lint_notes)
set(lint_missing)
foreach(tool clang clang-format clang-tidy)
  string(TOUPPER ${tool} name)
  string(REPLACE "-" "_" name ${name})
  find_program(${name} NAMES ${tool}-${pinned_clang} ${tool})
  if(NOT ${name})
    list(APPEND lint_missing ${tool})
    continue()
  endif()
  execute_process(COMMAND ${${name}} --version OUTPUT_VARIABLE version)
  string(REGEX MATCH "version ([0-9]+)" version "${version}")
  set(${name}_IS_PINNED OFF)
  if(CMAKE_MATCH_1 STREQUAL pinned_clang)
    set(${name}_IS_PINNED ON)
  elseif(tool STREQUAL clang)
    list(APPEND lint_notes COMMAND ${CMAKE_COMMAND} -E echo "lint: ${tool} ${CMAKE_MATCH_1}, made for ${pinned_clang}: its warnings do not count")
  else()
    list(APPEND lint_notes COMMAND ${CMAKE_COMMAND} -E echo "lint: ${tool} ${CMAKE_MATCH_1}, made for ${pinned_clang}: skipped")
  endif()
endforeach()
find_program(PYTHON3 python3)
if(NOT PYTHON3)
  list(APPEND lint_missing python3)
endif()
if(lint_missing)
  list(JOIN lint_missing ", " lint_missing)
  add_custom_target(lint_notes COMMAND ${CMAKE_COMMAND} -E echo "lint: not here: ${lint_missing}, see ./dev setup"
                    COMMAND ${CMAKE_COMMAND} -E false)
  add_custom_target(lint DEPENDS lint_notes)
  return()
endif()
set(lint_warnings -Wall -Wextra)
if(CLANG_IS_PINNED)
  list(APPEND lint_warnings -Werror)
endif()

file(GLOB_RECURSE lint_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.c ${PROJECT_SOURCE_DIR}/bench/*.c)
file(GLOB_RECURSE lint_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.h ${PROJECT_SOURCE_DIR}/kernels/*.h)
file(GLOB_RECURSE lint_others CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/*.c ${PROJECT_SOURCE_DIR}/tests/*.h ${PROJECT_SOURCE_DIR}/kernels/*.cl)

set(stamps ${CMAKE_BINARY_DIR}/lint)
set(done)
function(lint_step name)
  cmake_parse_arguments(arg "" "" "COMMAND;DEPENDS" ${ARGN})
  add_custom_command(OUTPUT ${stamps}/${name} COMMAND ${arg_COMMAND} COMMAND ${CMAKE_COMMAND} -E touch ${stamps}/${name}
                     DEPENDS ${arg_DEPENDS} VERBATIM)
  set(done ${done} ${stamps}/${name} PARENT_SCOPE)
endfunction()
file(MAKE_DIRECTORY ${stamps})

# Layers are checked in the object files that have been built. As it takes a second, it runs each time: there is no stamp.
add_custom_command(OUTPUT ${stamps}/tree
  COMMAND ${PYTHON3} ${CMAKE_CURRENT_LIST_DIR}/lint/lint_tree.py ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR} VERBATIM)
set_source_files_properties(${stamps}/tree PROPERTIES SYMBOLIC TRUE)
list(APPEND done ${stamps}/tree)

add_custom_target(lint_notes ${lint_notes})
add_custom_target(lint_format DEPENDS lint_notes)
if(CLANG_FORMAT_IS_PINNED)
  add_custom_command(TARGET lint_format COMMAND ${CLANG_FORMAT} --dry-run -Werror ${lint_sources} ${lint_headers} ${lint_others} VERBATIM)
  lint_step(format COMMAND ${CLANG_FORMAT} --dry-run -Werror ${lint_sources} ${lint_headers} ${lint_others} DEPENDS ${lint_sources} ${lint_headers} ${lint_others})
endif()

# Each kernel file by itself, as editors check it, in as many builds as show all of it: as for a CPU, where a kernel
# calls its body (CAMBER_KERNEL), and as for other devices, whose compilers take less: NVIDIA's has no variadic macros.
file(GLOB kernels CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/kernels/*.cl)
file(GLOB kernel_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/kernels/*.h ${PROJECT_SOURCE_DIR}/kernels/*.inl)
file(STRINGS ${PROJECT_SOURCE_DIR}/kernels/compile_flags.txt kernel_flags)
set(build_plain -pedantic)
set(build_cpu -DCAMBER_POINT_CHUNK=256 -DCAMBER_HAS_ARC_LENGTH=1 -UCAMBER_METHOD -DCAMBER_METHOD=1 -DCAMBER_RASTER_RICH=1)
set(build_pitched -pedantic -DCAMBER_PITCHED=1 -DCAMBER_RASTER_RICH=1 -DCAMBER_RASTER_PITCHED=1)
set(build_fan -pedantic -UCAMBER_METHOD -DCAMBER_METHOD=2)
set(build_gpu -pedantic -DCAMBER_LANES=1)
set(build_gpu_pitched ${build_gpu} -DCAMBER_RASTER_RICH=1 -DCAMBER_RASTER_PITCHED=1)
foreach(kernel IN LISTS kernels)
  get_filename_component(name ${kernel} NAME_WE)
  set(builds plain cpu pitched fan)
  if(name STREQUAL "raster") # with one lane, as a whole: other files are for vectors
    list(APPEND builds gpu gpu_pitched)
  endif()
  foreach(build IN LISTS builds)
    lint_step(kernel_${name}_${build}
      COMMAND ${CLANG} ${kernel_flags} -fsyntax-only ${lint_warnings} -Wno-unused-function -Wno-unused-parameter
              -Wno-ignored-pragmas -Wno-missing-field-initializers ${build_${build}} ${kernel}
      DEPENDS ${kernels} ${kernel_headers} ${PROJECT_SOURCE_DIR}/kernels/compile_flags.txt)
  endforeach()
endforeach()

file(GLOB public_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/camber*.h)
foreach(header IN LISTS public_headers)
  get_filename_component(name ${header} NAME)
  lint_step(c_${name} COMMAND ${CLANG} -std=c11 -pedantic ${lint_warnings} -fsyntax-only -x c ${header} DEPENDS ${public_headers})
  lint_step(cxx_${name} COMMAND ${CLANG} -std=c++17 -pedantic ${lint_warnings} -fsyntax-only -x c++ ${header} DEPENDS ${public_headers})
endforeach()

if(NOT CLANG_TIDY_IS_PINNED)
  set(lint_sources)
endif()
foreach(source IN LISTS lint_sources)
  file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${source})
  if(name MATCHES "^src/(style|features|formats|map|text)/" AND NOT CAMBER_MAP)
    continue()
  endif()
  set(made)
  if(name MATCHES "^src/formats/") # clang-tidy reads the headers that protoc-c makes
    set(made ${CMAKE_BINARY_DIR}/src/messages/vector_tile.pb-c.h)
  elseif(name MATCHES "^src/text/")
    set(made ${CMAKE_BINARY_DIR}/src/messages/glyphs.pb-c.h)
  endif()
  string(REPLACE "/" "_" name ${name})
  lint_step(tidy_${name} COMMAND ${CLANG_TIDY} --quiet --warnings-as-errors=* -p ${CMAKE_BINARY_DIR} ${source}
            DEPENDS ${source} ${lint_headers} ${made} ${PROJECT_SOURCE_DIR}/.clang-tidy)
endforeach()

add_custom_target(lint DEPENDS lint_notes ${done})
