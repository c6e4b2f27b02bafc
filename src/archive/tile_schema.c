/* The schemas that the style city supports (city.cmake), and how to recognise them. */
#include "archive/tile_schema.h"

#include <stdbool.h>
#include <string.h>

enum { LAYERS = 6 };

/* Any of these layers, or this field in any layer, identifies the schema. Names that anybody may use, such as "roads"
 * or "water", do not identify a schema. Protomaps 3 comes first, because it also has the layer of Protomaps 4. */
static const struct {
    const char *name, *layers[LAYERS], *field;
} schemas[] = {
    {"Protomaps 3", {"physical_line", "physical_point"}, "pmap:kind"},
    {"Protomaps 4", {"earth"}, "kind_detail"},
    {"Shortbread", {"water_polygons", "water_lines", "street_polygons", "street_labels", "pier_polygons"}, NULL},
    {"OpenMapTiles", {"transportation", "transportation_name", "water_name", "mountain_peak", "aerodrome_label"}, NULL},
};

static bool is_told_by(size_t schema, const json_t *layer) {
    const char *id = json_string_value(json_object_get(layer, "id")), *field = schemas[schema].field;
    for (size_t i = 0; id && i < LAYERS && schemas[schema].layers[i]; i++)
        if (strcmp(id, schemas[schema].layers[i]) == 0)
            return true;
    return field && json_object_get(json_object_get(layer, "fields"), field);
}

const char *camber_tile_schema_of_layers(const json_t *layers) {
    for (size_t s = 0; s < sizeof schemas / sizeof *schemas; s++)
        for (size_t i = 0; i < json_array_size(layers); i++)
            if (is_told_by(s, json_array_get(layers, i)))
                return schemas[s].name;
    return NULL;
}
