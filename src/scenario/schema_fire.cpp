#include "scenario/schema.h"

namespace pyroscene::scenario {

std::string fire_sections() {
    return R"json(    "fire": {
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
          "description": "low heat of the fuel: fireline intensity, burning rate, energy budget; given with heat_flux: smoke too"},
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
          "description": "turns heat back into fuel, for its smoke; default: fire.heat_of_combustion_J_kg if given with heat_flux, else 17.433e6"}
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
)json";
}

}  // namespace pyroscene::scenario
