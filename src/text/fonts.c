/* Sets of fonts. A stack of fonts keeps, for each code point that a text has asked for, the source that draws it, so
 * that all fonts are searched only once for each character. The answer depends only on the stack and the character,
 * never on earlier texts: a map looks the same whatever was drawn before it. */
#include "text/fonts.h"

#include "text/scripts.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>

static void free_strings(camber_context *context, char **strings, size_t count) {
    for (size_t i = 0; strings && i < count; i++)
        camber_free(context, strings[i]);
    camber_free(context, strings);
}

static bool copy_strings(camber_context *context, const char *const *strings, size_t count, char ***copies) {
    *copies = camber_alloc_zero(context, count, sizeof **copies);
    for (size_t i = 0; *copies && i < count; i++) {
        (*copies)[i] = camber_copy_string(context, strings[i]);
        if (!(*copies)[i])
            return false;
    }
    return *copies != NULL;
}

static camber_status check_folder(camber_context *context, const char *folder) {
    struct stat about;
    if (stat(folder, &about))
        return camber_file_fail(context, folder, errno);
    if (!S_ISDIR(about.st_mode))
        return camber_fail(context, CAMBER_ERROR_NOT_FOUND, "%s: this is no folder of fonts", folder);
    return CAMBER_OK;
}

camber_status camber_fonts_create(camber_context *context, const camber_fonts_desc *desc, camber_fonts **fonts) {
    const camber_fonts_desc zero = {0}, *given = desc ? desc : &zero;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < given->folder_count && !status; i++)
        status = check_folder(context, given->folders[i]);
    if (status)
        return status;
    camber_fonts *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    *made = (camber_fonts){.context = context,
                           .folder_count = given->folder_count,
                           .has_system = !given->no_system,
                           .read = given->glyphs,
                           .read_user = given->glyphs_user,
                           .index = {.context = context}};
    if (!copy_strings(context, given->folders, given->folder_count, &made->folders)) {
        camber_fonts_destroy(made);
        return CAMBER_ERROR_MEMORY;
    }
    *fonts = made;
    return CAMBER_OK;
}

static void free_stack(camber_context *context, camber_font_stack *stack) {
    free_strings(context, stack->names, stack->name_count);
    camber_free(context, stack->language);
    camber_free(context, stack->named);
    if (stack->sorted)
        FcFontSetDestroy(stack->sorted);
    camber_number_map_free(context, &stack->sources_of);
}

void camber_fonts_destroy(camber_fonts *fonts) {
    if (!fonts)
        return;
    camber_context *context = fonts->context;
    for (size_t i = 0; i < fonts->glyph_count; i++)
        for (camber_made_outline *made = fonts->glyphs[i].outlines, *next; made; made = next) {
            next = made->next;
            camber_free(context, made->block);
            camber_free(context, made);
        }
    for (size_t i = 0; i < fonts->stack_count; i++)
        free_stack(context, &fonts->stacks[i]);
    for (size_t i = 0; i < fonts->source_count; i++) {
        camber_glyph_ranges_close(fonts->sources[i].ranges);
        camber_number_map_free(context, &fonts->sources[i].glyphs);
    }
    camber_font_index_free(&fonts->index);
    free_strings(context, fonts->folders, fonts->folder_count);
    camber_shaping_free(context, &fonts->shaping);
    camber_text_memo_free(context, fonts->memo);
    camber_free(context, fonts->entry_sources);
    camber_free(context, fonts->glyphs);
    camber_free(context, fonts->stacks);
    camber_free(context, fonts->sources);
    camber_free(context, fonts->told);
    camber_free(context, fonts);
}

/* Whether the warning with this key has not been given yet. If there is no memory to remember it, it is not given. */
static bool is_news(camber_fonts *fonts, uint64_t key) {
    for (size_t i = 0; i < fonts->told_count; i++)
        if (fonts->told[i] == key)
            return false;
    camber_saved_log kept;
    camber_log_demote_errors(fonts->context, &kept);
    const bool has_room =
        camber_grow(fonts->context, &fonts->told, &fonts->told_capacity, fonts->told_count + 1, sizeof *fonts->told);
    camber_log_restore(fonts->context, &kept);
    if (has_room)
        fonts->told[fonts->told_count++] = key;
    return has_room;
}

/* ---- Sources ---- */

