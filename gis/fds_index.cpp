#include "gis/fds_index.h"

#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"

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

/// Node coordinates of TRNX, TRNY or TRNZ: how many transformations, these, then the nodes with their numbers.
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
            if (cells[0] < 1 || cells[1] < 1 || cells[2] < 1)
                lines.fail(fmt::format("GRID of {} x {} x {} cells", cells[0], cells[1], cells[2]));
            index.meshes.emplace_back();
        } else if (key == "PDIM") {
            const auto edges = lines.numbers<double>("PDIM", 6);
            mesh().x_m = even_nodes(edges[0], edges[1], static_cast<std::size_t>(cells[0]));
            mesh().y_m = even_nodes(edges[2], edges[3], static_cast<std::size_t>(cells[1]));
            mesh().z_m = even_nodes(edges[4], edges[5], static_cast<std::size_t>(cells[2]));
        } else if (key == "TRNX") {
            mesh().x_m = nodes(lines, "TRNX", static_cast<std::size_t>(cells[0]) + 1);
        } else if (key == "TRNY") {
            mesh().y_m = nodes(lines, "TRNY", static_cast<std::size_t>(cells[1]) + 1);
        } else if (key == "TRNZ") {
            mesh().z_m = nodes(lines, "TRNZ", static_cast<std::size_t>(cells[2]) + 1);
        } else if (key == "SLCF" || key == "SLCC" || key == "SLCT" || key == "BNDF" || key == "BNDC" || key == "BNDE") {
            FdsFile file;
            std::size_t number = 0;
            words >> number;
            if (number < 1 || number > index.meshes.size())
                lines.fail(fmt::format("{} of mesh {}, but there are {}", key, number, index.meshes.size()));
            file.mesh = number - 1;
            file.kind = key[0] == 'S'   ? FdsFile::Kind::Slice
                        : key == "BNDE" ? FdsFile::Kind::Geometry
                                        : FdsFile::Kind::Boundary;
            file.cell_centred = key == "SLCC" || key == "BNDC";
            file.file = smv.parent_path() / lines.entry("an output file");
            if (file.kind == FdsFile::Kind::Geometry) {
                const auto name = lines.entry("an output file");
                file.geometry =
                    smv.parent_path() / (name == "-" ? fmt::format("{}_{}.gcf", smv.stem().string(), file.mesh + 1) : name);
            }
            file.label = lines.entry("an output file");
            (void)lines.entry("an output file");
            file.unit = lines.entry("an output file");
            index.files.push_back(std::move(file));
        }
    }
    if (index.meshes.empty()) throw input_error(smv.string(), "has no GRID: is it the .smv of an FDS run?");
    return index;
}

}  // namespace pyroscene::gis
