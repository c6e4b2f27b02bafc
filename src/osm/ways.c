/* Reads the ways of a file.
 *
 * Input: blobs, and the keys that a style names. Output: for each way with a tag and at least two nodes its set of tags
 * and the ids of its nodes, and the set of all ids. Threads decode blocks: tags become indices of strings, and ways
 * that agree in them share a set. The caller's thread then gives a block's sets to those of the file. */
#include "osm/ways.h"

#include "source/osm_keys.h"

#include <strings.h>

/* A run is what one thread makes lines of at a time. */
enum { RUN_NODES = 16384, FIRST_SLOTS = 1024 };
enum { WAY_KEYS = 2, WAY_VALUES = 3, WAY_NODES = 8, STRING = 1 };
static const uint32_t NO_STRING = UINT32_MAX, NO_PROPERTY = UINT32_MAX;

/* ---- Keys ---- */

static camber_osm_key *find_key_of(camber_osm_ways *ways, camber_osm_text name) {
    for (size_t i = 0; i < ways->key_count; i++)
        if (ways->keys[i].length == name.length && memcmp(ways->keys[i].name, name.at, name.length) == 0)
            return &ways->keys[i];
    ways->keys[ways->key_count] =
        (camber_osm_key){.name = name.at, .length = name.length, .property = NO_PROPERTY, .filter = NO_PROPERTY};
    return &ways->keys[ways->key_count++];
}

static camber_osm_key *find_key(camber_osm_ways *ways, const char *name) {
    return find_key_of(ways, (camber_osm_text){name, strlen(name)});
}

/* Adds the filter's keys. false: one differs from another key in its case alone, which SQL does not tell apart. */
static bool find_filter_keys(camber_osm_ways *ways) {
    const camber_osm_where *where = ways->where;
    for (uint32_t i = 0; where && i < where->key_count; i++) {
        camber_osm_key *key = find_key_of(ways, where->keys[i]);
        key->filter = i;
        for (size_t k = 0; k < ways->key_count; k++)
            if (&ways->keys[k] != key && ways->keys[k].length == key->length &&
                strncasecmp(ways->keys[k].name, key->name, key->length) == 0)
                return false;
    }
    return true;
}

/* OGR's own columns, which are no tags. */
static bool is_column(const char *name) {
    return strncmp(name, "osm_", 4) == 0 || strcmp(name, "other_tags") == 0 || strcmp(name, "all_tags") == 0;
}

