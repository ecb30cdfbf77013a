#include "pipeline/flame_export.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "unit/base/temp_folder.h"

#ifdef PYROSCENE_WITH_OPENVDB
#include <openvdb/openvdb.h>
#endif

namespace pyroscene::pipeline {
namespace {

/// The first lines of the thesis's voxel list (appendix C.3), as flames on its lattice.
FlameExport thesis_sample() {
    FlameExport flame;
    flame.scenario = "sample";
    flame.time_s = 3996.0;
    flame.origin_m = {418500.0, 4761300.0, 0.0};
    const fire::VoxelGrid grid{{-1420.0, -1420.0, 0.0}, 142, 142, 20.0, 20.0, 5.0};
    const fire::FlameVoxel voxels[] = {{43, 57, 0, 1.0F, 795.444F},
                                       {44, 57, 0, 1.0F, 795.228F},
                                       {41, 58, 0, 1.0F, 795.228F},
                                       {42, 58, 0, 0.5F, 796.091F},
                                       {52, 60, 0, 1.0F, 795.875F}};
    flame.field = fire::make_flame_field(grid, voxels);
    flame.size = {142, 142, 64};
    return flame;
}

TEST(DirsigGrid, IsTheThesisText) {
    EXPECT_EQ(dirsig_grid(thesis_sample(), 206, 1000.2030),
              "142 142 64\n"
              "43 57 0 206 795.444 1000.2030\n"
              "44 57 0 206 795.228 1000.2030\n"
              "41 58 0 206 795.228 1000.2030\n"
              "42 58 0 206 796.091 500.1015\n"
              "52 60 0 206 795.875 1000.2030\n");
}

TEST(DirsigGrid, ObjectPlacesTheLattice) {
    EXPECT_EQ(dirsig_object(thesis_sample(), "666.grid"),
              "REGULAR_GRID {\n    INSERT_POINT = 417080.000, 4759880.000, 0.000\n    DELTA_X = 20\n    DELTA_Y = 20\n    "
              "DELTA_Z = 5\n"
              "    GRID_FILENAME = 666.grid\n}\n");
}

TEST(FlameCsv, HasCentresInMapCoordinates) {
    const TempFolder folder;
    write_text_file(folder / "flames.csv", flame_csv(thesis_sample()));
    const auto table = read_csv(folder / "flames.csv");
    EXPECT_EQ(table.rows.size(), 5U);
    EXPECT_DOUBLE_EQ(table.numbers("x_m")[0], 417080.0 + 43.5 * 20.0);
    EXPECT_DOUBLE_EQ(table.numbers("y_m")[0], 4759880.0 + 57.5 * 20.0);
    EXPECT_DOUBLE_EQ(table.numbers("z_m")[0], 2.5);
    EXPECT_DOUBLE_EQ(table.numbers("volume_m3")[3], 1000.0);
    EXPECT_NEAR(table.numbers("temperature_K")[3], 796.091, 1e-3);
}

TEST(FlameExport, ShiftsIndicesIntoTheLattice) {
    auto flame = thesis_sample();
    flame.shift = {3, 2, 1};
    EXPECT_NE(dirsig_grid(flame, 1, 1.0).find("\n46 59 1 1 795.444 1.0000\n"), std::string::npos);
    EXPECT_DOUBLE_EQ(flame.corner_m().x, 417080.0 - 60.0);
    EXPECT_DOUBLE_EQ(flame.corner_m().z, -5.0);
}

TEST(SideView, IsAPicture) {
    const TempFolder folder;
    write_side_view(folder / "side.png", thesis_sample(), {});
    EXPECT_EQ(read_text_file(folder / "side.png").substr(1, 3), "PNG");
    EXPECT_NO_THROW(write_side_view(folder / "part.png", thesis_sample(), MapWindow{-600, -200, -300, 100}));
    EXPECT_THROW(write_side_view(folder / "beside.png", thesis_sample(), MapWindow{2000, 3000, -300, 100}), Error);
    FlameExport none;
    none.field.grid = {{0, 0, 0}, 0, 0, 5.0, 5.0, 1.0};
    none.size = {10, 10, 3};
    EXPECT_NO_THROW(write_side_view(folder / "none.png", none, {}));
}

#ifdef PYROSCENE_WITH_OPENVDB
TEST(FlameVdb, ReadsBack) {
    const TempFolder folder;
    const auto flame = thesis_sample();
    write_flame_vdb(folder / "flames.vdb", flame);
    openvdb::initialize();
    openvdb::io::File file((folder / "flames.vdb").string());
    file.open();
    const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
    const auto temperature = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("temperature"));
    EXPECT_EQ(density->activeVoxelCount(), 5U);
    EXPECT_EQ(density->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_FLOAT_EQ(density->getConstAccessor().getValue({42, 58, 0}), 0.5F);
    EXPECT_FLOAT_EQ(temperature->getConstAccessor().getValue({43, 57, 0}), 795.444F);
    EXPECT_EQ(density->getConstAccessor().getValue({43, 57, 1}), 0.0F);
    const auto centre = density->indexToWorld(openvdb::Coord(43, 57, 0));
    EXPECT_DOUBLE_EQ(centre.x(), -1420.0 + 43.5 * 20.0);
    EXPECT_DOUBLE_EQ(centre.y(), -1420.0 + 57.5 * 20.0);
    EXPECT_DOUBLE_EQ(centre.z(), 2.5);
    EXPECT_EQ(density->voxelSize(), openvdb::Vec3d(20.0, 20.0, 5.0));
    EXPECT_DOUBLE_EQ((*file.getMetadata())["map_origin_m"]->str().empty() ? 0.0 : 1.0, 1.0);
    EXPECT_EQ((*file.getMetadata())["time_s"]->str(), "3996");
    file.close();
}

TEST(FlameVdb, SameFlamesSameBytes) {
    const TempFolder folder;
    write_flame_vdb(folder / "a.vdb", thesis_sample());
    write_flame_vdb(folder / "b.vdb", thesis_sample());
    EXPECT_EQ(read_text_file(folder / "a.vdb"), read_text_file(folder / "b.vdb"));
}
#else
TEST(FlameVdb, SaysThatItIsNotBuiltIn) {
    const TempFolder folder;
    try {
        write_flame_vdb(folder / "flames.vdb", thesis_sample());
        FAIL() << "was written";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Runtime);
        EXPECT_NE(std::string(e.what()).find("libopenvdb-dev"), std::string::npos);
    }
}
#endif

}  // namespace
}  // namespace pyroscene::pipeline
