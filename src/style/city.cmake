# The built-in style: kinds of areas in two palettes, with rivers, rails and the roads of roads.cmake above them.
#
# It draws extracts of OpenStreetMap by their keys, and vector tiles by their layers and classes, for the schemas
# OpenMapTiles, Protomaps (3 and 4) and Shortbread. Kinds that are drawn lower come first.

set(city_kinds reserve built commerce industry campus farm field park wood sand rock wetland ice pitch water pier apron plaza)
set(city_keys natural landuse leisure waterway amenity man_made aeroway highway)

set(city_reserve_leisure nature_reserve)
set(city_built_landuse residential)
set(city_commerce_landuse commercial retail)
set(city_industry_landuse industrial railway garages depot port quarry landfill brownfield construction military)
set(city_campus_landuse education institutional religious)
set(city_campus_amenity school university college kindergarten hospital)
set(city_field_natural grassland heath scrub fell)
set(city_farm_landuse farmland orchard vineyard plant_nursery greenfield)
set(city_field_landuse grass meadow)
set(city_park_leisure park garden golf_course common recreation_ground dog_park)
set(city_park_landuse recreation_ground village_green cemetery allotments)
set(city_park_amenity grave_yard)
set(city_wood_natural wood)
set(city_wood_landuse forest)
set(city_sand_natural sand beach shingle dune)
set(city_rock_natural bare_rock scree)
set(city_wetland_natural wetland mud)
set(city_ice_natural glacier)
set(city_pitch_leisure pitch track playground sports_centre stadium)
set(city_water_natural water)
set(city_water_landuse reservoir basin)
set(city_water_leisure swimming_pool)
set(city_water_waterway riverbank river canal dock)
set(city_pier_man_made pier breakwater groyne)
set(city_apron_aeroway apron runway taxiway helipad)
set(city_plaza_highway pedestrian footway path steps cycleway living_street residential unclassified service track)

# The classes of each kind in the layers of tiles, for all schemas together: several schemas may have a layer of the
# same name, but their classes do not conflict. "*": the whole layer.
set(city_tile_layers park landuse landcover natural land sites water ocean water_polygons aeroway transportation
    pier_polygons street_polygons bridges)
set(city_tiles_reserve_park *)
set(city_tiles_reserve_landuse nature_reserve national_park protected_area)
set(city_tiles_built_landuse residential suburb quarter neighbourhood)
set(city_tiles_built_landcover urban_area)
set(city_tiles_built_land residential)
set(city_tiles_commerce_landuse commercial retail)
set(city_tiles_commerce_land commercial retail)
set(city_tiles_industry_landuse industrial railway garages quarry military naval_base airfield)
set(city_tiles_industry_land industrial railway garages quarry landfill brownfield)
set(city_tiles_industry_sites construction)
set(city_tiles_campus_landuse school university college kindergarten hospital library)
set(city_tiles_campus_sites school university college hospital)
set(city_tiles_farm_landuse farmland)
set(city_tiles_farm_landcover farmland)
set(city_tiles_farm_land farmland orchard vineyard plant_nursery greenfield)
set(city_tiles_field_landuse grass meadow grassland scrub)
set(city_tiles_field_landcover grassland scrub)
set(city_tiles_field_natural grass meadow grassland scrub)
set(city_tiles_field_land grass meadow grassland scrub heath)
set(city_tiles_park_landuse cemetery zoo theme_park park garden golf_course dog_park recreation_ground village_green
    allotments)
