/* Reads the relations of a file that are areas, then its ways, and its nodes with tags.
 *
 * Input: blobs, and the keys that a style names. Output: for each way with a tag and at least two nodes, its set of
 * tags and the ids of its nodes, and the set of all ids. Ways that relations name are read even without tags. For each
 * node with a tag: its set of tags and its position. Threads decode blocks: tags become indices of strings, and
 * entities with equal tags share a set. The caller's thread then merges each block's sets into the file's. */
#include "osm/ways.h"

#include "features/osm_keys.h"

#include <math.h>
#include <strings.h>

/* RUN_NODES: one thread makes lines from about this many nodes at a time. */
enum { RUN_NODES = 16384, FIRST_SLOTS = 1024, FIRST_LEAF_SLOTS = 16384 };
enum { ID = 1, KEYS = 2, VALUES = 3, WAY_NODES = 8, WAY_LATITUDES = 9, STRING = 1 };
enum { NODE_LATITUDE = 8, NODE_LONGITUDE = 9, DENSE_LATITUDES = 8, DENSE_LONGITUDES = 9, DENSE_TAGS = 10 };
enum { RELATION_ROLES = 8, RELATION_MEMBERS = 9, RELATION_TYPES = 10, MEMBER_WAY = 1 };
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

/* Adds the filter's keys. Returns false if two keys differ only in their case, which SQL ignores. */
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

/* Whether this is the name of one of OGR's own columns, which are not tags. */
static bool is_column(const char *name) {
    return strncmp(name, "osm_", 4) == 0 || strcmp(name, "other_tags") == 0 || strcmp(name, "all_tags") == 0;
}

