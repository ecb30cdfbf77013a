#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "scenario/scenario.h"
#include "source_folder.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {

namespace {

/// What a broken scenario of scenarios/bad announces in the comments at its top.
struct BadScenario {
    fs::path path;
    std::vector<std::string> expected;  ///< parts of the message
    bool needs_files = false;           ///< load() cannot know: the fault lies in the files it names
};

BadScenario read_announcement(const fs::path& path) {
    const std::string expect = "# expect: ", needs = "# needs: ";
    BadScenario bad{path, {}, false};
    std::ifstream in(path);
    for (std::string line; std::getline(in, line) && line.starts_with("#");) {
        if (line.starts_with(expect)) bad.expected.push_back(line.substr(expect.size()));
        if (line.starts_with(needs)) bad.needs_files = true;
    }
    return bad;
}

std::vector<BadScenario> bad_scenarios() {
    std::vector<BadScenario> all;
    for (const auto& entry : fs::directory_iterator(source_folder() / "scenarios" / "bad"))
        if (entry.path().extension() == ".yaml") all.push_back(read_announcement(entry.path()));
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
    return all;
}

class EveryBadScenario : public ::testing::TestWithParam<BadScenario> {};

}  // namespace

TEST_P(EveryBadScenario, SaysWhatIsWrong) {
    const BadScenario& bad = GetParam();
    ASSERT_FALSE(bad.expected.empty()) << "no '# expect: ' at the top";
    if (bad.needs_files) {
        EXPECT_NO_THROW((void)load(bad.path));
        return;
    }
    try {
        (void)load(bad.path);
        FAIL() << "was accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        const std::string message = error.what();
        for (const auto& part : bad.expected)
            EXPECT_NE(message.find(part), std::string::npos) << part << "\n is not in\n" << message;
        const bool one_line = std::count(message.begin(), message.end(), '\n') == 0;
        EXPECT_TRUE(one_line || bad.expected.size() > 1) << "says more than the file announces:\n" << message;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, EveryBadScenario, ::testing::ValuesIn(bad_scenarios()), [](const auto& parameter) {
    std::string name = parameter.param.path.stem().string();
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
});

}  // namespace pyroscene::scenario
