/* Makes PoCL run the kernels of a saved binary as they are.
 *
 * Input: a binary that clGetProgramInfo gave. Output: the same without LLVM's code. Main idea: a binary of PoCL holds
 * the kernels, ready for work-groups of any size, and LLVM's code of the program. If PoCL has the code, it compiles a
 * kernel anew for the size, offset and count of a launch, which takes a second and gains nothing here. Only the
 * environment variable POCL_WORK_GROUP_SPECIALIZATION=0 stops that, and the environment is the caller's. If PoCL does
 * not have the code, it runs the kernels that it has.
 *
 * A binary begins with this (PoCL's lib/CL/pocl_binary.c, versions 9 to 12); numbers are little-endian:
 *
 *     8 bytes     "poclbin"
 *     8 + 4 + 4   the device, the version, the number of kernels
 *     8           flags
 *     4           the number of files of the program
 *     41          a hash in letters from A: the folder in PoCL's cache into which the binary is unpacked
 *     8           the size of global variables, if the flags have GLOBALS
 *     8           the bytes of the first file with its name and both their sizes, which follow
 *     4 + 11      "/program.bc"
 *     4 + n       LLVM's code
 *     ...         other files, and the kernels
 *
 * The stripped binary has an empty file by another name, since PoCL wants one, and a folder of its own. In the folder
 * of a program that was compiled from source PoCL would find the code. */
#include "cl/pocl.h"

#include <string.h>

static const char MAGIC[] = "poclbin", CODE[] = "/program.bc", NO_CODE[] = "/no-code.bc";

enum {
    VERSION_AT = 16,
    FLAGS_AT = 24,
    FOLDER_AT = 36,
    FOLDER_BYTES = 41,
    OLDEST = 9,
    NEWEST = 12,
    GLOBALS = 2,
    NAME_BYTES = sizeof CODE - 1,
    LEAST_BYTES = FOLDER_AT + FOLDER_BYTES + 8 + 8 + 4 + NAME_BYTES + 4,
};

bool camber_is_pocl(const camber_device_info *info) {
    return info->type == CAMBER_DEVICE_TYPE_CPU && strcmp(info->platform, "Portable Computing Language") == 0;
}

static uint64_t get(const unsigned char *at, size_t bytes) {
    uint64_t value = 0;
    for (size_t i = 0; i < bytes; i++)
        value |= (uint64_t)at[i] << 8 * i;
    return value;
}

static void put(unsigned char *at, size_t bytes, uint64_t value) {
    for (size_t i = 0; i < bytes; i++)
        at[i] = (unsigned char)(value >> 8 * i);
}

bool camber_pocl_strip(unsigned char *binary, size_t *size_bytes) {
    if (*size_bytes < LEAST_BYTES || memcmp(binary, MAGIC, sizeof MAGIC) != 0)
        return false;
    const uint64_t version = get(binary + VERSION_AT, 4);
    const bool has_globals = get(binary + FLAGS_AT, 8) & GLOBALS;
    unsigned char *const file = binary + FOLDER_AT + FOLDER_BYTES + (has_globals ? 8 : 0);
    unsigned char *const name = file + 8 + 4, *const code = name + NAME_BYTES + 4;
    const size_t left = (size_t)(binary + *size_bytes - code);
    const uint64_t code_bytes = get(code - 4, 4);
    if (version < OLDEST || version > NEWEST || get(name - 4, 4) != NAME_BYTES || memcmp(name, CODE, NAME_BYTES) != 0 ||
        code_bytes > left || get(file, 8) != 4 + NAME_BYTES + 4 + code_bytes)
        return false;
    put(file, 8, 4 + NAME_BYTES + 4);
    memcpy(name, NO_CODE, NAME_BYTES);
    put(code - 4, 4, 0);
    memmove(code, code + code_bytes, left - (size_t)code_bytes);
    binary[FOLDER_AT] = 'c'; /* no capital letter: no program from source has this folder */
    *size_bytes -= (size_t)code_bytes;
    return true;
}
