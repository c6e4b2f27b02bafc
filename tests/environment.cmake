# Every test of this directory gets one cache for all, kernels that were compiled before the first of them, a count of
# those that are compiled all the same, and what the sanitizers are told. And it gets processors, of which ./dev counts
# halves: one that waits for others most of the time gets a half.
#
# The last include also writes tests/manifest.txt, from which tests/tiers.py chooses: a line a test, with its name, its cost,
# what builds for it (a fixture, or -), whether it is such a build (setup, or -), and its labels.
set(CAMBER_TEST_CACHE ${CMAKE_BINARY_DIR}/cache CACHE PATH "Where tests keep what they compile")
set(CAMBER_TEST_KERNELS ${CMAKE_BINARY_DIR}/src/camber-kernels CACHE PATH "Kernels that are compiled before the tests")
file(MAKE_DIRECTORY ${CAMBER_TEST_CACHE}/pocl ${CAMBER_TEST_CACHE}/warm ${CAMBER_TEST_CACHE}/home)
set(environment XDG_CACHE_HOME=${CAMBER_TEST_CACHE} CAMBER_KERNELS=${CAMBER_TEST_KERNELS})
get_property(all DIRECTORY PROPERTY TESTS)
foreach(test IN LISTS all)
  # These test OpenCL: its calls, its caches, what drivers need, and how the tool fares with it. Others run on the back end
  # cpu, as users do, if it was built: a process that loads PoCL takes a third of a second for that.
  get_test_property(${test} LABELS label)
  if((label MATCHES "faults|deep|recipes|fuzz" AND NOT test MATCHES "^test_(validate|(leaks|memory)_cpu)$") OR
     test MATCHES "^(kernels|compilations|test_(program|memory|parts|fork|cli|install|examples))$")
    set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT CAMBER_CPU=none)
  endif()
  set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT ${environment})
  if(label MATCHES "tool" OR test STREQUAL "test_spec") # shells, browsers and rpm leave files at home
    set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT HOME=${CAMBER_TEST_CACHE}/home)
  endif()
  # A kernel is installed as PoCL's cache has it. Tests that break something leave kernels for work-groups of one size there:
  # what installs has a cache into which only `camber info --warm` writes.
  set(pocl pocl)
  if(test MATCHES "^(kernels|test_(install|examples))$")
    set(pocl warm)
  endif()
  set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT POCL_CACHE_DIR=${CAMBER_TEST_CACHE}/${pocl})
  if(CAMBER_SANITIZE)
    # Drivers keep what they allocate until the process ends; camber's own leaks are not on the list. LLVM, inside the
    # drivers, puts its own signal stack where the sanitizer expects the one it made. The leak sanitizer falls over the
    # thread-local storage of what has been unloaded, now and then: it looks for no pointer there.
    set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT ASAN_OPTIONS=use_sigaltstack=0
                 LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/fixtures/lsan.supp:print_suppressions=0:use_tls=0
                 UBSAN_OPTIONS=print_stacktrace=1)
  endif()
  get_test_property(${test} PROCESSORS halves)
  if(test MATCHES "^(sanitize_soak|test_(serve_outside|slurm|proxies|viewer_window))$")
    set_tests_properties(${test} PROPERTIES PROCESSORS 1)
  elseif(NOT halves)
    set_tests_properties(${test} PROPERTIES PROCESSORS 2)
  endif()
  get_test_property(${test} LABELS label)
  if(NOT CAMBER_SANITIZE AND NOT CMAKE_CROSSCOMPILING AND NOT label MATCHES "tree|unit|deep|fuzz|faults|recipes" AND NOT test MATCHES "^(kernels|compilations)$")
    get_test_property(${test} FIXTURES_REQUIRED required)
    if(required)
      set_tests_properties(${test} PROPERTIES FIXTURES_REQUIRED "${required};kernels")
    else()
      set_tests_properties(${test} PROPERTIES FIXTURES_REQUIRED kernels)
    endif()
    if(NOT test STREQUAL test_environment) # which has a library of its own that is loaded first
      set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT LD_PRELOAD=$<TARGET_FILE:count_compilations>
                   CAMBER_COMPILATIONS=${CAMBER_TEST_CACHE}/compilations)
    endif()
  endif()
  foreach(property COST FIXTURES_REQUIRED FIXTURES_SETUP FIXTURES_CLEANUP)
    get_test_property(${test} ${property} ${property})
    if(NOT ${property})
      set(${property} -)
    endif()
  endforeach()
  set(role -)
  if(NOT "${FIXTURES_SETUP}${FIXTURES_CLEANUP}" STREQUAL "--")
    set(role setup)
  endif()
  list(REMOVE_ITEM FIXTURES_REQUIRED kernels)
  list(JOIN FIXTURES_REQUIRED "," FIXTURES_REQUIRED)
  if(NOT FIXTURES_REQUIRED)
    set(FIXTURES_REQUIRED -)
  endif()
  get_test_property(${test} LABELS label)
  list(JOIN label "," label)
  set_property(GLOBAL APPEND_STRING PROPERTY camber_manifest "${test} ${COST} ${FIXTURES_REQUIRED} ${role} ${label}\n")
endforeach()
get_property(manifest GLOBAL PROPERTY camber_manifest)
file(WRITE ${CMAKE_BINARY_DIR}/tests/manifest.txt "${manifest}")