camber_status camber_osm_ways_init(camber_osm_ways *ways, camber_features *features, const camber_osm_where *where,
                                   bool *declined) {
    const camber_schema *schema = features->schema;
    size_t areas = 0;
    while (camber_osm_area_keys[areas])
        areas++;
    *ways = (camber_osm_ways){
        .context = features->context, .features = features, .where = where, .slot_count = FIRST_SLOTS};
    camber_osm_node_set_init(&ways->nodes, features->context);
    camber_osm_relations_init(&ways->relations, features->context);
    *declined = schema->property_count + areas >= UINT16_MAX - 3 - CAMBER_OSM_WHERE_KEYS;
    if (*declined)
        return CAMBER_OK;
    if (!(ways->keys = camber_alloc(ways->context, schema->property_count + areas + 2 + CAMBER_OSM_WHERE_KEYS,
                                    sizeof *ways->keys)) ||
        !(ways->slots = camber_alloc_zero(ways->context, ways->slot_count, sizeof *ways->slots)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < schema->property_count; i++) {
        const char *name = schema->properties[i];
        if (!camber_osm_is_key(name, strlen(name)) || !camber_features_reads_property(features, i))
            continue;
        *declined = *declined || is_column(name);
        find_key(ways, name)->property = (uint32_t)i;
    }
    for (size_t i = 0; i < areas; i++)
        find_key(ways, camber_osm_area_keys[i])->area = true;
    find_key(ways, "area")->is_area = true;
    find_key(ways, "highway")->highway = true;
    find_key(ways, "type")->type = true;
    *declined = *declined || !find_filter_keys(ways);
    return CAMBER_OK;
}

void camber_osm_ways_free(camber_osm_ways *ways) {
    camber_context *context = ways->context;
    camber_osm_node_set_free(&ways->nodes);
    camber_osm_relations_free(&ways->relations);
    camber_free(context, ways->local);
    camber_free(context, ways->text);
    camber_free(context, ways->slots);
    camber_free(context, ways->values);
    camber_free(context, ways->points);
    camber_free(context, ways->runs);
    camber_free(context, ways->packed);
    camber_free(context, ways->leaves);
    camber_free(context, ways->ids);
    camber_free(context, ways->ways);
    camber_free(context, ways->keys);
}

/* ---- One block, on any thread ---- */

typedef struct block {
    camber_osm_unpacked unpacked;
    camber_osm_block strings;    /* uint32_t: offsets of the strings in the table */
    camber_osm_block roles;      /* uint16_t per string: its key + 2; 1: not a key; 0: not looked up yet */
    camber_osm_block sets;       /* uint32_t: the strings of properties, one set after the other */
    camber_osm_block slots;      /* uint32_t: a hash table of sets; index + 1 */
    camber_osm_block ways;       /* camber_osm_way, with the block's sets */
    camber_osm_block ids;        /* uint32_t, in the form of camber_osm_ways.ids */
    camber_osm_block leaves;     /* block_leaf */
    camber_osm_block leaf_slots; /* uint32_t: a hash table of leaves; index + 1 */
    camber_osm_block members; /* for relations: camber_osm_member; for ways: their indices among the relations' ways */
    camber_osm_block relations; /* camber_osm_relation, with the block's sets and members */
    camber_osm_block points;    /* camber_osm_point, with the block's sets */
    camber_wire table;
    size_t string_count, set_count, slot_count, way_count, id_count, leaf_count, leaf_slot_count;
    size_t member_count, relation_count, point_count;
    bool has_ways, has_places;
} block;

/* A leaf of a block: the ids in the range of one leaf of the node set that the block names, as a bitmap. So each leaf
 * of the node set is looked up only once per block. */
typedef struct block_leaf {
    uint64_t id; /* the upper bits of the ids */
    uint64_t bits[CAMBER_OSM_LEAF_WORDS];
} block_leaf;

typedef struct decoder {
    const camber_osm_ways *ways;
    camber_osm_pass *pass;
    block *to;
    camber_osm_failure *failure;
    size_t property_count;
    camber_osm_search_hint hint; /* for searches among the relations' ways */
    uint64_t last_leaf_id;       /* UINT64_MAX: none yet */
    uint32_t last_leaf;
} decoder;

static void free_block(camber_context *context, void *slot) {
    block *one = slot;
    camber_osm_unpacked_free(context, &one->unpacked);
    camber_free(context, one->points.bytes);
    camber_free(context, one->relations.bytes);
    camber_free(context, one->members.bytes);
    camber_free(context, one->leaf_slots.bytes);
    camber_free(context, one->leaves.bytes);
    camber_free(context, one->ids.bytes);
    camber_free(context, one->ways.bytes);
    camber_free(context, one->slots.bytes);
    camber_free(context, one->sets.bytes);
    camber_free(context, one->roles.bytes);
    camber_free(context, one->strings.bytes);
}

/* Returns a string of the block's table. It may contain a 0, which ends it for GDAL. */
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

/* Returns the key whose name is this string, or NULL if nothing reads a key with this name. */
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

/* Looks up the new set, which is stored after the block's last set, among the block's sets, or adds it. */
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

/* The meaning of an entity's tags. */
typedef struct tag_facts {
    bool area, passes; /* passes: the filter accepts it */
    size_t count;
    uint32_t type; /* index of a string; NO_STRING: there is none */
} tag_facts;

/* Reads the tags of an entity. Appends the strings of properties after the last set. If a key occurs twice, its last
 * value counts. values may be the same as keys; then each key is followed by its value. */
static bool read_tags(decoder *self, camber_wire *keys, camber_wire *values, tag_facts *facts) {
    block *to = self->to;
    const size_t start = to->set_count * self->property_count;
    if (!camber_osm_reserve(self->pass, &to->sets, (start + self->property_count + 1) * sizeof(uint32_t),
                            self->failure))
        return false;
    uint32_t *set = (uint32_t *)(void *)to->sets.bytes + start;
    uint32_t areas = 0, told = 0, highways = 0;
    camber_osm_text compared[CAMBER_OSM_WHERE_KEYS] = {{0}};
    memset(set, 0xff, self->property_count * sizeof *set);
    *facts = (tag_facts){.type = NO_STRING};
    for (; keys->at < keys->end; facts->count++) {
        const uint64_t key = camber_wire_varint(keys), value = camber_wire_varint(values);
        if (keys->bad || values->bad || key >= to->string_count || value >= to->string_count)
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
        facts->type = known->type ? (uint32_t)value : facts->type;
        highways += known->highway;
        const bool counts = known->area && !is_no(to, (uint32_t)value);
        areas += counts;
        told += counts && known->is_area;
    }
    facts->area = told || (areas && !highways);
    facts->passes = !self->ways->where || camber_osm_where_passes(self->ways->where, compared);
    return true;
}

static bool grow_leaves(decoder *self) {
    block *to = self->to;
    const size_t slots = to->leaf_slot_count ? 2 * to->leaf_slot_count : FIRST_LEAF_SLOTS;
    if (to->leaf_count >= UINT32_MAX >> CAMBER_OSM_LEAF_BITS)
        return camber_osm_decline(self->failure);
    if (!camber_osm_reserve(self->pass, &to->leaf_slots, slots * sizeof(uint32_t), self->failure) ||
        !camber_osm_reserve(self->pass, &to->leaves, slots / 2 * sizeof(block_leaf), self->failure))
        return false;
    uint32_t *table = (uint32_t *)(void *)to->leaf_slots.bytes;
    const block_leaf *leaves = (const block_leaf *)(const void *)to->leaves.bytes;
    memset(table, 0, slots * sizeof *table);
    to->leaf_slot_count = slots;
    for (size_t i = 0; i < to->leaf_count; i++) {
        size_t slot = (size_t)camber_mix(0, leaves[i].id) & (slots - 1);
        while (table[slot])
            slot = (slot + 1) & (slots - 1);
        table[slot] = (uint32_t)i + 1;
    }
    return true;
}

/* Looks up a leaf among the block's leaves, or adds it, and remembers it as the last leaf. */
static bool find_leaf(decoder *self, uint64_t leaf_id) {
    block *to = self->to;
    if (to->leaf_count >= to->leaf_slot_count / 2 && !grow_leaves(self))
        return false;
    uint32_t *table = (uint32_t *)(void *)to->leaf_slots.bytes;
    block_leaf *leaves = (block_leaf *)(void *)to->leaves.bytes;
    size_t slot = (size_t)camber_mix(0, leaf_id) & (to->leaf_slot_count - 1);
    while (table[slot] && leaves[table[slot] - 1].id != leaf_id)
        slot = (slot + 1) & (to->leaf_slot_count - 1);
    if (!table[slot]) {
        leaves[to->leaf_count] = (block_leaf){.id = leaf_id};
        table[slot] = (uint32_t)++to->leaf_count;
    }
    self->last_leaf_id = leaf_id;
    self->last_leaf = table[slot] - 1;
    return true;
}

/* Adds a way with the ids of its nodes. */
static bool add_way(decoder *self, camber_wire ids, uint64_t count, camber_osm_way way) {
    block *to = self->to;
    uint64_t id = 0;
    if (count > UINT32_MAX ||
        !camber_osm_reserve(self->pass, &to->ids, (to->id_count + count) * sizeof(uint32_t), self->failure) ||
        !camber_osm_reserve(self->pass, &to->ways, (to->way_count + 1) * sizeof way, self->failure))
        return false;
    uint32_t *at = (uint32_t *)(void *)to->ids.bytes + to->id_count;
    for (const uint32_t *end = at + count; at < end;) {
        id += (uint64_t)camber_wire_signed(&ids);
        if (ids.bad || id >= (uint64_t)CAMBER_OSM_MOST_ID)
            return ids.bad ? camber_osm_fail(self->failure, "a way that does not parse")
                           : camber_osm_decline(self->failure);
        if (id >> CAMBER_OSM_LEAF_BITS != self->last_leaf_id && !find_leaf(self, id >> CAMBER_OSM_LEAF_BITS))
            return false;
        const uint32_t low = (uint32_t)id & ((1U << CAMBER_OSM_LEAF_BITS) - 1);
        ((block_leaf *)(void *)to->leaves.bytes)[self->last_leaf].bits[low >> 6] |= UINT64_C(1) << (low & 63);
        *at++ = self->last_leaf << CAMBER_OSM_LEAF_BITS | low;
    }
    if (ids.at < ids.end) /* the last id is cut off */
        return camber_osm_fail(self->failure, "a way that does not parse");
    to->id_count += (size_t)count;
    ((camber_osm_way *)(void *)to->ways.bytes)[to->way_count++] = way;
    return true;
}

/* Returns the bits of a way that a relation names, or 0 if none does. */
static uint32_t find_member(decoder *self, uint64_t id) {
    uint32_t index;
    const bool found = id < (uint64_t)CAMBER_OSM_MOST_ID &&
                       camber_osm_relations_find(&self->ways->relations, (int64_t)id, &self->hint, &index);
    return found ? CAMBER_OSM_WAY_MEMBER : 0;
}

/* Records the index of the way that find_member found last. */
static bool add_member_index(decoder *self) {
    block *to = self->to;
    if (!camber_osm_reserve(self->pass, &to->members, (to->member_count + 1) * sizeof(uint32_t), self->failure))
        return false;
    ((uint32_t *)(void *)to->members.bytes)[to->member_count++] = self->hint.index;
    return true;
}

static bool read_way(decoder *self, camber_wire wire) {
    camber_wire keys = {0}, values = {0}, ids = {0};
    uint64_t key, number = 0;
    while (camber_wire_next(&wire, &key)) {
        if (key == CAMBER_WIRE_KEY(ID, CAMBER_WIRE_VARINT)) {
            number = camber_wire_varint(&wire);
        } else if (key == CAMBER_WIRE_KEY(KEYS, CAMBER_WIRE_BYTES)) {
            keys = camber_wire_bytes(&wire);
        } else if (key == CAMBER_WIRE_KEY(VALUES, CAMBER_WIRE_BYTES)) {
            values = camber_wire_bytes(&wire);
        } else if (key == CAMBER_WIRE_KEY(WAY_NODES, CAMBER_WIRE_BYTES)) {
            ids = camber_wire_bytes(&wire);
        } else {
            self->to->has_places |= key == CAMBER_WIRE_KEY(WAY_LATITUDES, CAMBER_WIRE_BYTES);
            camber_wire_skip(&wire, key);
        }
    }
    if (wire.bad)
        return camber_osm_fail(self->failure, "a way that does not parse");
    const uint64_t count = camber_wire_count(&ids);
    uint32_t bits = find_member(self, number);
    if (count < 2 || (keys.at == keys.end && !bits))
        return true;
    uint32_t set = 0;
    tag_facts facts;
    const bool tagged = keys.at < keys.end;
    if (!read_tags(self, &keys, &values, &facts))
        return false;
    const bool bare = !tagged || !facts.passes;
    if (bare && !bits)
        return true;
    if (!bare && !find_set(self, &set))
        return false;
    bits |= bare ? CAMBER_OSM_WAY_BARE : facts.area ? CAMBER_OSM_WAY_AREA : 0u;
    return (!(bits & CAMBER_OSM_WAY_MEMBER) || add_member_index(self)) &&
           add_way(self, ids, count, (camber_osm_way){set * CAMBER_OSM_WAY_BITS | bits, (uint32_t)count});
}

/* Reads a group. relations_allowed: relations were read before, or do not matter. */
static bool read_group(decoder *self, camber_wire group, bool nodes_allowed, bool relations_allowed, bool any_order) {
    uint64_t key;
    while (camber_wire_next(&group, &key)) {
        const bool node = key == CAMBER_WIRE_KEY(CAMBER_OSM_NODE, CAMBER_WIRE_BYTES) ||
                          key == CAMBER_WIRE_KEY(CAMBER_OSM_DENSE, CAMBER_WIRE_BYTES);
        if (node && !any_order && (!nodes_allowed || self->to->has_ways))
            return camber_osm_decline(self->failure);
        if (key == CAMBER_WIRE_KEY(CAMBER_OSM_RELATION, CAMBER_WIRE_BYTES) && !relations_allowed)
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

/* Prepares the decoder and its block for a blob. */
static void begin_block(const reading *all, camber_osm_pass *pass, decoder *self) {
    block *to = self->to;
    self->ways = all->ways;
    self->pass = pass;
    self->property_count = all->ways->features->schema->property_count;
    self->hint = (camber_osm_search_hint){.leaf_id = UINT64_MAX, .id = -2};
    self->last_leaf_id = UINT64_MAX;
    to->set_count = to->slot_count = to->way_count = to->id_count = to->member_count = to->relation_count = 0;
    to->point_count = 0;
    to->leaf_count = to->leaf_slot_count = 0;
    to->has_ways = to->has_places = false;
}

static bool unpack_block(decoder *self, const reading *all, size_t blob, camber_osm_entities *entities) {
    return camber_osm_file_unpack(all->desc->file, blob, self->pass, &self->to->unpacked, entities, self->failure) &&
           list_strings(self, entities->strings);
}

/* Whether a blob that was examined before has no ways and nothing unexpected. */
static bool has_no_ways(const camber_osm_blob *blob, bool nodes_allowed, bool relations_allowed) {
    return (blob->kinds & CAMBER_OSM_LOOKED_AT) && !(blob->kinds & CAMBER_OSM_HAS_WAYS) &&
           (nodes_allowed || !(blob->kinds & CAMBER_OSM_HAS_NODES)) &&
           (relations_allowed || !(blob->kinds & CAMBER_OSM_HAS_RELATIONS));
}

static bool read_block(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    const reading *all = user;
    const size_t blob = all->desc->first_blob + part;
    decoder self = {.to = slot, .failure = failure};
    camber_osm_entities entities;
    camber_wire group;
    /* The blob before the first way may have the last nodes, and the blob before the first relation may have relations.
     */
    const bool any_order = all->desc->any_order;
    const unsigned kinds = camber_features_kinds(all->ways->features, false);
    const bool relations = any_order || !(kinds & CAMBER_KINDS_OF_AREAS) || blob + 1 >= all->desc->end_blob;
    begin_block(all, pass, &self);
    if (has_no_ways(&all->desc->file->blobs[blob], any_order || part == 0, relations))
        return true;
    if (!unpack_block(&self, all, blob, &entities))
        return false;
    while (camber_osm_entities_next(&entities, &group))
        if (!read_group(&self, group, part == 0, relations, any_order))
            return false;
    return !entities.groups.bad || camber_osm_fail(failure, "a block that does not parse");
}

/* ---- Relations, on any thread ---- */

static bool is_string(const block *from, uint64_t string, const char *text) {
    if (string >= from->string_count)
        return false;
    const camber_wire is = string_at(from, (uint32_t)string);
    const size_t length = strlen(text);
    return (size_t)(is.end - is.at) == length && memcmp(is.at, text, length) == 0;
}

static camber_osm_role role_of(const block *from, uint64_t string) {
    if (is_string(from, string, "inner") || is_string(from, string, "enclave"))
        return CAMBER_OSM_ROLE_INNER;
    if (is_string(from, string, "outer") || is_string(from, string, "exclave"))
        return CAMBER_OSM_ROLE_OUTER;
    return CAMBER_OSM_ROLE_UNKNOWN;
}

/* Adds the ways among a relation's members to the members of the block. */
static bool read_members(decoder *self, camber_wire roles, camber_wire members, camber_wire types) {
    block *to = self->to;
    uint64_t id = 0;
    while (members.at < members.end) {
        const uint64_t role = camber_wire_varint(&roles), type = camber_wire_varint(&types);
        id += (uint64_t)camber_wire_signed(&members);
        if (roles.bad || types.bad || members.bad)
            return camber_osm_fail(self->failure, "a relation that does not parse");
        if (type != MEMBER_WAY)
            continue;
        if (id >= (uint64_t)CAMBER_OSM_MOST_ID)
            return camber_osm_decline(self->failure);
        if (!camber_osm_reserve(self->pass, &to->members, (to->member_count + 1) * sizeof(camber_osm_member),
                                self->failure))
            return false;
        ((camber_osm_member *)(void *)to->members.bytes)[to->member_count++] =
            (camber_osm_member){(int64_t)id, role_of(to, role)};
    }
    return true;
}

static bool add_relation(decoder *self, camber_osm_relation relation) {
    block *to = self->to;
    if (!camber_osm_reserve(self->pass, &to->relations, (to->relation_count + 1) * sizeof relation, self->failure))
        return false;
    ((camber_osm_relation *)(void *)to->relations.bytes)[to->relation_count++] = relation;
    return true;
}

static bool read_relation(decoder *self, camber_wire wire) {
    camber_wire keys = {0}, values = {0}, roles = {0}, members = {0}, types = {0}, *field;
    uint64_t key;
    while (camber_wire_next(&wire, &key)) {
        field = key == CAMBER_WIRE_KEY(KEYS, CAMBER_WIRE_BYTES)               ? &keys
                : key == CAMBER_WIRE_KEY(VALUES, CAMBER_WIRE_BYTES)           ? &values
                : key == CAMBER_WIRE_KEY(RELATION_ROLES, CAMBER_WIRE_BYTES)   ? &roles
                : key == CAMBER_WIRE_KEY(RELATION_MEMBERS, CAMBER_WIRE_BYTES) ? &members
                : key == CAMBER_WIRE_KEY(RELATION_TYPES, CAMBER_WIRE_BYTES)   ? &types
                                                                              : NULL;
        if (field)
            *field = camber_wire_bytes(&wire);
        else
            camber_wire_skip(&wire, key);
    }
    if (wire.bad)
        return camber_osm_fail(self->failure, "a relation that does not parse");
    block *to = self->to;
    camber_osm_relation relation = {.first_member = to->member_count};
    tag_facts facts;
    if (!read_tags(self, &keys, &values, &facts))
        return false;
    relation.is_tagged = facts.count > 1;
    const bool area = is_string(to, facts.type, "multipolygon") || is_string(to, facts.type, "boundary");
    if (!area || (relation.is_tagged && !facts.passes))
        return true;
    if (!read_members(self, roles, members, types))
        return false;
    relation.member_count = (uint32_t)(to->member_count - relation.first_member);
    if (relation.member_count == 0 || (relation.is_tagged && !find_set(self, &relation.set)))
        return relation.member_count == 0;
    return add_relation(self, relation);
}

static bool read_relations(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    const reading *all = user;
    decoder self = {.to = slot, .failure = failure};
    camber_osm_entities entities;
    camber_wire group;
    uint64_t key;
    const size_t blob = all->desc->first_blob + part;
    const unsigned kinds = all->desc->file->blobs[blob].kinds;
    begin_block(all, pass, &self);
    if (kinds && !(kinds & CAMBER_OSM_HAS_RELATIONS))
        return true;
    if (!unpack_block(&self, all, blob, &entities))
        return false;
    while (camber_osm_entities_next(&entities, &group)) {
        while (camber_wire_next(&group, &key)) {
            if (key != CAMBER_WIRE_KEY(CAMBER_OSM_RELATION, CAMBER_WIRE_BYTES))
                camber_wire_skip(&group, key);
            else if (!read_relation(&self, camber_wire_bytes(&group)))
                return false;
        }
        if (group.bad)
            return camber_osm_fail(failure, "a group that does not parse");
    }
    return !entities.groups.bad || camber_osm_fail(failure, "a block that does not parse");
}

/* ---- Nodes with tags, on any thread ---- */

/* Converts a coordinate of the block to degrees, with GDAL's arithmetic. */
static double to_degrees(int64_t coordinate, int64_t offset, int32_t granularity) {
    return .000000001 * ((double)offset + (double)granularity * (double)coordinate);
}

/* Adds a node if it has a tag and passes the filter. */
static bool add_point(decoder *self, const camber_osm_entities *from, camber_wire *keys, camber_wire *values,
                      const int64_t place[2]) {
    block *to = self->to;
    tag_facts facts;
    camber_osm_point point = {.longitude = to_degrees(place[0], from->longitude_offset, from->granularity),
                              .latitude = to_degrees(place[1], from->latitude_offset, from->granularity)};
    if (keys->at == keys->end)
        return true;
    if (!(fabs(point.longitude) <= 180.0 && fabs(point.latitude) <= 90.0))
        return camber_osm_fail(self->failure, "a node that is not on Earth");
    if (!read_tags(self, keys, values, &facts))
        return false;
    if (!facts.passes)
        return true;
    if (!find_set(self, &point.set) ||
        !camber_osm_reserve(self->pass, &to->points, (to->point_count + 1) * sizeof point, self->failure))
        return false;
    ((camber_osm_point *)(void *)to->points.bytes)[to->point_count++] = point;
    return true;
}

static bool read_node(decoder *self, const camber_osm_entities *from, camber_wire wire) {
    camber_wire keys = {0}, values = {0};
    uint64_t key;
    int64_t place[2] = {0, 0};
    while (camber_wire_next(&wire, &key)) {
        if (key == CAMBER_WIRE_KEY(KEYS, CAMBER_WIRE_BYTES))
            keys = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(VALUES, CAMBER_WIRE_BYTES))
            values = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(NODE_LATITUDE, CAMBER_WIRE_VARINT))
            place[1] = camber_wire_signed(&wire);
        else if (key == CAMBER_WIRE_KEY(NODE_LONGITUDE, CAMBER_WIRE_VARINT))
            place[0] = camber_wire_signed(&wire);
        else
            camber_wire_skip(&wire, key);
    }
    if (wire.bad)
        return camber_osm_fail(self->failure, "a node that does not parse");
    return add_point(self, from, &keys, &values, place);
}

/* Returns the tags of the next dense node: keys and values alternate, up to a 0. */
static camber_wire next_tags(camber_wire *all) {
    camber_wire tags = *all;
    while (all->at < all->end) {
        tags.end = all->at;
        if (camber_wire_varint(all) == 0)
            return tags;
        camber_wire_varint(all);
    }
    tags.end = all->at;
    return tags;
}

/* Differences are added as unsigned numbers, which may wrap around. */
static bool read_dense(decoder *self, const camber_osm_entities *from, camber_wire wire) {
    camber_wire longitudes = {0}, latitudes = {0}, all = {0};
    uint64_t key, longitude = 0, latitude = 0;
    while (camber_wire_next(&wire, &key)) {
        if (key == CAMBER_WIRE_KEY(DENSE_LATITUDES, CAMBER_WIRE_BYTES))
            latitudes = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(DENSE_LONGITUDES, CAMBER_WIRE_BYTES))
            longitudes = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(DENSE_TAGS, CAMBER_WIRE_BYTES))
            all = camber_wire_bytes(&wire);
        else
            camber_wire_skip(&wire, key);
    }
    /* The last nodes may have no tags. */
    while (all.at < all.end && latitudes.at < latitudes.end) {
        latitude += (uint64_t)camber_wire_signed(&latitudes);
        longitude += (uint64_t)camber_wire_signed(&longitudes);
        camber_wire tags = next_tags(&all);
        if (all.bad || longitudes.bad || latitudes.bad)
            break;
        if (!add_point(self, from, &tags, &tags, (const int64_t[2]){(int64_t)longitude, (int64_t)latitude}))
            return false;
    }
    return !(wire.bad || all.bad || longitudes.bad || latitudes.bad) ||
           camber_osm_fail(self->failure, "nodes that do not parse");
}

