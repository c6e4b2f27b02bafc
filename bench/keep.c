/* Makes the files of bench/results: the rows that the tables of the documents show, and all figures, which later
 * measurements are compared with.
 *
 * Input: a document of all that was measured. Output: a smaller one, written with lines that are filled. Rows
 * keep the keys that readme.c reads. Figures become one object of a section, by item, what, and against ("": none). */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

enum { LINE_COLUMNS = 118 };

/* The keys that are kept of a section's rows, at any depth. Sections that are not here keep their figures only. */
static const struct {
    const char *section, *keys;
} kept[] = {
    {"stages", " key method width_px m_segments_s bytes_a_segment memcpy_gb_s all gb_s share "},
    {"network", " key simplify_px m_points_s "},
    {"frames", " key scene width_px frame_ms simple_frame_ms cl_frame_ms cl_simple_frame_ms peers ms alike "},
    {"areas", " key scene edges error cl_frame_ms peers ms alike "},
    {"glyphs", " key rings million_ms freetype_ms version "},
    {"city", " scene cl_frame_ms mapnik_ms "},
    {"fly", " by city frames width height frame scene tessellate draw read p50_ms p99_ms "},
    {"textures", " scene width_px rows_ms zero_copy_ms copy_ms gl_ms "},
    {"growth", " key points side_px frame_ms ns cores "},
    {"mosaic", " city points simple everything frame_ms peak_bytes everything_peak_bytes "},
    {"start", " name cold_ms warm_ms reading points read_ms ogr_ms "},
};

static bool has_word(const char *words, const char *word) {
    char framed[64];
    snprintf(framed, sizeof framed, " %s ", word);
    return strstr(words, framed) != NULL;
}

/* Members with keys among the words. all: all members, and of each those with such keys. */
static json_t *keep_members(const json_t *from, const char *words, bool all) {
    json_t *made = json_object(), *value;
    const char *key;
    json_object_foreach((json_t *)from, key, value) {
        if (!all && !has_word(words, key))
            continue;
        json_object_set_new(made, key,
                            json_is_object(value) ? keep_members(value, words, strcmp(key, "peers") == 0)
                                                  : json_incref(value));
    }
    return made;
}

/* The tables show strips, and networks of which all points are kept. */
static bool is_shown(const json_t *row) {
    const char *method = bench_text(row, "method");
    return (!*method || strcmp(method, "strip") == 0) && bench_number(row, "simplify_px") <= 0;
}

static json_t *keep_rows(const json_t *rows, const char *section) {
    json_t *made = json_array(), *row;
    size_t i;
    for (size_t k = 0; k < sizeof kept / sizeof *kept; k++) {
        if (strcmp(kept[k].section, section) != 0)
            continue;
        json_array_foreach(rows, i, row) if (is_shown(row))
            json_array_append_new(made, keep_members(row, kept[k].keys, false));
    }
    return made;
}

static json_t *member(json_t *object, const char *key) {
    if (!json_object_get(object, key))
        json_object_set_new(object, key, json_object());
    return json_object_get(object, key);
}

static json_t *keep_figures(json_t *figures) {
    json_t *made = json_object(), *figure;
    size_t i;
    if (json_is_object(figures)) /* the document is one that was kept */
        json_object_update(made, figures);
    json_array_foreach(figures, i, figure)
        json_object_set(member(member(made, bench_text(figure, "item")), bench_text(figure, "what")),
                        bench_text(figure, "against"), json_object_get(figure, "value"));
    return made;
}

json_t *bench_document_keep(const json_t *document) {
    json_t *made = json_copy((json_t *)document), *sections = json_object(), *section;
    const char *name;
    json_object_foreach(json_object_get(document, "sections"), name, section) {
        json_t *copy = json_copy(section);
        json_object_set_new(copy, "rows", keep_rows(bench_result_rows(section), name));
        json_object_set_new(copy, "figures", keep_figures(json_object_get(section, "figures")));
        json_object_set_new(sections, name, copy);
    }
    json_object_set_new(made, "sections", sections);
    return made;
}

/* ---- Writing ---- */

typedef struct writer {
    FILE *to;
    size_t column;
} writer;

static void put_text(writer *w, const char *text) {
    fputs(text, w->to);
    w->column += strlen(text);
}

/* Writes a member on this line if it fits there; else on lines of its own. key NULL: of an array. */
static void put_member(writer *w, const char *key, const json_t *value, size_t depth, bool first) {
    char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(6));
    const size_t needed = (text ? strlen(text) : 0) + (key ? strlen(key) + 4 : 0);
    const bool is_list = json_is_array(value), whole = needed + depth < LINE_COLUMNS;
    const char *name;
    json_t *item;
    size_t i, count = 0;
    if (!first)
        put_text(w, ",");
    if (depth > 0 && (!whole || w->column + needed >= LINE_COLUMNS)) {
        fprintf(w->to, "\n%*s", (int)depth, "");
        w->column = depth;
    } else if (!first) {
        put_text(w, " ");
    }
    if (key) {
        put_text(w, "\"");
        put_text(w, key);
        put_text(w, "\": ");
    }
    if (whole || !(is_list || json_is_object(value))) {
        put_text(w, text ? text : "null");
    } else {
        put_text(w, is_list ? "[" : "{");
        json_array_foreach(value, i, item) put_member(w, NULL, item, depth + 1, count++ == 0);
        json_object_foreach((json_t *)value, name, item) put_member(w, name, item, depth + 1, count++ == 0);
        put_text(w, is_list ? "]" : "}");
    }
    free(text);
}

bool bench_document_write(const json_t *document, const char *path) {
    writer w = {.to = fopen(path, "w"), .column = 0};
    if (!w.to)
        return false;
    put_member(&w, NULL, document, 0, true);
    put_text(&w, "\n");
    const bool done = !ferror(w.to);
    return fclose(w.to) == 0 && done;
}
