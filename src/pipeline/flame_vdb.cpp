#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "pipeline/flame_export.h"

#ifdef PYROSCENE_WITH_OPENVDB
#include <openvdb/openvdb.h>

#include <fstream>

namespace pyroscene::pipeline {
namespace {

openvdb::FloatGrid::Ptr make_grid(const FlameExport& flame, const char* name, const char* unit) {
    const auto& g = flame.field.grid;
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    // Index (i, j, k) is the centre of a voxel.
    auto place = openvdb::math::Mat4d::identity();
    place.preScale(openvdb::Vec3d(g.dx_m, g.dy_m, g.dz_m));
    const Vec3 corner = flame.corner_m();
    place.setTranslation(openvdb::Vec3d(corner.x - flame.origin_m.x + 0.5 * g.dx_m,
                                        corner.y - flame.origin_m.y + 0.5 * g.dy_m,
                                        corner.z - flame.origin_m.z + 0.5 * g.dz_m));
    grid->setTransform(openvdb::math::Transform::createLinearTransform(place));
    grid->insertMeta("unit", openvdb::StringMetadata(unit));
    return grid;
}

/// The library stamps each file with a random identifier; the same flames shall give the same bytes. It stands as text after
/// the magic number, three version numbers and one flag.
void write_fixed_identifier(const std::filesystem::path& file) {
    constexpr std::streamoff kPlace = 8 + 4 + 4 + 4 + 1;
    const std::string identifier = "00000000-0000-0000-0000-000000000000";
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    std::string found(identifier.size(), ' ');
    stream.seekg(kPlace);
    stream.read(found.data(), static_cast<std::streamsize>(found.size()));
    if (!stream || found[8] != '-' || found[13] != '-' || found[18] != '-' || found[23] != '-')
        throw runtime_error(file.string(), "OpenVDB wrote a header of unknown form");
    stream.seekp(kPlace);
    stream.write(identifier.data(), static_cast<std::streamsize>(identifier.size()));
    if (!stream.flush()) throw runtime_error(file.string(), "cannot be written");
}

}  // namespace

bool has_openvdb() noexcept { return true; }

void write_flame_vdb(const std::filesystem::path& path, const FlameExport& flame) {
    AtomicFile file(path);
    try {
        openvdb::initialize();
        auto density = make_grid(flame, "density", "1"), temperature = make_grid(flame, "temperature", "K");
        auto fill = density->getAccessor(), T = temperature->getAccessor();
        for_each_voxel(flame, [&](const ExportVoxel& v) {
            fill.setValue({v.i, v.j, v.k}, v.fill);
            T.setValue({v.i, v.j, v.k}, v.temperature_K);
        });
        openvdb::MetaMap metadata;
        metadata.insertMeta("scenario", openvdb::StringMetadata(flame.scenario));
        metadata.insertMeta("time_s", openvdb::DoubleMetadata(flame.time_s));
        metadata.insertMeta("synthetic", openvdb::BoolMetadata(true));
        metadata.insertMeta("map_origin_m",
                            openvdb::Vec3DMetadata(openvdb::Vec3d(flame.origin_m.x, flame.origin_m.y, flame.origin_m.z)));
        metadata.insertMeta("crs_wkt", openvdb::StringMetadata(flame.crs_wkt));
        openvdb::io::File out(file.path().string());
        out.write({density, temperature}, metadata);
        out.close();
    } catch (const openvdb::Exception& e) {
        throw runtime_error(path.string(), fmt::format("cannot be written: {}", e.what()));
    }
    write_fixed_identifier(file.path());
    file.commit();
}

}  // namespace pyroscene::pipeline

#else

namespace pyroscene::pipeline {

bool has_openvdb() noexcept { return false; }

void write_flame_vdb(const std::filesystem::path& path, const FlameExport&) {
    throw runtime_error(
        path.string(),
        "this program was built without OpenVDB; install libopenvdb-dev, configure and build again, or export "
        "as dirsig-grid or csv");
}

}  // namespace pyroscene::pipeline

#endif
