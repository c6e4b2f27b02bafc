/* The names and the size of a sprite, and how many overlays may decode it at once. */
#include "serve/icons.h"

#include <errno.h>
#include <jansson.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_HELD_BYTES = 64 << 20 };

struct camber_overlay_icons {
    char *sprite;
    json_t *names;            /* an object whose keys are the icons' names */
    size_t sheet_bytes;       /* of the larger picture, decoded */
    atomic_size_t held_bytes; /* of all overlays that have icons */
};

/* The bytes of a PNG's pixels by its header. 0: it is none. */
static size_t measure_sheet(const char *sprite, const char *ending) {
    char path[4096];
    uint8_t head[24];
    snprintf(path, sizeof path, "%.*s%s", (int)(sizeof path - strlen(ending) - 1), sprite, ending);
    FILE *file = fopen(path, "rb");
    const bool is_read = file && fread(head, sizeof head, 1, file) == 1;
    if (file)
        fclose(file);
    size_t sides[2] = {0};
    for (int i = 0; is_read && i < 8; i++)
        sides[i / 4] = sides[i / 4] << 8 | head[16 + i];
    return 4 * sides[0] * sides[1];
}

int camber_overlay_icons_create(const char *sprite, camber_overlay_icons **icons) {
    char list[4096], picture[4096];
    if ((size_t)snprintf(list, sizeof list, "%s.json", sprite) >= sizeof list)
        return ENAMETOOLONG;
    snprintf(picture, sizeof picture, "%.*s.png", (int)(sizeof picture - 5), sprite);
    if (access(list, R_OK) != 0 || access(picture, R_OK) != 0)
        return errno;
    camber_overlay_icons *made = calloc(1, sizeof *made);
    if (made && (made->sprite = strdup(sprite)))
        made->names = json_load_file(list, JSON_REJECT_DUPLICATES, NULL);
    if (made && json_object_size(made->names)) {
        const size_t plain = measure_sheet(sprite, ".png"), dense = measure_sheet(sprite, "@2x.png");
        made->sheet_bytes = plain > dense ? plain : dense;
        *icons = made;
        return 0;
    }
    const int cause = made && made->sprite ? EINVAL : ENOMEM;
    camber_overlay_icons_destroy(made);
    return cause;
}

void camber_overlay_icons_destroy(camber_overlay_icons *icons) {
    if (icons) {
        json_decref(icons->names);
        free(icons->sprite);
    }
    free(icons);
}

const char *camber_overlay_icons_get_sprite(const camber_overlay_icons *icons) {
    return icons->sprite;
}

bool camber_overlay_icons_has(const camber_overlay_icons *icons, const char *name) {
    return json_object_get(icons->names, name) != NULL;
}

camber_overlay_icons *camber_overlay_icons_hold(camber_overlay_icons *icons) {
    const size_t held = atomic_fetch_add(&icons->held_bytes, icons->sheet_bytes);
    if (held && held + icons->sheet_bytes > MOST_HELD_BYTES) {
        atomic_fetch_sub(&icons->held_bytes, icons->sheet_bytes);
        return NULL;
    }
    return icons;
}

void camber_overlay_icons_release(camber_overlay_icons *icons) {
    atomic_fetch_sub(&icons->held_bytes, icons->sheet_bytes);
}
