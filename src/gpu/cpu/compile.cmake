# Compiles every program of gpu/programs.h for each level of processors, by clang, as functions of the library. Below,
# cpu_objects are the objects, and cpu_definitions what levels.c and device.c must know; both are empty without clang.
set(cpu_objects)
set(cpu_definitions)

# Level, lanes of its vectors, what clang is told.
set(cpu_levels)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$" AND CMAKE_SIZEOF_VOID_P EQUAL 8)
  set(cpu_levels "x86_64_v4 16 -march=x86-64-v4 -mprefer-vector-width=512" "x86_64_v3 8 -march=x86-64-v3"
      "x86_64_v2 8 -march=x86-64-v2")
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$" AND CMAKE_SIZEOF_VOID_P EQUAL 8)
  set(cpu_levels "aarch64 8 -march=armv8-a")
endif()

# Fast arithmetic would change bytes. OpenCL's own division and roots may be off by some units in the last place.
set(cpu_flags -x cl -cl-std=CL1.2 -O3 -fPIC -ffp-contract=off -cl-fp32-correctly-rounded-divide-sqrt -Wno-psabi
    -Wno-unused-function -Wno-unused-variable)
if(CMAKE_CROSSCOMPILING)
  list(APPEND cpu_flags --target=${CMAKE_SYSTEM_PROCESSOR}-linux-gnu)
endif()

# Sets `lacks` to what is missing for the levels that are asked for, or to nothing.
function(camber_check_clang)
  set(lacks "" PARENT_SCOPE)
  find_program(CAMBER_CLANG NAMES clang clang-19 clang-18 clang-17 clang-16 clang-15 clang-14)
  if(NOT cpu_levels)
    set(lacks "kernels are not compiled ahead for ${CMAKE_SYSTEM_PROCESSOR}" PARENT_SCOPE)
    return()
  elseif(NOT CAMBER_CLANG)
    set(lacks "no clang (Debian: clang)" PARENT_SCOPE)
    return()
  endif()
  execute_process(COMMAND ${CAMBER_CLANG} -dumpversion OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(cpu_compiler "clang ${version}" PARENT_SCOPE)
  if(version VERSION_LESS 14)
    set(lacks "clang ${version}, which is older than 14" PARENT_SCOPE)
    return()
  endif()
  foreach(level IN LISTS cpu_levels)
    separate_arguments(level)
    list(SUBLIST level 2 -1 flags)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/cpu/check.cl "float4 twice(float4 x) { return 2.0f * x; }\n")
    execute_process(COMMAND ${CAMBER_CLANG} ${cpu_flags} ${flags} -c ${CMAKE_CURRENT_BINARY_DIR}/cpu/check.cl
                            -o ${CMAKE_CURRENT_BINARY_DIR}/cpu/check.o RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(failed)
      list(GET level 0 name)
      set(lacks "clang ${version} compiles no OpenCL C for ${name}" PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

function(camber_compile_level level)
  separate_arguments(level)
  list(GET level 0 name)
  list(GET level 1 lanes)
  list(SUBLIST level 2 -1 flags)
  set(row "PROGRAM\\(with, ([a-z_]+), ([a-z_]+), \"([^\"]*)\"\\)")
  file(READ gpu/programs.h list)
  string(REGEX MATCHALL "${row}" rows "${list}")
  foreach(matched IN LISTS rows)
    string(REGEX MATCH "${row}" matched "${matched}")
    set(program ${CMAKE_MATCH_1})
    set(source ${PROJECT_SOURCE_DIR}/kernels/${CMAKE_MATCH_2}.cl)
    separate_arguments(options UNIX_COMMAND "${CMAKE_MATCH_3}")
    set(object ${CMAKE_CURRENT_BINARY_DIR}/cpu/${name}_${program}.o)
    add_custom_command(OUTPUT ${object}
      COMMAND ${CAMBER_CLANG} ${cpu_flags} ${flags} -DCAMBER_DEVICE=1 -DCAMBER_POINT_CHUNK=256 -DCAMBER_LANES=${lanes}
              ${options} -DCAMBER_CPU_PROGRAM=camber_cpu_${name}_${program} -I${CMAKE_CURRENT_SOURCE_DIR}
              -include ${CMAKE_CURRENT_SOURCE_DIR}/gpu/cpu/opencl_c.h -MD -MF ${object}.d -c ${source} -o ${object}
      DEPENDS ${source} ${CMAKE_CURRENT_SOURCE_DIR}/gpu/cpu/opencl_c.h DEPFILE ${object}.d
      COMMENT "Compiling the kernels of ${program} for ${name}" VERBATIM)
    list(APPEND cpu_objects ${object})
  endforeach()
  set(cpu_objects ${cpu_objects} PARENT_SCOPE)
  set(cpu_definitions ${cpu_definitions} CAMBER_CPU_${name}=1 PARENT_SCOPE)
endfunction()

if(CAMBER_CPU AND NOT CAMBER_KERNEL_FILES)
  camber_check_clang()
  if(NOT lacks)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS gpu/programs.h)
    foreach(level IN LISTS cpu_levels)
      camber_compile_level("${level}")
    endforeach()
    set_source_files_properties(${cpu_objects} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
    list(APPEND cpu_definitions CAMBER_CPU=1 "CAMBER_CPU_COMPILER=\"${cpu_compiler}\"")
  elseif(CAMBER_CPU STREQUAL AUTO)
    message(STATUS "camber: ${lacks}: CPUs draw by OpenCL only, and need a driver (Debian: pocl-opencl-icd)")
  else()
    message(FATAL_ERROR "CAMBER_CPU=${CAMBER_CPU}: ${lacks}")
  endif()
endif()
