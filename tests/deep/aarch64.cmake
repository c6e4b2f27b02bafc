# Cross-compiles for aarch64, with what the folder CAMBER_SYSROOT of the environment has of Debian's arm64 packages; tests
# run under QEMU. Use: cmake --toolchain tests/deep/aarch64.cmake, with pkg-config told the same folder, as
# test_aarch64.sh does. The kernels are compiled by this machine's clang.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_SYSROOT $ENV{CAMBER_SYSROOT})
set(CMAKE_FIND_ROOT_PATH $ENV{CAMBER_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L $ENV{CAMBER_SYSROOT})