static bool read_points(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    const reading *all = user;
    decoder self = {.to = slot, .failure = failure};
    camber_osm_entities entities;
    camber_wire group;
    uint64_t key;
    const unsigned kinds = all->desc->file->blobs[part].kinds;
    bool read = true;
    begin_block(all, pass, &self);
    if (kinds && !(kinds & CAMBER_OSM_HAS_NODES))
        return true;
    if (!unpack_block(&self, all, part, &entities))
        return false;
    while (camber_osm_entities_next(&entities, &group)) {
        while (read && camber_wire_next(&group, &key)) {
            if (key == CAMBER_WIRE_KEY(CAMBER_OSM_DENSE, CAMBER_WIRE_BYTES))
                read = read_dense(&self, &entities, camber_wire_bytes(&group));
            else if (key == CAMBER_WIRE_KEY(CAMBER_OSM_NODE, CAMBER_WIRE_BYTES))
                read = read_node(&self, &entities, camber_wire_bytes(&group));
            else
                camber_wire_skip(&group, key);
        }
        if (!read || group.bad)
            return !read ? false : camber_osm_fail(failure, "a group that does not parse");
    }
    return !entities.groups.bad || camber_osm_fail(failure, "a block that does not parse");
}

/* ---- Merging the blocks' ways into the file's ---- */

