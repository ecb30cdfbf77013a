#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenario/arrival_model_source.h"
#include "scenario/schema.h"

namespace pyroscene::scenario {

namespace {

/// Times of the frames of a fire that the program computes (read_fire_inputs.cpp).
constexpr std::string_view kFrameKeys = R"json("duration_s": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e7},
        "frame_step_s": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e7, "description": "without it: 300"},
        "frames_s": {"type": "array", "minItems": 1, "items": {"type": "number"}, "description": "instead of both"},
        "mean_over_s": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e7,
          "description": "default: 6, or the shortest time between frames when that is less"},
        "coarse_burn_time_s": {"type": "number", "minimum": 1, "maximum": 1e5, "description": "without it: 300"})json";

/// A place on the map (read_spread.cpp).
constexpr std::string_view kShapeKeys = R"json("file": {"type": "string", "description": "any vector format"},
            "layer": {"type": "string"},
            "point": {"$ref": "#/$defs/position"},
            "points": {"$ref": "#/$defs/positions"},
            "line": {"$ref": "#/$defs/positions"},
            "polygon": {"$ref": "#/$defs/positions"},
            "crs": {"type": "string", "description": "of the coordinates; default: the map's"})json";

std::string quoted(const std::vector<std::string>& words) { return fmt::format(R"("{}")", fmt::join(words, R"(", ")")); }

/// A raster whose unit is said.
std::string unit_raster(const std::vector<std::string>& units) {
    return fmt::format(R"json({{"type": "object", "additionalProperties": false, "required": ["file"],
          "properties": {{"file": {{"type": "string"}}, "band": {{"$ref": "#/$defs/band"}}, "unit": {{"enum": [{}]}}}}}})json",
                       quoted(units));
}

std::string main_keys() {
    return R"json(    "inputs": {
      "type": "object",
      "additionalProperties": false,
      "anyOf": [{"required": ["terrain"]}, {"required": ["landscape"]}, {"required": ["wrf_sfire"]}],
      "oneOf": [{"required": ["heat_flux"], "not": {"required": ["wrf_sfire"]}}, {"required": ["wrf_sfire"]},
                {"required": ["spread"]}, {"required": ["arrival_model"]}],
      "properties": {
        "terrain": {"$ref": "#/$defs/static", "description": "elevation, m"},
        "landscape": {"$ref": "#/$defs/landscape"},
        "heat_flux": {"$ref": "#/$defs/heat_flux"},
        "fuel_load": {"$ref": "#/$defs/series", "description": "fuel load, kg m-2"},
        "wind": {"$ref": "#/$defs/wind"},
        "arrival": {"$ref": "#/$defs/static", "description": "time of arrival of the fire, s since start"},
        "fireline_intensity": {"$ref": "#/$defs/static", "description": "as the front passes, W m-1"},
        "flame_length": {"$ref": "#/$defs/static", "description": "along the leaning axis, m; for flame_height.method: raster"},
        "spread_rate": {"$ref": "#/$defs/static", "description": "of the front, m s-1; default: from arrival"},
        "arrival_model": {"$ref": "#/$defs/arrival_model"},
        "wrf_sfire": {"$ref": "#/$defs/wrf_sfire"},
        "spread": {"$ref": "#/$defs/spread"},
        "plume": {"$ref": "#/$defs/input_plume"},
        "cover": {"$ref": "#/$defs/cover"}
      }
    },
    "heat_flux": {
      "description": "sensible heat flux of the surface fire, W m-2: rasters, or the files of a program that writes none",
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "file": {"type": "string", "description": "raster of several frames; FDS: index of the run (.smv)"},
        "files": {"$ref": "#/$defs/files", "description": "QUIC-Fire: one per moment"},
        "band": {"$ref": "#/$defs/band"},
        "bands": {"$ref": "#/$defs/bands"},
        "times_s": {"$ref": "#/$defs/times_s"},
        "model": {"enum": ["quic-fire", "fds"], "description": "without it: rasters"},
        "crs": {"type": "string", "description": "projected, metres; of the program's coordinates"},
        "west_m": {"$ref": "#/$defs/map_coordinate_m", "description": "their origin"},
        "south_m": {"$ref": "#/$defs/map_coordinate_m", "description": "their origin"},
        "cols": {"$ref": "#/$defs/cells"},
        "rows": {"$ref": "#/$defs/cells"},
        "cell_m": {"$ref": "#/$defs/cell_m"},
        "quantity": {"type": "string", "description": "FDS; without it: HRRPUA, else HRRPUV"},
        "offset_s": {"$ref": "#/$defs/offset_s", "description": "of the program's clock: its 0 is so long after start"}
      }
    },
    "landscape": {
      "description": "terrain, fuel and canopy in one file of FARSITE (LCP) or LANDFIRE (GeoTIFF); inputs beside it go before its bands",
      "type": "object",
      "additionalProperties": false,
      "required": ["file", "scheme"],
      "properties": {
        "file": {"type": "string"},
        "scheme": {"$ref": "#/$defs/fuel_table", "description": "what the fuel codes count: fbfm13, fbfm40, fbfm53 (both), or a CSV file of fuel models"},
        "custom": {"$ref": "#/$defs/custom_fuel"},
        "nonburnable": {"$ref": "#/$defs/nonburnable"},
        "crs": {"type": "string", "description": "of a file that does not say its own"}
      }
    })json";
}

