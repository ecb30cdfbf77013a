#pragma once

#include "fire/state.h"
#include "pipeline/session.h"

namespace pyroscene::pipeline {

/// Makes the fire states that are not current, with their lists of fronts, from the first gap on; writes the rasters of a
/// modelled fire first, records the energy of all frames. Throws Error (input or runtime) and Cancelled.
void prepare_phase(Session& session);

/// The state that an acquisition sees: that of the last frame at or before it. Throws an input error when it is not there as the
/// scenario says.
fire::FireState state_for(const Session& session, const scenario::Acquisition& acquisition);

}  // namespace pyroscene::pipeline
