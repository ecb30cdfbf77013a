// Native forms of the instruments, opened by the programs that their users have (native_readers.py).
#include <gtest/gtest.h>

#include <fstream>

#include <fmt/format.h>

#include "system/support.h"

namespace pyroscene::test {
namespace {

/// A run of the minimal scenario's fire with other acquisitions.
void run_native(const ScratchFolder& scratch, const std::string& acquisitions) {
    const auto inputs = source_folder() / "scenarios" / "minimal";
    std::ofstream(scratch / "scenario.yaml") << fmt::format(R"(pyroscene: 1
name: native
inputs:
  terrain:   {{file: {0}/dem.tif}}
  heat_flux: {{file: {0}/heat_flux.tif}}
start: 2021-08-12T20:00:00Z
acquisitions:
{1}products: [radiance, ortho, native]
)",
                                                            inputs.string(), acquisitions);
    const auto done = pyroscene_cli("run " + (scratch / "scenario.yaml").string() + " -q -o " + (scratch / "out").string());
    ASSERT_EQ(done.exit_code, 0) << done.output;
}

/// Debian's interpreter, not one that a version manager puts first: the bindings belong to it.
void read_by(const std::string& arguments) {
    const auto script = source_folder() / "tests" / "system" / "native_readers.py";
    const auto read = run_command("/usr/bin/python3 " + script.string() + " " + arguments);
    constexpr int kAbsent = 77;
    if (read.exit_code == kAbsent) GTEST_SKIP() << "the program to read it with is not installed";
    EXPECT_EQ(read.exit_code, 0) << read.output;
}

TEST(NativeForms, AvirisCubeOpensInSpectralPython) {
    const ScratchFolder scratch;
    run_native(scratch, R"(  - {id: line, sensor: aviris-classic, time_s: 120, bands: ['30', '120', '200'],
     platform: {over: centre, altitude_agl_m: 4000, heading_deg: 30, ground_speed_m_s: 41}}
)");
    if (HasFatalFailure()) return;
    read_by("aviris " + (scratch / "out/line").string() + " line_rdn");
}

}  // namespace
}  // namespace pyroscene::test
