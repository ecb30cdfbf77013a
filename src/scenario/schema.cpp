#include "scenario/schema.h"
#include "scenario/scenario.h"

namespace pyroscene::scenario {

namespace {

/// The keys, types and bounds that the readers check; tests hold both together, and with docs/scenario.md.
constexpr const char* kHead = R"json({
  "$schema": "https://json-schema.org/draft/2020-12/schema",
  "title": "Pyroscene scenario",
  "type": "object",
  "additionalProperties": false,
  "required": ["pyroscene", "inputs", "start", "acquisitions"],
  "properties": {
    "pyroscene": {"const": 1, "description": "version of this format"},
    "name": {"$ref": "#/$defs/name", "description": "plain name, used in outputs; default: the file's name"},
    "title": {"type": "string", "description": "free text"},
    "map": {
      "description": "map grid of the scene; default: the terrain's grid, or its UTM/UPS zone when it is geographic",
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "crs": {"type": "string", "description": "projected CRS, anything PROJ understands", "examples": ["EPSG:32611"]},
        "cell_m": {"$ref": "#/$defs/cell_m"}
      }
    },
    "geoid_undulation_m": {"type": "number", "minimum": -120, "maximum": 120, "default": 0,
      "description": "added to terrain heights to make them ellipsoidal"},
    "inputs": {"$ref": "#/$defs/inputs"},
    "start": {"type": "string", "description": "ignition, UTC", "examples": ["2017-07-15T22:00:00Z"],
      "pattern": "^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}(:[0-9]{2}([.][0-9]+)?)?Z$"},
    "physics": {"enum": ["default", "thesis"], "default": "default"},
)json";

/// What the fire lies on, who looks at it, what comes out.
constexpr const char* kScene = R"json(    "surface": {
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "unburned": {"$ref": "#/$defs/surface", "default": "grass_dry"},
        "burned": {"$ref": "#/$defs/surface", "default": "char_black"},
        "ash": {"$ref": "#/$defs/surface", "default": "ash_gray"},
        "burn_severity": {"type": "number", "minimum": 0, "maximum": 1, "default": 0,
          "description": "share of ash in burnt ground"},
        "spectra": {"type": "object", "additionalProperties": {"type": "string"},
          "description": "reflectance spectra by name: CSV or ENVI .sli"},
        "emissivity": {"type": "number", "exclusiveMinimum": 0, "maximum": 1, "description": "grey, for all ground"}
      }
    },
    "atmosphere": {
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "model": {"default": "midlatitude_summer", "enum": ["midlatitude_summer", "midlatitude_winter",
          "subarctic_summer", "tropical", "us_standard_1976", "none"]},
        "visibility_km": {"type": "number", "minimum": 1, "maximum": 300, "default": 23},
        "ground_elevation_m": {"type": "number", "minimum": -500, "maximum": 6000,
          "description": "default: mean terrain height"},
        "file": {"type": "string", "description": "look-up table in netCDF, instead of model and visibility"}
      }
    },
    "render": {
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "samples_per_axis": {"type": "integer", "minimum": 1, "maximum": 16, "default": 3},
        "light_directions": {"type": "integer", "minimum": 4, "maximum": 65536, "default": 64},
        "light_reach_m": {"type": "number", "minimum": 0, "maximum": 10000, "default": 500},
        "flame_light": {"type": "boolean", "default": true},
        "flame_light_model": {"enum": ["hemisphere", "point_sources"], "default": "hemisphere"},
        "point_source_cut": {"type": "number", "minimum": 0, "maximum": 1, "default": 0.01},
        "light_bounces": {"type": "integer", "minimum": 1, "maximum": 16, "default": 3},
        "light_decay": {"type": "integer", "minimum": 1, "maximum": 64, "default": 4},
        "sun": {"type": "boolean", "default": true},
        "background": {"type": "string", "default": "cover"},
        "noise": {"type": "boolean", "default": true}
      }
    },
    "acquisitions": {
      "description": "one image each",
      "type": "array",
      "minItems": 1,
      "items": {
        "type": "object",
        "additionalProperties": false,
        "required": ["id", "sensor", "time_s", "platform"],
        "properties": {
          "id": {"$ref": "#/$defs/name", "description": "folder of its outputs; unique"},
          "sensor": {"type": "string", "description": "id of a shipped sensor or path of a sensor file", "examples": ["wasp"]},
          "time_s": {"type": "number", "minimum": 0, "maximum": 1e8, "description": "since start"},
          "platform": {
            "type": "object",
            "additionalProperties": false,
            "oneOf": [{"required": ["altitude_agl_m"]}, {"required": ["altitude_m"]}, {"required": ["pass"]},
              {"required": ["trajectory"]}],
            "properties": {
              "over": {
                "default": "centre",
                "oneOf": [
                  {"enum": ["centre", "fire"]},
                  {"type": "object", "additionalProperties": false, "required": ["x_m", "y_m"],
                   "properties": {"x_m": {"type": "number"}, "y_m": {"type": "number"}}},
                  {"type": "object", "additionalProperties": false, "required": ["lat_deg", "lon_deg"],
                   "properties": {"lat_deg": {"type": "number", "minimum": -90, "maximum": 90},
                                  "lon_deg": {"type": "number", "minimum": -180, "maximum": 180}}}
                ]
              },
              "altitude_agl_m": {"type": "number", "exclusiveMinimum": 0, "maximum": 5e7},
              "altitude_m": {"type": "number", "minimum": -500, "maximum": 5e7},
              "heading_deg": {"type": "number", "minimum": -360, "maximum": 360, "default": 0},
              "pitch_deg": {"type": "number", "minimum": -180, "maximum": 180, "default": 0},
              "roll_deg": {"type": "number", "minimum": -180, "maximum": 180, "default": 0},
              "ground_speed_m_s": {"type": "number", "exclusiveMinimum": 0, "maximum": 20000,
                "description": "of a flight line; default: the sensor file's"},
              "pass": {"enum": ["ascending", "descending", "geostationary"],
                "description": "on the orbit of the sensor file, instead of an altitude"},
              "scan_angle_deg": {"type": "number", "minimum": -90, "maximum": 90,
                "description": "where in the scan of a pass the place is seen, positive to the right"},
              "trajectory": {"type": "string", "description": "CSV of poses, instead of place and altitude"}
            }
          },
          "groups": {"$ref": "#/$defs/words", "description": "camera groups of the sensor; default: all"},
          "bands": {"$ref": "#/$defs/words", "description": "bands of the sensor; default: all"},
          "view": {"type": "string", "description": "of a conical scanner: nadir, forward, oblique"},
          "samples": {"enum": ["scene", "all"], "default": "scene",
            "description": "scanners: the part of each line that sees the map, or whole lines"},
          "lines": {"type": "integer", "minimum": 2, "maximum": 100000,
            "description": "scanners: how many; default: those that see the map"}
        }
      }
    },
    "mosaics": {
      "type": "array",
      "description": "images of one sensor merged on the map",
      "items": {
        "type": "object",
        "additionalProperties": false,
        "required": ["id", "of"],
        "properties": {
          "id": {"$ref": "#/$defs/name"},
          "of": {"type": "array", "minItems": 2, "uniqueItems": true, "items": {"type": "string"}, "description": "ids of acquisitions"},
          "rule": {"enum": ["nearest_nadir", "latest", "earliest"], "description": "default: nearest_nadir"}
        }
      }
    },
    "products": {
      "type": "array",
      "minItems": 1,
      "uniqueItems": true,
      "items": {"enum": ["radiance", "brightness_temperature", "ortho", "truth", "fractions", "frp", "quicklook", "report", "native"]},
      "default": ["radiance", "brightness_temperature", "ortho", "truth", "fractions", "frp", "quicklook", "report"]
    },
    "seed": {"type": "integer", "minimum": 0, "default": 1}
  },
)json";