camber_status camber_osm_ways_init(camber_osm_ways *ways, camber_features *features, const camber_osm_where *where,
                                   bool *declined) {
    const camber_style *style = features->style;
    size_t areas = 0;
    while (camber_osm_area_keys[areas])
        areas++;
    *ways = (camber_osm_ways){
        .context = features->context, .features = features, .plain = true, .where = where, .slot_count = FIRST_SLOTS};
    camber_osm_node_set_init(&ways->nodes, features->context);
    *declined = style->property_count + areas >= UINT16_MAX - 2 - CAMBER_OSM_WHERE_KEYS;
    if (*declined)
        return CAMBER_OK;
    if (!(ways->keys = camber_alloc(ways->context, style->property_count + areas + 1 + CAMBER_OSM_WHERE_KEYS,
                                    sizeof *ways->keys)) ||
        !(ways->slots = camber_alloc_zero(ways->context, ways->slot_count, sizeof *ways->slots)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < style->property_count; i++) {
        const char *name = style->properties[i];
        if (strcmp(name, CAMBER_PLAIN_PROPERTY) == 0 || !camber_osm_is_key(name, strlen(name)))
            continue;
        *declined = *declined || is_column(name);
        find_key(ways, name)->property = (uint32_t)i;
        ways->plain = false;
    }
    for (size_t i = 0; i < areas; i++)
        find_key(ways, camber_osm_area_keys[i])->area = true;
    find_key(ways, "highway")->highway = true;
    *declined = *declined || !find_filter_keys(ways);
    return CAMBER_OK;
}

void camber_osm_ways_free(camber_osm_ways *ways) {
    camber_context *context = ways->context;
    camber_osm_node_set_free(&ways->nodes);
    camber_free(context, ways->local);
    camber_free(context, ways->text);
    camber_free(context, ways->slots);
    camber_free(context, ways->values);
    camber_free(context, ways->runs);
    camber_free(context, ways->packed);
    camber_free(context, ways->ids);
    camber_free(context, ways->ways);
    camber_free(context, ways->keys);
}

/* ---- One block, on any thread ---- */

typedef struct block {
    camber_osm_unpacked unpacked;
    camber_osm_block strings; /* uint32_t: where the table has them */
    camber_osm_block roles;   /* uint16_t a string: its key + 2; 1: it is no key; 0: not looked up */
    camber_osm_block sets;    /* uint32_t: strings of properties, a set after the other */
    camber_osm_block slots;   /* uint32_t: a hash table of sets; index + 1 */
    camber_osm_block ways;    /* camber_osm_way, with sets of the block */
    camber_osm_block ids;
    camber_wire table;
    size_t string_count, set_count, slot_count, way_count, id_bytes;
    bool has_ways;
} block;

typedef struct decoder {
    const camber_osm_ways *ways;
    camber_osm_pass *pass;
    block *to;
    camber_osm_failure *failure;
    size_t property_count;
} decoder;

static void free_block(camber_context *context, void *slot) {
    block *one = slot;
    camber_osm_unpacked_free(context, &one->unpacked);
    camber_free(context, one->ids.bytes);
    camber_free(context, one->ways.bytes);
    camber_free(context, one->slots.bytes);
    camber_free(context, one->sets.bytes);
    camber_free(context, one->roles.bytes);
    camber_free(context, one->strings.bytes);
}

/* A string of the block's table. It may hold a 0, which ends it for GDAL. */
static camber_wire string_at(const block *from, uint32_t string) {
    camber_wire wire = {from->table.at + ((const uint32_t *)(const void *)from->strings.bytes)[string], from->table.end,
                        false};
    camber_wire text = camber_wire_bytes(&wire);
    const uint8_t *zero = text.at < text.end ? memchr(text.at, 0, (size_t)(text.end - text.at)) : NULL;
    text.end = zero ? zero : text.end;
    return text;
}

static bool list_strings(decoder *self, camber_wire table) {
    block *to = self->to;
    camber_wire wire = table;
    uint64_t key;
    to->table = table;
    to->string_count = 0;
    while (camber_wire_next(&wire, &key)) {
        if (key != CAMBER_WIRE_KEY(STRING, CAMBER_WIRE_BYTES)) {
            camber_wire_skip(&wire, key);
            continue;
        }
        if (!camber_osm_reserve(self->pass, &to->strings, (to->string_count + 1) * sizeof(uint32_t), self->failure))
            return false;
        ((uint32_t *)(void *)to->strings.bytes)[to->string_count++] = (uint32_t)(wire.at - table.at);
        camber_wire_bytes(&wire);
    }
    if (wire.bad)
        return camber_osm_fail(self->failure, "a table of strings that does not parse");
    if (!camber_osm_reserve(self->pass, &to->roles, (to->string_count + 1) * sizeof(uint16_t), self->failure))
        return false;
    memset(to->roles.bytes, 0, to->string_count * sizeof(uint16_t));
    return true;
}

/* The key that a string is; NULL: none of those looked for. */
static const camber_osm_key *key_of(const decoder *self, uint32_t string) {
    uint16_t *role = (uint16_t *)(void *)self->to->roles.bytes + string;
    if (*role == 0) {
        const camber_wire text = string_at(self->to, string);
        const size_t length = (size_t)(text.end - text.at);
        *role = 1;
        for (size_t i = 0; i < self->ways->key_count; i++)
            if (self->ways->keys[i].length == length && memcmp(self->ways->keys[i].name, text.at, length) == 0)
                *role = (uint16_t)(i + 2);
    }
    return *role > 1 ? &self->ways->keys[*role - 2] : NULL;
}

static bool is_no(const block *from, uint32_t string) {
    const camber_wire text = string_at(from, string);
    const char copy[3] = {text.end - text.at == 2 ? (char)text.at[0] : 0,
                          text.end - text.at == 2 ? (char)text.at[1] : 0, 0};
    return camber_osm_is_no(copy);
}

static size_t hash_strings(const uint32_t *strings, size_t count) {
    uint64_t hash = 0;
    for (size_t i = 0; i < count; i++)
        hash = camber_mix(hash, strings[i]);
    return (size_t)(hash ^ hash >> 32);
}

static bool grow_slots(decoder *self) {
    block *to = self->to;
    const size_t slots = to->slot_count ? 2 * to->slot_count : FIRST_SLOTS;
    if (!camber_osm_reserve(self->pass, &to->slots, slots * sizeof(uint32_t), self->failure))
        return false;
    uint32_t *table = (uint32_t *)(void *)to->slots.bytes;
    const uint32_t *sets = (const uint32_t *)(const void *)to->sets.bytes;
    memset(table, 0, slots * sizeof *table);
    to->slot_count = slots;
    for (size_t i = 0; i < to->set_count; i++) {
        size_t slot = hash_strings(sets + i * self->property_count, self->property_count) & (slots - 1);
        while (table[slot])
            slot = (slot + 1) & (slots - 1);
        table[slot] = (uint32_t)i + 1;
    }
    return true;
}

/* Finds the set behind the last one among the sets of the block, or adds it to them. */
static bool find_set(decoder *self, uint32_t *set) {
    block *to = self->to;
    const size_t count = self->property_count;
    if (to->set_count >= to->slot_count / 2 && !grow_slots(self))
        return false;
    uint32_t *table = (uint32_t *)(void *)to->slots.bytes;
    const uint32_t *sets = (const uint32_t *)(const void *)to->sets.bytes, *wanted = sets + to->set_count * count;
    size_t slot = hash_strings(wanted, count) & (to->slot_count - 1);
    for (; table[slot]; slot = (slot + 1) & (to->slot_count - 1)) {
        *set = table[slot] - 1;
        if (memcmp(sets + *set * count, wanted, count * sizeof *wanted) == 0)
            return true;
    }
    *set = (uint32_t)to->set_count++;
    table[slot] = *set + 1;
    return true;
}

/* Reads the tags of a way: the strings of properties go behind the last set. A key that comes twice has its last
 * value. *passes: the filter lets the way through. */
static bool read_tags(decoder *self, camber_wire keys, camber_wire values, bool *area, bool *passes) {
    block *to = self->to;
    const size_t start = to->set_count * self->property_count;
    if (!camber_osm_reserve(self->pass, &to->sets, (start + self->property_count + 1) * sizeof(uint32_t),
                            self->failure))
        return false;
    uint32_t *set = (uint32_t *)(void *)to->sets.bytes + start;
    uint32_t areas = 0, highways = 0;
    camber_osm_text compared[CAMBER_OSM_WHERE_KEYS] = {{0}};
    memset(set, 0xff, self->property_count * sizeof *set);
    while (keys.at < keys.end) {
        const uint64_t key = camber_wire_varint(&keys), value = camber_wire_varint(&values);
        if (keys.bad || values.bad || key >= to->string_count || value >= to->string_count)
            return camber_osm_fail(self->failure, "a tag that does not parse");
        const camber_osm_key *known = key_of(self, (uint32_t)key);
        if (!known)
            continue;
        if (known->property != NO_PROPERTY)
            set[known->property] = (uint32_t)value;
        if (known->filter != NO_PROPERTY) {
            const camber_wire text = string_at(to, (uint32_t)value);
            compared[known->filter] = (camber_osm_text){(const char *)text.at, (size_t)(text.end - text.at)};
        }
        highways += known->highway;
        areas += known->area && !is_no(to, (uint32_t)value);
    }
    *area = areas && !highways;
    *passes = !self->ways->where || camber_osm_where_passes(self->ways->where, compared);
    return true;
}

/* Copies the differences of ids as they are. */
static bool copy_ids(decoder *self, camber_wire ids, uint64_t count, camber_osm_way way) {
    block *to = self->to;
    const size_t size = (size_t)(ids.end - ids.at);
    uint64_t id = 0;
    if (count > UINT32_MAX || !camber_osm_reserve(self->pass, &to->ids, to->id_bytes + size, self->failure) ||
        !camber_osm_reserve(self->pass, &to->ways, (to->way_count + 1) * sizeof way, self->failure))
        return false;
    memcpy(to->ids.bytes + to->id_bytes, ids.at, size);
    while (ids.at < ids.end) {
        id += (uint64_t)camber_wire_signed(&ids);
        if (id >= (uint64_t)CAMBER_OSM_MOST_ID)
            return ids.bad ? camber_osm_fail(self->failure, "a way that does not parse")
                           : camber_osm_decline(self->failure);
    }
    if (ids.bad)
        return camber_osm_fail(self->failure, "a way that does not parse");
    to->id_bytes += size;
    ((camber_osm_way *)(void *)to->ways.bytes)[to->way_count++] = way;
    return true;
}

static bool read_way(decoder *self, camber_wire wire) {
    camber_wire keys = {0}, values = {0}, ids = {0};
    uint64_t key;
    while (camber_wire_next(&wire, &key)) {
        if (key == CAMBER_WIRE_KEY(WAY_KEYS, CAMBER_WIRE_BYTES))
            keys = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(WAY_VALUES, CAMBER_WIRE_BYTES))
            values = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(WAY_NODES, CAMBER_WIRE_BYTES))
            ids = camber_wire_bytes(&wire);
        else
            camber_wire_skip(&wire, key);
    }
    if (wire.bad)
        return camber_osm_fail(self->failure, "a way that does not parse");
    const uint64_t count = camber_wire_count(&ids);
    if (count < 2 || keys.at == keys.end)
        return true;
    uint32_t set;
    bool area = false, passes = false;
    if (!read_tags(self, keys, values, &area, &passes))
        return false;
    if (!passes)
        return true;
    if (!find_set(self, &set))
        return false;
    return copy_ids(self, ids, count, (camber_osm_way){2 * set + area, (uint32_t)count});
}

