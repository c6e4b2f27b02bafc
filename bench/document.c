/* The document: what was measured, on what, and by which versions. */
#include "bench.h"

#include "base/base.h"

#include <string.h>
#include <time.h>

#ifdef CAMBER_MAP
#include "camber_map.h"
#endif

const bench_section *const bench_sections[] = {&bench_section_stages,  &bench_section_network,  &bench_section_frames,
                                               &bench_section_areas,   &bench_section_devices,  &bench_section_city,
                                               &bench_section_labels,  &bench_section_zooms,    &bench_section_mosaic,
                                               &bench_section_fly,     &bench_section_textures, &bench_section_growth,
                                               &bench_section_start,   &bench_section_encode,   &bench_section_read,
                                               &bench_section_tiles,   &bench_section_serve,    &bench_section_many,
                                               &bench_section_outside, &bench_section_glyphs,   NULL};

static json_t *describe_peers(void) {
    json_t *peers = json_object();
    for (size_t i = 0; i < bench_peer_count; i++)
        json_object_set_new(peers, bench_peers[i]->key,
                            json_pack("{s:s, s:s, s:s, s:s}", "name", bench_peers[i]->name, "way", bench_peers[i]->way,
                                      "version", bench_peers[i]->version(), "build", bench_peers[i]->build()));
    return peers;
}

static json_t *date_now(void) {
    char date[32];
    const time_t now = time(NULL);
    struct tm parts;
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &parts));
    return json_string(date);
}

static json_t *describe(const bench *b) {
    static const char *const sizes[] = {"full", "quick", "tiny"};
    const camber_device_info device = camber_device_get_info(b->device);
    const camber_surface_info surface = camber_surface_get_info(b->surface);
    json_t *document =
        json_pack("{s:o, s:s, s:s, s:I, s:{s:s, s:s, s:s, s:s, s:I}, s:{s:s, s:s, s:s, s:b}, s:s, s:o}", "date",
                  date_now(), "camber", camber_version(), "size", sizes[b->size], "runs", (json_int_t)b->runs, "device",
                  "name", device.name, "platform", device.platform, "version", device.version, "driver", device.driver,
                  "units", (json_int_t)device.compute_units, "gl", "backend", surface.backend, "renderer",
                  surface.renderer, "version", surface.version, "software", surface.software, "sharing",
                  camber_sharing_get_name(camber_renderer_get_sharing(b->renderer)), "peers", describe_peers());
    json_object_set_new(document, "machine", bench_machine_describe(b));
#ifdef CAMBER_MAP
    json_object_set_new(document, "gdal", json_string(camber_gdal_get_version()));
#endif
    return document;
}

static void print_head(const json_t *document, FILE *to) {
    const json_t *device = json_object_get(document, "device"), *gl = json_object_get(document, "gl");
    const json_t *machine = json_object_get(document, "machine");
    fprintf(to, "camber %s, %s: %s (%s %s), %.0f units; %s, %s; sharing: %s\n", bench_text(document, "camber"),
            bench_text(document, "date"), bench_text(device, "name"), bench_text(device, "platform"),
            bench_text(device, "driver"), bench_number(device, "units"), bench_text(gl, "renderer"),
            bench_text(gl, "version"), bench_text(document, "sharing"));
    fprintf(to, "%s, %.0f cores, %s; code made as it runs is for %s; camber by %s\n", bench_text(machine, "processor"),
            bench_number(machine, "cores"), bench_text(machine, "vectors"), bench_text(machine, "code"),
            bench_text(machine, "compiler"));
    fprintf(to, "Peers:");
    const char *key;
    json_t *peer;
    json_object_foreach(json_object_get(document, "peers"), key, peer) if (!strchr(key, '_'))
        fprintf(to, " %s %s (%s);", bench_text(peer, "name"), bench_text(peer, "version"), bench_text(peer, "build"));
    fprintf(to, " each by one thread and by as many as there are cores. Medians of %.0f runs, in turn.\n",
            bench_number(document, "runs"));
}

static void print_section(const json_t *document, const bench_section *section, FILE *to) {
    const json_t *result = json_object_get(json_object_get(document, "sections"), section->name);
    if (json_array_size(bench_result_rows(result)) == 0)
        return;
    fprintf(to, "\n");
    section->print(result, to);
    fprintf(to, "(%s: %.0f s)\n", section->name, bench_number(result, "seconds"));
    fflush(to);
}

void bench_document_print(const json_t *document, FILE *to) {
    print_head(document, to);
    for (size_t i = 0; bench_sections[i]; i++)
        print_section(document, bench_sections[i], to);
}

/* Whether a section is among "frames,areas:houses", or nothing is named. Gives its item; "": all. */
static bool is_wanted(const char *list, const char *name, char *item, size_t size) {
    const size_t length = strlen(name);
    *item = 0;
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        const size_t whole = strcspn(at, ",");
        if (strncmp(at, name, length) != 0 || !strchr(":,", at[length]))
            continue;
        if (at[length] == ':')
            snprintf(item, size, "%.*s", (int)(whole - length - 1), at + length + 1);
        return true;
    }
    return !list;
}

json_t *bench_document_make(bench *b, const char *list) {
    json_t *document = describe(b), *sections = json_object();
    char item[64];
    const double begin = camber_now_ms();
    json_object_set_new(document, "sections", sections);
    print_head(document, stdout);
    if (*bench_peers_missing)
        printf("Not built in: %s\n", bench_peers_missing);
    for (size_t i = 0; bench_sections[i]; i++) {
        if (!is_wanted(list, bench_sections[i]->name, item, sizeof item))
            continue;
        const double start = camber_now_ms();
        json_t *result =
            bench_sections[i]->measure ? bench_sections[i]->measure(b, *item ? item : NULL) : bench_result_new();
        if (!result) {
            fprintf(stderr, "camber_bench: %s could not be measured\n", bench_sections[i]->name);
            json_decref(document);
            return NULL;
        }
        json_object_set_new(sections, bench_sections[i]->name, result);
        json_object_set_new(result, "date", date_now());
        json_object_set_new(result, "seconds", json_integer((json_int_t)((camber_now_ms() - start) / 1e3)));
        print_section(document, bench_sections[i], stdout);
    }
    json_object_set_new(document, "seconds", json_integer((json_int_t)((camber_now_ms() - begin) / 1e3)));
    printf("\n%.0f s\n", bench_number(document, "seconds"));
    return document;
}

json_t *bench_document_load(const char *path) {
    json_error_t error;
    json_t *document = json_load_file(path, 0, &error);
    if (!document)
        fprintf(stderr, "camber_bench: %s: %s\n", path, error.text);
    return document;
}