static camber_status intern(camber_osm_ways *ways, const block *from, uint32_t string, const char **value) {
    *value = NULL;
    if (string == NO_STRING)
        return CAMBER_OK;
    const camber_wire text = string_at(from, string);
    const size_t length = (size_t)(text.end - text.at);
    if (!camber_grow(ways->context, &ways->text, &ways->text_capacity, length + 1, 1))
        return CAMBER_ERROR_MEMORY;
    if (length)
        memcpy(ways->text, text.at, length);
    ways->text[length] = 0;
    return camber_features_intern(ways->features, ways->text, value);
}

/* Interned strings are equal if their pointers are. */
static size_t hash_values(const char *const *values, size_t count) {
    uint64_t hash = 0;
    for (size_t i = 0; i < count; i++)
        hash = camber_mix(hash, (uintptr_t)values[i]);
    return (size_t)(hash ^ hash >> 32);
}

static bool equal_values(const char *const *a, const char *const *b, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (a[i] != b[i])
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

/* Looks up a block's set among the file's sets, or adds it. */
static camber_status add_set(camber_osm_ways *ways, const block *from, const uint32_t *strings, uint32_t *set) {
    const camber_schema *schema = ways->features->schema;
    const size_t count = schema->property_count;
    if (ways->set_count >= UINT32_MAX / CAMBER_OSM_WAY_BITS)
        return camber_fail(ways->context, CAMBER_ERROR_LIMIT,
                           "more than 268435455 different sets of tags; use a style that reads fewer attributes");
    if (!camber_grow(ways->context, &ways->values, &ways->value_capacity, (ways->set_count + 1) * count,
                     sizeof *ways->values))
        return CAMBER_ERROR_MEMORY;
    const char **values = ways->values + ways->set_count * count;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++)
        status = intern(ways, from, strings[i], &values[i]);
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

/* Adds a way of a block, whose leaves begin at first_leaf, to the last run or to a new one. */
static camber_status add_to_run(camber_osm_ways *ways, const camber_osm_way *way, size_t first_leaf) {
    camber_osm_run *last = ways->run_count ? &ways->runs[ways->run_count - 1] : NULL;
    if (!last || last->first_leaf != first_leaf || last->node_count + way->node_count > RUN_NODES) {
        if (!camber_grow(ways->context, &ways->runs, &ways->run_capacity, ways->run_count + 1, sizeof *ways->runs))
            return CAMBER_ERROR_MEMORY;
        last = &ways->runs[ways->run_count++];
        *last = (camber_osm_run){.first_way = ways->way_count, .first_id = ways->node_count, .first_leaf = first_leaf};
    }
    last->way_count++;
    last->node_count += way->node_count;
    ways->node_count += way->node_count;
    return CAMBER_OK;
}

/* Adds the ids that a block names to the nodes of the file. */
static camber_status add_ids(camber_osm_ways *ways, const block *from) {
    const block_leaf *leaves = (const block_leaf *)(const void *)from->leaves.bytes;
    camber_status status = CAMBER_OK;
    if (!camber_grow(ways->context, &ways->ids, &ways->id_capacity, ways->node_count + from->id_count,
                     sizeof *ways->ids) ||
        !camber_grow(ways->context, &ways->leaves, &ways->leaf_capacity, ways->leaf_count + from->leaf_count,
                     sizeof *ways->leaves))
        return CAMBER_ERROR_MEMORY;
    memcpy(ways->ids + ways->node_count, from->ids.bytes, from->id_count * sizeof *ways->ids);
    for (size_t i = 0; i < from->leaf_count && status == CAMBER_OK; i++)
        status =
            camber_osm_node_set_add_leaf(&ways->nodes, leaves[i].id, leaves[i].bits, &ways->leaves[ways->leaf_count++]);
    return status;
}

/* Adds the sets of a block to the file's sets, and stores their indices in ways->local. */
static camber_status add_sets(camber_osm_ways *ways, const block *from) {
    const uint32_t *sets = (const uint32_t *)(const void *)from->sets.bytes;
    if (!camber_grow(ways->context, &ways->local, &ways->local_capacity, from->set_count, sizeof *ways->local))
        return CAMBER_ERROR_MEMORY;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < from->set_count && status == CAMBER_OK; i++)
        status = add_set(ways, from, sets + i * ways->features->schema->property_count, &ways->local[i]);
    return status;
}

