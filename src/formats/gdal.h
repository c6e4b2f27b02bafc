/* The last reader. It passes to GDAL all files that no other reader takes. */
#ifndef CAMBER_FORMATS_GDAL_H
#define CAMBER_FORMATS_GDAL_H

#include "features/reader.h"

extern const camber_reader camber_gdal_reader;

#endif