set(city_tiles_park_landcover grass)
set(city_tiles_park_land cemetery grave_yard park garden golf_course recreation_ground village_green allotments)
set(city_tiles_wood_landuse wood forest)
set(city_tiles_wood_landcover wood forest)
set(city_tiles_wood_natural wood forest)
set(city_tiles_wood_land forest)
set(city_tiles_sand_landuse sand beach)
set(city_tiles_sand_landcover sand)
set(city_tiles_sand_natural sand beach)
set(city_tiles_sand_land sand beach shingle)
set(city_tiles_rock_landuse bare_rock)
set(city_tiles_rock_landcover rock barren)
set(city_tiles_rock_natural bare_rock)
set(city_tiles_rock_land bare_rock scree)
set(city_tiles_wetland_landuse wetland)
set(city_tiles_wetland_landcover wetland)
set(city_tiles_wetland_natural wetland)
set(city_tiles_wetland_land swamp bog string_bog wet_meadow marsh)
set(city_tiles_ice_landuse glacier)
set(city_tiles_ice_landcover ice glacier)
set(city_tiles_ice_natural glacier)
set(city_tiles_ice_water_polygons glacier)
set(city_tiles_pitch_landuse pitch playground stadium)
set(city_tiles_pitch_land playground)
set(city_tiles_pitch_sites sports_centre)
set(city_tiles_water_water *)
set(city_tiles_water_ocean *)
set(city_tiles_water_water_polygons water river canal reservoir basin dock)
set(city_tiles_pier_landuse pier)
set(city_tiles_pier_transportation pier)
set(city_tiles_pier_pier_polygons *)
set(city_tiles_apron_landuse runway taxiway)
set(city_tiles_apron_aeroway apron runway taxiway helipad)
set(city_tiles_apron_street_polygons runway taxiway)
set(city_tiles_plaza_landuse pedestrian)
set(city_tiles_plaza_transportation path)
set(city_tiles_plaza_street_polygons pedestrian service)
set(city_tiles_plaza_bridges *)
set(city_tiles_class [=[["coalesce", ["get", "class"], ["get", "kind"], ["get", "pmap:kind"]]]=])

# The lines of each schema: the layers of rivers, rails and roads, and what the schema calls its roads (see osm_class and
# so on in roads.cmake). Protomaps has the names of both versions.
set(city_schemas openmaptiles protomaps shortbread)
set(city_openmaptiles_rivers waterway)
set(city_openmaptiles_rails transportation)
set(city_openmaptiles_roads transportation)
set(city_openmaptiles_class [=[["get", "class"]]=])
set(city_openmaptiles_tunnel [=[["==", ["get", "brunnel"], "tunnel"]]=])
set(city_openmaptiles_bridge [=[["==", ["get", "brunnel"], "bridge"]]=])
set(city_openmaptiles_is_ramp [=[["==", ["get", "ramp"], 1]]=])
set(city_openmaptiles_way [=[["case", ["==", ["get", "class"], "path"], ["coalesce", ["get", "subclass"], "path"], ["get", "class"]]]=])
set(city_openmaptiles_levels 2)
set(city_openmaptiles_minor minor)
set(city_protomaps_rivers water physical_line)
set(city_protomaps_rails roads transit)
set(city_protomaps_roads roads)
set(city_protomaps_class [=[["coalesce", ["get", "kind_detail"], ["get", "pmap:kind_detail"]]]=])
set(city_protomaps_tunnel [=[["any", ["==", ["get", "is_tunnel"], true], ["==", ["get", "pmap:level"], -1]]]=])
set(city_protomaps_bridge [=[["any", ["==", ["get", "is_bridge"], true], ["==", ["get", "pmap:level"], 1]]]=])
set(city_protomaps_is_ramp "")
set(city_protomaps_way "${city_protomaps_class}")
set(city_protomaps_levels 1)
set(city_protomaps_service alley driveway parking_aisle)
set(city_shortbread_rivers water_lines)
set(city_shortbread_rails streets)
set(city_shortbread_roads streets)
set(city_shortbread_class [=[["get", "kind"]]=])
set(city_shortbread_tunnel [=[["==", ["get", "tunnel"], true]]=])
set(city_shortbread_bridge [=[["all", ["==", ["get", "bridge"], true], ["!=", ["get", "tunnel"], true]]]=])
set(city_shortbread_is_ramp [=[["==", ["get", "link"], true]]=])
set(city_shortbread_way "${city_shortbread_class}")
set(city_shortbread_levels 1)

