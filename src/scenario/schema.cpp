#include "scenario/schema.h"
#include "scenario/scenario.h"

namespace pyroscene::scenario {

namespace {

/// The keys, types and bounds that the readers check; tests hold both together, and with docs/scenario.md.
constexpr const char* kSchema = R"json({
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
    "fire": {
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "front_threshold_W_m2": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e8, "default": 1000},
        "front_temperature_K": {"$ref": "#/$defs/temperature_K", "default": 1073.15},
        "ambient_temperature_K": {"$ref": "#/$defs/temperature_K", "default": 307.15},
        "flaming_heat_flux_W_m2": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e8, "default": 5e5},
        "one_sigma_rule": {"type": "boolean", "default": true},
        "jitter_m": {"type": "number", "minimum": 0, "maximum": 1000, "default": 0},
        "embers": {
          "description": "detached flame: drifts with the wind and cools",
          "type": "object",
          "additionalProperties": false,
          "properties": {
            "drift": {"type": "boolean", "default": true},
            "cooling_time_s": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e4, "default": 2},
            "lifetime_s": {"type": "number", "minimum": 0, "maximum": 1e5, "default": 6},
            "wind_height_m": {"type": "number", "minimum": 0.1, "maximum": 1000, "default": 6.1},
            "wind_exponent": {"type": "number", "minimum": 0, "maximum": 1, "default": 0.143}
          }
        },
        "flame_height": {
          "type": "object",
          "additionalProperties": false,
          "properties": {
            "method": {"default": "heat_flux", "enum": ["heat_flux", "heskestad", "byram", "weise_biging", "thomas", "nelson_adkins", "nelson_lab", "nelson_field",
              "butler", "clark", "fernandes", "finney_grumstrup", "constant", "raster"]},
            "alpha": {"type": "number", "exclusiveMinimum": 0, "maximum": 100, "default": 1},
            "volumetric_heat_release_W_m3": {"type": "number", "minimum": 1e4, "maximum": 1e8, "default": 2e6},
            "constant_m": {"type": "number", "exclusiveMinimum": 0, "maximum": 500, "default": 2},
            "air_fuel_ratio": {"type": "number", "minimum": 0.5, "maximum": 50, "default": 5.5},
            "plume_coefficient_m_kW": {"type": "number", "minimum": 0.01, "maximum": 1,
              "description": "Heskestad's A, m kW^-2/5; default: from air, heat of combustion and air_fuel_ratio"},
            "burning_area_fraction": {"type": "number", "exclusiveMinimum": 0, "maximum": 1,
              "description": "of a cell, for Heskestad's diameter; default: the part that flames"},
            "stand_height_m": {"type": "number", "minimum": 0, "maximum": 150, "default": 0}
          }
        },
        "tilt": {
          "type": "object",
          "additionalProperties": false,
          "properties": {
            "method": {"default": "buoyant_velocity", "enum": ["buoyant_velocity", "aga", "thomas", "albini", "putnam", "rule", "butler", "thesis"]},
            "maximum_deg": {"type": "number", "minimum": 0, "maximum": 89, "default": 85},
            "slope": {"type": "boolean", "default": false}
          }
        },
        "heat_of_combustion_J_kg": {"type": "number", "minimum": 1e6, "maximum": 5e7, "default": 16515000,
          "description": "low heat of the fuel: fireline intensity, burning rate, energy budget; if given, smoke too"},
        "maximum_spread_rate_m_s": {"type": "number", "exclusiveMinimum": 0, "maximum": 100, "default": 10},
        "fireline_intensity": {
          "type": "object",
          "additionalProperties": false,
          "properties": {
            "method": {"enum": ["auto", "fuel", "heat_flux"], "default": "auto"},
            "consumed_fraction": {"type": "number", "exclusiveMinimum": 0, "maximum": 1, "default": 1}
          }
        },
        "front_depth": {
          "type": "object",
          "additionalProperties": false,
          "properties": {
            "method": {"enum": ["heat_flux", "residence_time"], "default": "heat_flux"},
            "residence_time_s": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e5,
              "description": "default: of the fuel model where cover has table fbfm13 or fbfm40"}
          }
        },
        "air": {
          "type": "object",
          "additionalProperties": false,
          "properties": {
            "density_kg_m3": {"type": "number", "minimum": 0.1, "maximum": 2, "default": 1.18},
            "heat_capacity_J_kg_K": {"type": "number", "minimum": 500, "maximum": 2000, "default": 1005},
            "temperature_K": {"type": "number", "minimum": 200, "maximum": 400, "default": 300},
            "fuel_vapour_density_kg_m3": {"type": "number", "minimum": 0.05, "maximum": 5, "default": 0.36}
          }
        }
      }
    },
    "flame": {
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "enabled": {"type": "boolean", "default": true},
        "temperature_K": {"$ref": "#/$defs/temperature_K", "default": 1100},
        "profile": {"enum": ["constant", "linear", "mccaffrey"], "default": "constant"},
        "tip_temperature_K": {"$ref": "#/$defs/temperature_K", "default": 823.15},
        "soot_volume_fraction": {"type": "number", "minimum": 0, "maximum": 1e-4, "default": 2e-7},
        "composition": {
          "description": "of the flame gas; mole fractions, nitrogen is what is left",
          "type": "object",
          "additionalProperties": false,
          "properties": {
            "soot_volume_fraction": {"type": "number", "minimum": 0, "maximum": 1e-4, "default": 2e-7},
            "x_H2O": {"$ref": "#/$defs/mole_fraction", "default": 0.14},
            "x_CO2": {"$ref": "#/$defs/mole_fraction", "default": 0.10},
            "x_CO": {"$ref": "#/$defs/mole_fraction", "default": 0.02},
            "x_CH4": {"$ref": "#/$defs/mole_fraction", "default": 0},
            "x_O2": {"$ref": "#/$defs/mole_fraction", "default": 0.03},
            "potassium_ppm": {"type": "number", "minimum": 0, "maximum": 1000, "default": 1},
            "sodium_ppm": {"type": "number", "minimum": 0, "maximum": 1000, "default": 0}
          }
        },
        "pressure_Pa": {"type": "number", "minimum": 10000, "maximum": 120000, "description": "of the flame gas; default: standard atmosphere at the ground"},
        "hot_gas": {"type": "boolean", "description": "gas and alkali lines beside soot; default: true, with physics thesis false"},
        "absorption_per_m": {"type": "number", "minimum": 0, "maximum": 1e4, "description": "grey, instead of soot"},
        "voxel_m": {"type": "array", "minItems": 3, "maxItems": 3, "default": [5, 5, 1],
          "items": {"type": "number", "minimum": 0.05, "maximum": 200}},
        "radiant_fraction": {"type": "number", "exclusiveMinimum": 0, "maximum": 0.9,
          "description": "(front + flame) / heat released, met by scaling the flame"},
        "adjust": {"enum": ["soot", "temperature"], "default": "soot"},
        "ember_gap_m": {"type": "number", "minimum": 0, "maximum": 100, "default": 0.5}
      }
    },
    "plume": {
      "description": "smoke and hot gas above the fire: from inputs.plume, or risen by a model",
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "model": {"enum": ["none", "rise"], "default": "none"},
        "voxel_m": {"type": "array", "minItems": 3, "maxItems": 3, "default": [20, 20, 20],
          "items": {"type": "number", "minimum": 0.5, "maximum": 1000}},
        "top_m": {"type": "number", "exclusiveMinimum": 0, "maximum": 20000, "default": 1500},
        "duration_s": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e5, "default": 600},
        "minimum_excess_K": {"type": "number", "minimum": 0, "maximum": 1000, "default": 1},
        "entrainment": {"type": "number", "minimum": 0.05, "maximum": 2, "default": 0.6},
        "merge_m": {"type": "number", "minimum": 0, "maximum": 1e5, "default": 200},
        "temperature_K": {"$ref": "#/$defs/temperature_K", "description": "of every voxel, instead of the computed one"},
        "absorption_per_m": {"type": "number", "minimum": 0, "maximum": 1e3, "description": "grey, of every voxel, instead of smoke"},
        "layers": {"description": "horizontally uniform smoke", "type": "array", "items": {"type": "object", "additionalProperties": false,
          "required": ["bottom_m", "top_m"],
          "properties": {
            "bottom_m": {"type": "number", "minimum": -500, "maximum": 20000},
            "top_m": {"type": "number", "minimum": -500, "maximum": 20000},
            "concentration_g_m3": {"type": "number", "minimum": 0, "maximum": 10},
            "optical_depth_550nm": {"type": "number", "minimum": 0, "maximum": 100},
            "temperature_K": {"$ref": "#/$defs/temperature_K"}
          }}},
        "smoke": {"enum": ["savanna", "cerrado", "amazon_forest", "boreal_forest"], "default": "savanna"},
        "multiple_scattering": {"type": "boolean", "default": true, "description": "false: smoke scatters light once"},
        "emission_factor_g_kg": {"type": "number", "minimum": 0, "maximum": 1000, "default": 10},
        "heat_of_combustion_J_kg": {"type": "number", "minimum": 1e6, "maximum": 1e8,
          "description": "turns heat back into fuel, for its smoke; default: fire.heat_of_combustion_J_kg if given, else 17.433e6"}
      }
    },
    "scar": {
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "model": {"enum": ["double_exponential", "single_exponential"], "default": "double_exponential"},
        "amplitude1_K": {"type": "number", "minimum": 0, "maximum": 3000, "default": 578.97},
        "time_constant1_s": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e7, "default": 74.88},
        "amplitude2_K": {"type": "number", "minimum": 0, "maximum": 3000, "default": 197.50},
        "time_constant2_s": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e7, "default": 247.72},
        "floor_K": {"$ref": "#/$defs/temperature_K", "default": 306.34},
        "by_cover": {"type": "string", "description": "CSV: curve of each class of inputs.cover"}
      }
    },
    "surface": {
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

std::string json_schema() { return kSchema + std::string("  \"$defs\": {\n") + input_definitions() + kDefinitions; }

}  // namespace pyroscene::scenario