static bool read_group(decoder *self, camber_wire group, bool nodes_allowed) {
    uint64_t key;
    while (camber_wire_next(&group, &key)) {
        const bool node = key == CAMBER_WIRE_KEY(CAMBER_OSM_NODE, CAMBER_WIRE_BYTES) ||
                          key == CAMBER_WIRE_KEY(CAMBER_OSM_DENSE, CAMBER_WIRE_BYTES);
        if (node && (!nodes_allowed || self->to->has_ways))
            return camber_osm_decline(self->failure);
        if (key != CAMBER_WIRE_KEY(CAMBER_OSM_WAY, CAMBER_WIRE_BYTES)) {
            camber_wire_skip(&group, key);
            continue;
        }
        self->to->has_ways = true;
        if (!read_way(self, camber_wire_bytes(&group)))
            return false;
    }
    return !group.bad || camber_osm_fail(self->failure, "a group that does not parse");
}

typedef struct reading {
    camber_osm_ways *ways;
    const camber_osm_ways_desc *desc;
} reading;

static bool read_block(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    const reading *all = user;
    block *to = slot;
    decoder self = {.ways = all->ways,
                    .pass = pass,
                    .to = to,
                    .failure = failure,
                    .property_count = all->ways->features->style->property_count};
    camber_osm_entities entities;
    camber_wire group;
    to->set_count = to->slot_count = to->way_count = to->id_bytes = 0;
    to->has_ways = false;
    if (!camber_osm_file_unpack(all->desc->file, all->desc->first_blob + part, pass, &to->unpacked, &entities, failure))
        return false;
    if (!list_strings(&self, entities.strings))
        return false;
    /* The blob before the first way may have the last nodes. */
    while (camber_osm_entities_next(&entities, &group))
        if (!read_group(&self, group, part == 0))
            return false;
    return !entities.groups.bad || camber_osm_fail(failure, "a block that does not parse");
}

