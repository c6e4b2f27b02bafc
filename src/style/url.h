/* Resolves a style's URLs to files on this machine. */
#ifndef CAMBER_STYLE_URL_H
#define CAMBER_STYLE_URL_H

#include "base/base.h"

typedef enum camber_url_kind {
    CAMBER_URL_FILE = 0,
    CAMBER_URL_MBTILES, /* after mbtiles:// */
    CAMBER_URL_PMTILES, /* after pmtiles:// */
} camber_url_kind;

typedef struct camber_url {
    camber_url_kind kind;
    char *path; /* freed with camber_free */
} camber_url;

/* Whether the URL is on the network, from which nothing is read. */
bool camber_url_is_remote(const char *text);

/* Resolves file://, mbtiles://, pmtiles:// and plain paths. Relative ones start from the folder of base_path, which is
 * a file (NULL: the working folder). what names the source in messages. Returns CAMBER_ERROR_INPUT (another scheme, or
 * the network), CAMBER_ERROR_MEMORY. */
camber_status camber_url_resolve(camber_context *context, const char *what, const char *text, const char *base_path,
                                 camber_url *url);

#endif
