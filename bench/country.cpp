/* Makes up a country: camber_country OUT MILLIONS CITY.osm.pbf...
 *
 * Input: real cities, and how many million points their ways are to have in all. Output: a file in which copies of the
 * cities lie side by side, a degree apart. The same arguments give the same bytes. Its ending tells the format:
 *
 *     OUT.fgb   FlatGeobuf with an index, by OGR: the ways with their keys that styles name as columns
 *     others    PBF, nodes before ways and both by ascending ids, as a country's file has them. Nodes have ids in runs
 *               of ten with gaps between, which is about as dense as those of a real country.
 *
 * Relations are left out: no line needs them. The cities stay in memory and each copy is written at once. So memory
 * grows with the cities alone, and in a FlatGeobuf with the index, which OGR holds: 100 bytes a way. */
#include <osmium/builder/osm_object_builder.hpp>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/pbf_output.hpp>
#include <osmium/visitor.hpp>

#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr std::int64_t RUN = 10, GAP = 190;
constexpr std::int32_t CELL = 10000000; // a degree

struct City {
    osmium::memory::Buffer buffer{1024 * 1024, osmium::memory::Buffer::auto_grow::yes};
    std::vector<osmium::object_id_type> nodes; // their ids in the file, ascending
    std::int64_t points = 0;                   // of ways
    std::int64_t ways = 0;
    std::int32_t west = INT32_MAX, south = INT32_MAX;
};

void read_city(const std::string &path, City &city) {
    osmium::io::Reader reader{path, osmium::osm_entity_bits::node | osmium::osm_entity_bits::way,
                              osmium::io::read_meta::no};
    while (osmium::memory::Buffer buffer = reader.read()) {
        for (const auto &node : buffer.select<osmium::Node>()) {
            city.nodes.push_back(node.id());
            city.west = std::min(city.west, node.location().x());
            city.south = std::min(city.south, node.location().y());
        }
        for (const auto &way : buffer.select<osmium::Way>()) {
            city.points += static_cast<std::int64_t>(way.nodes().size());
            city.ways++;
        }
        city.buffer.add_buffer(buffer);
        city.buffer.commit();
    }
    reader.close();
    std::sort(city.nodes.begin(), city.nodes.end());
}

// One city in its place.
struct Copy {
    const City *city;
    std::int64_t first_node, first_way;
    std::int32_t x, y; // its south-west corner
};

std::int64_t spread(std::int64_t rank) {
    return 1 + rank / RUN * (RUN + GAP) + rank % RUN;
}

// A node that the city does not have has no id in the country either: one in a gap.
std::int64_t new_id(const Copy &copy, osmium::object_id_type id) {
    const auto &nodes = copy.city->nodes;
    const auto at = std::lower_bound(nodes.begin(), nodes.end(), id);
    const std::int64_t rank = copy.first_node + (at - nodes.begin());
    return at != nodes.end() && *at == id ? spread(rank) : spread(rank / RUN * RUN) + RUN + 1;
}

// Nodes of the city by ascending ids, as a country's file has them.
std::vector<const osmium::Node *> sort_nodes(const City &city) {
    std::vector<const osmium::Node *> nodes;
    for (const auto &node : city.buffer.select<osmium::Node>())
        nodes.push_back(&node);
    std::sort(nodes.begin(), nodes.end(),
              [](const osmium::Node *a, const osmium::Node *b) { return a->id() < b->id(); });
    return nodes;
}

void put(osmium::io::Writer &writer, osmium::memory::Buffer &buffer, bool all) {
    if (buffer.committed() > 4 * 1024 * 1024 || (all && buffer.committed())) {
        osmium::memory::Buffer full{8 * 1024 * 1024, osmium::memory::Buffer::auto_grow::yes};
        std::swap(full, buffer);
        writer(std::move(full));
    }
}

void write_nodes(osmium::io::Writer &writer, const Copy &copy) {
    osmium::memory::Buffer buffer{8 * 1024 * 1024, osmium::memory::Buffer::auto_grow::yes};
    for (const osmium::Node *node : sort_nodes(*copy.city)) {
        {
            osmium::builder::NodeBuilder builder{buffer};
            const osmium::Location at = node->location();
            builder.set_id(new_id(copy, node->id()));
            builder.set_location(osmium::Location{copy.x + (at.x() - copy.city->west) % CELL,
                                                  copy.y + (at.y() - copy.city->south) % CELL});
            builder.add_item(node->tags());
        }
        buffer.commit();
        put(writer, buffer, false);
    }
    put(writer, buffer, true);
}

void write_ways(osmium::io::Writer &writer, const Copy &copy) {
    osmium::memory::Buffer buffer{8 * 1024 * 1024, osmium::memory::Buffer::auto_grow::yes};
    std::int64_t id = copy.first_way;
    for (const auto &way : copy.city->buffer.select<osmium::Way>()) {
        {
            osmium::builder::WayBuilder builder{buffer};
            builder.set_id(id++);
            builder.add_item(way.tags());
            osmium::builder::WayNodeListBuilder nodes{builder};
            for (const auto &node : way.nodes())
                nodes.add_node_ref(new_id(copy, node.ref()));
        }
        buffer.commit();
        put(writer, buffer, false);
    }
    put(writer, buffer, true);
}

struct Country {
    std::vector<City> cities;
    std::vector<Copy> copies;
    std::int64_t points = 0, ways = 0;
};

void write_pbf(const std::string &out, const Country &country) {
    osmium::io::Header header;
    header.set("generator", "camber_country");
    header.set("sorting", "Type_then_ID");
    osmium::io::Writer writer{osmium::io::File{out, "pbf,add_metadata=false"}, header, osmium::io::overwrite::allow};
    for (const Copy &copy : country.copies)
        write_nodes(writer, copy);
    for (const Copy &copy : country.copies)
        write_ways(writer, copy);
    writer.close();
}

