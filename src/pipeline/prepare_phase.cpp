#include "pipeline/prepare_phase.h"

#include <algorithm>
#include <memory>

#include <tbb/parallel_pipeline.h>

#include "base/files.h"
#include "pipeline/energy.h"
#include "pipeline/fronts.h"
#include "pipeline/scenario_warnings.h"
#include "pipeline/spread_output.h"
#include "pipeline/state_file.h"

namespace pyroscene::pipeline {
namespace {

using scenario::Acquisition;

/// What the flame relations could not do as asked, front cells of all frames made in this run.
void count_flames(RunReport& report, const fire::FlameCounts& counts) {
    const std::pair<const char*, std::int64_t> named[] = {
        {"front_cells_without_flame_height", counts.without_height},
        {"front_cells_with_intensity_by_heat_flux", counts.intensity_by_heat_flux},
        {"front_cells_with_depth_by_heat_flux", counts.depth_by_heat_flux},
    };
    for (const auto& [name, count] : named)
        if (count > 0) report.count(name, count);
}

/// Lists the connected fronts beside the state. The report tells them for every frame of a short series, else for those that
/// are looked at, so that it stays small.
void write_fronts(Session& s, std::size_t i, const fire::FireState& state, const Raster<float>& heat_flux_W_m2) {
    constexpr std::size_t kShortSeries = 100;
    const auto path = state_path(s.options.output, state.time_s);
    const auto fronts = find_fronts(state, heat_flux_W_m2);
    write_text_file(fronts_path(path), fronts_csv(fronts));
    const auto& frames = s.inputs.frames;
    const auto& wanted = s.scenario.acquisitions;
    const bool seen = std::any_of(wanted.begin(), wanted.end(), [&](const Acquisition& a) {
        return a.time_s >= frames[i].time_s && (i + 1 == frames.size() || a.time_s < frames[i + 1].time_s);
    });
    if (frames.size() <= kShortSeries || seen) record_fronts(s.report, fronts, path.stem().string());
}

/// The states from frame `first` on, in order: while one is written, the rasters of the next are read.
/// \param previous  state before `first`; null before the first frame
void make_states(Session& s, std::size_t first, std::shared_ptr<const fire::FireState> previous) {
    struct Frame {
        std::size_t index;
        fire::FrameInputs inputs;
        std::shared_ptr<const fire::FireState> state;
    };
    using OnItsWay = std::shared_ptr<Frame>;
    constexpr auto kInOrder = tbb::filter_mode::serial_in_order;
    constexpr std::size_t kAtOnce = 2;
    const std::size_t count = s.inputs.frames.size();
    std::size_t next = first;
    const auto read = tbb::make_filter<void, OnItsWay>(kInOrder, [&](tbb::flow_control& flow) -> OnItsWay {
        if (next == count) {
            flow.stop();
            return nullptr;
        }
        s.stop_if_cancelled();
        s.progress("prepare", static_cast<double>(next) / static_cast<double>(count));
        const std::size_t i = next++;
        return std::make_shared<Frame>(Frame{i, inputs::load_frame(s.scenario, s.inputs, i), nullptr});
    });
    const auto advance = tbb::make_filter<OnItsWay, OnItsWay>(kInOrder, [&](OnItsWay frame) {
        previous = std::make_shared<const fire::FireState>(fire::advance(previous.get(), frame->inputs, s.scenario.fire));
        frame->state = previous;
        count_flames(s.report, previous->flame_counts);
        return frame;
    });
    const auto write = tbb::make_filter<OnItsWay, void>(kInOrder, [&](const OnItsWay& frame) {
        const double time_s = frame->inputs.time_s;
        write_fronts(s, frame->index, *frame->state, frame->inputs.heat_flux_W_m2);
        write_state(state_path(s.options.output, time_s), *frame->state, s.fingerprints.state(time_s), s.utc(time_s));
        s.report.count("states_made", 1);
    });
    tbb::parallel_pipeline(kAtOnce, read & advance & write);
}

}  // namespace

void prepare_phase(Session& s) {
    const PhaseTimer timer(s.report, "prepare");
    for (const auto& warning : scenario_warnings(s.scenario, s.inputs)) s.report.warn(warning);
    if (s.inputs.modelled) {
        record_spread(s.report, *s.inputs.modelled);
        const auto print = s.fingerprints.state(s.inputs.frames.back().time_s);
        if (!is_current(s.options.output / "spread" / "arrival.tif", print, s.options))
            write_front_rasters(*s.inputs.modelled, s.options.output / "spread", print);
    }
    const std::size_t count = s.inputs.frames.size();
    // The states that are still current need not be made again; work starts from the last one before the first gap.
    std::size_t first = 0;
    const auto path_of = [&](std::size_t i) { return state_path(s.options.output, s.inputs.frames[i].time_s); };
    const auto print_of = [&](std::size_t i) { return s.fingerprints.state(s.inputs.frames[i].time_s); };
    while (first < count && is_current(path_of(first), print_of(first), s.options)) ++first;
    s.report.count("states_skipped", static_cast<std::int64_t>(first));
    if (first == count) {
        record_inputs_energy(s.report, s.scenario, s.inputs, s.options.output);
        return;
    }
    std::shared_ptr<const fire::FireState> previous;
    if (first > 0)
        previous =
            std::make_shared<const fire::FireState>(read_state(path_of(first - 1), s.inputs.grid, s.inputs.arrival_time_s));
    make_states(s, first, std::move(previous));
    record_inputs_energy(s.report, s.scenario, s.inputs, s.options.output);
    s.progress("prepare", 1.0);
}

fire::FireState state_for(const Session& s, const Acquisition& acquisition) {
    const auto frame = inputs::frame_at(s.inputs.frames, acquisition.time_s, acquisition.id);
    const auto path = state_path(s.options.output, s.inputs.frames[frame].time_s);
    if (!is_current(path, s.fingerprints.state(s.inputs.frames[frame].time_s), RunOptions{}))
        throw input_error(path.string(), "no current fire state for this scenario; run 'pyroscene prepare' first");
    auto state = read_state(path, s.inputs.grid, s.inputs.arrival_time_s);
    state.scar_class = s.inputs.scar_class;
    return state;
}

}  // namespace pyroscene::pipeline