static camber_status add_source(camber_fonts *fonts, const camber_glyph_source *source, uint32_t *number) {
    if (!camber_grow(fonts->context, &fonts->sources, &fonts->source_capacity, fonts->source_count + 1,
                     sizeof *fonts->sources))
        return CAMBER_ERROR_MEMORY;
    *number = (uint32_t)fonts->source_count;
    fonts->sources[fonts->source_count++] = *source;
    return CAMBER_OK;
}

/* Finds the source of an entry; CAMBER_NO_SOURCE if the font is broken. */
static camber_status open_entry(camber_fonts *fonts, size_t entry, uint32_t *source) {
    camber_face *face = NULL;
    *source = CAMBER_NO_SOURCE;
    if (fonts->entry_sources[entry]) {
        *source = fonts->entry_sources[entry] - 1;
        return CAMBER_OK;
    }
    camber_status status = camber_font_index_open(&fonts->index, entry, &face);
    if (status || !face)
        return status;
    const camber_glyph_source made = {.face = face, .name = fonts->index.entries[entry].path};
    status = add_source(fonts, &made, source);
    if (!status)
        fonts->entry_sources[entry] = *source + 1;
    return status;
}

static camber_status fill_index(camber_fonts *fonts) {
    if (fonts->is_filled)
        return CAMBER_OK;
    camber_font_index_free(&fonts->index); /* left over from an attempt that ran out of memory */
    camber_status status = camber_font_index_fill(&fonts->index, (const char *const *)fonts->folders,
                                                  fonts->folder_count, fonts->has_system);
    if (status)
        return status;
    fonts->entry_sources = camber_alloc_zero(fonts->context, fonts->index.count, sizeof *fonts->entry_sources);
    fonts->is_filled = fonts->entry_sources != NULL;
    return fonts->is_filled ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

camber_status camber_fonts_list(camber_fonts *fonts, size_t n, camber_font_info *info) {
    const camber_status status = fill_index(fonts);
    if (status)
        return status;
    *info = (camber_font_info){0};
    if (n >= fonts->index.count)
        return CAMBER_OK;
    const camber_font_entry *entry = &fonts->index.entries[n];
    const char *name = entry->name ? entry->name : camber_font_pattern_name(entry->pattern);
    *info = (camber_font_info){.name = name && *name ? name : entry->path,
                               .path = entry->origin == CAMBER_FONT_SHIPPED ? NULL : entry->path,
                               .weight = entry->style.weight,
                               .width = entry->style.width,
                               .italic = entry->style.is_italic};
    return CAMBER_OK;
}

bool camber_glyph_source_has(const camber_glyph_source *source, uint32_t code) {
    return source->face ? camber_face_has(source->face, code) : camber_glyph_ranges_has(source->ranges, code);
}

camber_status camber_fonts_find_glyph(camber_fonts *fonts, uint32_t source, uint32_t number, uint32_t *glyph) {
    camber_glyph_source *from = &fonts->sources[source];
    *glyph = camber_number_map_get(&from->glyphs, number);
    if (*glyph) {
        --*glyph;
        return CAMBER_OK;
    }
    if (!from->glyphs.page_count)
        camber_log(fonts->context, CAMBER_LOG_INFO, "text is drawn with %s", from->name);
    if (!camber_grow(fonts->context, &fonts->glyphs, &fonts->glyph_capacity, fonts->glyph_count + 1,
                     sizeof *fonts->glyphs) ||
        !camber_number_map_set(fonts->context, &from->glyphs, number, (uint32_t)fonts->glyph_count + 1))
        return CAMBER_ERROR_MEMORY;
    fonts->glyphs[fonts->glyph_count] = (camber_font_glyph){source, number, NULL};
    *glyph = (uint32_t)fonts->glyph_count++;
    return CAMBER_OK;
}

/* ---- Stacks ---- */

/* Whether it is one of the specification's fonts for styles that name none. Nobody chose these, so nobody misses them.
 */
static bool is_default(const char *name) {
    return strcmp(name, "Open Sans Regular") == 0 || strcmp(name, "Arial Unicode MS Regular") == 0;
}

/* Warns of a missing font. If the caller gives ranges of glyphs, these have everything that a style draws, and no font
 * is needed. */
static void tell_missing_font(camber_fonts *fonts, const camber_font_stack *stack, const char *name) {
    const char *package = camber_font_name_package(name);
    if (!is_news(fonts, camber_font_name_key(name, "?")))
        return;
    const bool matters = stack->ranges_source == CAMBER_NO_SOURCE && !is_default(name);
    camber_log(fonts->context, matters ? CAMBER_LOG_WARNING : CAMBER_LOG_INFO,
               package ? "there is no font \"%s\": another one draws its text (Debian has it in %s)"
                       : "there is no font \"%s\": another one draws its text",
               name, package);
}

/* Finds the stack's fonts. */
static camber_status resolve(camber_fonts *fonts, camber_font_stack *stack) {
    if (stack->is_resolved)
        return CAMBER_OK;
    camber_status status = fill_index(fonts);
    if (!status && !stack->named) {
        stack->named = camber_alloc(fonts->context, stack->name_count, sizeof *stack->named);
        status = stack->named ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    }
    stack->named_count = 0;
    for (size_t i = 0; i < stack->name_count && !status; i++) {
        uint32_t source = CAMBER_NO_SOURCE;
        const size_t entry = camber_font_index_find(&fonts->index, stack->names[i]);
        if (entry != SIZE_MAX)
            status = open_entry(fonts, entry, &source);
        if (source != CAMBER_NO_SOURCE)
            stack->named[stack->named_count++] = source;
        else if (!status)
            tell_missing_font(fonts, stack, stack->names[i]);
    }
    stack->is_resolved = !status;
    return status;
}

/* Finds the shipped font with the stack's style. */
static camber_status find_shipped(camber_fonts *fonts, const camber_font_stack *stack, uint32_t *source) {
    size_t best = SIZE_MAX;
    float least = 0.0f;
    for (size_t i = 0; i < fonts->index.count; i++) {
        const camber_font_entry *entry = &fonts->index.entries[i];
        const float difference = camber_font_style_compare(&entry->style, &stack->style);
        if (entry->origin == CAMBER_FONT_SHIPPED && (best == SIZE_MAX || difference < least)) {
            best = i;
            least = difference;
        }
    }
    return open_entry(fonts, best, source);
}

static camber_status open_ranges(camber_fonts *fonts, camber_font_stack *stack) {
    size_t size_bytes = 1;
    for (size_t i = 0; i < stack->name_count; i++)
        size_bytes += strlen(stack->names[i]) + 1;
    char *joined = camber_alloc_zero(fonts->context, size_bytes, 1);
    camber_glyph_source source = {0};
    if (!joined)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0, length = 0; i < stack->name_count; i++) {
        if (i)
            joined[length++] = ',';
        memcpy(joined + length, stack->names[i], strlen(stack->names[i]));
        length += strlen(stack->names[i]);
    }
    camber_status status =
        camber_glyph_ranges_open(fonts->context, fonts->read, fonts->read_user, joined, &source.ranges);
    camber_free(fonts->context, joined);
    if (status)
        return status;
    source.name = source.ranges->stack;
    status = add_source(fonts, &source, &stack->ranges_source);
    if (status)
        camber_glyph_ranges_close(source.ranges);
    return status;
}