set(city_rivers river canal stream drain ditch tidal_channel)
set(city_rails_heavy rail narrow_gauge preserved funicular)
set(city_rails_light transit light_rail monorail subway)
set(city_rails ${city_rails_heavy} ${city_rails_light} tram)

# Other lines: their filters for OpenStreetMap's keys, and for layers of tiles.
set(city_borders_tiles boundary boundaries)
set(city_border_level_osm [=[["to-number", ["coalesce", ["get", "admin_level"], 99], 99]]=])
set(city_border_level_boundary [=[["to-number", ["coalesce", ["get", "admin_level"], 99], 99]]=])
set(city_border_level_boundaries [=[["match", ["coalesce", ["get", "kind"], ["get", "pmap:kind"], ""], "country", 2, "region", 4,
                ["to-number", ["coalesce", ["get", "admin_level"], 99], 99]]]=])
set(city_ferry_osm [=[["==", ["get", "route"], "ferry"]]=])
set(city_ferry_tiles transportation roads ferries transit)
set(city_ferry_transportation [=[["==", ["get", "class"], "ferry"]]=])
set(city_ferry_roads [=[["==", ["get", "kind"], "ferry"]]=])
set(city_ferry_ferries [=[["has", "kind"]]=])
set(city_ferry_transit [=[["==", ["get", "pmap:kind"], "ferry"]]=])
set(city_pier_osm [=[["match", ["get", "man_made"], ["pier", "breakwater", "groyne"], true, false]]=])
set(city_pier_tiles transportation roads pier_lines)
set(city_pier_transportation [=[["==", ["get", "class"], "pier"]]=])
set(city_pier_roads [=[["match", ["coalesce", ["get", "kind_detail"], ["get", "pmap:kind_detail"]], "pier", true, false]]=])
set(city_pier_pier_lines [=[["has", "kind"]]=])
set(city_runway_osm [=[["match", ["get", "aeroway"], ["runway", "taxiway"], true, false]]=])
set(city_runway_tiles aeroway roads streets)
set(city_runway_class_osm [=[["get", "aeroway"]]=])
set(city_runway_class_aeroway [=[["get", "class"]]=])
set(city_runway_class_roads [=[["coalesce", ["get", "kind_detail"], ["get", "pmap:kind_detail"]]]=])
set(city_runway_class_streets [=[["get", "kind"]]=])
foreach(layer IN LISTS city_runway_tiles)
  set(city_runway_${layer} "[\"match\", ${city_runway_class_${layer}}, [\"runway\", \"taxiway\"], true, false]")
endforeach()
set(city_lifts cable_car gondola mixed_lift chair_lift drag_lift t-bar j-bar platter rope_tow magic_carpet)
match_any(city_lift_osm [=[["get", "aerialway"]]=] ${city_lifts})
set(city_lift_tiles transportation aerialways)
match_any(city_lift_transportation [=[["get", "class"]]=] aerialway ${city_lifts})
set(city_lift_aerialways [=[["has", "kind"]]=])
set(city_works_osm [=[["==", ["get", "highway"], "construction"]]=])
set(city_works_tiles transportation)
set(city_works_transportation [=[["in", "_construction", ["to-string", ["get", "class"]]]]=])
set(city_building_tiles building buildings)
set(city_hedge_osm [=[["any", ["==", ["get", "barrier"], "hedge"], ["==", ["get", "natural"], "tree_row"]]]=])

# The first zoom at which a kind of small areas is drawn.
set(city_zoom_pitch 13)
set(city_zoom_pier 11)
set(city_zoom_apron 10)
set(city_zoom_plaza 14)

