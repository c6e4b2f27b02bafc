#include "property.h"

static const double QUANTUM_PX = 1.0 / 256;

/* ---- Makers ---- */

static void add_point(property_case *c, double x, double y) {
    assert_true(c->count < PROPERTY_POINTS);
    c->points[2 * c->count] = (float)(round(x / QUANTUM_PX) * QUANTUM_PX);
    c->points[2 * c->count++ + 1] = (float)(round(y / QUANTUM_PX) * QUANTUM_PX);
}

/* How a walk goes: steps are as likely to be twice as half as long. */
typedef struct gait {
    double least_px, most_px; /* of a step */
    double turn;              /* radians at most */
} gait;

/* Turns back where it would leave the middle of the picture. */
static void add_walk(property_case *c, uint64_t *seed, size_t count, const gait *g) {
    const double least = 20, most = PROPERTY_SIDE_PX - 20;
    double x = random_between(seed, least, most), y = random_between(seed, least, most);
    double direction = random_between(seed, -SCENE_PI, SCENE_PI);
    add_point(c, x, y);
    for (size_t i = 1; i < count; i++) {
        const double step = exp(random_between(seed, log(g->least_px), log(g->most_px)));
        double turned = direction + random_between(seed, -g->turn, g->turn);
        for (int tries = 0; tries < 32; tries++) {
            const double u = x + step * cos(turned), v = y + step * sin(turned);
            if (u >= least && u <= most && v >= least && v <= most)
                break;
            turned = direction + random_between(seed, -g->turn, g->turn);
        }
        const double u = x + step * cos(turned), v = y + step * sin(turned);
        if (u < least || u > most || v < least || v > most)
            return;
        direction = turned;
        add_point(c, x = u, y = v);
    }
}

static void add_grid(property_case *c, uint64_t *seed, size_t count) {
    const double pitch = (double)(1 + random_below(seed, 20));
    for (size_t i = 0; i < count; i++) {
        const double x = 64 + pitch * ((double)random_below(seed, 5) - 2);
        add_point(c, x, 64 + pitch * ((double)random_below(seed, 5) - 2));
    }
}

static void add_ring(property_case *c, uint64_t *seed, double least_radius) {
    const size_t sides = 3 + random_below(seed, 12);
    const double begin = random_between(seed, 0, 2 * SCENE_PI), sign = random_below(seed, 2) ? 1 : -1;
    const double x = random_between(seed, 60, 68), y = random_between(seed, 60, 68);
    for (size_t i = 0; i < sides; i++) {
        const double angle = begin + sign * 2 * SCENE_PI * (double)i / (double)sides;
        const double radius = random_between(seed, least_radius, fmax(least_radius * 1.3, 40));
        add_point(c, x + radius * cos(angle), y + radius * sin(angle));
    }
    add_point(c, (double)c->points[0], (double)c->points[1]);
}

static void make_stroke(property_case *c, uint64_t *seed) {
    static const float widths_px[] = {0.4f, 1, 1.5f, 2, 3, 5, 8, 12, 20};
    static const float limits[] = {0, 1.2f, 2, 4, 10};
    const size_t kind = random_below(seed, 27);
    *c = (property_case){.stroke = {widths_px[random_below(seed, 9)], (camber_join)(kind % 3),
                                    (camber_cap)(kind / 3 % 3), limits[random_below(seed, 5)]},
                         .method = (camber_method)(kind / 9)};
    c->dice = random_bits(seed);
}

void property_make_any(property_case *c, uint64_t *seed) {
    static const gait gaits[] = {{8, 30, 0.6}, {1, 40, 3.14159}, {0.05, 3, 1.5}, {0.01, 50, 2.5}};
    make_stroke(c, seed);
    const size_t kind = random_below(seed, 8), count = 2 + random_below(seed, 22);
    if (kind < 4)
        add_walk(c, seed, count, &gaits[kind]);
    else if (kind < 6)
        add_grid(c, seed, count);
    else if (kind < 7)
        add_ring(c, seed, random_between(seed, 0.5, 30));
    else
        add_walk(c, seed, 1 + random_below(seed, 2), &gaits[random_below(seed, 4)]);
}

void property_make_plain(property_case *c, uint64_t *seed) {
    make_stroke(c, seed);
    const double least = 2 * (double)c->stroke.width_px + 3;
    add_walk(c, seed, 2 + random_below(seed, 10), &(gait){least, fmax(30, 1.2 * least), 1.7});
}

