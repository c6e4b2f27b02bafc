/* The functions of the gdal layer that other layers call. They are in a table because the shared library loads that
 * layer only when it is needed. */
#ifndef CAMBER_FEATURES_GDAL_CALLS_H
#define CAMBER_FEATURES_GDAL_CALLS_H

#include "camber_map.h"

typedef struct camber_gdal_calls {
    camber_status (*read)(camber_features *features, const camber_source_desc *desc);
    const char *(*format_name)(size_t n);
    const char *(*version)(void);
} camber_gdal_calls;

#ifdef __GNUC__
__attribute__((visibility("default"))) /* the module exports the symbol */
#endif
extern const camber_gdal_calls camber_gdal;

/* Returns the table: either the table in the module, which it loads (src/load/), or the one that is linked. Returns
 * NULL if the module cannot be loaded; then *why is the reason, or NULL. */
const camber_gdal_calls *camber_gdal_find(const char **why);

#endif
