/* TileJSON 3 of the served content. */
#ifndef CAMBER_SERVE_TILEJSON_H
#define CAMBER_SERVE_TILEJSON_H

#include "serve/server.h"

typedef struct camber_tilejson_desc {
    const camber_server_content *content;
    const char *url;   /* base URL of the server, without a trailing slash */
    const char *theme; /* "light" or "dark"; NULL: unknown */
    bool below_dark;   /* the paths of the tiles begin with /dark */
    uint32_t most_ratio;
    bool edits;
} camber_tilejson_desc;

/* Returns NULL if there is no memory, or if a string is not UTF-8. */
camber_body *camber_tilejson_create(const camber_tilejson_desc *desc);

#endif
