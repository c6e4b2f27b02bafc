/* Mapnik's renderer over lines in memory: a line symbolizer as a style would have it, neither simplified nor smoothed.
 */
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
std::shared_ptr<mapnik::memory_datasource> make_source(const camber_lines &lines) {
    mapnik::parameters parameters;
    parameters["type"] = "memory";
    const auto source = std::make_shared<mapnik::memory_datasource>(parameters);
    const auto context = std::make_shared<mapnik::context_type>();
    for (std::size_t i = 0; i < lines.polyline_count; i++) {
        const std::size_t first = lines.offsets[i], end = lines.offsets[i + 1];
        if (end - first < 2)
            continue;
        mapnik::geometry::line_string<double> line;
        line.reserve(end - first);
        for (std::size_t k = first; k < end; k++)
            line.emplace_back(static_cast<double>(lines.points[2 * k]),
                              BENCH_SIDE_PX - static_cast<double>(lines.points[2 * k + 1]));
        const mapnik::feature_ptr feature =
            mapnik::feature_factory::create(context, static_cast<mapnik::value_integer>(i + 1));
        feature->set_geometry(std::move(line));
        source->push(feature);
    }
    return source;
}

mapnik::Map make_map(const camber_lines &lines, double width_px) {
    mapnik::Map map(BENCH_SIDE_PX, BENCH_SIDE_PX, "epsg:3857");
    map.set_background(mapnik::color(255, 255, 255));
    mapnik::line_symbolizer symbolizer;
    mapnik::put(symbolizer, mapnik::keys::stroke, mapnik::color(0, 0, 0));
    mapnik::put(symbolizer, mapnik::keys::stroke_width, width_px);
    mapnik::put(symbolizer, mapnik::keys::stroke_linejoin, mapnik::line_join_enum::ROUND_JOIN);
    mapnik::put(symbolizer, mapnik::keys::stroke_linecap, mapnik::line_cap_enum::BUTT_CAP);
    mapnik::rule rule;
    rule.append(std::move(symbolizer));
    mapnik::feature_type_style style;
    style.add_rule(std::move(rule));
    map.insert_style("lines", std::move(style));
    mapnik::layer layer("lines", "epsg:3857");
    layer.set_datasource(make_source(lines));
    layer.add_style("lines");
    map.add_layer(std::move(layer));
    map.zoom_to_box(mapnik::box2d<double>(0, 0, BENCH_SIDE_PX, BENCH_SIDE_PX));
    return map;
}

double draw(const bench_peer_frame *frame) {
    try {
        const mapnik::Map map = make_map(*frame->lines, static_cast<double>(frame->width_px));
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
