# The style that draws only roads: a table of road classes and two palettes, written as MapLibre style documents. The
# style city has the same roads, and draws the roads of tiles by the same tables.
#
# Roads have levels: tunnels, the ground, and bridges by OpenStreetMap's layer. Each level has the casings of all
# classes first and then their fills, minor classes first. The casing and the fill of a road have the same filter, cap
# and join, so that they are tessellated once.

set(road_zooms 5 7 9 10 11 11.9 12 13 14 16 18 22)
# How much wider a casing is than its fill, in CSS px at these zooms, for through roads and for other roads. Roads have
# no casing as long as they are thinner than 1 px or so.
set(road_casing_main  0 0 0 0 0.4 0.8 0.8 1.2 1.6 2.2 3.2 18)
set(road_casing_other 0 0 0 0 0   0   0   0.8 1.3 2   3   16)
set(road_casing_bridge_main  0 0 0 0 0.4 0.9 0.9 1.5 2 2.8 4.4 26)
set(road_casing_bridge_other 0 0 0 0 0   0   0   0.9 1.6 2.6 4.2 24)

# Widths of fills, in CSS px at these zooms; 0: the class is left out. A class begins as thin as it can be seen, and
# becomes wider. From zoom 18 on they are close to true scale: a lane is 3 to 3.5 m wide, and at zoom 18 a metre is
# about 4 px at a latitude of 40 degrees. Classes are in drawing order: a link is below the roads that it leads to.
set(road_classes service pedestrian link3 link2 link1 ramp minor tertiary secondary primary trunk motorway)
set(road_width_service    0   0   0   0   0   0   0   0.5 1.5 4.5  15 220)
set(road_width_pedestrian 0   0   0   0   0   0   0   0.8 2   7    24 370)
set(road_width_link3      0   0   0   0   0   0.5 0.6 1.1 2.2 6    20 300)
set(road_width_link2      0   0   0   0   0.4 0.8 0.8 1.4 2.5 6.5  21 310)
set(road_width_link1      0   0   0   0   0.6 1   1   1.6 2.8 7    22 330)
set(road_width_ramp       0   0   0   0.4 0.8 1.4 1.4 2.1 3.2 7.5  24 350)
set(road_width_minor      0   0   0   0   0   0   0.7 1.4 2.9 8    26 400)
set(road_width_tertiary   0   0   0   0.5 0.8 1.4 1.5 2.2 3.6 9.5  30 460)
set(road_width_secondary  0   0   0.6 0.9 1.3 2.1 2.1 2.9 4.3 11   34 520)
set(road_width_primary    0   0.5 0.9 1.2 1.8 2.7 2.7 3.6 5    12.5 38 580)
set(road_width_trunk      0.4 0.8 1.2 1.6 2.2 3.2 3.2 4.3 5.8 13.5 41 640)
set(road_width_motorway   0.6 1   1.5 2   2.7 3.8 3.8 5   6.6  15   46 700)
# The classes with the casing of through roads.
set(road_main link2 link1 ramp tertiary secondary primary trunk motorway)

# The values of OpenStreetMap's highway (type in vector tiles made from it) and of the Census Bureau's MTFCC.
set(road_values_service service busway bus_guideway raceway escape S1640 S1730 S1740 S1750 S1780)
set(road_values_pedestrian pedestrian)
set(road_values_link3 tertiary_link)
set(road_values_link2 secondary_link)
set(road_values_link1 primary_link)
set(road_values_ramp motorway_link trunk_link access_ramp S1630)
set(road_values_minor residential unclassified living_street road S1400)
set(road_values_tertiary tertiary)
set(road_values_secondary secondary)
set(road_values_primary primary S1200)
set(road_values_trunk trunk)
set(road_values_motorway motorway S1100)