/* ---- The blocks' ways become the file's ---- */

static camber_status intern(camber_osm_ways *ways, const block *from, uint32_t string, camber_value *value) {
    *value = (camber_value){0};
    if (string == NO_STRING)
        return CAMBER_OK;
    const camber_wire text = string_at(from, string);
    const size_t length = (size_t)(text.end - text.at);
    if (!camber_grow(ways->context, &ways->text, &ways->text_capacity, length + 1, 1))
        return CAMBER_ERROR_MEMORY;
    if (length)
        memcpy(ways->text, text.at, length);
    ways->text[length] = 0;
    value->type = CAMBER_VALUE_STRING;
    return camber_features_intern(ways->features, ways->text, &value->string);
}

/* Interned strings are equal where their pointers are. */
static size_t hash_values(const camber_value *values, size_t count) {
    uint64_t hash = 0;
    for (size_t i = 0; i < count; i++)
        hash = camber_mix(hash, values[i].type == CAMBER_VALUE_STRING ? (uintptr_t)values[i].string : values[i].type);
    return (size_t)(hash ^ hash >> 32);
}

static bool equal_values(const camber_value *a, const camber_value *b, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (a[i].type != b[i].type || (a[i].type == CAMBER_VALUE_STRING && a[i].string != b[i].string))
            return false;
    return true;
}

