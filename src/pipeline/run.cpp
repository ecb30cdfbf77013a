#include "pipeline/run.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_pipeline.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/raster_output.h"
#include "pipeline/energy.h"
#include "pipeline/fingerprint.h"
#include "pipeline/fronts.h"
#include "pipeline/hash.h"
#include "pipeline/mosaics.h"
#include "pipeline/products_phase.h"
#include "pipeline/render_phase.h"
#include "pipeline/run_html.h"
#include "pipeline/run_report_file.h"
#include "pipeline/scenario_warnings.h"
#include "pipeline/spread_output.h"
#include "pipeline/state_file.h"

namespace pyroscene::pipeline {
namespace {

using scenario::Acquisition;
using scenario::Scenario;

/// What the phases of one run share.
struct Session {
    const Scenario& scenario;
    const RunOptions& options;
    RunReport& report;
    Fingerprints fingerprints;
    inputs::SceneInputs inputs;
    std::optional<OpticalTables> tables;

    Session(const Scenario& s, const RunOptions& o, RunReport& r)
        : scenario(s), options(o), report(r), fingerprints(s), inputs(inputs::load_scene_inputs(s, [this](double fraction) {
              stop_if_cancelled();
              progress("spread", fraction);
          })) {}

    /// Read when they are first asked for.
    const OpticalTables& optical_tables() {
        if (!tables) tables = load_optical_tables(scenario, inputs);
        return *tables;
    }
    void stop_if_cancelled() const {
        if (options.cancelled != nullptr && options.cancelled->load()) throw Cancelled();
    }
    [[nodiscard]] Monitor monitor(const std::string& step) const {
        Monitor m;
        m.cancelled = options.cancelled;
        if (options.on_progress) m.progress = [this, step](double f) { options.on_progress(step, f); };
        return m;
    }
    void progress(const std::string& step, double fraction) const {
        if (options.on_progress) options.on_progress(step, fraction);
    }
    [[nodiscard]] std::string utc(double time_s) const { return UtcTime{scenario.start.unix_s + time_s}.iso8601(); }
};

bool is_current(const std::filesystem::path& file, const std::string& fingerprint, const RunOptions& options) {
    if (options.force) return false;
    const auto metadata = gis::read_metadata(file);
    if (!metadata) return false;
    const auto it = metadata->find("FINGERPRINT");
    return it != metadata->end() && it->second == fingerprint;
}

std::vector<const Acquisition*> chosen_acquisitions(const Scenario& scenario, const RunOptions& options) {
    std::vector<const Acquisition*> chosen;
    for (const auto& a : scenario.acquisitions)
        if (options.acquisitions.empty() ||
            std::find(options.acquisitions.begin(), options.acquisitions.end(), a.id) != options.acquisitions.end())
            chosen.push_back(&a);
    for (const auto& id : options.acquisitions)
        if (std::none_of(chosen.begin(), chosen.end(), [&](const auto* a) { return a->id == id; })) {
            std::vector<std::string> ids;
            for (const auto& a : scenario.acquisitions) ids.push_back(a.id);
            throw input_error("--acquisition", fmt::format("the scenario has no '{}'; it has {}", id, fmt::join(ids, ", ")));
        }
    return chosen;
}

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

AcquisitionFiles files_of(const Session& s, const Acquisition& acquisition, const std::string& group,
                          std::size_t group_count) {
    return {s.options.output / acquisition.id, group_count > 1 ? "_" + group : ""};
}

void render_acquisition(Session& s, const Acquisition& acquisition, std::optional<render::TerrainMesh>& terrain) {
    const auto sensor = sensors::load_sensor(acquisition.sensor);
    const auto groups = wanted_groups(acquisition, sensor);
    const auto fingerprint = s.fingerprints.image(acquisition);
    std::optional<fire::FireState> state;
    std::optional<FireScene> scene;
    for (const auto& id : groups) {
        s.stop_if_cancelled();
        const auto files = files_of(s, acquisition, id, groups.size());
        if (is_current(files.radiance(), fingerprint, s.options)) {
            s.report.count("images_skipped", 1);
            continue;
        }
        const auto make_terrain = [&] {
            if (!terrain) terrain.emplace(s.inputs.terrain_m, s.inputs.origin_m);
        };
        const auto make_scene = [&] {
            if (scene) return;
            const PhaseTimer timer(s.report, "render/fire_scene");
            state = state_for(s, acquisition);
            scene = make_fire_scene(s.scenario, s.inputs, *state, acquisition.time_s);
            meet_radiant_fraction(s.report, s.scenario, *state, *scene, acquisition.id);
            record_energy(s.report, s.scenario, *state, *scene, acquisition.id);
        };
        tbb::parallel_invoke(make_terrain, make_scene);
        const GroupJob job{s.scenario,
                           acquisition,
                           s.inputs,
                           s.optical_tables(),
                           *scene,
                           *terrain,
                           sensor,
                           sensor.group(id),
                           wanted_bands(acquisition, sensor, id),
                           resolve_geometry(acquisition, s.inputs, &*state, sensor, sensor.group(id)),
                           files,
                           fingerprint};
        render_group(job, s.monitor("render " + acquisition.id), s.report);
        s.report.count("images_made", 1);
    }
}

/// Reads the optical tables if an image will want them. What is wrong with them is said where they are used.
void read_tables_ahead(Session& s, const std::vector<const Acquisition*>& chosen) {
    const auto is_new = [&](const Acquisition* a) { return !std::filesystem::exists(s.options.output / a->id); };
    if (!s.options.force && std::none_of(chosen.begin(), chosen.end(), is_new)) return;
    try {
        (void)s.optical_tables();
    } catch (const Error&) {
    }
}

void render_phase(Session& s) {
    const PhaseTimer timer(s.report, "render");
    std::optional<render::TerrainMesh> terrain;
    for (const auto* acquisition : chosen_acquisitions(s.scenario, s.options)) render_acquisition(s, *acquisition, terrain);
}

/// What the products of a rendered group are made from. Throws an input error when it is not rendered as the scenario says.
ProductJob product_job(const Session& s, const Acquisition& acquisition, const sensors::Sensor& sensor,
                       const std::string& group, std::size_t group_count) {
    const auto files = files_of(s, acquisition, group, group_count);
    if (!is_current(files.radiance(), s.fingerprints.image(acquisition), RunOptions{}))
        throw input_error(files.radiance().string(), "no current radiance for this scenario; run 'pyroscene render' first");
    ProductJob job{s.scenario,
                   acquisition,
                   s.inputs,
                   sensor,
                   sensor.group(group),
                   wanted_bands(acquisition, sensor, group),
                   files,
                   s.fingerprints.product(acquisition),
                   s.options.force};
    if (s.scenario.products.native) {
        const auto state = state_for(s, acquisition);
        job.geometry = resolve_geometry(acquisition, s.inputs, &state, sensor, job.group);
    }
    return job;
}

/// Mosaics whose images are all there; --acquisition may have left some out.
void mosaics_phase(Session& s) {
    for (const auto& mosaic : s.scenario.mosaics) {
        std::vector<const Acquisition*> members;
        for (const auto& id : mosaic.of)
            for (const auto& a : s.scenario.acquisitions)
                if (a.id == id) members.push_back(&a);
        const auto sensor = sensors::load_sensor(members.front()->sensor);
        const auto groups = wanted_groups(*members.front(), sensor);
        for (const auto& group : groups) {
            s.stop_if_cancelled();
            const std::string suffix = groups.size() > 1 ? "_" + group : "";
            MosaicJob job{mosaic, {}, s.options.output / mosaic.id / ("mosaic_radiance" + suffix + ".tif"), ""};
            for (const auto* a : members) job.fingerprint += s.fingerprints.image(*a);
            job.fingerprint = sha256(job.fingerprint + fmt::format("{}", static_cast<int>(mosaic.rule))).substr(0, 32);
            if (is_current(job.file, job.fingerprint, s.options)) continue;
            try {
                for (const auto* a : members)
                    job.members.push_back(product_job(s, *a, sensor, group, wanted_groups(*a, sensor).size()));
            } catch (const Error& e) {
                s.report.warn(fmt::format("mosaic '{}' was not made: {}", mosaic.id, e.what()));
                continue;
            }
            const PhaseTimer timer(s.report, "products/mosaic");
            s.progress("mosaic " + mosaic.id, 0.0);
            write_mosaic(job, s.report);
        }
    }
}

void products_phase(Session& s) {
    const PhaseTimer timer(s.report, "products");
    std::vector<ReportImage> images;
    for (const auto* acquisition : chosen_acquisitions(s.scenario, s.options)) {
        const auto sensor = sensors::load_sensor(acquisition->sensor);
        const auto groups = wanted_groups(*acquisition, sensor);
        for (const auto& id : groups) {
            s.stop_if_cancelled();
            const ProductJob job = product_job(s, *acquisition, sensor, id, groups.size());
            if (make_products(job, s.options, s.report))
                s.report.count("product_sets_made", 1);
            else
                s.report.count("product_sets_skipped", 1);
            images.push_back({acquisition, sensor.name, id, job.files, job.fingerprint});
        }
        keep_energy(s.report, s.options.output, acquisition->id);
    }
    mosaics_phase(s);
    write_catalog(s.scenario, s.options.output);
    if (s.scenario.products.report) {
        const PhaseTimer page(s.report, "products/report");
        write_html_report(s.scenario, s.inputs, images, s.options, s.report);
    }
}

/// Runs some phases and writes run.json whatever happens.
template <class Phases>
void in_session(const Scenario& scenario, const RunOptions& options, RunReport& report, const Phases& phases) {
    const auto threads = options.threads > 0
                             ? static_cast<std::size_t>(options.threads)
                             : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const gis::CompressionThreads compression_limit(options.threads);
    std::optional<Session> session;
    try {
        const PhaseTimer timer(report, "total");
        {
            const PhaseTimer loading(report, "load_inputs");
            session.emplace(scenario, options, report);
            for (const auto& note : scenario.notes) report.warn(note);
        }
        phases(*session);
    } catch (const std::exception& e) {
        write_run_report(scenario, options, report, session ? &session->fingerprints : nullptr, e.what());
        throw;
    }
    write_run_report(scenario, options, report, &session->fingerprints, "");
}

}  // namespace

void spread(const Scenario& scenario, const RunOptions& options, RunReport& report) {
    if (!scenario.inputs.spread && !scenario.inputs.arrival_model)
        throw input_error(
            scenario.path.string(),
            "has no inputs.spread and no inputs.arrival_model; 'pyroscene spread' writes the fire that they describe");
    in_session(scenario, options, report, [](Session& s) {
        const PhaseTimer timer(s.report, "write");
        const auto& fire = *s.inputs.modelled;
        const auto print = s.fingerprints.state(s.inputs.frames.back().time_s);
        record_spread(s.report, fire);
        write_front_rasters(fire, s.options.output, print);
        write_fire_frames(fire, s.options.output, print, s.utc(0.0), [&](double fraction) {
            s.stop_if_cancelled();
            s.progress("write", fraction);
        });
    });
}
void prepare(const Scenario& scenario, const RunOptions& options, RunReport& report) {
    in_session(scenario, options, report, [](Session& s) { prepare_phase(s); });
}
void render(const Scenario& scenario, const RunOptions& options, RunReport& report) {
    in_session(scenario, options, report, [](Session& s) { render_phase(s); });
}
void products(const Scenario& scenario, const RunOptions& options, RunReport& report) {
    in_session(scenario, options, report, [](Session& s) { products_phase(s); });
}
void run(const Scenario& scenario, const RunOptions& options, RunReport& report) {
    in_session(scenario, options, report, [](Session& s) {
        const auto chosen = chosen_acquisitions(s.scenario, s.options);
        tbb::parallel_invoke([&] { prepare_phase(s); }, [&] { read_tables_ahead(s, chosen); });
        render_phase(s);
        products_phase(s);
    });
}

std::string version() { return PYROSCENE_VERSION; }

}  // namespace pyroscene::pipeline