# Ways without a casing, their widths, and their dashes in units of the width.
set(way_zooms 12.9 13 13.9 14 14.9 15 16 16.9 17 18 20 22)
set(way_classes sidewalk footway path steps track)
set(way_width_sidewalk 0 0   0   0   0   0   0   0   0.6 1   2.5 10)
set(way_width_footway  0 0   0   0   0   0.8 1.1 1.5 1.5 2.1 5   20)
set(way_width_path     0 0   0   0.6 0.8 0.8 1.1 1.5 1.5 2.1 5   20)
set(way_width_steps    0 0   0   0   0   1.4 2.2 3   3.1 4.5 11  44)
set(way_width_track    0 0.6 0.9 0.9 1.2 1.2 1.6 2.2 2.2 3   7   28)
set(way_dashes_sidewalk "1, 0")
set(way_dashes_footway "2.2, 1.4")
set(way_dashes_path "2.2, 1.4")
set(way_dashes_steps "0.45, 0.4")
set(way_dashes_track "6, 1.6")
set(way_values_sidewalk sidewalk crossing platform)
set(way_values_footway footway)
set(way_values_path path cycleway bridleway corridor S1710 S1720 S1820 S1830)
set(way_values_steps steps)
set(way_values_track track S1500)

# Palettes: colours of fills in close-ups, of fills in whole cities, where minor roads are thinner than a pixel or two
# and need contrast, and of casings.
# The zoom from which on the colours of close-ups are reached. In the dark theme they are darker, so it is later.
set(light_near_zoom 13.5)
set(dark_near_zoom 15)

set(light_paper "#f6f2ea")
set(light_plain "#3f6595")
set(light_plain_fill "#d8e0e9")
set(light_casing_bridge "#a2988a")
set(light_service    "#fffefb" "#d9d0c0" "#cdc3b3")
set(light_pedestrian "#f4efe6" "#d9d0c0" "#c6bcab")
set(light_minor      "#ffffff" "#c2b6a3" "#c0b5a4")
set(light_tertiary   "#fff8dd" "#d9c996" "#bba97c")
set(light_secondary  "#fdebb8" "#e2c886" "#cbb176")
set(light_primary    "#f9d488" "#e8ba62" "#c4974a")
set(light_ramp       "#eeb498" "#e3a083" "#bb7459")
set(light_trunk      "#f5ba86" "#e8a266" "#ba7640")
set(light_motorway   "#e58c70" "#da7656" "#a5523a")
set(light_way        "#a3916f")
set(light_sidewalk   "#d6cdbd")
set(light_bridge_bed "#faf7f0")

set(dark_paper "#10141c")
set(dark_plain "#86aadb")
set(dark_plain_fill "#1f2a3b")
set(dark_casing_bridge "#56627a")
set(dark_service    "#2b3444" "#28313f" "#0b0e14")
set(dark_pedestrian "#2a3242" "#222a37" "#0b0e14")
set(dark_minor      "#3c485b" "#46546c" "#0b0e14")
set(dark_tertiary   "#4c586c" "#55637d" "#0b0e14")
set(dark_secondary  "#5e5d58" "#67655f" "#0b0e14")
set(dark_primary    "#786850" "#8a795d" "#0b0e14")
set(dark_ramp       "#84674a" "#9f7a57" "#0b0e14")
set(dark_trunk      "#8e7049" "#a68256" "#0b0e14")
set(dark_motorway   "#ad804c" "#cb975f" "#0b0e14")
set(dark_way        "#5a6273")
set(dark_sidewalk   "#2b3341")
set(dark_bridge_bed "#161b25")
foreach(theme light dark)
  set(${theme}_link3 ${${theme}_tertiary})
  set(${theme}_link2 ${${theme}_secondary})
  set(${theme}_link1 ${${theme}_primary})
endforeach()

