/* Mapnik's renderer over lines or areas in memory: a symbolizer as a style would have it, neither simplified nor
 * smoothed. */
#include "peers/peer.h"

#include <mapnik/agg_renderer.hpp>
#include <mapnik/feature.hpp>
#include <mapnik/feature_factory.hpp>
#include <mapnik/feature_type_style.hpp>
#include <mapnik/image.hpp>
#include <mapnik/layer.hpp>
#include <mapnik/map.hpp>
#include <mapnik/memory_datasource.hpp>
#include <mapnik/rule.hpp>
#include <mapnik/symbolizer.hpp>
#include <mapnik/version.hpp>

#include <chrono>
#include <cstring>
#include <exception>

namespace {

/* A map unit a pixel, y up. */
template <typename line_type> line_type make_line(const camber_lines &lines, std::size_t polyline) {
    const std::size_t first = lines.offsets[polyline], end = lines.offsets[polyline + 1];
    line_type line;
    line.reserve(end - first);
    for (std::size_t k = first; k < end; k++)
        line.emplace_back(static_cast<double>(lines.points[2 * k]),
                          BENCH_SIDE_PX - static_cast<double>(lines.points[2 * k + 1]));
    return line;
}

mapnik::geometry::polygon<double> make_area(const bench_peer_frame &frame, std::size_t area) {
    mapnik::geometry::polygon<double> polygon;
    for (std::size_t k = frame.areas[area]; k < frame.areas[area + 1]; k++) {
        auto ring = make_line<mapnik::geometry::linear_ring<double>>(*frame.lines, k);
#if MAPNIK_MAJOR_VERSION >= 4
        polygon.push_back(std::move(ring));
#else
        if (k == frame.areas[area])
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
            feature->set_geometry(make_area(frame, i));
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

double draw(const bench_peer_frame *frame) {
    try {
        const mapnik::Map map = make_map(*frame);
        const auto begin = std::chrono::steady_clock::now();
        mapnik::image_rgba8 image(BENCH_SIDE_PX, BENCH_SIDE_PX);
        mapnik::agg_renderer<mapnik::image_rgba8> renderer(map, image);
        renderer.apply();
        const auto end = std::chrono::steady_clock::now();
        std::memcpy(frame->rgba, image.bytes(), image.size());
        return std::chrono::duration<double, std::milli>(end - begin).count();
    } catch (const std::exception &) {
        return -1;
    }
}

const char *version() {
    return MAPNIK_VERSION_STRING;
}

const char *build() {
    return CAMBER_BENCH_BUILD;
}

} // namespace

extern "C" const bench_peer bench_peer_mapnik = {"mapnik", "Mapnik", "", version, build, draw};
