/* Mapnik's renderer over lines or areas in memory: a symbolizer as a style would have it, neither simplified nor
 * smoothed; by one thread, and by stripes, each a map of its own over the same lines. */
#include "peers/labels.h"
#include "peers/layers.h"
#include "peers/peer.h"

#include <mapnik/agg_renderer.hpp>
#include <mapnik/feature.hpp>
#include <mapnik/feature_factory.hpp>
#include <mapnik/feature_type_style.hpp>
#include <mapnik/font_engine_freetype.hpp>
#include <mapnik/image.hpp>
#include <mapnik/layer.hpp>
#include <mapnik/load_map.hpp>
#include <mapnik/map.hpp>
#include <mapnik/memory_datasource.hpp>
#include <mapnik/rule.hpp>
#include <mapnik/symbolizer.hpp>
#include <mapnik/unicode.hpp>
#include <mapnik/version.hpp>

#include <chrono>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

namespace {

/* A map unit a pixel, y up. */
template <typename line_type>
line_type make_line(const camber_lines &lines, std::size_t polyline, double shift_px = 0) {
    const std::size_t first = lines.offsets[polyline], end = lines.offsets[polyline + 1];
    line_type line;
    line.reserve(end - first);
    for (std::size_t k = first; k < end; k++)
        line.emplace_back(static_cast<double>(lines.points[2 * k]) - shift_px,
                          BENCH_SIDE_PX + shift_px - static_cast<double>(lines.points[2 * k + 1]));
    return line;
}

/* Of an outer ring and its holes: the polylines [first, end). */
mapnik::geometry::polygon<double> make_area(const camber_lines &lines, std::size_t first, std::size_t end,
                                            double shift_px = 0) {
    mapnik::geometry::polygon<double> polygon;
    for (std::size_t k = first; k < end; k++) {
        auto ring = make_line<mapnik::geometry::linear_ring<double>>(lines, k, shift_px);
#if MAPNIK_MAJOR_VERSION >= 4
        polygon.push_back(std::move(ring));
#else
        if (k == first)
            polygon.set_exterior_ring(std::move(ring));
        else
            polygon.add_hole(std::move(ring));
#endif
    }
    return polygon;
}

std::shared_ptr<mapnik::memory_datasource> make_source(const bench_peer_frame &frame) {
    const camber_lines &lines = *frame.lines;
    mapnik::parameters parameters;
    parameters["type"] = "memory";
    const auto source = std::make_shared<mapnik::memory_datasource>(parameters);
    const auto context = std::make_shared<mapnik::context_type>();
    for (std::size_t i = 0; i < bench_peer_part_count(&frame); i++) {
        if (!frame.areas && lines.offsets[i + 1] - lines.offsets[i] < 2)
            continue;
        const mapnik::feature_ptr feature =
            mapnik::feature_factory::create(context, static_cast<mapnik::value_integer>(i + 1));
        if (frame.areas)
            feature->set_geometry(make_area(lines, frame.areas[i], frame.areas[i + 1]));
        else
            feature->set_geometry(make_line<mapnik::geometry::line_string<double>>(lines, i));
        source->push(feature);
    }
    return source;
}

mapnik::rule make_rule(const bench_peer_frame &frame) {
    mapnik::rule rule;
    if (frame.areas) {
        mapnik::polygon_symbolizer symbolizer;
        mapnik::put(symbolizer, mapnik::keys::fill, mapnik::color(0, 0, 0));
        rule.append(std::move(symbolizer));
        return rule;
    }
    mapnik::line_symbolizer symbolizer;
    mapnik::put(symbolizer, mapnik::keys::stroke, mapnik::color(0, 0, 0));
    mapnik::put(symbolizer, mapnik::keys::stroke_width, static_cast<double>(frame.width_px));
    mapnik::put(symbolizer, mapnik::keys::stroke_linejoin, mapnik::line_join_enum::ROUND_JOIN);
    mapnik::put(symbolizer, mapnik::keys::stroke_linecap, mapnik::line_cap_enum::BUTT_CAP);
    rule.append(std::move(symbolizer));
    return rule;
}

mapnik::Map make_map(const bench_peer_frame &frame) {
    mapnik::Map map(BENCH_SIDE_PX, BENCH_SIDE_PX, "epsg:3857");
    map.set_background(mapnik::color(255, 255, 255));
    mapnik::feature_type_style style;
    style.add_rule(make_rule(frame));
    map.insert_style("lines", std::move(style));
    mapnik::layer layer("lines", "epsg:3857");
    layer.set_datasource(make_source(frame));
    layer.add_style("lines");
    map.add_layer(std::move(layer));
    map.zoom_to_box(mapnik::box2d<double>(0, 0, BENCH_SIDE_PX, BENCH_SIDE_PX));
    return map;
}

double render(const mapnik::Map &map, uint8_t *rgba) {
    const auto begin = std::chrono::steady_clock::now();
    mapnik::image_rgba8 image(BENCH_SIDE_PX, BENCH_SIDE_PX);
    mapnik::agg_renderer<mapnik::image_rgba8> renderer(map, image);
    renderer.apply();
    const auto end = std::chrono::steady_clock::now();
    std::memcpy(rgba, image.bytes(), image.size());
    return std::chrono::duration<double, std::milli>(end - begin).count();
}

double draw(const bench_peer_frame *frame) {
    try {
        return render(make_map(*frame), frame->rgba);
    } catch (const std::exception &) {
        return -1;
    }
}

/* ---- Stripes ---- */

struct stripe {
    mapnik::Map map;
    mapnik::image_rgba8 image;
};

bool draw_stripe(void *user, std::size_t part) {
    stripe &one = (*static_cast<std::vector<stripe> *>(user))[part];
    try {
        one.image = mapnik::image_rgba8(BENCH_SIDE_PX, static_cast<int>(one.map.height()));
        mapnik::agg_renderer<mapnik::image_rgba8> renderer(one.map, one.image);
        renderer.apply();
        return true;
    } catch (const std::exception &) {
        return false;
    }
}

/* Each thread draws rows of the map, which is of the whole picture: a copy of it has the same layers' lines. Lines
 * beside its rows reach into them by up to buffer_px. */
double render_stripes(const mapnik::Map &map, int buffer_px, uint8_t *rgba) {
    std::vector<stripe> stripes;
    for (std::size_t i = 0; i < bench_stripe_count(); i++) {
        const int first = bench_stripe_first_row(i), end = bench_stripe_first_row(i + 1);
        stripes.push_back({map, {}});
        stripes[i].map.resize(BENCH_SIDE_PX, end - first);
        stripes[i].map.set_buffer_size(buffer_px);
        stripes[i].map.zoom_to_box(mapnik::box2d<double>(0, BENCH_SIDE_PX - end, BENCH_SIDE_PX, BENCH_SIDE_PX - first));
    }
    const double ms = bench_stripes_draw(draw_stripe, &stripes);
    for (const stripe &one : stripes) {
        std::memcpy(rgba, one.image.bytes(), one.image.size());
        rgba += one.image.size();
    }
    return ms;
}

double draw_stripes(const bench_peer_frame *frame) {
    try {
        return render_stripes(make_map(*frame), static_cast<int>(frame->width_px) + 1, frame->rgba);
    } catch (const std::exception &) {
        return -1;
    }
}

/* ---- Layers of a style ---- */

constexpr int LAYERS_BUFFER_PX = 64; /* no style has wider lines */

mapnik::color color_of(const camber_color &color) {
    const auto level = [](float share) { return static_cast<uint8_t>(255 * share + 0.5f); };
    return mapnik::color(level(color.r), level(color.g), level(color.b), level(color.a));
}

/* Twice its area, above 0 where it runs clockwise as seen. */
double area_of(const camber_lines &lines, std::size_t ring) {
    double area = 0;
    for (std::size_t k = lines.offsets[ring]; k + 1 < lines.offsets[ring + 1]; k++) {
        const float *p = lines.points + 2 * k;
        area += static_cast<double>(p[0]) * static_cast<double>(p[3]) -
                static_cast<double>(p[2]) * static_cast<double>(p[1]);
    }
    return area;
}

std::shared_ptr<mapnik::memory_datasource> make_source(const bench_layer &layer) {
    mapnik::parameters parameters;
    parameters["type"] = "memory";
    const auto source = std::make_shared<mapnik::memory_datasource>(parameters);
    const auto context = std::make_shared<mapnik::context_type>();
    std::size_t next;
    for (std::size_t i = layer.first; i < layer.end; i = next) {
        next = i + 1;
        while (layer.area && next < layer.end && area_of(*layer.lines, next) <= 0)
            next++;
        if (layer.lines->offsets[i + 1] - layer.lines->offsets[i] < 2)
            continue;
        const mapnik::feature_ptr feature =
            mapnik::feature_factory::create(context, static_cast<mapnik::value_integer>(i + 1));
        if (layer.area)
            feature->set_geometry(make_area(*layer.lines, i, next, layer.shift_px));
        else
            feature->set_geometry(make_line<mapnik::geometry::line_string<double>>(*layer.lines, i, layer.shift_px));
        source->push(feature);
    }
    return source;
}

mapnik::rule make_rule(const bench_layer &layer) {
    mapnik::rule rule;
    if (layer.area) {
        mapnik::polygon_symbolizer symbolizer;
        mapnik::put(symbolizer, mapnik::keys::fill, color_of(layer.color));
        rule.append(std::move(symbolizer));
        return rule;
    }
    mapnik::line_symbolizer symbolizer;
    mapnik::put(symbolizer, mapnik::keys::stroke, color_of(layer.color));
    mapnik::put(symbolizer, mapnik::keys::stroke_width, static_cast<double>(layer.width_px));
    mapnik::put(symbolizer, mapnik::keys::stroke_linejoin, mapnik::line_join_enum::ROUND_JOIN);
    mapnik::put(symbolizer, mapnik::keys::stroke_linecap,
                layer.cap == CAMBER_CAP_ROUND ? mapnik::line_cap_enum::ROUND_CAP : mapnik::line_cap_enum::BUTT_CAP);
    rule.append(std::move(symbolizer));
    return rule;
}

void add_layer(mapnik::Map &map, const bench_layer &layer, const std::string &name) {
    mapnik::feature_type_style style;
    style.add_rule(make_rule(layer));
    style.set_opacity(layer.opacity);
    map.insert_style(name, std::move(style));
    mapnik::layer made(name, "epsg:3857");
    made.set_datasource(make_source(layer));
    made.add_style(name);
    map.add_layer(std::move(made));
}

/* ---- Labels ---- */

std::shared_ptr<mapnik::memory_datasource> make_source(const bench_labels &labels) {
    const mapnik::transcoder utf8("utf-8");
    mapnik::parameters parameters;
    parameters["type"] = "memory";
    const auto source = std::make_shared<mapnik::memory_datasource>(parameters);
    const auto context = std::make_shared<mapnik::context_type>();
    context->push("name");
    for (std::size_t i = 0; i < labels.count; i++) {
        const bench_label &label = labels.labels[i];
        const mapnik::feature_ptr feature =
            mapnik::feature_factory::create(context, static_cast<mapnik::value_integer>(i + 1));
        feature->set_geometry(mapnik::geometry::point<double>(label.x, BENCH_SIDE_PX - label.y));
        feature->put("name", utf8.transcode(label.text));
        source->push(feature);
    }
    return source;
}

mapnik::Map make_map(const bench_labels &labels) {
    mapnik::Map map(BENCH_SIDE_PX, BENCH_SIDE_PX, "epsg:3857");
    mapnik::freetype_engine::register_font(labels.font_file);
    const std::string symbolizer = std::string("<TextSymbolizer fill=\"black\" halo-fill=\"white\" ") +
                                   "allow-overlap=\"true\" face-name=\"" + labels.font + "\" size=\"" +
                                   std::to_string(labels.size_px) + "\" halo-radius=\"" +
                                   std::to_string(labels.halo_px) + "\">[name]</TextSymbolizer>";
    mapnik::load_map_string(map, "<Map background-color=\"#808080\"><Style name=\"labels\"><Rule>" + symbolizer +
                                     "</Rule></Style></Map>");
    mapnik::layer layer("labels", "epsg:3857");
    layer.set_datasource(make_source(labels));
    layer.add_style("labels");
    map.add_layer(std::move(layer));
    map.zoom_to_box(mapnik::box2d<double>(0, 0, BENCH_SIDE_PX, BENCH_SIDE_PX));
    return map;
}

const char *version() {
    return MAPNIK_VERSION_STRING;
}

const char *build() {
    return CAMBER_BENCH_BUILD;
}

} // namespace

extern "C" double bench_mapnik_layers(const bench_layer *layers, std::size_t count, camber_color background,
                                      uint8_t *rgba) {
    try {
        mapnik::Map map(BENCH_SIDE_PX, BENCH_SIDE_PX, "epsg:3857");
        map.set_background(color_of(background));
        for (std::size_t i = 0; i < count; i++)
            add_layer(map, layers[i], std::to_string(i));
        map.zoom_to_box(mapnik::box2d<double>(0, 0, BENCH_SIDE_PX, BENCH_SIDE_PX));
        return render_stripes(map, LAYERS_BUFFER_PX, rgba);
    } catch (const std::exception &) {
        return -1;
    }
}

extern "C" double bench_mapnik_labels(const bench_labels *labels, uint8_t *rgba) {
    try {
        return render(make_map(*labels), rgba);
    } catch (const std::exception &) {
        return -1;
    }
}

extern "C" {
const bench_peer bench_peer_mapnik = {"mapnik", "Mapnik", "one thread", version, build, draw};
const bench_peer bench_peer_mapnik_stripes = {"mapnik_stripes", "Mapnik", "a stripe per thread",
                                              version,          build,    draw_stripes};
}