# The words of a schema for its roads: the class, and the tests for tunnels, bridges, ramps and sidewalks. OpenStreetMap's
# values are "yes" or a kind of bridge or tunnel, and 0 or 1 in vector tiles. A bridge with a roof counts as a tunnel.
# road_levels: how many levels of bridges there are. osm_is_ramp: empty, because its links have classes of their own.
set(road_no "[\"\", \"0\", \"no\", \"false\"]")
set(osm_class [=[["coalesce", ["get", "highway"], ["get", "type"], ["get", "MTFCC"]]]=])
set(osm_tunnel "[\"match\", [\"to-string\", [\"get\", \"tunnel\"]], ${road_no}, false, true]")
set(osm_bridge "[\"all\", [\"match\", [\"to-string\", [\"get\", \"bridge\"]], ${road_no}, false, true], [\"!\", ${osm_tunnel}]]")
set(osm_is_ramp "")
set(osm_way [=[["match", ["get", "footway"], ["sidewalk", "crossing", "traffic_island", "link"], "sidewalk", ["coalesce", ["get", "highway"], ["get", "type"], ["get", "MTFCC"]]]]=])
set(osm_levels 3)

# Makes a test of whether an expression has one of the values.
function(match_any out value)
  list(JOIN ARGN "\", \"" values)
  set(${out} "[\"match\", ${value}, [\"${values}\"], true, false]" PARENT_SCOPE)
endfunction()

# Makes ["match", value, ...] with a result for each class. schema has additional values: SCHEMA_CLASS.
function(match_classes out prefix classes value schema other)
  set(text "[\"match\", ${value}")
  foreach(class result IN ZIP_LISTS ${classes} ARGN)
    set(values ${${prefix}_values_${class}} ${${schema}_${class}})
    list(JOIN values "\", \"" values)
    string(APPEND text ", [\"${values}\"], ${result}")
  endforeach()
  set(${out} "${text}, ${other}]" PARENT_SCOPE)
endfunction()

# Makes a curve over the zoom. At each zoom an array has the widths of all classes; index selects one of them. casing:
# what is added to widths that are not 0.
function(width_curve out index prefix base casing)
  set(text "[\"let\", \"class\", ${index}, [\"interpolate\", [\"exponential\", ${base}], [\"zoom\"]")
  list(LENGTH ${prefix}_zooms count)
  math(EXPR last "${count} - 1")
  foreach(at RANGE ${last})
    list(GET ${prefix}_zooms ${at} zoom)
    set(widths "")
    foreach(class IN LISTS ${prefix}_classes)
      list(GET ${prefix}_width_${class} ${at} width)
      set(group other)
      if(class IN_LIST ${prefix}_main)
        set(group main)
      endif()
      if(casing)
        list(GET ${casing}_${group} ${at} extra)
        if(width EQUAL 0 OR extra EQUAL 0)
          set(width 0)
        else()
          add_decimals(width ${width} ${extra})
        endif()
      endif()
      list(APPEND widths ${width})
    endforeach()
    list(JOIN widths ", " widths)
    string(APPEND text ",\n                ${zoom}, [\"at\", [\"var\", \"class\"], [\"literal\", [${widths}]]]")
  endforeach()
  set(${out} "${text}]]" PARENT_SCOPE)
endfunction()

# Adds two numbers with at most one decimal place. CMake's arithmetic has only whole numbers.
function(add_decimals out)
  set(sum 0)
  foreach(number IN LISTS ARGN)
    if(NOT number MATCHES "\\.")
      string(APPEND number ".0")
    endif()
    string(REPLACE "." "" tenths ${number})
    string(REGEX REPLACE "^0+([0-9])" "\\1" tenths ${tenths})
    math(EXPR sum "${sum} + ${tenths}")
  endforeach()
  math(EXPR whole "${sum} / 10")
  math(EXPR tenth "${sum} % 10")
  set(${out} "${whole}.${tenth}" PARENT_SCOPE)
endfunction()