set(city_light_reserve  "#edf0df")
set(city_light_built    "#efe9de")
set(city_light_built_far "#e5dacb")
set(city_light_commerce "#f3e7dd")
set(city_light_industry "#ebe6de")
set(city_light_campus   "#f3ead3")
set(city_light_farm     "#f2ecd2")
set(city_light_field    "#e3ecce")
set(city_light_park     "#d5e6bf")
set(city_light_wood     "#c1d9ad")
set(city_light_sand     "#f4e7c6")
set(city_light_rock     "#e4dfd6")
set(city_light_wetland  "#d5e4d8")
set(city_light_ice      "#eef5f7")
set(city_light_pitch    "#c4e0b4")
set(city_light_water    "#a6cfdd")
set(city_light_pier     "#efe9dd")
set(city_light_apron    "#e5e1d9")
set(city_light_plaza    "#fbf8f1")
set(city_light_building_far "#e1d8cb")
set(city_light_building "#e0d7cb")
set(city_light_building_edge "#c6bbad")
set(city_light_stream   "#9ac7d8")
set(city_light_rail     "#8b827c")
set(city_light_border   "#a183a8")
set(city_light_border_band "#dfd0dd")
set(city_light_ferry    "#6d9db2")
set(city_light_runway   "#dcd8d2")
set(city_light_lift     "#8a8178")
set(city_light_hedge    "#b5cc9d")
set(city_light_works    "#c9a98a")

set(city_dark_reserve  "#121c1e")
set(city_dark_built    "#141924")
set(city_dark_built_far "#1b2230")
set(city_dark_commerce "#181a27")
set(city_dark_industry "#171a22")
set(city_dark_campus   "#1a1d24")
set(city_dark_farm     "#1d211e")
set(city_dark_field    "#16251f")
set(city_dark_park     "#172b23")
set(city_dark_wood     "#172f24")
set(city_dark_sand     "#2a271d")
set(city_dark_rock     "#1d2127")
set(city_dark_wetland  "#14282c")
set(city_dark_ice      "#29353f")
set(city_dark_pitch    "#1a3026")
set(city_dark_water    "#173d58")
set(city_dark_pier     "#1c222e")
set(city_dark_apron    "#20262f")
set(city_dark_plaza    "#1d2431")
set(city_dark_building_far "#1e2533")
set(city_dark_building "#212937")
set(city_dark_building_edge "#323d50")
set(city_dark_stream   "#285d82")
set(city_dark_rail     "#6a6680")
set(city_dark_border   "#7d6e94")
set(city_dark_border_band "#2c2a3d")
set(city_dark_ferry    "#417294")
set(city_dark_runway   "#2a303b")
set(city_dark_lift     "#6a7184")
set(city_dark_hedge    "#1f3a2c")
set(city_dark_works    "#5b4f47")

# A test for features that are not from Protomaps 3, which repeats OpenStreetMap's keys in addition to its own classes.
set(city_no_schema [=[["!", ["has", "pmap:kind"]]]=])

# Appends a layer that fills areas of a kind, with an id, additional members (head) and a filter.
function(city_layer out theme kind id head filter)
  set(paint "\"fill-color\": \"${city_${theme}_${kind}}\"")
  if(DEFINED city_${theme}_${kind}_far)
    # Towns stand out where they are small.
    string(CONCAT paint "\"fill-color\": [\"interpolate\", [\"linear\"], [\"zoom\"], 11, "
           "\"${city_${theme}_${kind}_far}\", 13, \"${city_${theme}_${kind}}\"]")
  endif()
  if(DEFINED city_zoom_${kind})
    string(APPEND paint ", \"fill-opacity\": [\"step\", [\"zoom\"], 0, ${city_zoom_${kind}}, 1]")
  endif()
  if(filter)
    string(APPEND head "\n     \"filter\": ${filter},")
  endif()
  string(APPEND ${out} ",\n    {\"id\": \"${id}\", \"type\": \"fill\",${head}\n"
         "     \"paint\": {${paint}}}")
  set(${out} "${${out}}" PARENT_SCOPE)
endfunction()

