/* Runs `camber info`: prints devices, GL back ends, how buffers are shared, versions and formats, as text or JSON. A
 * missing part is not a failure: the reason is printed in its place. */
#include "cli/verbs.h"

#include <stdlib.h>
#include <string.h>

static json_t *device_json(const camber_device_info *info) {
    const char *type = info->type == CAMBER_DEVICE_TYPE_CPU   ? "cpu"
                       : info->type == CAMBER_DEVICE_TYPE_GPU ? "gpu"
                                                              : "other";
    return json_pack("{s:o, s:o, s:o, s:o, s:s, s:I, s:I, s:I, s:b, s:b}", "name", camber_json_text(info->name),
                     "platform", camber_json_text(info->platform), "version", camber_json_text(info->version), "driver",
                     camber_json_text(info->driver), "type", type, "compute_units", (json_int_t)info->compute_units,
                     "memory_bytes", (json_int_t)info->memory_bytes, "largest_buffer_bytes",
                     (json_int_t)info->largest_buffer_bytes, "gl_sharing", info->gl_sharing, "fixed_kernels",
                     info->fixed_kernels);
}

/* Takes the message of the last failure out of the report, so that it is not printed again. */
static json_t *take_error(camber_report *report, camber_status status) {
    json_t *text = camber_json_text(report->error[0] ? report->error : camber_status_get_name(status));
    report->error[0] = 0;
    return text;
}

static void add_devices(camber_session *session, json_t *object) {
    json_t *list = json_array();
    json_object_set_new(object, "devices", list);
    const camber_device_info *info = NULL;
    camber_status status = camber_device_list(session->context, NULL, 0, &info);
    for (size_t i = 1; status == CAMBER_OK && info; i++) {
        json_array_append_new(list, device_json(info));
        status = camber_device_list(session->context, NULL, i, &info);
    }
    if (status != CAMBER_OK)
        json_object_set_new(object, "devices_error", take_error(session->report, status));
}

/* Adds why no device is OpenCL's, if that is so: listing the others is no error. */
static void add_opencl(camber_session *session, json_t *object) {
    const json_t *list = json_object_get(object, "devices"), *entry;
    size_t i;
    if (json_object_get(object, "devices_error"))
        return; /* it would be the same error */
    json_array_foreach(list, i, entry) {
        const char *version = json_string_value(json_object_get(entry, "version"));
        if (version && strncmp(version, "OpenCL", strlen("OpenCL")) == 0)
            return;
    }
    const camber_device_desc desc = {.match = "opencl"};
    camber_device *device = NULL;
    const camber_status status = camber_device_create(session->context, &desc, &device);
    camber_device_destroy(device);
    if (status != CAMBER_OK)
        json_object_set_new(object, "opencl_error", take_error(session->report, status));
}

static void add_backends(camber_session *session, json_t *object) {
    static const struct {
        camber_backend backend;
        const char *name;
    } backends[] = {{CAMBER_BACKEND_EGL, "egl"}, {CAMBER_BACKEND_OSMESA, "osmesa"}};
    json_t *list = json_array();
    json_object_set_new(object, "backends", list);
    for (size_t i = 0; i < sizeof backends / sizeof *backends; i++) {
        const camber_surface_desc desc = {.backend = backends[i].backend};
        camber_surface *surface = NULL;
        const camber_status status = camber_surface_create(session->context, &desc, &surface);
        json_t *entry = json_pack("{s:s, s:b}", "backend", backends[i].name, "available", status == CAMBER_OK);
        json_array_append_new(list, entry);
        if (status != CAMBER_OK) {
            json_object_set_new(entry, "error", take_error(session->report, status));
            continue;
        }
        const camber_surface_info info = camber_surface_get_info(surface);
        json_object_set_new(entry, "name", camber_json_text(info.backend));
        json_object_set_new(entry, "gl_renderer", camber_json_text(info.renderer));
        json_object_set_new(entry, "gl_version", camber_json_text(info.version));
        json_object_set_new(entry, "largest_target_px", json_integer(info.largest_target_px));
        json_object_set_new(entry, "software", json_boolean(info.software));
        json_object_set_new(entry, "buffer_storage", json_boolean(info.buffer_storage));
        camber_surface_destroy(surface);
    }
}

/* Adds the rasterizer that would draw a picture, and why. */
static void add_choice(camber_session *session, json_t *object) {
    const camber_status status = camber_session_open(session, CAMBER_NEEDS_RENDERER);
    camber_session_describe(session, object);
    if (status != CAMBER_OK)
        json_object_set_new(object, "unavailable", take_error(session->report, status));
}