static camber_status fill_stack(camber_fonts *fonts, camber_font_stack *stack) {
    camber_status status = fonts->read && stack->name_count ? open_ranges(fonts, stack) : CAMBER_OK;
    if (!status && stack->ranges_source != CAMBER_NO_SOURCE &&
        fonts->sources[stack->ranges_source].ranges->glyph_count) {
        stack->ascender_em = fonts->sources[stack->ranges_source].ranges->ascender_em;
        return CAMBER_OK;
    }
    uint32_t source = CAMBER_NO_SOURCE;
    status = status ? status : resolve(fonts, stack);
    if (!status && stack->named_count)
        source = stack->named[0];
    else if (!status)
        status = find_shipped(fonts, stack, &source);
    stack->ascender_em = source == CAMBER_NO_SOURCE ? 1.0f : fonts->sources[source].face->ascender_em;
    return status;
}

static uint64_t hash_stack(const char *const *names, size_t name_count, const char *language) {
    uint64_t key = CAMBER_HASH_START;
    for (size_t i = 0; i < name_count; i++)
        key = camber_hash(key, names[i], strlen(names[i]) + 1);
    return language ? camber_hash(key, language, strlen(language)) : key;
}

camber_status camber_fonts_find_stack(camber_fonts *fonts, const char *const *names, size_t name_count,
                                      const char *language, uint32_t *stack) {
    camber_context *context = fonts->context;
    const uint64_t key = hash_stack(names, name_count, language);
    for (size_t i = 0; i < fonts->stack_count; i++)
        if (fonts->stacks[i].key == key) {
            *stack = (uint32_t)i;
            return CAMBER_OK;
        }
    if (!camber_grow(context, &fonts->stacks, &fonts->stack_capacity, fonts->stack_count + 1, sizeof *fonts->stacks))
        return CAMBER_ERROR_MEMORY;
    camber_font_stack made = {.key = key, .name_count = name_count, .ranges_source = CAMBER_NO_SOURCE};
    made.style = name_count ? camber_font_name_split(names[0]).style : CAMBER_FONT_STYLE_REGULAR;
    camber_status status = copy_strings(context, names, name_count, &made.names) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (!status && language) {
        made.language = camber_copy_string(context, language);
        status = made.language ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    }
    if (!status)
        status = fill_stack(fonts, &made);
    if (status) {
        free_stack(context, &made);
        return status;
    }
    *stack = (uint32_t)fonts->stack_count;
    fonts->stacks[fonts->stack_count++] = made;
    return CAMBER_OK;
}