# Appends the layers of a kind: one for features with OpenStreetMap's keys, and one for each layer of tiles that has
# it.
function(city_areas out theme kind)
  set(filter "[\"all\", ${city_no_schema}, [\"any\"")
  foreach(key IN LISTS city_keys)
    if(DEFINED city_${kind}_${key})
      match_any(match "[\"get\", \"${key}\"]" ${city_${kind}_${key}})
      string(APPEND filter ",\n                ${match}")
    endif()
  endforeach()
  if(with_osm)
    city_layer(${out} ${theme} ${kind} ${kind} "" "${filter}]]")
  endif()
  foreach(layer IN LISTS city_tile_layers)
    if(DEFINED city_tiles_${kind}_${layer})
      set(filter "")
      if(NOT city_tiles_${kind}_${layer} STREQUAL "*")
        match_any(filter "${city_tiles_class}" ${city_tiles_${kind}_${layer}})
      endif()
      city_layer(${out} ${theme} ${kind} tiles-${layer}-${kind} "${tile_source} \"source-layer\": \"${layer}\"," "${filter}")
    endif()
  endforeach()
  set(${out} "${${out}}" PARENT_SCOPE)
endfunction()

set(city_template_building [=[
    {"id": "@ID@", "type": "fill",@HEAD@
     "paint": {"fill-color": ["interpolate", ["linear"], ["zoom"], 13.5, "@BUILDING_FAR@", 15, "@BUILDING@"],
               "fill-outline-color": ["step", ["zoom"], "rgba(0, 0, 0, 0)", 15, "@BUILDING_EDGE@"],
               "fill-opacity": ["step", ["zoom"], 0, 13.5, 1]}}]=])
set(city_template_river [=[
    {"id": "@ID@", "type": "line",@HEAD@
     "layout": {"line-cap": "round", "line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": ["match", @CLASS@, ["river", "canal"], "@WATER@", "@STREAM@"],
               "line-width": ["interpolate", ["exponential", 1.4], ["zoom"],
                              8, ["match", @CLASS@, "river", 0.6, "canal", 0.5, 0],
                              11, ["match", @CLASS@, "river", 1.5, "canal", 1, 0],
                              12, ["match", @CLASS@, "river", 2, "canal", 1.5, 0.5],
                              16, ["match", @CLASS@, "river", 6, "canal", 5, 2],
                              20, ["match", @CLASS@, "river", 26, "canal", 22, 8]]}}]=])
set(city_template_rail [=[
    {"id": "@ID@", "type": "line",@HEAD@
     "filter": @FILTER@,
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@RAIL@",
               "line-width": ["let", "kind", ["case", ["has", "service"], 3, @KIND@],
                 ["interpolate", ["exponential", 1.4], ["zoom"],
                   8, 0, 9, ["at", ["var", "kind"], ["literal", [0.4, 0, 0, 0]]],
                   11, ["at", ["var", "kind"], ["literal", [0.6, 0.4, 0, 0]]],
                   13, ["at", ["var", "kind"], ["literal", [0.8, 0.8, 0.4, 0]]],
                   14, ["at", ["var", "kind"], ["literal", [1, 1, 0.7, 0.5]]],
                   16, ["at", ["var", "kind"], ["literal", [1.5, 1.5, 1.1, 0.8]]],
                   20, ["at", ["var", "kind"], ["literal", [4.5, 4.5, 3, 2.5]]]]]}}]=])
set(city_template_ties [=[
    {"id": "@ID@-ties", "type": "line",@HEAD@
     "filter": @FILTER@,
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@RAIL@", "line-dasharray": [0.3, 2],
               "line-width": ["let", "kind", ["case", ["has", "service"], 3, @KIND@],
                 ["interpolate", ["exponential", 1.4], ["zoom"],
                   13.9, 0, 14, ["at", ["var", "kind"], ["literal", [2.6, 0, 0, 0]]],
                   16, ["at", ["var", "kind"], ["literal", [4.6, 0, 0, 0]]],
                   20, ["at", ["var", "kind"], ["literal", [15, 0, 0, 0]]]]]}}]=])