# Makes the colours of all classes: for close-ups, for whole cities, and of casings. Those of tunnels are mixed halfway
# with the paper, so they are paler without being translucent. Light casings begin in the colour of their roads, because
# whole cities would be a mesh of edges; dark ones are as dark as the ground.
function(road_colors theme schema)
  foreach(index name IN ZIP_LISTS road_color_indices road_color_names)
    set(colors "")
    foreach(class IN LISTS road_classes)
      list(GET ${theme}_${class} ${index} color)
      list(APPEND colors "\"${color}\"")
    endforeach()
    list(GET colors -1 last)
    match_classes(${name} road road_classes "${${schema}_class}" ${schema} ${last} ${colors})
    if(${schema}_is_ramp)
      list(GET ${theme}_ramp ${index} color)
      match_any(large "${${schema}_class}" trunk motorway)
      set(${name} "[\"case\", [\"all\", ${${schema}_is_ramp}, ${large}], \"${color}\",\n                ${${name}}]")
    endif()
    set(pale_${name} "[\"interpolate\", [\"linear\"], 0.45, 0, \"${${theme}_paper}\", 1, ${${name}}]")
  endforeach()
  set(zoomed "[\"interpolate\", [\"linear\"], [\"zoom\"], 12,")
  set(bridge "\"${${theme}_casing_bridge}\"")
  set(color_ground_fill "${zoomed} ${far}, ${${theme}_near_zoom}, ${near}]" PARENT_SCOPE)
  if(theme STREQUAL "dark")
    set(color_ground_casing "${casing}" PARENT_SCOPE)
    set(color_tunnel_casing "${pale_casing}" PARENT_SCOPE)
    set(color_bridge_casing "${zoomed} ${casing}, 15, ${bridge}]" PARENT_SCOPE)
  else()
    set(color_ground_casing "${zoomed} ${far}, 14.5, ${casing}]" PARENT_SCOPE)
    set(color_tunnel_casing "${zoomed} ${pale_far}, 14.5, ${pale_casing}]" PARENT_SCOPE)
    set(color_bridge_casing "${zoomed} ${far}, 15, ${bridge}]" PARENT_SCOPE)
  endif()
  set(color_tunnel_fill "${zoomed} ${pale_far}, ${${theme}_near_zoom}, ${pale_near}]" PARENT_SCOPE)
  set(color_bridge_fill "${zoomed} ${far}, ${${theme}_near_zoom}, ${near}]" PARENT_SCOPE)
endfunction()
set(road_color_indices 0 1 2)
set(road_color_names near far casing)

# Appends a layer made from a template, with the template's variables filled in.
macro(append_layer out template)
  string(CONFIGURE "${template}" layer_text @ONLY)
  string(STRIP "${layer_text}" layer_text)
  string(APPEND ${out} ",\n    ${layer_text}")
endmacro()

set(road_template [=[
    {"id": "@ID@", "type": "line",@HEAD@@TUCK@
     "filter": @FILTER@,
     "layout": {"line-cap": "round", "line-join": "round", "line-round-limit": 1, "line-sort-key": @KEY@},
     "paint": {"line-color": @COLOR@,
               "line-width": @WIDTH@}}]=])
set(way_template [=[
    {"id": "@ID@", "type": "line",@HEAD@
     "filter": @FILTER@,
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": @WAY_COLOR@,
               "line-dasharray": @WAY_DASHES@,
               "line-width": @WAY_WIDTH@}}]=])
set(bed_template [=[
    {"id": "@ID@", "type": "line",@HEAD@
     "filter": @FILTER@,
     "layout": {"line-join": "round", "line-round-limit": 1},
     "paint": {"line-color": "@COLOR@",
               "line-width": ["interpolate", ["exponential", 1.6], ["zoom"], 14.9, 0, 15, @AT15@, 18, @AT18@, 22, @AT22@]}}]=])

# Areas, such as pedestrian squares, get no road around them; the style city fills them.
set(not_area "[\"!=\", [\"geometry-type\"], \"Polygon\"]")