/* ---- The source of a character ---- */

/* Finds the font in the folders that has the character and the nearest style. */
static camber_status find_in_folders(camber_fonts *fonts, const camber_font_stack *stack, uint32_t code,
                                     uint32_t *source) {
    float least = INFINITY;
    for (size_t i = 0; i < fonts->index.count; i++) {
        const camber_font_entry *entry = &fonts->index.entries[i];
        const float difference = camber_font_style_compare(&entry->style, &stack->style);
        uint32_t opened;
        if (entry->origin != CAMBER_FONT_FROM_FOLDER || entry->is_broken || difference >= least)
            continue;
        const camber_status status = open_entry(fonts, i, &opened);
        if (status)
            return status;
        if (opened != CAMBER_NO_SOURCE && camber_glyph_source_has(&fonts->sources[opened], code)) {
            *source = opened;
            least = difference;
        }
    }
    return CAMBER_OK;
}

/* Finds Noto Sans for the character's script, which goes well with the shipped font. */
static camber_status find_by_script(camber_fonts *fonts, const camber_font_stack *stack, uint32_t code,
                                    uint32_t *source) {
    const hb_script_t script = hb_unicode_script(hb_unicode_funcs_get_default(), code);
    const char *name = camber_get_script_name(script, stack->language);
    const uint64_t key = camber_font_name_key("Noto Sans", name);
    const size_t entry = name ? camber_font_index_find_family(&fonts->index, key, &stack->style) : SIZE_MAX;
    uint32_t opened = CAMBER_NO_SOURCE;
    const camber_status status = entry == SIZE_MAX ? CAMBER_OK : open_entry(fonts, entry, &opened);
    if (!status && opened != CAMBER_NO_SOURCE && camber_glyph_source_has(&fonts->sources[opened], code))
        *source = opened;
    return status;
}

static camber_status find_in_system(camber_fonts *fonts, camber_font_stack *stack, uint32_t code, uint32_t *source) {
    if (!stack->is_sorted)
        stack->sorted = camber_font_index_sort_system(&fonts->index, &stack->style, stack->language);
    stack->is_sorted = true;
    for (int i = 0; stack->sorted && i < stack->sorted->nfont; i++) {
        FcCharSet *has = NULL;
        if (FcPatternGetCharSet(stack->sorted->fonts[i], FC_CHARSET, 0, &has) != FcResultMatch ||
            !FcCharSetHasChar(has, code))
            continue;
        const size_t entry = camber_font_index_find_pattern(&fonts->index, stack->sorted->fonts[i]);
        uint32_t opened = CAMBER_NO_SOURCE;
        const camber_status status = entry == SIZE_MAX ? CAMBER_OK : open_entry(fonts, entry, &opened);
        if (status)
            return status;
        if (opened != CAMBER_NO_SOURCE && camber_glyph_source_has(&fonts->sources[opened], code)) {
            *source = opened;
            return CAMBER_OK;
        }
    }
    return CAMBER_OK;
}

/* Whether it is an emoji or another pictograph. If one is missing, no box is drawn for it. */
static bool is_pictograph(uint32_t code) {
    return (code >= 0x1f000 && code <= 0x1faff) || (code >= 0x2600 && code <= 0x27bf);
}