void property_make_crossing(property_case *c, uint64_t *seed) {
    make_stroke(c, seed);
    const double least = (double)c->stroke.width_px + 0.1;
    add_walk(c, seed, 2 + random_below(seed, 14), &(gait){least, fmax(50, 1.2 * least), SCENE_PI});
}

void property_make_ring(property_case *c, uint64_t *seed) {
    make_stroke(c, seed);
    add_ring(c, seed, 30);
}

bool property_is_ring(const property_case *c) {
    return c->count > 2 && memcmp(c->points, c->points + 2 * (c->count - 1), 2 * sizeof *c->points) == 0;
}

void property_reverse(property_case *c) {
    for (size_t i = 0, k = c->count - 1; i < k; i++, k--) {
        const float x = c->points[2 * i], y = c->points[2 * i + 1];
        c->points[2 * i] = c->points[2 * k], c->points[2 * i + 1] = c->points[2 * k + 1];
        c->points[2 * k] = x, c->points[2 * k + 1] = y;
    }
}

/* ---- Meshes of cases ---- */

camber_polylines *property_polylines(camber_context *context, const property_case *c) {
    const uint32_t offsets[] = {0, (uint32_t)c->count};
    const camber_polylines_desc desc = {c->points, c->count, offsets, 1, NULL, false};
    camber_polylines *polylines = NULL;
    assert_int_equal(camber_polylines_create(context, &desc, &polylines), CAMBER_OK);
    return polylines;
}

camber_mesh_data property_mesh(camber_context *context, const property_case *c) {
    const camber_tessellation_desc desc = {&c->stroke, 1, c->method, 0, false};
    camber_polylines *polylines = property_polylines(context, c);
    camber_mesh_data data;
    assert_int_equal(camber_tessellate_on_host(context, polylines, &desc, &data), CAMBER_OK);
    camber_polylines_destroy(polylines);
    return data;
}

/* Writes the triangles as triples of indices, in the order and winding that GL draws them with; gives how many. */
size_t property_triangles(const camber_mesh_data *data, uint32_t (**triangles)[3]) {
    uint32_t(*list)[3] = malloc((data->info.index_count + 1) * sizeof *list);
    assert_non_null(list);
    size_t count = 0;
    for (size_t i = 0; i < data->info.index_count; i++) {
        const uint32_t *at = data->indices + i;
        if (!camber_mesh_data_draws(data, i))
            continue;
        const bool odd = data->info.strips && i % 2;
        list[count][0] = at[odd ? 1 : 0], list[count][1] = at[odd ? 0 : 1], list[count][2] = at[2];
        count++;
    }
    *triangles = list;
    return count;
}

/* Where a vertex lies when drawn with this width: the formula of camber_vertex. */
void property_place(const camber_vertex *v, double width_px, double place[2]) {
    const double g = width_px / 2 + (double)CAMBER_PAD_PX, length = hypot((double)v->dx, (double)v->dy);
    const double ux = length > 0 ? (double)v->dx / length : 1, uy = length > 0 ? (double)v->dy / length : 0;
    const double limit = (double)v->limit_px, along = fmax(-limit, fmin(limit, (double)v->along * g));
    const double across = v->across / 16384.0 * g;
    place[0] = (double)v->x + ux * along - uy * across;
    place[1] = (double)v->y + uy * along + ux * across;
}

/* ---- Shrinking ---- */

typedef struct hunt {
    const property *property;
    void *user;
    property_case least;
    char story[PROPERTY_STORY];
} hunt;

static bool take_if_broken(hunt *h, const property_case *smaller) {
    char story[PROPERTY_STORY] = "";
    if (h->property->check(h->user, smaller, story) != PROPERTY_BROKEN)
        return false;
    h->least = *smaller;
    memcpy(h->story, story, sizeof story);
    return true;
}

/* Leaves out runs of points, long ones first, as long as any can be. */
static void drop_points(hunt *h) {
    for (size_t run = h->least.count / 2; run > 0; run /= 2)
        for (size_t first = 0; first + run <= h->least.count && h->least.count > 1;) {
            property_case smaller = h->least;
            memmove(smaller.points + 2 * first, smaller.points + 2 * (first + run),
                    2 * (smaller.count - first - run) * sizeof *smaller.points);
            smaller.count -= run;
            if (smaller.count == 0 || !take_if_broken(h, &smaller))
                first++;
        }
}

