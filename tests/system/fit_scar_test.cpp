// `pyroscene fit-scar` as a user types it: files, exit codes, messages.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/files.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

std::string record() { return (source_folder() / "tests/data/burnscar_synthetic.csv").string(); }

TEST(FitScar, WritesCoefficientsReportAndPlot) {
    const ScratchFolder scratch;
    for (const std::string algorithm : {"nelder-mead", "powell", "levenberg-marquardt"}) {
        const auto prefix = (scratch / ("deep/folder/" + algorithm)).string();
        const auto result =
            pyroscene_cli("fit-scar " + record() + " --algorithm " + algorithm + " --start 700,30,50,600,40 -o " + prefix);
        ASSERT_EQ(result.exit_code, 0) << result.output;
        EXPECT_NE(result.output.find("200.1048493"), std::string::npos) << result.output;
        EXPECT_NE(result.output.find("converged:"), std::string::npos);
        EXPECT_NE(read_text_file(prefix + ".yaml").find("scar:\n  model: double_exponential\n  amplitude1_K: 567.840"),
                  std::string::npos);
        EXPECT_NE(read_text_file(prefix + ".json").find("\"converged\": true"), std::string::npos);
        EXPECT_EQ(file_bytes(prefix + ".png").substr(1, 3), "PNG");
        EXPECT_GT(file_bytes(prefix + ".png").size(), 5000U);
    }
}

TEST(FitScar, KelvinAndCelsiusGiveTheSame) {
    const ScratchFolder scratch;
    std::ofstream out(scratch / "kelvin.csv");
    out << "time_s,temperature_K\n";
    std::istringstream in(read_text_file(record()));
    for (std::string line; std::getline(in, line);)
        if (std::isdigit(static_cast<unsigned char>(line[0])) != 0) {
            const auto comma = line.find(',');
            out << line.substr(0, comma + 1) << std::to_string(std::stod(line.substr(comma + 1)) + 273.15) << "\n";
        }
    out.close();
    const auto result = pyroscene_cli("fit-scar " + (scratch / "kelvin.csv").string() + " -o " + (scratch / "fit").string());
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_NE(result.output.find("200.10484"), std::string::npos) << result.output;
}

TEST(FitScar, SaysWhenItDoesNotConvergeAndStillShowsThePicture) {
    const ScratchFolder scratch;
    const auto prefix = (scratch / "fit").string();
    const auto result =
        pyroscene_cli("fit-scar " + record() + " --algorithm nelder-mead --maximum-evaluations 30 -o " + prefix);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.output.find("did not converge"), std::string::npos) << result.output;
    EXPECT_TRUE(std::filesystem::exists(prefix + ".png"));
    EXPECT_NE(read_text_file(prefix + ".json").find("\"converged\": false"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(prefix + ".yaml"));
}

TEST(FitScar, RefusesBadTables) {
    const ScratchFolder scratch;
    const std::pair<const char*, const char*> tables[] = {
        {"t_s,T_F\n0,1400\n", "expected one column of temperatures"},
        {"minutes,T_C\n0,800\n", "no column of times"},
        {"t_s,T_C,T_K\n0,800,1073\n", "expected one column of temperatures"},
        {"t_s,T_C\n0,800\n10,hot\n", "bad.csv:3"},
        {"t_s,T_C\n0,800\n-5,700\n", "bad.csv:3"},
        {"t_s,T_C\n0,800\n10,-300\n", "bad.csv:3"},
        {"t_s,T_C\n0,800\n10,700\n", "2 points cannot determine 5 coefficients"},
        {"t_s,T_C\n0,20\n1,20\n2,20\n3,20\n4,20\n5,20\n", "does not change"},
        {"", "bad.csv"},
    };
    for (const auto& [text, message] : tables) {
        std::ofstream(scratch / "bad.csv") << text;
        const auto result =
            pyroscene_cli("fit-scar " + (scratch / "bad.csv").string() + " -o " + (scratch / "fit").string());
        EXPECT_EQ(result.exit_code, 3) << text << result.output;
        EXPECT_NE(result.output.find(message), std::string::npos) << text << result.output;
    }
    EXPECT_EQ(pyroscene_cli("fit-scar nowhere.csv").exit_code, 3);
    EXPECT_EQ(pyroscene_cli("fit-scar " + record() + " --algorithm guess").exit_code, 2);
    EXPECT_EQ(pyroscene_cli("fit-scar " + record() + " --start 1,2").exit_code, 2);
}

}  // namespace
}  // namespace pyroscene::test