std::string wind_keys() {
    return R"json(    "wind": {
      "description": "rasters of u and v (m s-1) or one vector for the whole map; absent: calm",
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "file": {"type": "string"},
        "files": {"$ref": "#/$defs/files"},
        "bands": {
          "description": "u, v of each frame; [u, v] = as stored: 1, 2 (3, 4, ...)",
          "oneOf": [{"const": ["u", "v"]},
                    {"type": "array", "minItems": 2, "items": {"type": "integer", "minimum": 1, "maximum": 65535}}]
        },
        "times_s": {"$ref": "#/$defs/times_s"},
        "speed": {"$ref": "#/$defs/wind_speed"},
        "speed_m_s": {"$ref": "#/$defs/wind_speed"},
        "from_deg": {"type": "number", "minimum": -360, "maximum": 360,
          "description": "where the wind comes from, clockwise from true north"},
        "table": {"type": "string", "description": "CSV file of a station: time_s, speed_m_s, from_deg; instead of the others"},
        "windninja": {
          "description": "rasters of speed and direction, one pair for each moment; instead of the others",
          "type": "object",
          "additionalProperties": false,
          "required": ["speed", "unit"],
          "properties": {
            "speed": {"$ref": "#/$defs/file_or_files", "description": "..._vel.asc"},
            "angle": {"$ref": "#/$defs/file_or_files", "description": "..._ang.asc; without it: beside the speeds"},
            "unit": {"enum": [)json" +
           quoted(kSpeedUnits) + R"json(]},
            "north": {"enum": ["true", "grid"], "description": "from which angles count; without it: true"},
            "crs": {"type": "string", "description": "of files that do not say their own"},
            "times_s": {"$ref": "#/$defs/times_s"}
          }
        },
        "height": {"enum": ["midflame", "20ft", "10m"], "description": "where the wind blows; without it: taken as it is"},
        "height_m": {"type": "number", "minimum": 0.5, "maximum": 500, "description": "the same as a number: above the vegetation"},
        "roughness_m": {"type": "number", "minimum": 1e-5, "maximum": 5,
          "description": "with height_m, which then counts from the ground; without it: the vegetation's"},
        "fuel_depth_m": {"type": "number", "exclusiveMinimum": 0, "maximum": 10, "description": "without it: of the fuel models"},
        "canopy": {"$ref": "#/$defs/canopy", "description": "without it: that of spread or landscape"}
      }
    })json";
}

