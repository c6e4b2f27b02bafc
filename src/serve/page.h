/* The files of camber serve's page: those in src/serve/page/, and Leaflet's, which the build copies from this machine
 * (src/serve/page.cmake). */
#ifndef CAMBER_SERVE_PAGE_H
#define CAMBER_SERVE_PAGE_H

#include <stddef.h>

typedef struct camber_page_file {
    const char *path; /* the path after /page/; "" is the page itself, which is at / */
    const char *content_type;
    const unsigned char *bytes;
    size_t size;
} camber_page_file;

extern const camber_page_file camber_page_files[];
extern const size_t camber_page_file_count;

#endif
