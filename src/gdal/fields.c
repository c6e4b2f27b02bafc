/* Finds the fields of a layer that the style reads, and reads the attributes of features from them. */
#include "gdal/vector_file.h"

#include <cpl_string.h>
#include <math.h>
#include <string.h>

/* Fields in which vector tiles store the id of a feature: OGR's name for the format's own id, OSM's name, a common
 * name, and TIGER's name. */
static const char *const id_names[] = {"mvt_id", "osm_id", "id", "TLID"};

/* OGR's own lookup ignores case, but names in styles do not: "Name" and "name" are different keys. */
static int find_field(OGRFeatureDefnH schema, const char *name) {
    const int count = OGR_FD_GetFieldCount(schema);
    for (int i = 0; i < count; i++)
        if (strcmp(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(schema, i)), name) == 0)
            return i;
    return -1;
}

static void find_properties(camber_columns *columns, OGRFeatureDefnH schema) {
    const camber_schema *wanted = columns->features->schema;
    for (size_t i = 0; i < wanted->property_count; i++) {
        camber_column *one = &columns->items[i];
        *one = (camber_column){.field = -1};
        if (camber_features_reads_property(columns->features, i))
            one->field = find_field(schema, wanted->properties[i]);
        if (one->field < 0)
            continue;
        OGRFieldDefnH definition = OGR_FD_GetFieldDefn(schema, one->field);
        one->type = OGR_Fld_GetType(definition);
        one->boolean = OGR_Fld_GetSubType(definition) == OFSTBoolean;
    }
}

camber_status camber_columns_find(camber_columns *columns, camber_features *features, OGRFeatureDefnH schema,
                                  bool tiles, bool osm) {
    camber_context *context = features->context;
    const size_t count = features->schema->property_count;
    size_t keys = 0;
    while (camber_osm_area_keys[keys])
        keys++;
    if ((!columns->items && !(columns->items = camber_alloc(context, count, sizeof *columns->items))) ||
        (!columns->values && !(columns->values = camber_alloc(context, count, sizeof *columns->values))) ||
        (!columns->areas && !(columns->areas = camber_alloc(context, keys, sizeof *columns->areas))))
        return CAMBER_ERROR_MEMORY;
    columns->features = features;
    columns->unsorted = !osm && !(tiles && camber_schema_names_layer(features->schema, OGR_FD_GetName(schema)));
    find_properties(columns, schema);
    columns->id_count = columns->area_count = 0;
    for (size_t i = 0; tiles && i < sizeof id_names / sizeof *id_names; i++) {
        const int field = find_field(schema, id_names[i]);
        if (field >= 0)
            columns->ids[columns->id_count++] = field;
    }
    columns->highway = find_field(schema, "highway");
    columns->area = find_field(schema, camber_osm_area_keys[0]);
    for (size_t i = 0; osm && i < keys; i++) {
        const int field = find_field(schema, camber_osm_area_keys[i]);
        if (field >= 0)
            columns->areas[columns->area_count++] = field;
    }
    return CAMBER_OK;
}

void camber_columns_free(camber_columns *columns, camber_context *context) {
    camber_free(context, columns->areas);
    camber_free(context, columns->values);
    camber_free(context, columns->items);
    *columns = (camber_columns){0};
}

static bool reads_field(const camber_columns *columns, int field) {
    for (size_t i = 0; i < columns->features->schema->property_count; i++)
        if (columns->items[i].field == field)
            return true;
    for (size_t i = 0; i < columns->id_count; i++)
        if (columns->ids[i] == field)
            return true;
    return false;
}

void camber_columns_ignore_others(const camber_columns *columns, OGRLayerH layer) {
    if (columns->area_count || !OGR_L_TestCapability(layer, OLCIgnoreFields))
        return;
    OGRFeatureDefnH schema = OGR_L_GetLayerDefn(layer);
    char **names = NULL;
    for (int i = 0; i < OGR_FD_GetFieldCount(schema); i++)
        if (!reads_field(columns, i))
            names = CSLAddString(names, OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(schema, i)));
    names = CSLAddString(names, "OGR_STYLE");
    OGR_L_SetIgnoredFields(layer, (const char **)names);
    CSLDestroy(names);
}

/* ---- One feature ---- */

static camber_status read_value(camber_columns *columns, OGRFeatureH feature, const camber_column *from,
                                camber_value *value) {
    *value = (camber_value){0};
    if (from->field < 0 || !OGR_F_IsFieldSetAndNotNull(feature, from->field))
        return CAMBER_OK;
    switch (from->type) {
    case OFTInteger:
        value->type = from->boolean ? CAMBER_VALUE_BOOL : CAMBER_VALUE_NUMBER;
        value->number = OGR_F_GetFieldAsInteger(feature, from->field);
        value->boolean = from->boolean && value->number != 0;
        return CAMBER_OK;
    case OFTInteger64:
        value->type = CAMBER_VALUE_NUMBER;
        value->number = (double)OGR_F_GetFieldAsInteger64(feature, from->field);
        return CAMBER_OK;
    case OFTReal:
        value->number = OGR_F_GetFieldAsDouble(feature, from->field);
        value->type = isnan(value->number) ? CAMBER_VALUE_NULL : CAMBER_VALUE_NUMBER;
        return CAMBER_OK;
    case OFTBinary: return CAMBER_OK;
    default:
        value->type = CAMBER_VALUE_STRING;
        return camber_features_intern(columns->features, OGR_F_GetFieldAsString(feature, from->field), &value->string);
    }
}

camber_status camber_columns_class(camber_columns *columns, OGRFeatureH feature, uint32_t layer,
                                   camber_geometry_kind kind, uint32_t *class_index) {
    const camber_schema *schema = columns->features->schema;
    for (size_t i = 0; i < schema->property_count; i++) {
        const camber_status status = read_value(columns, feature, &columns->items[i], &columns->values[i]);
        if (status != CAMBER_OK)
            return status;
    }
    const camber_feature_class wanted = {.layer = layer, .geometry = kind, .unsorted = columns->unsorted};
    return camber_features_find_class_of(columns->features, &wanted, columns->values, class_index);
}

bool camber_columns_id(const camber_columns *columns, OGRFeatureH feature, uint64_t *id) {
    for (size_t i = 0; i < columns->id_count; i++) {
        if (!OGR_F_IsFieldSetAndNotNull(feature, columns->ids[i]))
            continue;
        const char *text = OGR_F_GetFieldAsString(feature, columns->ids[i]);
        *id = camber_hash(CAMBER_HASH_START + i, text, strlen(text));
        return true;
    }
    return false;
}

bool camber_columns_is_area(const camber_columns *columns, OGRFeatureH feature, OGRGeometryH geometry) {
    if (columns->area_count == 0 || wkbFlatten(OGR_G_GetGeometryType(geometry)) != wkbLineString)
        return false;
    const int last = OGR_G_GetPointCount(geometry) - 1;
    if (last < 3 || OGR_G_GetX(geometry, 0) != OGR_G_GetX(geometry, last) ||
        OGR_G_GetY(geometry, 0) != OGR_G_GetY(geometry, last))
        return false;
    const bool is_highway = columns->highway >= 0 && OGR_F_IsFieldSetAndNotNull(feature, columns->highway);
    for (size_t i = 0; i < columns->area_count; i++) {
        if ((!is_highway || columns->areas[i] == columns->area) &&
            OGR_F_IsFieldSetAndNotNull(feature, columns->areas[i]) &&
            !camber_osm_is_no(OGR_F_GetFieldAsString(feature, columns->areas[i])))
            return true;
    }
    return false;
}
