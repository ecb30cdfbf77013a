#include "scenario/scenario.h"

namespace pyroscene::scenario {

std::string json_schema() { return "{}"; }

}  // namespace pyroscene::scenario