static void add_formats(json_t *object) {
    json_t *list = json_array();
    json_object_set_new(object, "formats", list);
#ifdef CAMBER_MAP
    const char *version = camber_gdal_get_version();
    json_object_set_new(object, "gdal", version ? camber_json_text(version) : json_null());
    const char *name;
    for (size_t i = 0; (name = camber_format_list(i)) != NULL; i++)
        json_array_append_new(list, camber_json_text(name));
#endif
}

static const char *text_of(const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "none";
}

static void print_formats(const json_t *object) {
    const json_t *list = json_object_get(object, "formats");
    if (json_array_size(list) == 0) {
        puts("formats   polylines in pixels (this build reads no maps)");
        return;
    }
    size_t column = 100;
    for (size_t i = 0; i < json_array_size(list); i++) {
        const char *name = json_string_value(json_array_get(list, i));
        if (!name)
            continue;
        const bool wraps = column + strlen(name) + 2 > 100;
        if (i > 0)
            fputs(wraps ? ",\n" : ", ", stdout);
        if (wraps)
            column = (size_t)printf("%-10s", i > 0 ? "" : "formats");
        column += (size_t)printf("%s", name) + 2;
    }
    puts("");
}

static void print_text(const json_t *object) {
    printf("camber    %s\n", text_of(object, "camber"));
    const json_t *list = json_object_get(object, "devices");
    const json_t *entry;
    size_t i;
    json_array_foreach(list, i, entry) {
        printf("device    %s (%s, %s, driver %s)\n", text_of(entry, "name"), text_of(entry, "platform"),
               text_of(entry, "version"), text_of(entry, "driver"));
        printf("          %s, %lld compute units, %.1f GB, largest buffer %.1f GB%s\n", text_of(entry, "type"),
               (long long)json_integer_value(json_object_get(entry, "compute_units")),
               (double)json_integer_value(json_object_get(entry, "memory_bytes")) / 1e9,
               (double)json_integer_value(json_object_get(entry, "largest_buffer_bytes")) / 1e9,
               json_is_true(json_object_get(entry, "gl_sharing")) ? ", cl_khr_gl_sharing" : "");
    }
    if (i == 0)
        printf("device    none: %s\n",
               json_object_get(object, "devices_error")
                   ? text_of(object, "devices_error")
                   : "no device here; install a driver of OpenCL, or build camber where clang is");
    if (json_object_get(object, "opencl_error"))
        printf("OpenCL    not available: %s\n", text_of(object, "opencl_error"));
    json_array_foreach(json_object_get(object, "backends"), i, entry) {
        if (json_is_true(json_object_get(entry, "available")))
            printf("GL        %s: %s, %s, targets up to %lld px\n", text_of(entry, "name"),
                   text_of(entry, "gl_renderer"), text_of(entry, "gl_version"),
                   (long long)json_integer_value(json_object_get(entry, "largest_target_px")));
        else
            printf("GL        %s: not available: %s\n", text_of(entry, "backend"), text_of(entry, "error"));
    }
    if (json_object_get(object, "draw"))
        printf("draw      %s: %s\n", text_of(object, "draw"), text_of(object, "draw_reason"));
    if (json_object_get(object, "unavailable"))
        printf("sharing   none: %s\n", text_of(object, "unavailable"));
    else if (strcmp(text_of(object, "draw"), "cl") == 0)
        printf("sharing   none: GL is not used\n");
    else
        printf("sharing   %s, between %s and %s\n", text_of(object, "sharing"), text_of(object, "device"),
               text_of(object, "gl_renderer"));
    const json_t *gdal = json_object_get(object, "gdal");
    if (gdal)
        printf("GDAL      %s\n", json_is_null(gdal) ? "none: install it (Debian: gdal-bin) to read more formats"
                                                    : json_string_value(gdal));
    print_formats(object);
}

int camber_verb_info(camber_session *session) {
    const int status = camber_session_need(session, CAMBER_NEEDS_CONTEXT);
    if (status != CAMBER_EXIT_DONE)
        return status;
    if (session->options->warm)
        return camber_warm(session);
    json_t *object = json_pack("{s:s}", "camber", camber_version());
    if (!object)
        return camber_report_json(session->report, NULL);
    add_formats(object); /* must come first, because libraries load faster before drivers have started threads */
    add_devices(session, object);
    add_opencl(session, object);
    add_backends(session, object);
    add_choice(session, object);
    if (session->options->json)
        return camber_report_json(session->report, object);
    print_text(object);
    const size_t devices = json_array_size(json_object_get(object, "devices"));
    json_decref(object);
    const int printed = camber_report_flush(session->report);
    if (printed == CAMBER_EXIT_DONE)
        camber_report_done(session->report, "info", 0, camber_session_elapsed_ms(session), "%s device%s",
                           camber_figure_count(devices).text, camber_plural(devices));
    return printed;
}
