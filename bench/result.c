/* Rows and figures of a section. */
#include "bench.h"

#include <math.h>
#include <string.h>

json_t *bench_result_new(void) {
    return json_pack("{s:[], s:[]}", "rows", "figures");
}

json_t *bench_measure_scenes(bench *b, const char *only, bench_scene_fn *measure, void *user) {
    json_t *result = bench_result_new();
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < b->scene_count && status == CAMBER_OK; i++)
        if (!only || strcmp(only, b->scenes[i].key) == 0)
            status = measure(b, b->scenes + i, user, result);
    if (status == CAMBER_OK)
        return result;
    json_decref(result);
    return NULL;
}

void bench_result_add_row(json_t *result, json_t *row) {
    json_array_append_new(json_object_get(result, "rows"), row);
}

json_t *bench_result_rows(const json_t *result) {
    return json_object_get(result, "rows");
}

void bench_result_add_figure(json_t *result, const bench_figure *figure) {
    if (!isfinite(figure->value) || figure->value <= 0)
        return;
    json_t *made = json_pack("{s:s, s:s, s:s?, s:f, s:b}", "item", figure->item, "what", figure->what, "against",
                             figure->against, "value", figure->value, "less", figure->less);
    json_array_append_new(json_object_get(result, "figures"), made);
}

json_t *bench_ms(double ms) {
    return json_real(round(ms * 1000) / 1000);
}

double bench_number(const json_t *row, const char *key) {
    return json_number_value(json_object_get(row, key));
}

const char *bench_text(const json_t *row, const char *key) {
    const char *text = json_string_value(json_object_get(row, key));
    return text ? text : "";
}

const char *bench_best_way(const json_t *peers, const char *library) {
    const size_t length = strcspn(library, "_");
    const char *key, *best = "";
    json_t *peer;
    json_object_foreach((json_t *)peers, key, peer) {
        const double ms = bench_number(peer, "ms");
        const bool counts = json_is_true(json_object_get(peer, "alike")) && ms > 0;
        if (counts && strcspn(key, "_") == length && strncmp(key, library, length) == 0 &&
            (!*best || ms < bench_number(json_object_get(peers, best), "ms")))
            best = key;
    }
    return best;
}

double bench_best_peer(const json_t *peers, const char *library) {
    return bench_number(json_object_get(peers, bench_best_way(peers, library)), "ms");
}
