/* Reads the results of each drawing kernel, or of the CPU twin instead, so that validation can compare them. */
#include "camber_proof.h"
#include "draw/draw_cl.h"
#include "draw/renderer.h"

#include <assert.h>

typedef struct reading {
    bool on_host;
    bool done;
    camber_raster_stages stages;
    camber_raster_area area;
} reading;

static camber_status read_area(camber_renderer *renderer, const camber_raster_scene *scene,
                               const camber_raster_area *area, void *user) {
    camber_context *context = renderer->share.device->context;
    reading *r = user;
    if (r->done)
        return CAMBER_OK;
    r->done = true;
    r->area = *area;
    if (r->on_host)
        return camber_raster_on_host(context, scene, area, &r->stages);
    const camber_status status = camber_raster_draw(renderer->raster, scene, area);
    if (status != CAMBER_OK)
        return status;
    if (camber_raster_slice_count(renderer->raster) > 1)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "the intermediate results of a picture that is drawn in slices are not kept; draw less, or "
                           "allow more memory");
    return camber_raster_read_stages(renderer->raster, &r->stages);
}

static camber_status read_stages(camber_renderer *renderer, const camber_frame *frame, bool on_host,
                                 camber_drawing_stages *stages) {
    reading r = {.on_host = on_host};
    assert(renderer->raster);
    camber_status status = camber_renderer_resolve(renderer, frame);
    if (status == CAMBER_OK)
        status = camber_cl_each_area(renderer, frame, read_area, &r);
    if (status != CAMBER_OK) {
        camber_raster_stages_free(renderer->share.device->context, &r.stages);
        return status;
    }
    *stages = (camber_drawing_stages){
        .context = renderer->share.device->context,
        .segments = r.stages.segments,
        .segment_words = CAMBER_SEGMENT_WORDS,
        .arc_length_words = CAMBER_SEGMENT_ARC_LENGTHS,
        .plane_words = CAMBER_PLANE_WORDS,
        .boxes = r.stages.boxes,
        .arc_lengths = r.stages.arc_lengths,
        .planes = r.stages.planes,
        .segment_count = r.stages.segment_count,
        .starts = r.stages.starts,
        .columns = camber_raster_tiles(r.area.width),
        .rows = camber_raster_tiles(r.area.height),
        .lists = r.stages.lists,
        .rgba = r.stages.rgba,
        .width = r.area.width,
        .height = r.area.height,
    };
    return CAMBER_OK;
}

camber_status camber_renderer_read_stages(camber_renderer *renderer, const camber_frame *frame,
                                          camber_drawing_stages *stages) {
    return read_stages(renderer, frame, false, stages);
}

camber_status camber_drawing_stages_rasterize(camber_renderer *renderer, const camber_frame *frame,
                                              camber_drawing_stages *stages) {
    return read_stages(renderer, frame, true, stages);
}

void camber_drawing_stages_destroy(camber_drawing_stages *stages) {
    camber_context *context = stages->context;
    if (!context)
        return;
    camber_free(context, stages->segments);
    camber_free(context, stages->boxes);
    camber_free(context, stages->arc_lengths);
    camber_free(context, stages->planes);
    camber_free(context, stages->starts);
    camber_free(context, stages->lists);
    camber_free(context, stages->rgba);
    *stages = (camber_drawing_stages){0};
}