/* Says once for each script which character of it has no font, and which package has one. */
static void tell_missing_character(camber_fonts *fonts, uint32_t code) {
    const hb_script_t script = hb_unicode_script(hb_unicode_funcs_get_default(), code);
    const bool is_cjk = camber_is_ideographic(code) || script == HB_SCRIPT_HANGUL;
    char tag[5] = {0};
    hb_tag_to_string(hb_script_to_iso15924_tag(script), tag);
    if (is_pictograph(code)) {
        if (is_news(fonts, 1))
            camber_log(fonts->context, CAMBER_LOG_WARNING,
                       "no font has an outline of the pictograph U+%04X: such characters are left out (Debian has "
                       "outlines in fonts-noto-core and fonts-symbola)",
                       (unsigned)code);
    } else if (is_news(fonts, is_cjk ? 3 : camber_mix(2, (uint64_t)script))) {
        const char *name = is_cjk ? "Chinese, Japanese and Korean" : camber_get_script_name(script, NULL);
        camber_log(fonts->context, CAMBER_LOG_WARNING,
                   "no font has U+%04X (script: %s): such characters are drawn as boxes (Debian has them in %s)",
                   (unsigned)code, name ? name : tag, is_cjk ? "fonts-noto-cjk" : "fonts-noto-core");
    }
}

/* Finds the source for a character that no font has: it is drawn as the box of the stack's first font. */
static camber_status find_box(camber_fonts *fonts, const camber_font_stack *stack, uint32_t code, uint32_t *source) {
    tell_missing_character(fonts, code);
    if (is_pictograph(code))
        return CAMBER_OK;
    if (!stack->named_count)
        return find_shipped(fonts, stack, source);
    *source = stack->named[0];
    return CAMBER_OK;
}

/* Searches all fonts. */
static camber_status find_source_of(camber_fonts *fonts, camber_font_stack *stack, uint32_t code, uint32_t *source) {
    *source = CAMBER_NO_SOURCE;
    if (stack->ranges_source != CAMBER_NO_SOURCE) {
        camber_glyph_ranges *ranges = fonts->sources[stack->ranges_source].ranges;
        const bool has = camber_glyph_ranges_has(ranges, code);
        if (has || ranges->status) {
            *source = stack->ranges_source;
            return ranges->status;
        }
    }
    camber_status status = resolve(fonts, stack);
    for (size_t i = 0; i < stack->named_count && !status && *source == CAMBER_NO_SOURCE; i++)
        if (camber_glyph_source_has(&fonts->sources[stack->named[i]], code))
            *source = stack->named[i];
    if (!status && *source == CAMBER_NO_SOURCE) {
        uint32_t shipped = CAMBER_NO_SOURCE;
        status = find_shipped(fonts, stack, &shipped);
        if (!status && camber_glyph_source_has(&fonts->sources[shipped], code))
            *source = shipped;
    }
    if (!status && *source == CAMBER_NO_SOURCE)
        status = find_by_script(fonts, stack, code, source);
    if (!status && *source == CAMBER_NO_SOURCE)
        status = find_in_folders(fonts, stack, code, source);
    if (!status && *source == CAMBER_NO_SOURCE)
        status = find_in_system(fonts, stack, code, source);
    if (!status && *source == CAMBER_NO_SOURCE)
        status = find_box(fonts, stack, code, source);
    return status;
}

/* Whether a source has all characters of a cluster, on their own or combined with the first one. */
static bool has_all(const camber_glyph_source *source, const uint32_t *codes, size_t count) {
    hb_unicode_funcs_t *unicode = hb_unicode_funcs_get_default();
    uint32_t composed = codes[0];
    for (size_t i = 0; i < count; i++) {
        hb_codepoint_t both;
        if (i && hb_unicode_compose(unicode, composed, codes[i], &both) && camber_glyph_source_has(source, both))
            composed = both;
        else if (!camber_glyph_source_has(source, codes[i]))
            return false;
    }
    return true;
}