/* Records a way that a relation names. */
static camber_status add_member(camber_osm_ways *ways, const camber_osm_way *way, uint32_t index) {
    camber_osm_relations *relations = &ways->relations;
    if (!camber_grow(ways->context, &relations->met, &relations->met_capacity, relations->met_count + 1,
                     sizeof *relations->met))
        return CAMBER_ERROR_MEMORY;
    relations->met[relations->met_count++] = index;
    if (!(way->tags & CAMBER_OSM_WAY_BARE))
        relations->ways[index].set = way->tags / CAMBER_OSM_WAY_BITS + 1;
    return CAMBER_OK;
}

static camber_status add_block(void *user, size_t part, void *slot) {
    camber_osm_ways *ways = ((const reading *)user)->ways;
    const block *from = slot;
    const size_t first_leaf = ways->leaf_count;
    const camber_osm_way *added = (const camber_osm_way *)(const void *)from->ways.bytes;
    const uint32_t *members = (const uint32_t *)(const void *)from->members.bytes;
    size_t member = 0;
    (void)part;
    ways->has_places = ways->has_places || from->has_places;
    if (from->way_count == 0)
        return CAMBER_OK;
    if (!camber_grow(ways->context, &ways->ways, &ways->way_capacity, ways->way_count + from->way_count,
                     sizeof *ways->ways))
        return CAMBER_ERROR_MEMORY;
    camber_status status = add_ids(ways, from);
    if (status == CAMBER_OK)
        status = add_sets(ways, from);
    for (size_t i = 0; i < from->way_count && status == CAMBER_OK; i++) {
        const uint32_t bits = added[i].tags % CAMBER_OSM_WAY_BITS, local = added[i].tags / CAMBER_OSM_WAY_BITS;
        const uint32_t set = bits & CAMBER_OSM_WAY_BARE ? 0 : ways->local[local];
        const camber_osm_way way = {set * CAMBER_OSM_WAY_BITS | bits, added[i].node_count};
        status = add_to_run(ways, &way, first_leaf);
        if (status == CAMBER_OK && bits & CAMBER_OSM_WAY_MEMBER)
            status = add_member(ways, &way, members[member++]);
        ways->ways[ways->way_count++] = way;
    }
    return status;
}

