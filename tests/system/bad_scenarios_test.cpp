// Every file in scenarios/bad must be refused with exit code 3 and the message that its first lines announce.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "system/support.h"

namespace pyroscene::test {
namespace {

std::vector<std::string> bad_scenarios() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "scenarios" / "bad"))
        if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

/// The texts after "# expect: " at the top of the file.
std::vector<std::string> expected_messages(const std::filesystem::path& file) {
    std::vector<std::string> expected;
    std::ifstream in(file);
    const std::string tag = "# expect: ";
    for (std::string line; std::getline(in, line) && line.starts_with("#");)
        if (line.starts_with(tag)) expected.push_back(line.substr(tag.size()));
    return expected;
}

class BadScenario : public testing::TestWithParam<std::string> {};

TEST_P(BadScenario, IsRefusedWithItsMessage) {
    const auto file = source_folder() / "scenarios" / "bad" / (GetParam() + ".yaml");
    const auto expected = expected_messages(file);
    ASSERT_FALSE(expected.empty()) << "no '# expect: ' line";
    const ScratchFolder scratch;
    const auto result = pyroscene_cli("run " + file.string() + " -o " + (scratch / "out").string());
    EXPECT_EQ(result.exit_code, 3) << result.output;
    for (const auto& text : expected)
        EXPECT_NE(result.output.find(text), std::string::npos) << "expected: " << text << "\n" << result.output;
    EXPECT_LT(result.output.size(), 2000U) << "the message should be short";
}

INSTANTIATE_TEST_SUITE_P(Shipped, BadScenario, testing::ValuesIn(bad_scenarios()), [](const auto& param_info) {
    std::string name = param_info.param;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
    return name;
});

TEST(BadScenarios, ThereAreEnough) { EXPECT_GE(bad_scenarios().size(), 25U); }

}  // namespace
}  // namespace pyroscene::test