camber_status camber_fonts_find_source(camber_fonts *fonts, uint32_t stack, const uint32_t *codes, size_t count,
                                       uint32_t *source) {
    camber_font_stack *of = &fonts->stacks[stack];
    const uint32_t known = camber_number_map_get(&of->sources_of, codes[0]);
    camber_status status = CAMBER_OK;
    if (known)
        *source = known - 2; /* 1 means that no source draws it */
    if (!known) {
        status = find_source_of(fonts, of, codes[0], source);
        if (!status && !camber_number_map_set(fonts->context, &of->sources_of, codes[0], *source + 2))
            status = CAMBER_ERROR_MEMORY;
    }
    if (status || *source == CAMBER_NO_SOURCE || count < 2 || has_all(&fonts->sources[*source], codes, count))
        return status;
    status = resolve(fonts, of);
    for (size_t i = 0; i < of->named_count && !status; i++)
        if (has_all(&fonts->sources[of->named[i]], codes, count)) {
            *source = of->named[i];
            return CAMBER_OK;
        }
    return status;
}

/* ---- Outlines ---- */

/* How far an outline's segments may be from its curves in a text of a given size, px. */
static const float TOLERANCE_PX = 1.0f / 32.0f;
/* Stem darkening. In a text of fewer px per em than this, strokes are widened: the smaller it is, the more. */
static const float DARKENED_BELOW_PX = 20.0f;
static const float DARKENING_PX = 0.2f; /* for a text of 0 px */
/* Outlines are made in steps of weight, because texts in perspective have very many sizes. */
static const float WEIGHT_STEP_EM = 1.0f / 1024.0f;
static const float LARGEST_WEIGHT = 32.0f;

static camber_status make_outline(camber_fonts *fonts, uint32_t glyph, int exponent, unsigned weight,
                                  camber_made_outline **made) {
    const camber_font_glyph *of = &fonts->glyphs[glyph];
    const camber_glyph_source *source = &fonts->sources[of->source];
    camber_made_outline *node = camber_alloc_zero(fonts->context, 1, sizeof *node);
    if (!node)
        return CAMBER_ERROR_MEMORY;
    node->exponent = exponent;
    node->weight = weight;
    camber_outline_maker maker = {
        .context = fonts->context, .tolerance_em = ldexpf(1.0f, exponent), .wider_em = (float)weight * WEIGHT_STEP_EM};
    if (source->face)
        camber_outline_draw_glyph(&maker, source->face, of->number);
    else
        camber_glyph_ranges_draw(source->ranges, of->number, &maker);
    const camber_status status = camber_outline_finish(&maker, &node->outline, &node->block);
    if (status) {
        camber_free(fonts->context, node);
        return status;
    }
    *made = node;
    return CAMBER_OK;
}

static camber_status find_outline(camber_fonts *fonts, uint32_t glyph, float tolerance_em, unsigned weight,
                                  camber_outline *outline) {
    int exponent;
    assert(glyph < fonts->glyph_count);
    /* One outline serves all tolerances between two powers of 2. Outlines from ranges have no curves, so one serves
     * all. */
    frexpf(tolerance_em > 0.0f ? fminf(fmaxf(tolerance_em, 0x1p-20f), 1.0f) : 1.0f / 256.0f, &exponent);
    exponent--;
    if (fonts->sources[fonts->glyphs[glyph].source].ranges) {
        exponent = 0;
        weight = 0;
    }
    for (const camber_made_outline *made = fonts->glyphs[glyph].outlines; made; made = made->next)
        if (made->exponent == exponent && made->weight == weight) {
            *outline = made->outline;
            return CAMBER_OK;
        }
    camber_made_outline *made = NULL;
    const camber_status status = make_outline(fonts, glyph, exponent, weight, &made);
    if (status)
        return status;
    made->next = fonts->glyphs[glyph].outlines;
    fonts->glyphs[glyph].outlines = made;
    *outline = made->outline;
    return CAMBER_OK;
}

camber_status camber_fonts_get_outline(camber_fonts *fonts, uint32_t glyph, float tolerance_em,
                                       camber_outline *outline) {
    return find_outline(fonts, glyph, tolerance_em, 0, outline);
}

camber_status camber_fonts_get_sized_outline(camber_fonts *fonts, uint32_t glyph, float size_px,
                                             camber_outline *outline) {
    assert(size_px > 0.0f);
    const float wider_px = DARKENING_PX * fmaxf(1.0f - size_px / DARKENED_BELOW_PX, 0.0f);
    const float weight = fminf(wider_px / size_px / WEIGHT_STEP_EM + 0.5f, LARGEST_WEIGHT);
    return find_outline(fonts, glyph, TOLERANCE_PX / size_px, (unsigned)weight, outline);
}
