/* What cover.cl draws of a plane that is seen at an angle, of which kernels/cover_pitch.h says what it is. */
#if CAMBER_COVER_PITCHED

static inline void put_tilted(private canvas *c, private const camber_pitch_pen *p, int i, float16 area,
                              private const camber_pitch_pixel *at) {
    c->ink[0][i] *= 1.0f - area;
    float16 nx, ny;
    const int16 thick = camber_pitch_inward(p, at, &nx, &ny);
    const float16 none = (float16)(0.0f), edge = area * (1.0f - area);
    c->ink[1][i] += thick ? area : none;
    c->ink[2][i] += thick ? nx * edge : none;
    c->ink[3][i] += thick ? ny * edge : none;
}

/* As sort_cells. */
static inline void sort_tilted(private const camber_pitch_pen *p, private const places *at, cell_box box, ulong cells,
                               camber_eye eye, private cell_sets *sets) {
    sets->meets = sets->nears = sets->inside = 0;
    for (int j = box.from_y; j <= box.to_y; j += 4)
        for (int i = box.from_x; i <= box.to_x; i += 4) {
            camber_meeting m;
            const int first = CAMBER_TILE_CELLS * j + i;
            if (!(cells >> first & 0x0f0f0f0ful))
                continue;
            camber_pitch_cells_meet(p, at->middle_x[i] - eye.x, at->middle_y[j] - eye.y, &m);
            sets->meets |= (ulong)bits_of(m.meets) << first;
            sets->nears |= (ulong)bits_of(m.nears) << first;
            sets->inside |= (ulong)bits_of(m.inside) << first;
        }
    sets->meets &= cells;
    sets->nears &= sets->meets;
    sets->inside &= sets->meets & ~sets->nears;
}

/* Those that a segment of an ink with features meets. */
static __attribute__((noinline)) void draw_rich_tilted(private canvas *c, private const places *at,
                                                       private const camber_pitch_pen *p, ulong meets, tilted from) {
    camber_extras e;
    camber_image_pen image;
    camber_extras_of(&c->more, 0, from.measure, from.tail, &e);
    if (e.features & CAMBER_FEATURE_IMAGE)
        camber_pitch_image_of(from.tail, 4u * c->more.image, from.measure, p, &image);
    for (ulong left = meets; left; left &= left - 1) {
        const int i = lowest(left);
        camber_pitch_pixel pixels;
        float16 along;
        camber_pitch_look(p, at->x[i % CAMBER_TILE_CELLS] - from.eye.x, at->y[i / CAMBER_TILE_CELLS] - from.eye.y,
                          &pixels);
        const float16 area = camber_pitch_extras_area(p, &e, &pixels, &along);
        if (e.features & CAMBER_FEATURES_COLORS) {
            const float16 reach = camber_pitch_extent(p, &pixels);
            const float range[2] = {-most_of(reach - along), most_of(along + reach)};
            float16 color[4] = {(float16)(1.0f), (float16)(1.0f), (float16)(1.0f), (float16)(1.0f)};
            if (e.features & CAMBER_FEATURE_RAMP)
                camber_pitch_ramp(p, &e, &pixels, along, range, color);
            if (e.features & CAMBER_FEATURE_IMAGE) {
                camber_image_spot spot;
                float16 rgba[4];
                camber_pitch_spot(p, &pixels, &spot);
                camber_line_image(from.tail, &image, &spot, rgba);
                for (int channel = 0; channel < 4; channel++)
                    color[channel] *= rgba[channel];
            }
            put_colors(c, i, area, color, 0);
            continue;
        }
        c->inked |= 1ul << i;
        if (c->now.mode == CAMBER_INK_UNION)
            put_tilted(c, p, i, area, &pixels);
        else
            put_over(c, i, area, c->now.a);
    }
}

/* As draw_segment. */
static inline void draw_tilted(private canvas *c, private const places *at, place where, tilted from) {
    cell_box box;
    cell_sets sets;
    camber_pitch_pen p;
    const ulong cells = box_of(from.shape, where, &box) & ~(c->done | c->filled);
    const int is_union = c->now.mode == CAMBER_INK_UNION;
    if (!cells)
        return;
    if (c->more.features & CAMBER_FEATURE_IMAGE && from.plane[CAMBER_PLANE_HALF_WIDTH] >= CAMBER_FILL_PX) {
        fill_with_images(c, at, from.eye, from.tail);
        return;
    }
    camber_pitch_pen_of(from.eye, from.shape, from.plane, as_uint(from.shape[CAMBER_SHAPE_FLAGS]), &p);
    sort_tilted(&p, at, box, cells, from.eye, &sets);
    if (c->more.features) {
        draw_rich_tilted(c, at, &p, sets.meets, from);
        return;
    }
    for (ulong left = sets.meets & ~sets.inside; left; left &= left - 1) {
        const int i = lowest(left);
        const float16 x = at->x[i % CAMBER_TILE_CELLS] - from.eye.x, y = at->y[i / CAMBER_TILE_CELLS] - from.eye.y;
        camber_pitch_pixel pixels;
        if (!is_union && !(sets.nears >> i & 1ul)) {
            put_over(c, i, camber_pitch_side(&p, x, y), c->now.a);
            continue;
        }
        camber_pitch_look(&p, x, y, &pixels);
        const float16 area = camber_pitch_area(&p, &pixels);
        if (is_union)
            put_tilted(c, &p, i, area, &pixels);
        else
            put_over(c, i, area, c->now.a);
    }
    if (sets.inside)
        put_whole(c, sets.inside);
    c->inked |= sets.meets;
}

#endif