static camber_status grow_table(camber_osm_ways *ways, size_t count) {
    const size_t slots = 2 * ways->slot_count;
    uint32_t *table = camber_alloc_zero(ways->context, slots, sizeof *table);
    if (!table)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < ways->set_count; i++) {
        size_t slot = hash_values(ways->values + i * count, count) & (slots - 1);
        while (table[slot])
            slot = (slot + 1) & (slots - 1);
        table[slot] = (uint32_t)i + 1;
    }
    camber_free(ways->context, ways->slots);
    ways->slots = table;
    ways->slot_count = slots;
    return CAMBER_OK;
}

/* Finds a block's set among those of the file, or adds it to them. */
static camber_status add_set(camber_osm_ways *ways, const block *from, const uint32_t *strings, uint32_t *set) {
    const camber_style *style = ways->features->style;
    const size_t count = style->property_count;
    if (ways->set_count >= UINT32_MAX / 2)
        return camber_fail(ways->context, CAMBER_ERROR_LIMIT,
                           "more than 2147483647 different lines; read fewer attributes");
    if (!camber_grow(ways->context, &ways->values, &ways->value_capacity, (ways->set_count + 1) * count,
                     sizeof *ways->values))
        return CAMBER_ERROR_MEMORY;
    camber_value *values = ways->values + ways->set_count * count;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        status = intern(ways, from, strings[i], &values[i]);
        if (ways->plain && strcmp(style->properties[i], CAMBER_PLAIN_PROPERTY) == 0)
            values[i] = (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = true};
    }
    if (status == CAMBER_OK && ways->set_count >= ways->slot_count / 2)
        status = grow_table(ways, count);
    if (status != CAMBER_OK)
        return status;
    size_t slot = hash_values(values, count) & (ways->slot_count - 1);
    for (; ways->slots[slot]; slot = (slot + 1) & (ways->slot_count - 1)) {
        *set = ways->slots[slot] - 1;
        if (equal_values(ways->values + *set * count, values, count))
            return CAMBER_OK;
    }
    *set = (uint32_t)ways->set_count++;
    ways->slots[slot] = *set + 1;
    return CAMBER_OK;
}

