#include "base/files.h"

#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "unit/base/temp_folder.h"

namespace pyroscene {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

TEST(AtomicFile, AppearsOnlyWithCommit) {
    const TempFolder folder;
    const auto target = folder / "image.tif";
    AtomicFile file(target);
    put(file.path(), "new");
    EXPECT_FALSE(fs::exists(target));
    EXPECT_EQ(file.path().parent_path(), target.parent_path());
    EXPECT_EQ(file.path().extension(), ".tif");
    file.commit();
    EXPECT_EQ(read_text_file(target), "new");
    EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, LeavesTheOldFileAndNothingElseWithoutCommit) {
    const TempFolder folder;
    const auto target = folder / "image.tif";
    put(target, "old");
    {
        AtomicFile file(target);
        put(file.path(), "half");
        put(file.path().string() + ".aux.xml", "side file");
    }
    EXPECT_EQ(read_text_file(target), "old");
    EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, MakesTheFolderOfItsTarget) {
    const TempFolder folder;
    write_text_file(folder / "a/b/c.txt", "text");
    EXPECT_EQ(read_text_file(folder / "a/b/c.txt"), "text");
}

TEST(AtomicFile, CommitWithoutAFileIsARuntimeError) {
    const TempFolder folder;
    AtomicFile file(folder / "never_written.txt");
    try {
        file.commit();
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Runtime);
        EXPECT_NE(std::string(e.what()).find("never_written.txt"), std::string::npos);
    }
}

TEST(WriteTextFile, FailsWhereAFileStandsInTheWay) {
    const TempFolder folder;
    put(folder / "file", "x");
    EXPECT_THROW(write_text_file(folder / "file/inside.txt", "y"), Error);
}

TEST(ReadTextFile, MissingFileIsAnInputError) {
    try {
        read_text_file("/nonexistent/file");
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
    }
}

/// Sets an environment variable for one test.
class Environment {
public:
    Environment(const char* name, const std::string& value) : name_(name) { ::setenv(name, value.c_str(), 1); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;
    ~Environment() { ::unsetenv(name_); }

private:
    const char* name_;
};

TEST(DataFolder, FollowsTheEnvironment) {
    const TempFolder folder;
    const Environment environment("PYROSCENE_DATA", folder.path().string());
    EXPECT_EQ(data_folder(), folder.path());
}

TEST(DataFolder, RefusesAnEnvironmentThatNamesNoFolder) {
    const Environment environment("PYROSCENE_DATA", "/nonexistent/data");
    EXPECT_THROW(data_folder(), Error);
}

TEST(DataFolder, FindsTheSourceTree) {
    EXPECT_TRUE(fs::is_directory(data_folder() / "atmosphere"));
    EXPECT_TRUE(fs::is_directory(sensor_folder() / "specs"));
}

}  // namespace
}  // namespace pyroscene