std::string fire_keys() {
    return R"json(    "arrival_model": {
      "description": "a fire known by the arrival times that FARSITE, FlamMap, ELMFIRE or another program computed",
      "type": "object",
      "additionalProperties": false,
      "required": ["model", "arrival"],
      "properties": {
        "model": {"enum": ["farsite", "flammap", "elmfire", "pyretechnics", "cell2fire", "forefire", "quic-fire", "fds", "other"]},
        "arrival": {"type": "object", "additionalProperties": false,
          "oneOf": [{"required": ["file"]}, {"required": ["files"]}],
          "properties": {
            "file": {"type": "string"}, "band": {"$ref": "#/$defs/band"},
            "files": {"$ref": "#/$defs/files", "description": "ForestGridNN.csv of Cell2Fire, mburnt_integ-TTTTT.bin of QUIC-Fire"},
            "unit": {"enum": [)json" +
           quoted(kTimeUnits) + R"json(]},
            "period": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e5, "description": "of Cell2Fire, in 'unit'; without it: 1"}
          }},
        "like": {"type": "string", "description": "raster of the cells of Cell2Fire (its fuels.asc)"},
        "crs": {"type": "string", "description": "of rasters that do not say their own; of the place of QUIC-Fire and FDS"},
        "west_m": {"$ref": "#/$defs/map_coordinate_m", "description": "x of the origin of QUIC-Fire or FDS"},
        "south_m": {"$ref": "#/$defs/map_coordinate_m", "description": "y of the origin of QUIC-Fire or FDS"},
        "cols": {"$ref": "#/$defs/cells", "description": "nx of QUIC-Fire"},
        "rows": {"$ref": "#/$defs/cells", "description": "ny of QUIC-Fire"},
        "cell_m": {"$ref": "#/$defs/cell_m", "description": "dx of QUIC-Fire"},
        "fireline_intensity": )json" +
           unit_raster(kIntensityUnits) + R"json(,
        "flame_length": )json" +
           unit_raster(kLengthUnits) + R"json(,
        "spread_rate": )json" +
           unit_raster(kRateUnits) + R"json(,
        "offset_s": {"$ref": "#/$defs/offset_s", "description": "start of the model's clock after 'start'; without it: 0"},
        "fuel": {"$ref": "#/$defs/fuel"},
        "fuel_moisture_pct": {"type": "number", "minimum": 0, "maximum": 300, "description": "without it: 8"},
)json" + std::string(kFrameKeys) +
           R"json(      }
    },
    "wrf_sfire": {
      "description": "history files of WRF-SFIRE or WRF-Fire, one or several; inputs beside them go before theirs",
      "oneOf": [
        {"type": "string"},
        {"$ref": "#/$defs/files"},
        {"type": "object",
         "additionalProperties": false,
         "properties": {
           "file": {"type": "string"},
           "files": {"$ref": "#/$defs/files"},
           "crs": {"type": "string", "description": "projected, metres; of an idealised run, which has none"},
           "west_m": {"$ref": "#/$defs/map_coordinate_m", "description": "its western edge"},
           "south_m": {"$ref": "#/$defs/map_coordinate_m", "description": "its southern edge"},
           "plume": {"type": "boolean", "description": "hot air above the fire from its heating RTHFRTEN; without it: false"},
           "fuel_table": {"type": "string", "description": "what NFUEL_CAT counts: fbfm13, fbfm40 or a CSV file code,surface"}
         }}
      ]
    })json";
}

