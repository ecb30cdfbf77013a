#include "base/files.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"

namespace fs = std::filesystem;

namespace pyroscene {

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)) {
    std::error_code ignored;
    if (target_.has_parent_path()) fs::create_directories(target_.parent_path(), ignored);
    const auto name = fmt::format(".{}.{}.part{}", target_.stem().string(), ::getpid(), target_.extension().string());
    temporary_ = target_.parent_path() / name;
}

AtomicFile::~AtomicFile() {
    if (committed_) return;
    std::error_code ignored;
    fs::remove(temporary_, ignored);
    fs::remove(temporary_.string() + ".aux.xml", ignored);
}

void AtomicFile::commit() {
    std::error_code failure;
    fs::rename(temporary_, target_, failure);
    if (failure) throw runtime_error(target_.string(), "cannot be written: " + failure.message());
    committed_ = true;
    std::error_code ignored;
    fs::remove(temporary_.string() + ".aux.xml", ignored);
}

void write_text_file(const fs::path& path, const std::string& text) {
    AtomicFile file(path);
    std::ofstream out(file.path(), std::ios::binary);
    out << text;
    out.close();
    if (!out) throw runtime_error(path.string(), "cannot be written");
    file.commit();
}

std::string read_text_file(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw input_error(path.string(), "cannot be opened");
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

namespace {

fs::path program_folder() {
    std::error_code ignored;
    const auto program = fs::read_symlink("/proc/self/exe", ignored);
    return ignored ? fs::path{} : program.parent_path();
}

}  // namespace

fs::path data_folder() {
    std::error_code ignored;
    if (const char* override_path = std::getenv("PYROSCENE_DATA"); override_path != nullptr && *override_path != '\0') {
        if (fs::is_directory(override_path, ignored)) return override_path;
        throw input_error("PYROSCENE_DATA", fmt::format("'{}' is not a folder", override_path));
    }
    if (const auto installed = program_folder() / "../share/pyroscene"; fs::is_directory(installed / "atmosphere", ignored))
        return fs::weakly_canonical(installed);
    if (fs::is_directory(PYROSCENE_SOURCE_DIR "/data", ignored)) return PYROSCENE_SOURCE_DIR "/data";
    throw runtime_error("data folder", "not found; set PYROSCENE_DATA to the folder that holds 'atmosphere' and 'optical'");
}

fs::path sensor_folder() {
    std::error_code ignored;
    const auto data = data_folder();
    if (fs::is_directory(data / "sensors", ignored)) return data / "sensors";
    if (fs::is_directory(data / "../sensors/specs", ignored)) return fs::weakly_canonical(data / "../sensors");
    throw runtime_error("sensor folder", fmt::format("no 'sensors' folder in or beside '{}'", data.string()));
}

}  // namespace pyroscene
