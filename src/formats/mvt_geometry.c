/* Converts the drawing commands of one feature of a vector tile to lines in world coordinates.
 *
 * Input: 32-bit words with commands (move, line, close) and zigzag-coded deltas. Output: points, and where each line
 * ends. Reading stops at a command that makes no sense; the lines before it stay.
 */
#include "formats/mvt_geometry.h"

enum { MOVE_TO = 1, LINE_TO = 2, CLOSE_PATH = 7 };

typedef struct pen {
    camber_mvt_geometry *geometry;
    const camber_mvt_commands *commands;
    int64_t x, y; /* the sum of 2^26 words of at most 2^31 each cannot overflow */
    size_t first; /* the first point of the open line */
    bool closed;
} pen;

static bool add_world_point(camber_mvt_geometry *geometry, double x, double y) {
    if (!camber_grow(geometry->context, &geometry->points, &geometry->point_capacity, geometry->point_count + 1,
                     2 * sizeof *geometry->points))
        return false;
    geometry->points[2 * geometry->point_count] = x;
    geometry->points[2 * geometry->point_count + 1] = y;
    geometry->point_count++;
    return true;
}

/* Adds the pen's position as a point. It is exact at a tile's corner, and everywhere on a grid whose size is a power of
 * two. */
static bool add_point(const pen *p) {
    const camber_mvt_commands *c = p->commands;
    return add_world_point(p->geometry, (c->column + (double)p->x / c->extent) / c->side,
                           (c->row + (double)p->y / c->extent) / c->side);
}

static void note_damage(camber_mvt_geometry *geometry, const char *damage) {
    if (!geometry->damage)
        geometry->damage = damage;
}

static bool add_first_again(const pen *p) {
    const double x = p->geometry->points[2 * p->first], y = p->geometry->points[2 * p->first + 1];
    return add_world_point(p->geometry, x, y);
}

static bool end_line(pen *p) {
    camber_mvt_geometry *geometry = p->geometry;
    const bool point = p->commands->kind == CAMBER_GEOMETRY_POINT;
    const bool ring = !point && p->commands->kind != CAMBER_GEOMETRY_LINE;
    const size_t count = geometry->point_count - p->first;
    if (count == 0)
        return true;
    if (ring && !p->closed)
        note_damage(geometry, "a ring that is not closed");
    if (count < (ring ? 3u : point ? 1u : 2u)) {
        note_damage(geometry, ring ? "a ring of one point" : "a line of one point");
        geometry->point_count = p->first;
        return true;
    }
    if (p->commands->kind == CAMBER_GEOMETRY_AREA && !p->closed) {
        geometry->closed_rings++;
        if (!add_first_again(p))
            return false;
    }
    if (!camber_grow(geometry->context, &geometry->ends, &geometry->line_capacity, geometry->line_count + 1,
                     sizeof *geometry->ends))
        return false;
    geometry->ends[geometry->line_count++] = p->first = geometry->point_count;
    return true;
}

static int64_t unzigzag(uint32_t word) {
    return (int64_t)(word >> 1) ^ -(int64_t)(word & 1);
}

static bool close_ring(pen *p) {
    camber_mvt_geometry *geometry = p->geometry;
    const camber_geometry_kind kind = p->commands->kind;
    if (kind == CAMBER_GEOMETRY_LINE || kind == CAMBER_GEOMETRY_POINT || geometry->point_count == p->first) {
        note_damage(geometry, "a close command outside a ring");
        return true;
    }
    p->closed = true;
    return add_first_again(p) && end_line(p);
}

/* Executes one command, whose count points begin at `words`. */
static bool run_command(pen *p, uint32_t command, const uint32_t *words, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (command == MOVE_TO) {
            if (!end_line(p))
                return false;
            p->first = p->geometry->point_count;
            p->closed = false;
        } else if (p->geometry->point_count == p->first) {
            note_damage(p->geometry, "a line that starts nowhere");
            return true;
        }
        p->x += unzigzag(words[2 * i]);
        p->y += unzigzag(words[2 * i + 1]);
        if (!add_point(p))
            return false;
    }
    return true;
}

camber_status camber_mvt_geometry_read(camber_mvt_geometry *geometry, const camber_mvt_commands *commands) {
    geometry->point_count = geometry->line_count = geometry->closed_rings = 0;
    geometry->damage = NULL;
    pen p = {.geometry = geometry, .commands = commands};
    bool fits = true;
    for (size_t i = 0; i < commands->count && fits;) {
        const uint32_t command = commands->words[i] & 7;
        size_t count = commands->words[i++] >> 3;
        if (command == CLOSE_PATH) {
            fits = close_ring(&p);
            continue;
        }
        if (command != MOVE_TO && command != LINE_TO) {
            note_damage(geometry, "an unknown command");
            break;
        }
        if (count == 0)
            note_damage(geometry, "a command without points");
        if (count > (commands->count - i) / 2) {
            note_damage(geometry, "fewer points than the command announces");
            count = (commands->count - i) / 2;
            fits = run_command(&p, command, commands->words + i, count);
            break;
        }
        fits = run_command(&p, command, commands->words + i, count);
        i += 2 * count;
    }
    return fits && end_line(&p) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

void camber_mvt_geometry_free(camber_mvt_geometry *geometry) {
    camber_free(geometry->context, geometry->ends);
    camber_free(geometry->context, geometry->points);
    *geometry = (camber_mvt_geometry){0};
}
