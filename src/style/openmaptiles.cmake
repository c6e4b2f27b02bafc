# The style for vector tiles of the OpenMapTiles schema that the style itself names: what the style city draws of such
# tiles, with a source.

set(omt_metadata [=[
  "metadata": {
    "camber:tiles": "Vector tiles of the OpenMapTiles schema. \"url\" of the source says where: mbtiles://FILE, pmtiles://FILE or a TileJSON file; or \"tiles\": [\"FOLDER/{z}/{x}/{y}.pbf\"]. A path is relative to the style, or to the working folder where the style is named and not a file.",
    "camber:missing": {"openmaptiles": "tilemaker makes it of an OpenStreetMap extract, as man camber shows under STYLES; or name other tiles in a copy of the style"}
  },]=])
set(omt_sources [=["openmaptiles": {"type": "vector", "url": "mbtiles://openmaptiles.mbtiles",
                               "attribution": "(c) OpenMapTiles, (c) OpenStreetMap contributors"}]=])

# Writes openmaptiles-THEME.json into the folder.
function(openmaptiles_style theme folder)
  set(with_osm OFF)
  set(tile_source " \"source\": \"openmaptiles\",")
  # The schema's layers, of those that the style city knows.
  set(city_schemas openmaptiles)
  set(city_tile_layers park landuse landcover water aeroway transportation)
  set(city_building_tiles building)
  set(city_borders_tiles boundary)
  foreach(kind pier ferry works lift)
    set(city_${kind}_tiles transportation)
  endforeach()
  set(city_runway_tiles aeroway)
  set(label_tile_layers place transportation_name waterway water_name park mountain_peak poi aerodrome_label housenumber)
  set(layers "")
  city_layers(layers ${theme})
  label_layers(layers ${theme} ON ${label_kinds})
  set(METADATA "${omt_metadata}")
  set(SOURCES "${omt_sources}")
  road_document(openmaptiles ${theme} "${layers}" ${folder})
endfunction()