# The borders of countries and regions. The gaps between a country's dashes are paler, and not what is below: above a
# river both would make one motley line.
set(city_template_border [=[
    {"id": "@ID@-band", "type": "line",@HEAD@
     "filter": ["all", @NO_AREA@, @TEST@, ["<", @LEVEL@, 3]],
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@BORDER_BAND@",
               "line-width": ["interpolate", ["exponential", 1.2], ["zoom"], 4, 1.4, 8, 2.8, 12, 4, 18, 6]}},
    {"id": "@ID@", "type": "line",@HEAD@
     "filter": ["all", @NO_AREA@, @TEST@, ["<", @LEVEL@, 5]],
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@BORDER@", "line-dasharray": ["step", @LEVEL@, ["literal", [7, 2]], 3, ["literal", [4, 2, 1, 2]]],
               "line-width": ["interpolate", ["exponential", 1.2], ["zoom"],
                              4, ["step", @LEVEL@, 0.8, 3, 0], 8, ["step", @LEVEL@, 1.5, 3, 0.7],
                              12, ["step", @LEVEL@, 1.7, 3, 1], 18, ["step", @LEVEL@, 2.6, 3, 2]]}}]=])
# The borders of municipalities.
set(city_template_border_local [=[
    {"id": "@ID@-local", "type": "line",@HEAD@
     "filter": ["all", @NO_AREA@, @TEST@, [">=", @LEVEL@, 5], ["<=", @LEVEL@, 8]],
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@BORDER@", "line-dasharray": [4, 2, 1, 2],
               "line-width": ["interpolate", ["exponential", 1.2], ["zoom"], 11.9, 0, 12, 0.5, 18, 1.3]}}]=])
set(city_template_ferry [=[
    {"id": "@ID@", "type": "line",@HEAD@
     "filter": ["all", @NO_AREA@, @TEST@],
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@FERRY@", "line-dasharray": [5, 3],
               "line-width": ["interpolate", ["exponential", 1.2], ["zoom"], 7.9, 0, 8, 0.6, 14, 1, 18, 2]}}]=])
set(city_template_pier [=[
    {"id": "@ID@", "type": "line",@HEAD@
     "filter": ["all", @NO_AREA@, @TEST@],
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@PIER@",
               "line-width": ["interpolate", ["exponential", 1.6], ["zoom"], 11.9, 0, 12, 0.6, 14, 1.4, 16, 4, 18, 12, 22, 180]}}]=])
set(city_template_runway [=[
    {"id": "@ID@", "type": "line",@HEAD@
     "filter": ["all", @NO_AREA@, @TEST@],
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@RUNWAY@",
               "line-width": ["interpolate", ["exponential", 1.6], ["zoom"],
                              9.9, 0, 10, ["match", @CLASS@, "runway", 1.2, 0.3], 14, ["match", @CLASS@, "runway", 8, 2],
                              18, ["match", @CLASS@, "runway", 90, 25], 22, ["match", @CLASS@, "runway", 1400, 400]]}}]=])
set(city_template_lift [=[
    {"id": "@ID@", "type": "line",@HEAD@
     "filter": ["all", @NO_AREA@, @TEST@],
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@LIFT@",
               "line-width": ["interpolate", ["exponential", 1.3], ["zoom"], 11.9, 0, 12, 0.6, 16, 1.2, 20, 3]}},
    {"id": "@ID@-ties", "type": "line",@HEAD@
     "filter": ["all", @NO_AREA@, @TEST@],
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@LIFT@", "line-dasharray": [0.3, 4],
               "line-width": ["interpolate", ["exponential", 1.3], ["zoom"], 12.9, 0, 13, 3, 16, 5, 20, 12]}}]=])
set(city_template_works [=[
    {"id": "@ID@", "type": "line",@HEAD@
     "filter": ["all", @NO_AREA@, @TEST@],
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@WORKS@", "line-dasharray": [2, 1.5],
               "line-width": ["interpolate", ["exponential", 1.5], ["zoom"], 12.9, 0, 13, 0.8, 14, 1.5, 16, 3, 20, 14]}}]=])
