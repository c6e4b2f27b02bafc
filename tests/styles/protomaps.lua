-- A profile for tilemaker: the layers of Protomaps' basemap (version 4), as far as its style and a city need them.
-- Kinds come from OpenStreetMap's tags in the way of Protomaps' own profile; its generalization is left out.

node_keys = {"place", "amenity", "shop", "tourism", "railway", "natural", "leisure", "aeroway", "highway", "historic"}

local roads = { -- kind, min_zoom
    motorway = {"highway", 3}, trunk = {"major_road", 6}, primary = {"major_road", 7}, secondary = {"major_road", 9},
    tertiary = {"major_road", 9}, unclassified = {"minor_road", 12}, residential = {"minor_road", 12},
    living_street = {"minor_road", 12}, road = {"minor_road", 12}, service = {"minor_road", 13},
    pedestrian = {"path", 12}, footway = {"path", 13}, path = {"path", 13}, cycleway = {"path", 13},
    bridleway = {"path", 13}, steps = {"path", 13}, track = {"path", 13}, corridor = {"path", 14},
}
local landuse = { -- by tag, then by value
    landuse = {residential = "residential", cemetery = "cemetery", forest = "forest", grass = "grass",
        industrial = "industrial", military = "military", railway = "railway", recreation_ground = "recreation_ground",
        village_green = "park", meadow = "meadow", farmland = "farmland", allotments = "allotments"},
    leisure = {park = "park", garden = "garden", golf_course = "golf_course", pitch = "pitch", stadium = "stadium",
        nature_reserve = "nature_reserve", playground = "playground", dog_park = "park"},
    natural = {wood = "wood", beach = "beach", sand = "sand", scrub = "scrub", grassland = "grassland"},
    amenity = {school = "school", university = "university", college = "college", hospital = "hospital",
        kindergarten = "kindergarten"},
    aeroway = {aerodrome = "aerodrome", runway = "runway"},
    tourism = {zoo = "zoo"},
}
local pois = { -- kind, min_zoom
    amenity = {school = {"school", 15}, university = {"university", 13}, library = {"library", 15},
        toilets = {"toilets", 16}, drinking_water = {"drinking_water", 16}, bench = {"bench", 17},
        ferry_terminal = {"ferry_terminal", 14}},
    leisure = {park = {"park", 13}, garden = {"garden", 14}, marina = {"marina", 14}, stadium = {"stadium", 14}},
    natural = {peak = {"peak", 12}, beach = {"beach", 13}},
    railway = {station = {"station", 12}},
    highway = {bus_stop = {"bus_stop", 16}},
    tourism = {zoo = {"zoo", 13}},
    aeroway = {aerodrome = {"aerodrome", 11}},
}
local places = { -- kind, min_zoom, population_rank
    city = {"locality", 6, 11}, town = {"locality", 8, 8}, village = {"locality", 10, 5}, hamlet = {"locality", 11, 3},
    suburb = {"neighbourhood", 11, 4}, neighbourhood = {"neighbourhood", 12, 3}, quarter = {"neighbourhood", 12, 3},
    state = {"region", 3, 12}, country = {"country", 1, 14},
}

function init_function() end
function exit_function() end

local function write_names(object)
    for _, key in ipairs({"name", "name:en"}) do
        local name = object:Find(key)
        if name ~= "" then object:Attribute(key, name) end
    end
end

local function write_poi(object, is_area)
    for key, kinds in pairs(pois) do
        local poi = kinds[object:Find(key)]
        if poi then
            if is_area then object:LayerAsCentroid("pois") else object:Layer("pois", false) end
            object:MinZoom(poi[2] - 1)
            object:Attribute("kind", poi[1])
            object:AttributeNumeric("min_zoom", poi[2])
            write_names(object)
            return
        end
    end
end

function node_function(node)
    local place = places[node:Find("place")]
    if place then
        node:Layer("places", false)
        node:MinZoom(place[2])
        node:Attribute("kind", place[1])
        node:Attribute("kind_detail", node:Find("place"))
        node:AttributeNumeric("min_zoom", place[2])
        node:AttributeNumeric("population_rank", place[3])
        write_names(node)
    end
    write_poi(node, false)
end

local function write_road(way)
    local class = way:Find("highway")
    local is_link = class:sub(-5) == "_link"
    if is_link then class = class:sub(1, -6) end
    local road = roads[class]
    if not road or way:Find("area") == "yes" then return end
    way:Layer("roads", false)
    way:MinZoom(is_link and math.max(road[2], 11) or road[2])
    way:Attribute("kind", road[1])
    way:Attribute("kind_detail", class)
    way:AttributeNumeric("min_zoom", road[2])
    if is_link then way:AttributeBoolean("is_link", true) end
    if way:Find("tunnel") == "yes" then way:AttributeBoolean("is_tunnel", true) end
    if way:Find("bridge") == "yes" then way:AttributeBoolean("is_bridge", true) end
    write_names(way)
end

local function write_line(way, kind, detail, zoom)
    way:Layer("roads", false)
    way:MinZoom(zoom)
    way:Attribute("kind", kind)
    way:Attribute("kind_detail", detail)
    way:AttributeNumeric("min_zoom", zoom)
    write_names(way)
end

local function write_areas(way)
    if way:Find("building") ~= "" then
        way:Layer("buildings", true)
        way:MinZoom(13)
        way:Attribute("kind", "building")
    end
    if way:Find("natural") == "water" or way:Find("waterway") == "riverbank" or way:Find("landuse") == "basin" then
        way:Layer("water", true)
        way:MinZoom(6)
        way:Attribute("kind", "water")
        if way:Find("name") ~= "" then
            way:LayerAsCentroid("water")
            way:MinZoom(12)
            way:Attribute("kind", "water")
            write_names(way)
        end
    end
    for key, kinds in pairs(landuse) do
        local kind = kinds[way:Find(key)]
        if kind then
            way:Layer("landuse", true)
            way:MinZoom(7)
            way:Attribute("kind", kind)
        end
    end
    write_poi(way, true)
end

function way_function(way)
    write_road(way)
    if way:Find("railway") == "rail" then write_line(way, "rail", "rail", 11) end
    if way:Find("aeroway") == "taxiway" then write_line(way, "aeroway", "taxiway", 12) end
    if way:Find("aeroway") == "runway" then write_line(way, "aeroway", "runway", 9) end
    if way:Find("man_made") == "pier" then write_line(way, "path", "pier", 12) end
    local waterway = way:Find("waterway")
    if waterway == "river" or waterway == "stream" or waterway == "canal" then
        way:Layer("water", false)
        way:MinZoom(waterway == "river" and 9 or 12)
        way:Attribute("kind", waterway)
        write_names(way)
    end
    local level = tonumber(way:Find("admin_level"))
    if way:Find("boundary") == "administrative" and level and level <= 4 then
        way:Layer("boundaries", false)
        way:AttributeNumeric("kind_detail", level)
    end
    if way:IsClosed() then write_areas(way) end
end