static camber_status add_relations(void *user, size_t part, void *slot) {
    camber_osm_ways *ways = ((const reading *)user)->ways;
    camber_osm_relations *to = &ways->relations;
    const block *from = slot;
    const camber_osm_member *members = (const camber_osm_member *)(const void *)from->members.bytes;
    const camber_osm_relation *added = (const camber_osm_relation *)(const void *)from->relations.bytes;
    (void)part;
    if (from->relation_count == 0)
        return CAMBER_OK;
    if (!camber_grow(ways->context, &to->items, &to->capacity, to->count + from->relation_count, sizeof *to->items) ||
        !camber_grow(ways->context, &to->members, &to->member_capacity, to->member_count + from->member_count,
                     sizeof *to->members))
        return CAMBER_ERROR_MEMORY;
    camber_status status = add_sets(ways, from);
    for (size_t i = 0; i < from->relation_count && status == CAMBER_OK; i++) {
        camber_osm_relation relation = added[i];
        relation.first_member += to->member_count;
        relation.set = relation.is_tagged ? ways->local[relation.set] + 1 : 0;
        to->items[to->count++] = relation;
    }
    for (size_t i = 0; i < from->member_count && status == CAMBER_OK; i++)
        status = camber_osm_node_set_add(&to->ids, members[i].way);
    memcpy(to->members + to->member_count, members, from->member_count * sizeof *members);
    to->member_count += from->member_count;
    return status;
}