std::string spread_keys() {
    return R"json(    "spread": {
      "description": "a fire that the program spreads itself, instead of heat_flux, fuel_load, arrival and what a front shows",
      "type": "object",
      "additionalProperties": false,
      "required": ["ignition", "moisture"],
      "properties": {
        "fuel": {"$ref": "#/$defs/fuel"},
        "ignition": {"type": "array", "minItems": 1, "items": {
          "type": "object",
          "additionalProperties": false,
          "properties": {
)json" + std::string(kShapeKeys) +
           R"json(,
            "time_s": {"type": "number", "minimum": 0, "maximum": 1e8, "description": "from when on it burns; without it: 0"},
            "area": {"type": "boolean", "description": "lines that close are outlines of areas, which burn as a whole"}
          }}},
        "barriers": {"type": "array", "minItems": 1, "items": {
          "type": "object",
          "additionalProperties": false,
          "properties": {
)json" + std::string(kShapeKeys) +
           R"json(
          }}},
        "moisture": {
          "description": "of the fuel, per cent of its dry mass: numbers, a table, or rasters",
          "type": "object",
          "additionalProperties": false,
          "properties": {
            "m1h_pct": {"$ref": "#/$defs/moisture_pct"},
            "m10h_pct": {"$ref": "#/$defs/moisture_pct"},
            "m100h_pct": {"$ref": "#/$defs/moisture_pct"},
            "mherb_pct": {"$ref": "#/$defs/moisture_pct"},
            "mwoody_pct": {"$ref": "#/$defs/moisture_pct"},
            "table": {"type": "string", "description": "CSV: time_s and the moistures that have no number"},
            "file": {"type": "string", "description": "five bands for each moment, in the order of the keys"},
            "files": {"$ref": "#/$defs/files"},
            "bands": {"type": "array", "minItems": 5, "items": {"$ref": "#/$defs/band"}},
            "times_s": {"$ref": "#/$defs/times_s"}
          }
        },
        "canopy": {"$ref": "#/$defs/canopy"},
        "wind_height": {"enum": ["midflame", "20ft", "10m"], "description": "without it: 20ft"},
        "wind_limit": {"type": "boolean", "description": "without it: false"},
        "curing": {"enum": ["behave", "linear"], "description": "without it: behave"},
)json" + std::string(kFrameKeys) +
           R"json(      }
    })json";
}

std::string other_keys() {
    return R"json(    "canopy": {
      "description": "trees, which shelter the fuel from the wind",
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "cover": {"description": "0 to 1, or a raster",
          "oneOf": [{"type": "number", "minimum": 0, "maximum": 1}, {"$ref": "#/$defs/scaled"}]},
        "height_m": {"description": "0 to 150, or a raster",
          "oneOf": [{"type": "number", "minimum": 0, "maximum": 150}, {"$ref": "#/$defs/scaled"}]},
        "crown_ratio": {"type": "number", "minimum": 0, "maximum": 1, "description": "without it: 0.5"}
      }
    },
    "input_plume": {
      "description": "three-dimensional field above the fire, one band per level",
      "type": "object",
      "additionalProperties": false,
      "required": ["levels_m"],
      "properties": {
        "file": {"type": "string"},
        "files": {"$ref": "#/$defs/files"},
        "times_s": {"$ref": "#/$defs/times_s"},
        "levels_m": {"type": "array", "minItems": 1, "items": {"type": "number", "minimum": 0},
          "description": "heights above the terrain, ascending, one per band"},
        "quantity": {"enum": ["temperature", "excess", "buoyancy"], "description": "without it: temperature"},
        "variable": {"type": "string", "description": "of a netCDF file with several"}
      }
    },
    "cover": {
      "description": "class of each cell and the table that gives each class a surface spectrum",
      "type": "object",
      "additionalProperties": false,
      "required": ["file", "table"],
      "properties": {
        "file": {"type": "string"},
        "band": {"$ref": "#/$defs/band"},
        "table": {"$ref": "#/$defs/fuel_table", "description": "fbfm13, fbfm40, fbfm53 or a CSV file"}
      }
    })json";
}

}  // namespace

std::string input_definitions() {
    return main_keys() + ",\n" + wind_keys() + ",\n" + fire_keys() + ",\n" + spread_keys() + ",\n" + other_keys() + ",\n";
}

}  // namespace pyroscene::scenario