set(city_template_hedge [=[
    {"id": "@ID@", "type": "line",@HEAD@
     "filter": ["all", @NO_AREA@, @TEST@],
     "layout": {"line-cap": "round", "line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@HEDGE@", "line-width": ["interpolate", ["exponential", 1.6], ["zoom"], 16.9, 0, 17, 2, 20, 8]}}]=])

# Appends the rivers that are not in tunnels, for OpenStreetMap's keys and for the layers of each schema. Areas get no
# line around them.
macro(city_append_rivers out)
  match_any(match "[\"get\", \"waterway\"]" ${city_rivers})
  set(CLASS "[\"get\", \"waterway\"]")
  set(ID river)
  set(HEAD "\n     \"filter\": [\"all\", ${not_area}, ${city_no_schema}, ${match},\n                [\"!\", ${osm_tunnel}]],")
  if(with_osm)
    append_layer(${out} "${city_template_river}")
  endif()
  match_any(match "${city_tiles_class}" ${city_rivers})
  set(CLASS "${city_tiles_class}")
  foreach(schema IN LISTS city_schemas)
    foreach(layer IN LISTS city_${schema}_rivers)
      set(ID tiles-${layer}-river)
      set(HEAD "${tile_source} \"source-layer\": \"${layer}\",\n     \"filter\": [\"all\", ${not_area}, ${match},\n                ")
      string(APPEND HEAD "[\"!\", ${city_${schema}_tunnel}]],")
      append_layer(${out} "${city_template_river}")
    endforeach()
  endforeach()
endmacro()

# Sets the class of rails to the value of an expression.
macro(prepare_rails value)
  match_any(is_rail "${value}" ${city_rails})
  list(JOIN city_rails_heavy "\", \"" heavy)
  list(JOIN city_rails_light "\", \"" light)
  set(KIND "[\"match\", ${value}, [\"${heavy}\"], 0, [\"${light}\"], 1, 2]")
endmacro()

# Appends the rails of a level; append_network calls this.
macro(append_rails out id level test)
  set(FILTER "[\"all\", ${not_area}, ${is_rail}, ${test}]")
  if("${level}" STREQUAL "bridge")
    append_bed(${out} ${id}rail 3.4 6 60)
  endif()
  set(ID ${id}rail)
  append_layer(${out} "${city_template_rail}")
  append_layer(${out} "${city_template_ties}")
endmacro()

# Appends the lines of a kind that has a template, for OpenStreetMap's keys and for layers of tiles.
macro(city_append_lines out kind)
  set(NO_AREA "${not_area}")
  set(ID ${kind}-line)
  set(HEAD "")
  set(TEST "[\"all\", ${city_no_schema}, ${city_${kind}_osm}]")
  set(CLASS "${city_${kind}_class_osm}")
  if(with_osm)
    append_layer(${out} "${city_template_${kind}}")
  endif()
  foreach(layer IN LISTS city_${kind}_tiles)
    set(ID tiles-${layer}-${kind}-line)
    set(HEAD "${tile_source} \"source-layer\": \"${layer}\",")
    set(TEST "${city_${kind}_${layer}}")
    set(CLASS "${city_${kind}_class_${layer}}")
    append_layer(${out} "${city_template_${kind}}")
  endforeach()
endmacro()

# Appends borders. template: which ones.
macro(city_append_borders out template)
  set(NO_AREA "${not_area}")
  set(ID border)
  set(HEAD "")
  set(TEST "[\"all\", [\"==\", [\"get\", \"boundary\"], \"administrative\"],\n                [\"!=\", [\"get\", \"maritime\"], \"yes\"]]")
  set(LEVEL "${city_border_level_osm}")
  if(with_osm)
    append_layer(${out} "${${template}}")
  endif()
  foreach(layer IN LISTS city_borders_tiles)
    set(ID tiles-${layer}-border)
    set(HEAD "${tile_source} \"source-layer\": \"${layer}\",")
    set(TEST "[\"match\", [\"to-string\", [\"get\", \"maritime\"]], [\"1\", \"true\"], false, true]")
    set(LEVEL "${city_border_level_${layer}}")
    append_layer(${out} "${${template}}")
  endforeach()