static camber_status add_points(void *user, size_t part, void *slot) {
    camber_osm_ways *ways = ((const reading *)user)->ways;
    const block *from = slot;
    const camber_osm_point *added = (const camber_osm_point *)(const void *)from->points.bytes;
    (void)part;
    if (from->point_count == 0)
        return CAMBER_OK;
    if (!camber_grow(ways->context, &ways->points, &ways->point_capacity, ways->point_count + from->point_count,
                     sizeof *ways->points))
        return CAMBER_ERROR_MEMORY;
    const camber_status status = add_sets(ways, from);
    for (size_t i = 0; i < from->point_count && status == CAMBER_OK; i++) {
        camber_osm_point point = added[i];
        point.set = ways->local[point.set];
        ways->points[ways->point_count++] = point;
    }
    return status;
}

/* ---- All passes ---- */

static camber_osm_pass_desc pass_over(reading *all) {
    return (camber_osm_pass_desc){.context = all->ways->context,
                                  .name = all->desc->file->path,
                                  .part_count = all->desc->file->blob_count - all->desc->first_blob,
                                  .threads = all->desc->threads,
                                  .slot_bytes = sizeof(block),
                                  .user = all,
                                  .free_slot = free_block,
                                  .from = all->desc->from,
                                  .to = all->desc->to};
}