# Appends the casings and the fills of a level. Ends are tucked: a road ends flat where it goes on as a lesser road, or on
# a lower level. The fill of a bridge overlaps its neighbour; otherwise its casing would show through the smooth edge of
# its end. Roads in a cutting, of a layer below 0, are below the other roads of the ground.
macro(append_roads out id level test)
  set(FILTER "[\"all\", ${not_area}, ${is_road}, ${test}]")
  foreach(part IN ITEMS casing fill)
    set(ID "${id}-${part}")
    set(COLOR "${color_${level}_${part}}")
    set(WIDTH "${width_${level}_${part}}")
    set(TUCK "\n     \"metadata\": {\"camber:tuck\": true},")
    if("${level}-${part}" STREQUAL "bridge-fill")
      set(TUCK "")
    endif()
    set(KEY "${INDEX}")
    if("${level}" STREQUAL "ground" AND road_layers GREATER 1)
      set(KEY "[\"-\", ${INDEX}, [\"case\", [\"<\", [\"to-number\", [\"get\", \"layer\"], 0], 0], 12, 0]]")
    endif()
    append_layer(${out} "${road_template}")
  endforeach()
endmacro()

# Appends the edge and the ground of a bridge for lines that have no casing: paths or rails. at15 and so on: the width
# of the ground in CSS px at these zooms.
macro(append_bed out id at15 at18 at22)
  set(ID "${id}-edge")
  set(COLOR "${${theme}_casing_bridge}")
  add_decimals(AT15 ${at15} 0.8)
  add_decimals(AT18 ${at18} 1.4)
  add_decimals(AT22 ${at22} 8)
  append_layer(${out} "${bed_template}")
  set(ID "${id}-bed")
  set(COLOR "${${theme}_bridge_bed}")
  set(AT15 ${at15})
  set(AT18 ${at18})
  set(AT22 ${at22})
  append_layer(${out} "${bed_template}")
endmacro()

# Appends the paths, steps and tracks of a level.
macro(append_ways out id level test)
  set(FILTER "[\"all\", ${not_area}, ${is_way}, ${test}]")
  if("${level}" STREQUAL "bridge")
    append_bed(${out} ${id} 2 4.5 40)
  endif()
  set(ID ${id})
  append_layer(${out} "${way_template}")
endmacro()

# Sets the expressions of a schema's roads and paths.
macro(prepare_roads theme schema)
  set(indices "")
  foreach(class IN LISTS road_classes)
    list(LENGTH indices index)
    list(APPEND indices ${index})
  endforeach()
  match_classes(INDEX road road_classes "${${schema}_class}" ${schema} 0 ${indices})
  if(${schema}_is_ramp)
    string(CONCAT INDEX "[\"case\", ${${schema}_is_ramp}, [\"match\", ${${schema}_class}, [\"motorway\", \"trunk\"], 5, "
           "\"primary\", 4, \"secondary\", 3, 2],\n                ${INDEX}]")
  endif()
  set(values "")
  foreach(class IN LISTS road_classes)
    list(APPEND values ${road_values_${class}} ${${schema}_${class}})
  endforeach()
  match_any(is_road "${${schema}_class}" ${values})
  width_curve(width_ground_fill "${INDEX}" road 1.6 "")
  width_curve(width_ground_casing "${INDEX}" road 1.6 road_casing)
  width_curve(width_bridge_casing "${INDEX}" road 1.6 road_casing_bridge)
  set(width_tunnel_fill "${width_ground_fill}")
  set(width_tunnel_casing "${width_ground_casing}")
  set(width_bridge_fill "${width_ground_fill}")
  set(road_layers "${${schema}_levels}")
  road_colors(${theme} ${schema})

  set(values "")
  set(dashes "")
  foreach(class IN LISTS way_classes)
    list(APPEND values ${way_values_${class}})
    list(APPEND dashes "[\"literal\", [${way_dashes_${class}}]]")
  endforeach()
  match_any(is_way "${${schema}_way}" ${values})
  match_classes(way_index way way_classes "${${schema}_way}" ${schema} 2 0 1 2 3 4)
  width_curve(WAY_WIDTH "${way_index}" way 1.4 "")
  match_classes(WAY_DASHES way way_classes "${${schema}_way}" ${schema} "[\"literal\", [1, 0]]" ${dashes})
  list(JOIN way_values_sidewalk "\", \"" values)
  set(WAY_COLOR "[\"match\", ${${schema}_way}, [\"${values}\"], \"${${theme}_sidewalk}\", \"${${theme}_way}\"]")