/// What several keys refer to.
constexpr const char* kDefinitions =
    R"json(    "file_or_files": {"oneOf": [{"type": "string"}, {"$ref": "#/$defs/files"}]},
    "files": {"type": "array", "minItems": 1, "items": {"type": "string"}},
    "name": {"type": "string", "maxLength": 100, "pattern": "^[A-Za-z0-9][A-Za-z0-9._-]*$"},
    "words": {"type": "array", "minItems": 1, "items": {"type": "string"}},
    "temperature_K": {"type": "number", "minimum": 200, "maximum": 3500},
    "mole_fraction": {"type": "number", "minimum": 0, "maximum": 1},
    "wind_speed": {"type": "number", "minimum": 0, "maximum": 100, "description": "m s-1"},
    "band": {"type": "integer", "minimum": 1, "maximum": 65535, "description": "counted from 1"},
    "bands": {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/band"}},
    "cell_m": {"type": "number", "minimum": 0.1, "maximum": 10000},
    "cells": {"type": "integer", "minimum": 1, "maximum": 100000},
    "map_coordinate_m": {"type": "number", "minimum": -1e8, "maximum": 1e8},
    "offset_s": {"type": "number", "minimum": -1e8, "maximum": 1e8},
    "fuel_table": {"type": "string", "examples": ["fbfm13", "fbfm40", "fbfm53"]},
    "custom_fuel": {"type": "string", "description": "CSV file of more fuel models"},
    "nonburnable": {"type": "array", "items": {"type": "integer"}, "description": "further codes without fire"},
    "fuel": {
      "description": "fuel model of each cell",
      "type": "object",
      "additionalProperties": false,
      "required": ["file", "table"],
      "properties": {
        "file": {"type": "string"},
        "band": {"$ref": "#/$defs/band"},
        "table": {"$ref": "#/$defs/fuel_table", "description": "which codes: fbfm13, fbfm40, fbfm53 (both), or a CSV file of fuel models"},
        "custom": {"$ref": "#/$defs/custom_fuel"},
        "nonburnable": {"$ref": "#/$defs/nonburnable"}
      }
    },
    "times_s": {"type": "array", "minItems": 1, "items": {"type": "number", "minimum": 0},
      "description": "s since start of each frame, ascending; default: band metadata time_s"},
    "surface": {"type": "string", "description": "one of these, or a name of surface.spectra", "examples": ["grass_green", "grass_dry", "grass_cured_20pct_green", "chaparral", "conifer", "litter_needles",
      "soil_bare", "soil_dark", "soil_light", "char_black", "ash_gray", "ash_white", "rock_gravel", "asphalt", "water"]},
    "moisture_pct": {"type": "number", "minimum": 0, "maximum": 1000},
    "position": {"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "number"}, "description": "x, y"},
    "positions": {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/position"}},
    "scaled": {
      "type": "object",
      "additionalProperties": false,
      "required": ["file"],
      "properties": {
        "file": {"type": "string"},
        "band": {"$ref": "#/$defs/band"},
        "scale": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e6, "description": "of the values; without it: 1"}
      }
    },
    "static": {
      "type": "object",
      "additionalProperties": false,
      "required": ["file"],
      "properties": {"file": {"type": "string"}, "band": {"$ref": "#/$defs/band"}}
    },
    "series": {
      "type": "object",
      "additionalProperties": false,
      "oneOf": [{"required": ["file"]}, {"required": ["files"]}],
      "properties": {
        "file": {"type": "string"},
        "files": {"$ref": "#/$defs/files"},
        "band": {"$ref": "#/$defs/band"},
        "bands": {"$ref": "#/$defs/bands"},
        "times_s": {"$ref": "#/$defs/times_s"}
      }
    }
  }
}
)json";

}  // namespace

std::string json_schema() {
    return kHead + fire_sections() + kScene + "  \"$defs\": {\n" + input_definitions() + kDefinitions;
}

}  // namespace pyroscene::scenario
