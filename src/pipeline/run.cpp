#include "pipeline/run.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <tbb/parallel_invoke.h>

#include "base/error.h"
#include "gis/raster_output.h"
#include "pipeline/energy.h"
#include "pipeline/hash.h"
#include "pipeline/mosaics.h"
#include "pipeline/prepare_phase.h"
#include "pipeline/products_phase.h"
#include "pipeline/render_phase.h"
#include "pipeline/run_html.h"
#include "pipeline/run_report_file.h"
#include "pipeline/session.h"
#include "pipeline/spread_output.h"

namespace pyroscene::pipeline {
namespace {

using scenario::Acquisition;
using scenario::Scenario;

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
