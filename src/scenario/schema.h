#pragma once

#include <string>

namespace pyroscene::scenario {

/// The sections `fire`, `flame`, `plume` and `scar`, each followed by a comma.
std::string fire_sections();

/// `inputs` and its sources as entries of the schema's $defs, each followed by a comma.
std::string input_definitions();

}  // namespace pyroscene::scenario