static void round_points(hunt *h) {
    static const float steps_px[] = {8, 1, 0.25f};
    for (size_t i = 0; i < 2 * h->least.count; i++)
        for (size_t k = 0; k < 3; k++) {
            property_case simpler = h->least;
            simpler.points[i] = roundf(simpler.points[i] / steps_px[k]) * steps_px[k];
            if (simpler.points[i] == h->least.points[i] || take_if_broken(h, &simpler))
                break;
        }
}

static void simplify_stroke(hunt *h) {
    property_case simpler = h->least;
    simpler.stroke.join = CAMBER_JOIN_ROUND;
    take_if_broken(h, &simpler);
    simpler = h->least;
    simpler.stroke.cap = CAMBER_CAP_BUTT;
    take_if_broken(h, &simpler);
    simpler = h->least;
    simpler.stroke.miter_limit = 0;
    take_if_broken(h, &simpler);
}

static void shrink(hunt *h) {
    for (size_t before = SIZE_MAX; h->least.count < before;) {
        before = h->least.count;
        drop_points(h);
        simplify_stroke(h);
    }
    round_points(h);
    drop_points(h);
}

/* ---- Printing and checking ---- */

static void print_case(const property_case *c) {
    static const char *const joins[] = {"ROUND", "MITER", "BEVEL"}, *const caps[] = {"BUTT", "ROUND", "SQUARE"};
    static const char *const methods[] = {"STRIP", "KITE", "FAN"};
    printf("#   static const float points[%zu][2] = {", c->count);
    for (size_t i = 0; i < c->count; i++)
        printf("%s{%.9g, %.9g}", i ? ", " : "", (double)c->points[2 * i], (double)c->points[2 * i + 1]);
    printf("};\n#   static const camber_stroke stroke = {%.9g, CAMBER_JOIN_%s, CAMBER_CAP_%s, %.9g}; /* "
           "CAMBER_METHOD_%s */\n",
           (double)c->stroke.width_px, joins[c->stroke.join], caps[c->stroke.cap], (double)c->stroke.miter_limit,
           methods[c->method]);
}

static uint64_t number_from(const char *name, uint64_t otherwise) {
    const char *text = getenv(name);
    return text && *text ? strtoull(text, NULL, 0) : otherwise;
}

/* Seeds that follow each other give cases that have nothing in common. splitmix64, S. Vigna. */
static uint64_t mix(uint64_t seed) {
    seed = (seed ^ seed >> 30) * 0xbf58476d1ce4e5b9ull;
    seed = (seed ^ seed >> 27) * 0x94d049bb133111ebull;
    return (seed ^ seed >> 31) | 1;
}

void property_check(const property *p, void *user) {
    enum { PRINTED = 3 };
    const uint64_t first_seed = number_from("CAMBER_SEED", 1000);
    const size_t cases = (size_t)number_from("CAMBER_CASES", p->cases);
    /* Counted with the seeds that are tried each time; others may give some more. */
    const bool elsewhere = getenv("CAMBER_SEED") || getenv("CAMBER_CASES");
    const size_t known = elsewhere ? (3 * p->known * cases + p->cases - 1) / p->cases : p->known;
    size_t broken = 0, silent = 0;
    for (size_t i = 0; i < cases; i++) {
        hunt h = {.property = p, .user = user};
        uint64_t state = mix(first_seed + i);
        property_case c;
        p->make(&c, &state);
        const property_outcome outcome = p->check(user, &c, h.story);
        silent += outcome == PROPERTY_SILENT;
        if (outcome != PROPERTY_BROKEN || broken++ >= PRINTED)
            continue;
        h.least = c;
        shrink(&h);
        printf("# %s is broken; CAMBER_SEED=%llu CAMBER_CASES=1 shows it again. Of %zu points %zu are left: %s\n",
               p->name, (unsigned long long)(first_seed + i), c.count, h.least.count, h.story);
        print_case(&h.least);
    }
    printf("# %s: %zu cases, it does not speak of %zu, broken by %zu (known: %zu)\n", p->name, cases, silent, broken,
           known);
    assert_true(broken <= known);
    assert_true(cases < 20 || 4 * (cases - silent) >= cases);
}
