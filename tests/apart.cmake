# What every test of this directory gets: caches of its own, for PoCL has crashed when two processes built their first
# kernel in one folder; and what the sanitizers are told.
get_property(all DIRECTORY PROPERTY TESTS)
foreach(test IN LISTS all)
  set(cache ${CMAKE_BINARY_DIR}/cache/${test})
  file(MAKE_DIRECTORY ${cache}/pocl)
  set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT XDG_CACHE_HOME=${cache} POCL_CACHE_DIR=${cache}/pocl)
  if(CAMBER_SANITIZE)
    # Drivers keep what they allocate until the process ends; camber's own leaks are not on the list. LLVM, inside the
    # drivers, puts its own signal stack where the sanitizer expects the one it made. The leak sanitizer falls over the
    # thread-local storage of what has been unloaded, now and then: it looks for no pointer there.
    set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT ASAN_OPTIONS=use_sigaltstack=0
                 LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/lsan.supp:print_suppressions=0:use_tls=0
                 UBSAN_OPTIONS=print_stacktrace=1)
  endif()
endforeach()
