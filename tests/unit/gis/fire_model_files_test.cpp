// Files of Cell2Fire, QUIC-Fire and FDS, written here byte by byte after their documentation: the right cell at the right time, or one
// clear error.
#include "gis/fire_model_files.h"

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gis/raster_input.h"
#include "unit/gis/source_raster.h"

namespace pyroscene::gis {
namespace {

namespace fs = std::filesystem;

/// Values of a raster in memory with its georeference.
struct Read {
    RasterInfo info;
    Raster<float> values;
};
Read read(const fs::path& file) {
    const auto grid = make_map_grid(file, {}, {});
    return {read_info(file),
            read_band({.file = file, .resampling = Resampling::Nearest, .name = "arrival", .unit = "s"}, grid)};
}

void write_text(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

class Cell2Fire : public ::testing::Test {
protected:
    void SetUp() override {
        SourceRaster{.cols = 4, .rows = 3}.band([](int, int) { return 1.0; }).write(fuels());
    }
    [[nodiscard]] fs::path fuels() const { return folder_ / "fuels.tif"; }
    [[nodiscard]] fs::path write(const std::string& name, const std::string& text) const {
        write_text(folder_ / name, text);
        return folder_ / name;
    }
    TempFolder folder_;
};

TEST_F(Cell2Fire, MessagesCountCellsFromTheNorthwest) {
    // Cell 6 (row 1, column 1) was lit; it reaches 7 after 2 periods of a minute and again, later, by another way; 7 reaches 3.
    const auto file = write("MessagesFile01.csv", "6,7,2,11.5\n6,2,4,5.0\n7,3,5,8\n2,7,9,1\n");
    const auto [info, t] = read(cell2fire_messages(file, fuels(), 60.0));
    EXPECT_EQ(info.geotransform, (std::array{500000.0, 30.0, 0.0, 5170000.0, 0.0, -30.0}));
    EXPECT_EQ(t.at(1, 1), 0.0F);
    EXPECT_EQ(t.at(1, 2), 120.0F);
    EXPECT_EQ(t.at(0, 1), 240.0F);
    EXPECT_EQ(t.at(0, 2), 300.0F);
    EXPECT_TRUE(std::isnan(t.at(2, 3)));
    // With a line of names.
    const auto named = write("named.csv", "origin,destiny,time,ros\n6,7,2,11.5\n");
    EXPECT_EQ(read(cell2fire_messages(named, fuels(), 60.0)).values.at(1, 2), 120.0F);
}

TEST_F(Cell2Fire, GridsGiveTheMiddleOfThePeriod) {
    const auto g0 = write("ForestGrid00.csv", "0,0,0,0\n0,1,0,0\n0,0,0,0\n"),
               g1 = write("ForestGrid01.csv", "0,1,0,0\n0,1,1,0\n0,0,0,0\n"),
               g3 = write("ForestGrid03.csv", "0,1,1,0\n0,1,1,0\n0,0,0,1\n");
    const auto t = read(cell2fire_grids({g3, g0, g1}, fuels(), 3600.0)).values;
    EXPECT_EQ(t.at(1, 1), 0.0F);
    EXPECT_EQ(t.at(0, 1), 1800.0F);
    EXPECT_EQ(t.at(2, 3), 7200.0F);
    EXPECT_TRUE(std::isnan(t.at(2, 0)));
}

TEST_F(Cell2Fire, JunkIsRefusedByName) {
    const auto messages = [&](const std::string& text) {
        return input_error_of([&] { (void)cell2fire_messages(write("m.csv", text), fuels(), 60.0); });
    };
    EXPECT_NE(messages("6,13,2,1\n").find("m.csv:1: cell 13, expected 1 to 12"), std::string::npos);
    EXPECT_NE(messages("6,0,2,1\n").find("cell 0, expected 1 to 12"), std::string::npos);
    EXPECT_NE(messages("6,7,soon,1\n").find("m.csv:1"), std::string::npos);
    EXPECT_NE(messages("6,7,-1,1\n").find("time -1"), std::string::npos);
    EXPECT_NE(messages("6,7\n").find("has 2 numbers"), std::string::npos);
    EXPECT_NE(messages("").find("no row of numbers"), std::string::npos);
    const auto grids = [&](const std::string& name, const std::string& text) {
        return input_error_of([&] {
            (void)cell2fire_grids({write("ForestGrid00.csv", "0,0,0,0\n0,1,0,0\n0,0,0,0\n"), write(name, text)}, fuels(),
                                  60.0);
        });
    };
    EXPECT_NE(grids("ForestGrid01.csv", "0,0,0,0\n0,1,0,0\n").find("has 2 rows, expected 3"), std::string::npos);
    EXPECT_NE(grids("ForestGrid01.csv", "0,0,0\n0,1,0\n0,0,0\n").find("has 3 cells, expected 4"), std::string::npos);
    EXPECT_NE(grids("ForestGrid01.csv", "0,0,0,0\n0,0,0,0\n0,0,0,0\n").find("cell 6 burns no longer"), std::string::npos);
    EXPECT_NE(grids("ForestGrid01.csv", "0,0,0,0\n0,2,0,0\n0,0,0,0\n").find("holds 2, expected 0 or 1"), std::string::npos);
    EXPECT_NE(grids("final.csv", "0,0,0,0\n0,1,0,0\n0,0,0,0\n").find("no number at the end"), std::string::npos);
}

/// A Fortran file of records.
class Records {
public:
    explicit Records(const fs::path& file) : out_(file, std::ios::binary) {}
    Records& text(std::string value) {
        value.resize(30, ' ');
        return put(value.data(), value.size());
    }
    template <class T>
    Records& values(const std::vector<T>& v) {
        return put(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(T));
    }

private:
    Records& put(const char* bytes, std::size_t count) {
        const auto mark = static_cast<std::uint32_t>(count);
        out_.write(reinterpret_cast<const char*>(&mark), 4);
        out_.write(bytes, static_cast<std::streamsize>(count));
        out_.write(reinterpret_cast<const char*>(&mark), 4);
        return *this;
    }
    std::ofstream out_;
};

TEST(QuicFire, RowsComeFromTheSouthAndTimesFromTheNames) {
    const TempFolder folder;
    // 3 x 2 cells; the south-western one burns at once, its eastern neighbour between 100 and 300 s, the north-eastern one later.
    const auto file = [&](int time, std::vector<float> values) {
        const auto path = folder / fmt::format("mburnt_integ-{:05d}.bin", time);
        Records(path).values(values);
        return path;
    };
    const std::vector<fs::path> files{file(300, {60, 20, 0, 0, 0, 0}), file(100, {5, 0, 0, 0, 0, 0}),
                                      file(500, {90, 60, 0, 0, 0, 10})};
    const QuicFireGrid grid{.cols = 3, .rows = 2, .cell_m = 2.0, .place = {"EPSG:32616", 400000.0, 4000000.0}};
    const auto [info, t] = read(quic_fire_arrival(files, grid));
    EXPECT_EQ(info.geotransform, (std::array{400000.0, 2.0, 0.0, 4000004.0, 0.0, -2.0}));
    EXPECT_EQ(t.at(1, 0), 100.0F);
    EXPECT_EQ(t.at(1, 1), 200.0F);
    EXPECT_EQ(t.at(0, 2), 400.0F);
    EXPECT_TRUE(std::isnan(t.at(0, 0)));

    const auto says = [&](const std::vector<fs::path>& some, const QuicFireGrid& g) {
        return input_error_of([&] { (void)quic_fire_arrival(some, g); });
    };
    auto other = grid;
    other.cols = 4;
    EXPECT_NE(says(files, other).find("record 1 has 24 bytes, expected 32"), std::string::npos);
    EXPECT_NE(says({file(10, {0, 0, 0, 0, 0, 0})}, grid).find("no cell burns"), std::string::npos);
    EXPECT_NE(says({file(10, {0, 0, 0, 0, 0, 400})}, grid).find("holds 400 %"), std::string::npos);
    fs::copy_file(files[0], folder / "fuels-dens-00300.bin");
    EXPECT_NE(says({folder / "fuels-dens-00300.bin"}, grid).find("expected a name like mburnt_integ"), std::string::npos);
    write_text(folder / "mburnt_integ-00007.bin", "short");
    EXPECT_NE(says({folder / "mburnt_integ-00007.bin"}, grid).find("record 1 has"), std::string::npos);
}

TEST(QuicFire, EnergyIsAFluxOfItsCells) {
    const TempFolder folder;
    const QuicFireGrid grid{.cols = 3, .rows = 2, .cell_m = 2.0, .place = {"EPSG:32616", 400000.0, 4000000.0}};
    const auto file = [&](const std::string& name, const std::vector<float>& values) {
        Records(folder / name).values(values);
        return folder / name;
    };
    // kW m-2: the south-western cell at 10 s, the north-eastern one at 20 s; files in any order.
    const std::vector<fs::path> surface{file("surfEnergy00020.bin", {0, 0, 0, 0, 0, 7.5F}),
                                        file("surfEnergy00010.bin", {400, 0, 0, 0, 0, 0})};
    const auto series = quic_fire_heat_flux(surface, grid);
    EXPECT_EQ(series.times_s, (std::vector{10.0, 20.0}));
    const auto map = make_map_grid(series.raster, {}, {});
    const auto band = [&](const fs::path& raster, int number) {
        return read_band({raster, number, Resampling::Nearest, "flux", "W m-2"}, map);
    };
    EXPECT_EQ(band(series.raster, 1).at(1, 0), 4e5F);
    EXPECT_EQ(band(series.raster, 1).at(0, 2), 0.0F);
    EXPECT_EQ(band(series.raster, 2).at(0, 2), 7500.0F);
    // kW in cells of 4 m2, two layers: 100 + 60 kW are 40 kW m-2.
    const auto to_air =
        quic_fire_heat_flux({file("fire-energy_to_atmos-00030.bin", {0, 100, 0, 0, 0, 0, 0, 60, 0, 0, 0, 0})}, grid);
    EXPECT_EQ(to_air.times_s, std::vector{30.0});
    EXPECT_EQ(band(to_air.raster, 1).at(1, 1), 4e4F);
    const auto says = [&](const std::vector<fs::path>& files) {
        return input_error_of([&] { (void)quic_fire_heat_flux(files, grid); });
    };
    EXPECT_NE(says({surface[0], to_air.raster}).find("expected a name like surfEnergy00300.bin"), std::string::npos);
    EXPECT_NE(says({file("surfEnergy00001.bin", {1, 2, 3, 4})}).find("record 1 has 16 bytes, expected 24"),
              std::string::npos);
    EXPECT_NE(says({file("fire-energy_to_atmos-00001.bin", {1, 2, 3, 4, 5, 6, 7})}).find("expected a multiple of 24"),
              std::string::npos);
    EXPECT_NE(says({file("surfEnergy00002.bin", {-9, 0, 0, 0, 0, 0})}).find("holds a flux of -9 kW m-2"), std::string::npos);
    EXPECT_NE(says({file("surfEnergy00003.bin", {NAN, 0, 0, 0, 0, 0})}).find("holds a flux of nan"), std::string::npos);
}

/// An index with two meshes side by side, 3 x 2 cells of 10 m each (or other numbers of them in the second).
std::string fds_index(const std::string& outputs, int cols = 3, int rows = 2) {
    const auto mesh = [&](double west) {
        if (west == 0.0 && (cols != 3 || rows != 2))
            return fmt::format("GRID   MESH_2\n  {}  {}  4  1\n\nPDIM\n  0 30.0 0.0 20.0 0.0 40.0  0. 0. 0.\n\n", cols,
                               rows);
        std::string text =
            fmt::format("GRID   MESH_{:.0f}\n  3  2  4  1\n\nPDIM\n  {} {} 0.0 20.0 0.0 40.0  0. 0. 0.\n\nTRNX\n  0\n", west,
                        west, west + 30.0);
        for (int i = 0; i <= 3; ++i) text += fmt::format("  {} {}\n", i, west + 10.0 * i);
        text += "\nTRNY\n  0\n";
        for (int i = 0; i <= 2; ++i) text += fmt::format("  {} {}\n", i, 10.0 * i);
        return text + "\n";
    };
    return "TITLE\n grass\n\nNMESHES\n 2\n\n" + mesh(-30.0) + mesh(0.0) + outputs;
}

std::string output(const std::string& key, int mesh, const std::string& file, const std::string& label,
                   const std::string& unit) {
    return fmt::format("{}  {} # STRUCTURED &  0 3 0 2 1 1 !  1\n {}\n {}\n short\n {}\n", key, mesh, file, label, unit);
}

const LocalPlacement kPlace{"EPSG:32616", 400000.0, 4000000.0};

TEST(Fds, SlicesOfAllMeshesMeetAtTheirNodes) {
    const TempFolder folder;
    for (int mesh = 1; mesh <= 2; ++mesh) {
        std::vector<float> early(12, 1e6F), late;
        for (int j = 0; j <= 2; ++j)
            for (int i = 0; i <= 3; ++i)
                late.push_back(mesh == 1 && i == 0
                                   ? 1e6F
                                   : 10.0F * static_cast<float>(3 * (mesh - 1) + i) + 0.5F * static_cast<float>(j));
        Records(folder / fmt::format("a_{}.sf", mesh))
            .text("FIRE ARRIVAL TIME")
            .text("time")
            .text("s")
            .values(std::vector<std::int32_t>{0, 3, 0, 2, 1, 1})
            .values(std::vector<float>{0.0F})
            .values(early)
            .values(std::vector<float>{100.0F})
            .values(late);
    }
    write_text(folder / "a.smv", fds_index(output("SLCF", 1, "a_1.sf", "FIRE ARRIVAL TIME", "s") +
                                           output("SLCF", 2, "a_2.sf", "FIRE ARRIVAL TIME", "s")));
    const auto [info, t] =
        read(fds_ground_quantity(folder / "a.smv", {"TIME OF ARRIVAL", "FIRE ARRIVAL TIME"}, "s", kPlace));
    EXPECT_EQ(info.geotransform, (std::array{399965.0, 10.0, 0.0, 4000025.0, 0.0, -10.0}));
    ASSERT_EQ(t.grid.cols, 7);
    ASSERT_EQ(t.grid.rows, 3);
    for (int row = 0; row < 3; ++row) {
        EXPECT_TRUE(std::isnan(t.at(row, 0)));  // never reached
        for (int col = 1; col < 7; ++col)
            EXPECT_EQ(t.at(row, col), 10.0F * static_cast<float>(col) + 0.5F * static_cast<float>(2 - row))
                << row << ' ' << col;
    }
}

TEST(Fds, BoundariesThatFaceUpGiveCellsTheirValues) {
    const TempFolder folder;
    // A patch of 2 x 2 cells that faces up, one that faces west. Cells stand with the node to their west and south (DUMP_BNDF
    // writes the cells L1 to L2 + 1, of which the last is none).
    Records(folder / "b.bf")
        .text("FIRE ARRIVAL TIME")
        .text("time")
        .text("s")
        .values(std::vector<std::int32_t>{2})
        .values(std::vector<std::int32_t>{1, 3, 0, 2, 1, 1, 3, 1, 1})
        .values(std::vector<std::int32_t>{1, 1, 0, 2, 0, 1, -1, 1, 1})
        .values(std::vector<float>{50.0F})
        .values(std::vector<float>{20, 30, -1, 21, 31, -1, -1, -1, -1})
        .values(std::vector<float>{1, 1, 1, 1, 1, 1});
    write_text(folder / "b.smv", fds_index(output("BNDC", 2, "b.bf", "FIRE ARRIVAL TIME", "s")));
    const auto [info, t] = read(fds_ground_quantity(folder / "b.smv", {"FIRE ARRIVAL TIME"}, "s", kPlace));
    // Nodes 2 and 3 of the second mesh: cells from 10 to 20 and from 20 to 30 m east of the origin, 0 to 10 and 10 to 20 m north.
    const auto at = [&](double east, double north) {
        return t.at(static_cast<int>(t.grid.row_at(kPlace.south_m + north)),
                    static_cast<int>(t.grid.col_at(kPlace.west_m + east)));
    };
    EXPECT_EQ(at(15.0, 5.0), 20.0F);
    EXPECT_EQ(at(25.0, 5.0), 30.0F);
    EXPECT_EQ(at(15.0, 15.0), 21.0F);
    EXPECT_EQ(at(25.0, 15.0), 31.0F);
    EXPECT_TRUE(std::isnan(at(5.0, 5.0)));
    EXPECT_TRUE(std::isnan(at(-5.0, 5.0)));
}

TEST(Fds, JunkIsRefusedByName) {
    const TempFolder folder;
    const auto says = [&](const std::string& index) {
        write_text(folder / "c.smv", index);
        return input_error_of([&] { (void)fds_ground_quantity(folder / "c.smv", {"FIRE ARRIVAL TIME"}, "s", kPlace); });
    };
    EXPECT_NE(says("nothing").find("has no GRID"), std::string::npos);
    EXPECT_NE(says(fds_index("")).find("has no output of 'FIRE ARRIVAL TIME'; it has none"), std::string::npos);
    EXPECT_NE(says(fds_index(output("SLCF", 1, "c.sf", "TEMPERATURE", "C"))).find("it has TEMPERATURE"), std::string::npos);
    EXPECT_NE(says(fds_index(output("SLCF", 3, "c.sf", "FIRE ARRIVAL TIME", "s"))).find("of mesh 3, but there are 2"),
              std::string::npos);
    EXPECT_NE(says(fds_index(output("SLCF", 1, "c.sf", "FIRE ARRIVAL TIME", "min"))).find("is in 'min', expected 's'"),
              std::string::npos);
    EXPECT_NE(says(fds_index(output("SLCF", 1, "c.sf", "FIRE ARRIVAL TIME", "s"))).find("c.sf: cannot be opened"),
              std::string::npos);
    Records(folder / "c.sf")
        .text("FIRE ARRIVAL TIME")
        .text("time")
        .text("s")
        .values(std::vector<std::int32_t>{1, 1, 0, 2, 0, 4});
    EXPECT_NE(says(fds_index(output("SLCF", 1, "c.sf", "FIRE ARRIVAL TIME", "s"))).find("no horizontal slice"),
              std::string::npos);
    auto uneven = fds_index(output("SLCF", 1, "c.sf", "FIRE ARRIVAL TIME", "s"));
    uneven.replace(uneven.find("  1 -20"), 7, "  1 -35");
    EXPECT_NE(says(uneven).find("nodes do not ascend"), std::string::npos);
    Records(folder / "c.sf")
        .text("FIRE ARRIVAL TIME")
        .text("time")
        .text("s")
        .values(std::vector<std::int32_t>{0, 4, 0, 2, 1, 1});
    EXPECT_NE(says(fds_index(output("SLCF", 1, "c.sf", "FIRE ARRIVAL TIME", "s"))).find("nodes 0 to 4 beyond its mesh"),
              std::string::npos);
}

/// A slice file of a quantity at one moment.
void write_slice(const fs::path& file, const std::string& label, const std::string& unit,
                 const std::vector<std::int32_t>& box, double time_s, const std::vector<float>& values) {
    Records(file)
        .text(label)
        .text("short")
        .text(unit)
        .values(box)
        .values(std::vector{static_cast<float>(time_s)})
        .values(values);
}

TEST(Fds, ACoarseMeshIsInterpolatedOntoTheFineOne) {
    const TempFolder folder;
    // 2 x 2 nodes of 30 m x 20 m beside 4 x 3 nodes of 10 m; both hold t = x + 2 y + 100 s.
    const auto t = [](double x, double y) { return static_cast<float>(x + 2.0 * y + 100.0); };
    std::vector<float> fine, coarse;
    for (int j = 0; j <= 2; ++j)
        for (int i = 0; i <= 3; ++i) fine.push_back(t(-30.0 + 10.0 * i, 10.0 * j));
    for (int j = 0; j <= 1; ++j)
        for (int i = 0; i <= 1; ++i) coarse.push_back(i == 1 && j == 1 ? 1e6F : t(30.0 * i, 20.0 * j));
    write_slice(folder / "1.sf", "FIRE ARRIVAL TIME", "s", {0, 3, 0, 2, 1, 1}, 500.0, fine);
    write_slice(folder / "2.sf", "FIRE ARRIVAL TIME", "s", {0, 1, 0, 1, 1, 1}, 500.0, coarse);
    write_text(folder / "a.smv", fds_index(output("SLCF", 1, "1.sf", "FIRE ARRIVAL TIME", "s") +
                                               output("SLCF", 2, "2.sf", "FIRE ARRIVAL TIME", "s"),
                                           1, 1));
    const auto [info, arrival] = read(fds_ground_quantity(folder / "a.smv", {"FIRE ARRIVAL TIME"}, "s", kPlace));
    EXPECT_EQ(info.geotransform, (std::array{399965.0, 10.0, 0.0, 4000025.0, 0.0, -10.0}));
    ASSERT_EQ(arrival.grid.cols, 7);
    for (int col = 0; col < 7; ++col) EXPECT_NEAR(arrival.at(2, col), t(-30.0 + 10.0 * col, 0.0), 1e-3) << col;
    for (int col = 0; col <= 3; ++col) EXPECT_NEAR(arrival.at(0, col), t(-30.0 + 10.0 * col, 20.0), 1e-3) << col;
    // The fire has not come to the north-eastern node, nor to what is nearer to it than to another.
    EXPECT_TRUE(std::isnan(arrival.at(0, 6)) && std::isnan(arrival.at(0, 5)));
    EXPECT_FALSE(std::isnan(arrival.at(0, 4)));

    write_slice(folder / "2.sf", "FIRE ARRIVAL TIME", "s", {0, 1, 0, 1, 1, 1}, 520.0, coarse);
    EXPECT_NE(input_error_of([&] {
                  (void)fds_ground_quantity(folder / "a.smv", {"FIRE ARRIVAL TIME"}, "s", kPlace);
              }).find("at 500 s in one mesh and at 520 s in another"),
              std::string::npos);
}

TEST(Fds, HeatReleaseOfAVolumeIsSummedOverItsHeight) {
    const TempFolder folder;
    // Nodes at 0, 10, .. 40 m; 6 kW m-3 at the ground and 2 kW m-3 at 10 m: 5 x 6 + 10 x 2 kW m-2 over 0 to 20 m.
    std::vector<float> values(4 * 3 * 3, 0.0F);
    values[5] = 6.0F, values[12 + 5] = 2.0F;
    write_slice(folder / "v.sf", "HRRPUV", "kW/m3", {0, 3, 0, 2, 0, 2}, 7.0, values);
    write_slice(folder / "h.sf", "HRRPUV", "kW/m3", {0, 3, 0, 2, 1, 1}, 7.0, std::vector<float>(12, 99.0F));
    write_text(folder / "a.smv",
               fds_index(output("SLCF", 1, "v.sf", "HRRPUV", "kW/m3") + output("SLCF", 1, "h.sf", "HRRPUV", "kW/m3")));
    const auto series = fds_heat_flux(folder / "a.smv", "", kPlace);
    EXPECT_EQ(series.times_s, std::vector{7.0});
    const auto map = make_map_grid(series.raster, {}, {});
    const auto flux = read_band({series.raster, 1, Resampling::Nearest, "flux", "W m-2"}, map);
    EXPECT_EQ(flux.at(1, 1), 5e4F);
    EXPECT_EQ(flux.at(1, 2), 0.0F);
    const auto says = [&](const std::string& index, const std::string& quantity) {
        write_text(folder / "b.smv", index);
        return input_error_of([&] { (void)fds_heat_flux(folder / "b.smv", quantity, kPlace); });
    };
    EXPECT_NE(says(fds_index(output("SLCF", 1, "h.sf", "HRRPUV", "kW/m3")), "").find("no slice that is a volume"),
              std::string::npos);
    EXPECT_NE(says(fds_index(output("SLCF", 1, "h.sf", "TEMPERATURE", "C")), "")
                  .find("has no output of 'HRRPUA', 'HRRPUV'; it has TEMPERATURE"),
              std::string::npos);
    EXPECT_NE(says(fds_index(output("SLCF", 1, "h.sf", "TEMPERATURE", "C")), "TEMPERATURE")
                  .find("is in 'C', expected 'kW/m2' or 'kW/m3'"),
              std::string::npos);
}

TEST(Fds, GeometryThatSlopesGivesItsFluxPerAreaOfTheMap) {
    const TempFolder folder;
    // A square of 10 m that rises 10 m to the east, as two triangles, and an upright triangle; 30 kW per m2 of ground.
    Records(folder / "a_2.gcf")
        .values(std::vector<std::int32_t>{1})
        .values(std::vector<std::int32_t>{2})
        .values(std::vector<std::int32_t>{0, 0, 1})
        .values(std::vector<float>{0.0F})
        .values(std::vector<std::int32_t>{4, 3, 0})
        .values(std::vector<float>{10, 0, 0, 20, 0, 10, 20, 10, 10, 10, 10, 0})
        .values(std::vector<std::int32_t>{1, 2, 3, 1, 3, 4, 2, 3, 2});
    Records(folder / "a.be")
        .values(std::vector<std::int32_t>{1})
        .values(std::vector<std::int32_t>{2})
        .values(std::vector<float>{4.0F})
        .values(std::vector<std::int32_t>{0, 0, 0, 3})
        .values(std::vector<float>{30, 30, 900});
    write_text(folder / "a.smv", fds_index("BNDE  2  1\n a.be\n -\n HRRPUA\n short\n kW/m2\n"));
    const auto series = fds_heat_flux(folder / "a.smv", "HRRPUA", kPlace);
    const auto map = make_map_grid(series.raster, {}, {});
    const auto flux = read_band({series.raster, 1, Resampling::Nearest, "flux", "W m-2"}, map);
    const auto at = [&](double east, double north) {
        return flux.at(static_cast<int>(map.row_at(kPlace.south_m + north)),
                       static_cast<int>(map.col_at(kPlace.west_m + east)));
    };
    EXPECT_NEAR(at(15.0, 5.0), 3e4 * std::sqrt(2.0), 1.0);
    EXPECT_TRUE(std::isnan(at(5.0, 5.0)) && std::isnan(at(25.0, 5.0)) && std::isnan(at(15.0, 15.0)));
    EXPECT_EQ(fds_files(folder / "a.smv", {"HRRPUA"}), (std::vector{folder / "a.be", folder / "a_2.gcf"}));
    Records(folder / "a.be")
        .values(std::vector<std::int32_t>{1})
        .values(std::vector<std::int32_t>{2})
        .values(std::vector<float>{4.0F})
        .values(std::vector<std::int32_t>{0, 0, 0, 2})
        .values(std::vector<float>{30, 30});
    EXPECT_NE(input_error_of([&] {
                  (void)fds_heat_flux(folder / "a.smv", "HRRPUA", kPlace);
              }).find("has 2 values, but its geometry 3 triangles"),
              std::string::npos);
}

}  // namespace
}  // namespace pyroscene::gis
