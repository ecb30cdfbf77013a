#include "gis/fds_index.h"

#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"
#include "gis/fortran_records.h"

namespace pyroscene::gis {
namespace {

/// Lines of the index with their numbers.
class Lines {
public:
    explicit Lines(const std::filesystem::path& smv) : path_(smv.string()), in_(smv) {
        if (!in_) throw input_error(path_, "cannot be opened");
    }
    bool next(std::string& line) {
        if (!std::getline(in_, line)) return false;
        ++number_;
        const auto first = line.find_first_not_of(" \t\r"), last = line.find_last_not_of(" \t\r");
        line = first == std::string::npos ? "" : line.substr(first, last - first + 1);
        return true;
    }
    /// The next line of an entry that must have one.
    std::string entry(const char* what) {
        std::string line;
        if (!next(line)) fail(fmt::format("ends inside {}", what));
        return line;
    }
    template <class T>
    std::vector<T> numbers(const char* what, std::size_t least) {
        std::istringstream in(entry(what));
        std::vector<T> values;
        for (T v; in >> v;) values.push_back(v);
        if (values.size() < least) fail(fmt::format("{} has {} numbers, expected {}", what, values.size(), least));
        return values;
    }
    [[noreturn]] void fail(const std::string& what) const { throw input_error(fmt::format("{}:{}", path_, number_), what); }

private:
    std::string path_;
    std::ifstream in_;
    int number_ = 0;
};

/// Node coordinates of TRNX or TRNY: how many transformations, these, then the nodes with their numbers.
std::vector<double> nodes(Lines& lines, const char* what, std::size_t count) {
    const int transformations = lines.numbers<int>(what, 1)[0];
    for (int i = 0; i < transformations; ++i) (void)lines.entry(what);
    std::vector<double> at;
    for (std::size_t i = 0; i < count; ++i) at.push_back(lines.numbers<double>(what, 2)[1]);
    return at;
}

std::vector<double> even_nodes(double first, double last, std::size_t cells) {
    std::vector<double> at;
    for (std::size_t i = 0; i <= cells; ++i)
        at.push_back(first + (last - first) * static_cast<double>(i) / static_cast<double>(cells));
    return at;
}

}  // namespace

FdsIndex read_fds_index(const std::filesystem::path& smv) {
    Lines lines(smv);
    FdsIndex index;
    std::vector<int> cells;
    std::string line;
    const auto mesh = [&]() -> FdsMesh& {
        if (index.meshes.empty()) lines.fail("has no GRID before this");
        return index.meshes.back();
    };
    while (lines.next(line)) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "GRID") {
            cells = lines.numbers<int>("GRID", 3);
            if (cells[0] < 1 || cells[1] < 1) lines.fail(fmt::format("GRID of {} x {} cells", cells[0], cells[1]));
            index.meshes.emplace_back();
        } else if (key == "PDIM") {
            const auto edges = lines.numbers<double>("PDIM", 4);
            mesh().x_m = even_nodes(edges[0], edges[1], static_cast<std::size_t>(cells[0]));
            mesh().y_m = even_nodes(edges[2], edges[3], static_cast<std::size_t>(cells[1]));
        } else if (key == "TRNX") {
            mesh().x_m = nodes(lines, "TRNX", static_cast<std::size_t>(cells[0]) + 1);
        } else if (key == "TRNY") {
            mesh().y_m = nodes(lines, "TRNY", static_cast<std::size_t>(cells[1]) + 1);
        } else if (key == "SLCF" || key == "SLCC" || key == "SLCT" || key == "BNDF" || key == "BNDC") {
            FdsFile file;
            std::size_t number = 0;
            words >> number;
            if (number < 1 || number > index.meshes.size())
                lines.fail(fmt::format("{} of mesh {}, but there are {}", key, number, index.meshes.size()));
            file.mesh = number - 1;
            file.kind = key[0] == 'S' ? FdsFile::Kind::Slice : FdsFile::Kind::Boundary;
            file.cell_centred = key == "SLCC" || key == "BNDC";
            file.file = smv.parent_path() / lines.entry("an output file");
            file.label = lines.entry("an output file");
            (void)lines.entry("an output file");
            file.unit = lines.entry("an output file");
            index.files.push_back(std::move(file));
        }
    }
    if (index.meshes.empty()) throw input_error(smv.string(), "has no GRID: is it the .smv of an FDS run?");
    return index;
}

namespace {

constexpr std::size_t kLabelLength = 30;

/// \param box  first and last index along x, y and z
std::size_t values_of(const std::vector<std::int32_t>& box) {
    const auto length = [&](std::size_t first) { return static_cast<std::size_t>(box[first + 1] - box[first] + 1); };
    return length(0) * length(2) * length(4);
}

std::vector<FdsPatch> last_moment(FortranRecords& records, const std::vector<std::vector<std::int32_t>>& boxes,
                                  const std::vector<bool>& wanted) {
    std::vector<FdsPatch> patches;
    while (!records.at_end()) {
        (void)records.floats(1);
        patches.clear();
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const auto& b = boxes[i];
            auto values = records.floats(values_of(b));
            if (wanted[i]) patches.push_back({b[0], b[1], b[2], b[3], std::move(values)});
        }
    }
    return patches;
}

}  // namespace

std::vector<FdsPatch> read_fds_patches(const FdsFile& file) {
    constexpr std::int32_t kUp = 3;
    FortranRecords records(file.file);
    for (int i = 0; i < 3; ++i) (void)records.text(kLabelLength);
    if (file.kind == FdsFile::Kind::Slice) {
        const auto box = records.integers(6);
        return last_moment(records, {box}, {box[4] == box[5]});
    }
    const int count = records.integers(1)[0];
    std::vector<std::vector<std::int32_t>> boxes;
    std::vector<bool> faces_up;
    for (int i = 0; i < count; ++i) {
        boxes.push_back(records.integers(9));  // box, orientation, obstacle, mesh
        faces_up.push_back(boxes.back()[6] == kUp);
    }
    return last_moment(records, boxes, faces_up);
}

}  // namespace pyroscene::gis