// ---- FlatGeobuf ----

const char *const COLUMNS[] = {"highway", "railway", "waterway", "bridge", "tunnel", "service", "name", "ref", "layer"};

struct Table {
    GDALDatasetH file;
    OGRLayerH lines;
};

void check(bool good, const char *what) {
    if (!good)
        throw std::runtime_error{std::string{what} + ": " + CPLGetLastErrorMsg()};
}

Table open_table(const std::string &out) {
    const char *const options[] = {"SPATIAL_INDEX=YES", nullptr};
    GDALAllRegister();
    GDALDriverH driver = GDALGetDriverByName("FlatGeobuf");
    check(driver, "OGR writes no FlatGeobuf");
    std::remove(out.c_str());
    Table table{};
    table.file = GDALCreate(driver, out.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
    check(table.file, "create");
    OGRSpatialReferenceH degrees = OSRNewSpatialReference(nullptr);
    OSRImportFromEPSG(degrees, 4326);
    OSRSetAxisMappingStrategy(degrees, OAMS_TRADITIONAL_GIS_ORDER);
    table.lines = GDALDatasetCreateLayer(table.file, "lines", degrees, wkbLineString, const_cast<char **>(options));
    OSRDestroySpatialReference(degrees);
    check(table.lines, "create a layer");
    for (const char *column : COLUMNS) {
        OGRFieldDefnH field = OGR_Fld_Create(column, OFTString);
        check(OGR_L_CreateField(table.lines, field, 0) == OGRERR_NONE, "create a column");
        OGR_Fld_Destroy(field);
    }
    return table;
}

OGRGeometryH make_line(const Copy &copy, const osmium::Way &way, const std::vector<const osmium::Node *> &nodes) {
    OGRGeometryH line = OGR_G_CreateGeometry(wkbLineString);
    for (const auto &ref : way.nodes()) {
        const auto at =
            std::lower_bound(nodes.begin(), nodes.end(), ref.ref(),
                             [](const osmium::Node *node, osmium::object_id_type id) { return node->id() < id; });
        if (at == nodes.end() || (*at)->id() != ref.ref())
            continue;
        const osmium::Location place = (*at)->location();
        OGR_G_AddPoint_2D(line, (copy.x + (place.x() - copy.city->west) % CELL) / 1e7,
                          (copy.y + (place.y() - copy.city->south) % CELL) / 1e7);
    }
    return line;
}

void write_lines(const Table &table, const Copy &copy) {
    const std::vector<const osmium::Node *> nodes = sort_nodes(*copy.city);
    for (const auto &way : copy.city->buffer.select<osmium::Way>()) {
        OGRGeometryH line = way.tags().empty() ? nullptr : make_line(copy, way, nodes);
        if (line && OGR_G_GetPointCount(line) >= 2) {
            OGRFeatureH feature = OGR_F_Create(OGR_L_GetLayerDefn(table.lines));
            int column = 0;
            for (const char *key : COLUMNS) {
                if (const char *value = way.tags()[key])
                    OGR_F_SetFieldString(feature, column, value);
                column++;
            }
            OGR_F_SetGeometry(feature, line);
            const OGRErr error = OGR_L_CreateFeature(table.lines, feature);
            OGR_F_Destroy(feature);
            check(error == OGRERR_NONE, "write a line");
        }
        if (line)
            OGR_G_DestroyGeometry(line);
    }
}

void write_fgb(const std::string &out, const Country &country) {
    const Table table = open_table(out);
    for (const Copy &copy : country.copies)
        write_lines(table, copy);
    CPLErrorReset();
    GDALClose(table.file);
    check(CPLGetLastErrorType() < CE_Failure, "write the index");
}

// ---- Both ----

void make(const std::string &out, double millions, const std::vector<std::string> &paths) {
    Country country;
    country.cities.resize(paths.size());
    for (std::size_t i = 0; i < paths.size(); i++)
        read_city(paths[i], country.cities[i]);
    std::int64_t node = 0;
    for (std::size_t i = 0; static_cast<double>(country.points) < millions * 1e6; i++) {
        const City &city = country.cities[i % paths.size()];
        // A square of 50 by 50 degrees, from the south-west.
        const auto cell = static_cast<std::int32_t>(i);
        country.copies.push_back(
            {&city, node, country.ways + 1, (-20 + cell % 50) * CELL, (20 + cell / 50 % 50) * CELL});
        node += static_cast<std::int64_t>(city.nodes.size() + RUN) / RUN * RUN;
        country.ways += city.ways;
        country.points += city.points;
    }
    if (out.size() > 4 && out.compare(out.size() - 4, 4, ".fgb") == 0)
        write_fgb(out, country);
    else
        write_pbf(out, country);
    std::printf("%lld points of %lld ways in %zu cities\n", static_cast<long long>(country.points),
                static_cast<long long>(country.ways), country.copies.size());
}

} // namespace

int main(int count, char **arguments) {
    const double millions = count > 3 ? std::atof(arguments[2]) : 0.0;
    if (millions <= 0.0) {
        std::fprintf(stderr, "usage: camber_country OUT.osm.pbf|OUT.fgb MILLIONS CITY.osm.pbf...\n");
        return 2;
    }
    try {
        make(arguments[1], millions, std::vector<std::string>(arguments + 3, arguments + count));
    } catch (const std::exception &error) {
        std::fprintf(stderr, "camber_country: %s\n", error.what());
        return 1;
    }
    return 0;
}
