/* libosmium in the process: blocks are decoded by a pool with a thread per core, places of nodes go into its index for
 * files of any size, and each way's points are looked up, projected and copied with its tags. */
#include "peers/osmium.h"
#include "peers/peer.h"

#include <osmium/geom/mercator_projection.hpp>
#include <osmium/handler/node_locations_for_ways.hpp>
#include <osmium/index/map/flex_mem.hpp>
#include <osmium/io/pbf_input.hpp>
#include <osmium/thread/pool.hpp>
#include <osmium/visitor.hpp>

#include <chrono>
#include <cstddef>
#include <exception>
#include <string>
#include <vector>

namespace {

using places = osmium::index::map::FlexMem<osmium::unsigned_object_id_type, osmium::Location>;

/* What is kept: lines as camber has them, and their tags one after the other. */
class lines : public osmium::handler::Handler {
  public:
    lines(const char *const *keys, std::size_t key_count) : keys(keys, keys + key_count) {
    }

    void way(const osmium::Way &way) {
        if (!is_wanted(way.tags()))
            return;
        for (const osmium::NodeRef &node : way.nodes()) {
            if (!node.location().valid())
                continue;
            const auto at = osmium::geom::lonlat_to_mercator(osmium::geom::Coordinates{node.location()});
            points.push_back(at.x);
            points.push_back(at.y);
        }
        for (const osmium::Tag &tag : way.tags()) {
            tags.append(tag.key()).push_back('\0');
            tags.append(tag.value()).push_back('\0');
        }
        offsets.push_back(points.size() / 2);
        tag_offsets.push_back(tags.size());
    }

    std::size_t point_count() const {
        return points.size() / 2;
    }

  private:
    const std::vector<std::string> keys;
    std::vector<double> points;
    std::vector<std::size_t> offsets, tag_offsets;
    std::string tags;

    bool is_wanted(const osmium::TagList &list) const {
        for (const std::string &key : keys)
            if (list.has_key(key.c_str()))
                return true;
        return false;
    }
};

} // namespace

extern "C" double bench_osmium_read(const char *path, const char *const *keys, std::size_t key_count,
                                    std::size_t *points) {
    try {
        const auto begin = std::chrono::steady_clock::now();
        osmium::thread::Pool pool{static_cast<int>(bench_stripe_count())};
        osmium::io::Reader reader{path, osmium::osm_entity_bits::node | osmium::osm_entity_bits::way,
                                  osmium::io::read_meta::no, pool};
        places index;
        osmium::handler::NodeLocationsForWays<places> resolve{index};
        resolve.ignore_errors();
        lines kept{keys, key_count};
        osmium::apply(reader, resolve, kept);
        reader.close();
        const auto end = std::chrono::steady_clock::now();
        *points = kept.point_count();
        return std::chrono::duration<double, std::milli>(end - begin).count();
    } catch (const std::exception &) {
        return -1;
    }
}
