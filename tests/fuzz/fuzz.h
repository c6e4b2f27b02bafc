/* Helpers that the fuzz targets share: a context that watches its memory and its log, and what must hold for any mesh.
 *
 * A target is a body over bytes. libFuzzer's main calls it (CAMBER_FUZZ, ./dev fuzz), or replay.c's on the files that
 * lie in corpus/ and regressions/. */
#ifndef CAMBER_TESTS_FUZZ_FUZZ_H
#define CAMBER_TESTS_FUZZ_FUZZ_H

#include "camber_proof.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define REQUIRE(condition) ((condition) ? (void)0 : fuzz_break(#condition, __FILE__, __LINE__))
void fuzz_break(const char *condition, const char *file, int line);

typedef struct fuzz_run {
    camber_context *context;
    uint64_t hash; /* of the bytes: what a target varies without being told */
    size_t live_blocks, calls;
    size_t refuse_at; /* the call that gets no memory, counted from 1; 0: none */
    bool refused;
    size_t errors; /* told since the last fuzz_done */
} fuzz_run;

typedef void fuzz_body(fuzz_run *run, const uint8_t *bytes, size_t size);

/* Runs the body, and for some inputs once more with one allocation refused. Nothing may stay allocated. */
void fuzz_each(const uint8_t *bytes, size_t size, fuzz_body *body);

/* Whether a call succeeded. A failure has told one story, a success none, and memory is short only where it was
 * refused. */
bool fuzz_done(fuzz_run *run, camber_status status);

/* Bytes that a target takes its input from; 0 behind the end. */
typedef struct fuzz_reader {
    const uint8_t *bytes;
    size_t size;
} fuzz_reader;
uint64_t fuzz_take(fuzz_reader *from, size_t byte_count);
float fuzz_take_float(fuzz_reader *from);
double fuzz_take_double(fuzz_reader *from);
/* f32 width, f32 miter limit, u8 join | cap << 2. */
camber_stroke fuzz_take_stroke(fuzz_reader *from);

/* Tessellates on the host and checks the mesh; keep: it is handed over and freed by the caller. */
bool fuzz_tessellate(fuzz_run *run, const camber_polylines *polylines, const camber_tessellation_desc *desc,
                     camber_mesh_data *keep);
void fuzz_check_lines(const camber_lines *lines);

/* A sink that keeps what it gets. */
typedef struct fuzz_bytes {
    uint8_t *bytes;
    size_t size, capacity;
} fuzz_bytes;
camber_sink fuzz_sink(fuzz_bytes *bytes);

/* The target's own; libFuzzer and replay.c call them. A target with nothing to begin with has the first from fuzz.c. */
int LLVMFuzzerInitialize(int *argument_count, char ***arguments);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

#endif