static camber_status add_ids(camber_osm_ways *ways, const uint8_t *bytes, size_t size, const camber_osm_way *way,
                             size_t *used) {
    camber_wire wire = {bytes + *used, bytes + size, false};
    uint64_t id = 0;
    camber_status status = CAMBER_OK;
    for (uint32_t i = 0; i < way->node_count && status == CAMBER_OK; i++) {
        id += (uint64_t)camber_wire_signed(&wire);
        status = camber_osm_node_set_add(&ways->nodes, (int64_t)id);
    }
    *used = (size_t)(wire.at - bytes);
    return status;
}

/* Adds a way whose ids lie at this place to the last run, or to a new one. */
static camber_status add_to_run(camber_osm_ways *ways, const camber_osm_way *way, size_t first_id) {
    camber_osm_run *last = ways->run_count ? &ways->runs[ways->run_count - 1] : NULL;
    if (!last || last->node_count + way->node_count > RUN_NODES) {
        if (!camber_grow(ways->context, &ways->runs, &ways->run_capacity, ways->run_count + 1, sizeof *ways->runs))
            return CAMBER_ERROR_MEMORY;
        last = &ways->runs[ways->run_count++];
        *last = (camber_osm_run){.first_way = ways->way_count, .first_id = first_id};
    }
    last->way_count++;
    last->node_count += way->node_count;
    ways->node_count += way->node_count;
    return CAMBER_OK;
}

static camber_status add_block(void *user, size_t part, void *slot) {
    camber_osm_ways *ways = ((const reading *)user)->ways;
    const block *from = slot;
    const size_t properties = ways->features->style->property_count, first_id = ways->id_bytes;
    const uint32_t *sets = (const uint32_t *)(const void *)from->sets.bytes;
    const camber_osm_way *added = (const camber_osm_way *)(const void *)from->ways.bytes;
    size_t used = 0;
    (void)part;
    if (from->way_count == 0)
        return CAMBER_OK;
    if (!camber_grow(ways->context, &ways->local, &ways->local_capacity, from->set_count, sizeof *ways->local) ||
        !camber_grow(ways->context, &ways->ways, &ways->way_capacity, ways->way_count + from->way_count,
                     sizeof *ways->ways) ||
        !camber_grow(ways->context, &ways->ids, &ways->id_capacity, ways->id_bytes + from->id_bytes, 1))
        return CAMBER_ERROR_MEMORY;
    memcpy(ways->ids + first_id, from->ids.bytes, from->id_bytes);
    ways->id_bytes += from->id_bytes;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < from->set_count && status == CAMBER_OK; i++)
        status = add_set(ways, from, sets + i * properties, &ways->local[i]);
    for (size_t i = 0; i < from->way_count && status == CAMBER_OK; i++) {
        const camber_osm_way way = {2 * ways->local[added[i].tags / 2] + (added[i].tags & 1), added[i].node_count};
        status = add_to_run(ways, &way, first_id + used);
        if (status == CAMBER_OK)
            status = add_ids(ways, from->ids.bytes, from->id_bytes, &way, &used);
        ways->ways[ways->way_count++] = way;
    }
    return status;
}

camber_status camber_osm_ways_read(camber_osm_ways *ways, const camber_osm_ways_desc *desc, bool *declined) {
    reading all = {ways, desc};
    const camber_osm_pass_desc pass = {.context = ways->context,
                                       .name = desc->file->path,
                                       .part_count = desc->file->blob_count - desc->first_blob,
                                       .threads = desc->threads,
                                       .slot_bytes = sizeof(block),
                                       .user = &all,
                                       .work = read_block,
                                       .commit = add_block,
                                       .free_slot = free_block,
                                       .from = desc->from,
                                       .to = desc->to};
    camber_status status = camber_osm_pass_run(&pass, declined);
    if (status == CAMBER_OK && !*declined)
        status = camber_osm_node_set_complete(&ways->nodes);
    return status;
}
