# The target `lint`: formatting, clang-tidy, every kernel and every public header by itself.
find_program(CLANG clang)
find_program(CLANG_FORMAT clang-format)
find_program(CLANG_TIDY clang-tidy)
if(NOT CLANG OR NOT CLANG_FORMAT OR NOT CLANG_TIDY)
  add_custom_target(lint COMMAND ${CMAKE_COMMAND} -E echo "lint: clang, clang-format and clang-tidy are needed; see ./dev setup"
                    COMMAND ${CMAKE_COMMAND} -E false)
  return()
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

lint_step(format COMMAND ${CLANG_FORMAT} --dry-run -Werror ${lint_sources} ${lint_headers} ${lint_others} DEPENDS ${lint_sources} ${lint_headers} ${lint_others})

foreach(method 0 1 2)
  lint_step(kernels_${method}
    COMMAND ${CLANG} -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Werror
            -Wno-unused-function -Wno-unused-parameter -Wno-ignored-pragmas -DCAMBER_METHOD=${method} -D__OPENCL_VERSION__=120 ${CMAKE_BINARY_DIR}/src/kernels.cl
    DEPENDS ${CMAKE_BINARY_DIR}/src/kernels.cl)
endforeach()

lint_step(kernels_network
  COMMAND ${CLANG} -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Werror
          -Wno-unused-function -Wno-unused-parameter -Wno-ignored-pragmas -D__OPENCL_VERSION__=120 ${CMAKE_BINARY_DIR}/src/network.cl
  DEPENDS ${CMAKE_BINARY_DIR}/src/network.cl)

foreach(variant 0,0 1,0 1,1)
  string(REGEX REPLACE "(.),(.)" "-DCAMBER_COVER_RICH=\\1;-DCAMBER_COVER_PITCHED=\\2" macros ${variant})
  string(REPLACE "," "_" variant ${variant})
  lint_step(kernels_cover_${variant}
    COMMAND ${CLANG} -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Werror
            -Wno-unused-function -Wno-unused-parameter -Wno-ignored-pragmas -D__OPENCL_VERSION__=120 ${macros}
            ${CMAKE_BINARY_DIR}/src/cover.cl
    DEPENDS ${CMAKE_BINARY_DIR}/src/cover.cl)
endforeach()

lint_step(kernels_cover_lanes
  COMMAND ${CLANG} -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Werror
          -Wno-unused-function -Wno-unused-parameter -Wno-ignored-pragmas -D__OPENCL_VERSION__=120 -Wno-bitwise-instead-of-logical -DCAMBER_LANES=1
          ${CMAKE_BINARY_DIR}/src/cover.cl
  DEPENDS ${CMAKE_BINARY_DIR}/src/cover.cl)

foreach(header camber.h camber_map.h)
  lint_step(c_${header} COMMAND ${CLANG} -std=c11 -pedantic -Wall -Wextra -Werror -fsyntax-only -x c ${PROJECT_SOURCE_DIR}/src/${header}
            DEPENDS ${PROJECT_SOURCE_DIR}/src/camber.h ${PROJECT_SOURCE_DIR}/src/camber_map.h)
  lint_step(cxx_${header} COMMAND ${CLANG} -std=c++17 -pedantic -Wall -Wextra -Werror -fsyntax-only -x c++ ${PROJECT_SOURCE_DIR}/src/${header}
            DEPENDS ${PROJECT_SOURCE_DIR}/src/camber.h ${PROJECT_SOURCE_DIR}/src/camber_map.h)
endforeach()

foreach(source IN LISTS lint_sources)
  file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${source})
  if(name MATCHES "^src/(style|source|map)/" AND NOT CAMBER_MAP)
    continue()
  endif()
  string(REPLACE "/" "_" name ${name})
  lint_step(tidy_${name} COMMAND ${CLANG_TIDY} --quiet --warnings-as-errors=* -p ${CMAKE_BINARY_DIR} ${source}
            DEPENDS ${source} ${lint_headers} ${PROJECT_SOURCE_DIR}/.clang-tidy)
endforeach()

add_custom_target(lint DEPENDS ${done})