endmacro()

# Appends everything above the areas: buildings, lines, and the roads of tiles in the same colours as other roads.
function(city_details out theme)
  set(ID building)
  set(HEAD "\n     \"filter\": [\"match\", [\"to-string\", [\"get\", \"building\"]], [\"\", \"no\"], false, true],")
  if(with_osm)
    append_layer(${out} "${city_template_building}")
  endif()
  foreach(layer IN LISTS city_building_tiles)
    set(ID tiles-${layer})
    set(HEAD "${tile_source} \"source-layer\": \"${layer}\",")
    append_layer(${out} "${city_template_building}")
  endforeach()
  foreach(kind hedge pier runway ferry)
    city_append_lines(${out} ${kind})
  endforeach()
  city_append_borders(${out} city_template_border)
  city_append_lines(${out} works)

  foreach(schema IN LISTS city_schemas)
    prepare_rails("${city_${schema}_class}")
    set(layer ${city_${schema}_roads})
    set(HEAD "${tile_source} \"source-layer\": \"${layer}\",")
    append_network(${out} ${theme} city_${schema} tiles-${layer}- rails)
  endforeach()
  if("protomaps" IN_LIST city_schemas)
    set(HEAD " \"source-layer\": \"transit\",")
    prepare_rails("${city_protomaps_class}")
    append_rails(${out} tiles-transit- ground "[\"!\", [\"any\", ${city_protomaps_tunnel}, ${city_protomaps_bridge}]]")
    append_rails(${out} tiles-transit-bridge- bridge "${city_protomaps_bridge}")
  endif()
  if(with_osm)
    set(HEAD "")
    prepare_rails("[\"get\", \"railway\"]")
    set(is_rail "[\"all\", ${city_no_schema}, ${is_rail}]")
    append_network(${out} ${theme} osm "" rails)
  endif()
  city_append_lines(${out} lift)
  set(${out} "${${out}}" PARENT_SCOPE)
endfunction()

# Appends the areas and lines. with_osm: for OpenStreetMap's keys, too, and not only for the layers of tiles.
# tile_source: members of the layers that draw tiles.
function(city_layers out theme)
  foreach(color building building_far building_edge water stream rail border border_band ferry pier runway lift hedge works)
    string(TOUPPER ${color} name)
    set(${name} "${city_${theme}_${color}}")
  endforeach()
  foreach(kind IN LISTS city_kinds)
    # The middle of a river shows only where there is no area of water, and so does the border of a municipality.
    if(kind STREQUAL "water")
      city_append_borders(${out} city_template_border_local)
      city_append_rivers(${out})
    endif()
    city_areas(${out} ${theme} ${kind})
  endforeach()
  city_details(${out} ${theme})
  set(${out} "${${out}}" PARENT_SCOPE)
endfunction()

function(city_document theme folder)
  set(with_osm ON)
  set(tile_source "")
  set(layers ",\n    {\"id\": \"plain-area\", \"type\": \"fill\", \"metadata\": {\"camber:plain\": true},\n")
  string(APPEND layers "     \"paint\": {\"fill-color\": [\"global-state\", \"plain-fill\"]}}")
  city_layers(layers ${theme})
  plain_lines(layers line "[\"!=\", [\"geometry-type\"], \"Point\"]" 0)
  plain_lines(layers point "[\"==\", [\"geometry-type\"], \"Point\"]" 4)
  label_layers(layers ${theme} ON ${label_kinds})
  road_document(city ${theme} "${layers}" ${folder})
endfunction()

# Writes city-THEME.json into the folder, and into its folder osm the same without the layers for vector tiles.
function(city_style theme folder)
  city_document(${theme} ${folder})
  foreach(list schemas tile_layers building_tiles borders_tiles pier_tiles runway_tiles ferry_tiles works_tiles lift_tiles)
    set(city_${list} "")
  endforeach()
  set(label_tile_layers "")
  city_document(${theme} ${folder}/osm)
endfunction()
