#include "cli/results_text.h"

#include <math.h>

static json_t *number_json(double value) {
    if (!isfinite(value))
        return json_string(isnan(value) ? "nan" : value < 0 ? "-inf" : "inf");
    return fabs(value) < 0x1p53 && floor(value) == value ? json_integer((json_int_t)value) : json_real(value);
}

static json_t *text_json(const char *text) {
    return text ? camber_json_text(text) : json_null();
}

static json_t *check_json(const camber_check *check) {
    return json_pack("{s:o, s:o, s:o}", "check", text_json(check->name), "device", text_json(check->device), "backend",
                     text_json(check->backend));
}

static json_t *failure_json(const camber_check *check) {
    const camber_finding *finding = &check->finding;
    json_t *object = check_json(check);
    json_object_set_new(object, "stage", text_json(finding->stage));
    json_object_set_new(object, "polyline", finding->has_point ? camber_json_count(finding->polyline) : json_null());
    json_object_set_new(object, "point", finding->has_point ? camber_json_count(finding->point) : json_null());
    json_object_set_new(object, "field", text_json(finding->field));
    json_object_set_new(object, "got", finding->field ? number_json(finding->got) : json_null());
    json_object_set_new(object, "expected", finding->field ? number_json(finding->expected) : json_null());
    json_object_set_new(object, "difference", text_json(finding->what));
    json_object_set_new(object, "picture", text_json(finding->picture));
    return object;
}

static json_t *bounds_json(const camber_pixel_bounds *bounds) {
    return json_pack("{s:f, s:f, s:f}", "mean", bounds->mean, "past_16", bounds->past_16, "past_64", bounds->past_64);
}

static json_t *pixels_json(const camber_check *check) {
    json_t *object = check_json(check), *has_arc_length = bounds_json(&check->error.of);
    json_object_update(object, has_arc_length);
    json_decref(has_arc_length);
    json_object_set_new(object, "windows", camber_json_count(check->error.windows));
    json_object_set_new(object, "pixels", camber_json_count(check->error.pixels));
    json_object_set_new(object, "max", json_integer(check->error.max));
    json_object_set_new(object, "bounds", bounds_json(&check->most));
    return object;
}

int camber_results_print_json(const camber_results *results, camber_report *report) {
    json_t *failures = json_array(), *skips = json_array(), *pixels = json_array();
    for (size_t i = 0; i < results->count; i++) {
        const camber_check *check = &results->list[i];
        if (check->result == CAMBER_RESULT_FAILED)
            json_array_append_new(failures, failure_json(check));
        if (check->result == CAMBER_RESULT_SKIPPED) {
            json_t *skip = check_json(check);
            json_object_set_new(skip, "reason", text_json(check->reason));
            json_array_append_new(skips, skip);
        }
        if (check->has_error)
            json_array_append_new(pixels, pixels_json(check));
    }
    return camber_report_json(
        report, json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "checks", camber_json_count(results->count), "failed",
                          camber_json_count(results->failed), "skipped", camber_json_count(results->skipped),
                          "failures", failures, "skips", skips, "pixels", pixels));
}
