/* The functions of the gdal layer that the rest calls: a table, since the shared library loads that layer late. */
#ifndef CAMBER_FEATURES_GDAL_CALLS_H
#define CAMBER_FEATURES_GDAL_CALLS_H

#include "camber_map.h"

typedef struct camber_gdal_calls {
    camber_status (*read)(camber_features *features, const camber_source_desc *desc);
    const char *(*format_name)(size_t n);
    const char *(*version)(void);
} camber_gdal_calls;

#ifdef __GNUC__
__attribute__((visibility("default"))) /* the module exports it */
#endif
extern const camber_gdal_calls camber_gdal;

/* Finds the table: in the module, which it loads (src/load/), or where it is linked. NULL: the module is not there, and
 * *why says why, or is NULL. */
const camber_gdal_calls *camber_gdal_find(const char **why);

#endif
