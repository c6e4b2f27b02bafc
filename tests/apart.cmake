# What every test of this directory gets: one cache for all, so that each kernel is compiled once in all of them; and what
# the sanitizers are told.
get_property(all DIRECTORY PROPERTY TESTS)
set(cache ${CMAKE_BINARY_DIR}/cache)
file(MAKE_DIRECTORY ${cache}/pocl)
foreach(test IN LISTS all)
  set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT XDG_CACHE_HOME=${cache} POCL_CACHE_DIR=${cache}/pocl
               POCL_WORK_GROUP_SPECIALIZATION=0 CAMBER_KERNELS=${CAMBER_TEST_KERNELS})
  if(CAMBER_SANITIZE)
    # Drivers keep what they allocate until the process ends; camber's own leaks are not on the list. LLVM, inside the
    # drivers, puts its own signal stack where the sanitizer expects the one it made. The leak sanitizer falls over the
    # thread-local storage of what has been unloaded, now and then: it looks for no pointer there.
    set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT ASAN_OPTIONS=use_sigaltstack=0
                 LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/lsan.supp:print_suppressions=0:use_tls=0
                 UBSAN_OPTIONS=print_stacktrace=1)
  endif()
endforeach()
