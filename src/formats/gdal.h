/* The last reader, which passes all files that no other reader takes to GDAL. */
#ifndef CAMBER_FORMATS_GDAL_H
#define CAMBER_FORMATS_GDAL_H

#include "features/reader.h"

extern const camber_reader camber_gdal_reader;

#endif