camber_status camber_osm_relations_read(camber_osm_ways *ways, const camber_osm_ways_desc *desc, bool *declined) {
    reading all = {ways, desc};
    camber_osm_pass_desc pass = pass_over(&all);
    pass.work = read_relations;
    pass.commit = add_relations;
    const camber_status status = camber_osm_pass_run(&pass, declined);
    return status == CAMBER_OK && !*declined ? camber_osm_relations_complete(&ways->relations) : status;
}

camber_status camber_osm_ways_read(camber_osm_ways *ways, const camber_osm_ways_desc *desc, bool *declined) {
    reading all = {ways, desc};
    camber_osm_pass_desc pass = pass_over(&all);
    pass.work = read_block;
    pass.commit = add_block;
    const camber_status status = camber_osm_pass_run(&pass, declined);
    camber_osm_relations_settle(&ways->relations);
    return status == CAMBER_OK && !*declined ? camber_osm_node_set_complete(&ways->nodes) : status;
}

camber_status camber_osm_points_read(camber_osm_ways *ways, const camber_osm_ways_desc *desc, bool *declined) {
    reading all = {ways, desc};
    camber_osm_pass_desc pass = pass_over(&all);
    pass.part_count = desc->end_blob;
    pass.work = read_points;
    pass.commit = add_points;
    return camber_osm_pass_run(&pass, declined);
}
