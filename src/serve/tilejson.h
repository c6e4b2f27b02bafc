/* TileJSON 3 of what is shown. */
#ifndef CAMBER_SERVE_TILEJSON_H
#define CAMBER_SERVE_TILEJSON_H

#include "serve/server.h"

typedef struct camber_tilejson_desc {
    const camber_shown *shown;
    const char *url;   /* of the server, without a slash at its end */
    const char *theme; /* "light", "dark"; NULL: it is not known */
    bool below_dark;   /* the tiles are below /dark */
    uint32_t most_ratio;
    bool edits;
} camber_tilejson_desc;

/* NULL: no memory, or a text is not UTF-8. */
camber_body *camber_tilejson_create(const camber_tilejson_desc *desc);

#endif