endmacro()

# Appends the roads of a schema. prefix and HEAD: what the ids and the layers begin with. rails: a macro that appends
# rails, or empty.
macro(append_network out theme schema prefix rails)
  prepare_roads(${theme} ${schema})
  append_roads(${out} ${prefix}tunnel tunnel "${${schema}_tunnel}")
  set(on_ground "[\"!\", [\"any\", ${${schema}_tunnel}, ${${schema}_bridge}]]")
  append_ways(${out} ${prefix}ground-path ground "${on_ground}")
  append_roads(${out} ${prefix}ground ground "${on_ground}")
  if(NOT "${rails}" STREQUAL "")
    append_rails(${out} "${prefix}" ground "${on_ground}")
  endif()
  foreach(height RANGE 1 ${${schema}_levels})
    set(on_bridge "${${schema}_bridge}")
    set(id ${prefix}bridge)
    if(height GREATER 1)
      set(id ${prefix}bridge-${height})
    endif()
    if(${schema}_levels GREATER 1)
      # The layers up to 1 are the first level, and the last level has all above.
      set(comparison "==")
      if(height EQUAL 1)
        set(comparison "<=")
      elseif(height EQUAL ${schema}_levels)
        set(comparison ">=")
      endif()
      string(CONCAT on_bridge "[\"all\", ${on_bridge}, [\"${comparison}\", "
             "[\"to-number\", [\"get\", \"layer\"], 1], ${height}]]")
    endif()
    append_ways(${out} ${id}-path bridge "${on_bridge}")
    append_roads(${out} ${id} bridge "${on_bridge}")
    if(NOT "${rails}" STREQUAL "")
      append_rails(${out} "${id}-" bridge "${on_bridge}")
    endif()
  endforeach()
endmacro()
# Appends a layer for features that no other layer draws: lines, whose width is the same at all zooms, or points, drawn
# as dots by round caps and some px wider.
function(plain_lines out what filter more)
  set(layer ",\n    {\"id\": \"plain-${what}\", \"type\": \"line\", \"metadata\": {\"camber:plain\": true},\n")
  string(APPEND layer "     \"filter\": ${filter},\n")
  string(APPEND layer "     \"layout\": {\"line-cap\": \"round\", \"line-join\": \"round\", \"line-round-limit\": 1},\n")
  string(APPEND layer "     \"paint\": {\"line-color\": [\"global-state\", \"plain-color\"],\n")
  string(APPEND layer "               \"line-width\": [\"+\", ${more}, [\"global-state\", \"plain-width\"]]}}")
  set(${out} "${${out}}${layer}" PARENT_SCOPE)
endfunction()

# Writes NAME-THEME.json into the folder: a background, followed by the layers. METADATA, SOURCES: other members.
function(road_document NAME THEME LAYERS folder)
  set(PAPER ${${THEME}_paper})
  set(PLAIN_COLOR ${${THEME}_plain})
  set(PLAIN_FILL ${${THEME}_plain_fill})
  configure_file(${PROJECT_SOURCE_DIR}/src/style/roads.json.in ${folder}/${NAME}-${THEME}.json @ONLY)
endfunction()

function(road_style theme folder)
  set(layers "")
  set(HEAD "")
  set(with_osm ON)
  append_network(layers ${theme} osm "" "")
  plain_lines(layers line "[\"==\", [\"geometry-type\"], \"LineString\"]" 0)
  label_layers(layers ${theme} OFF street_small street street_main shield)
  road_document(roads ${theme} "${layers}" ${folder})
endfunction()
