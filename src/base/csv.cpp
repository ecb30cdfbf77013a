#include "base/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"

namespace pyroscene {
namespace {

std::string_view trim(std::string_view s) {
    const auto first = s.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
}

/// One field from `rest`, which keeps what follows it, with its comma. In quotes a doubled quote stands for one, and commas
/// and blanks belong to the field. Throws an input error for a quote that does not end or is followed by text.
std::string take_field(std::string_view& rest, std::string_view subject) {
    const auto first = rest.find_first_not_of(" \t");
    if (first == std::string_view::npos || rest[first] != '"') {
        const auto comma = std::min(rest.find(','), rest.size());
        std::string field(trim(rest.substr(0, comma)));
        rest.remove_prefix(comma);
        return field;
    }
    std::string field;
    std::size_t at = first + 1;
    for (;; ++at) {
        if (at >= rest.size()) throw input_error(subject, "a quoted field does not end on its line");
        if (rest[at] != '"') {
            field += rest[at];
        } else if (at + 1 < rest.size() && rest[at + 1] == '"') {
            field += rest[at++];
        } else {
            break;
        }
    }
    rest.remove_prefix(at + 1);
    const auto comma = std::min(rest.find(','), rest.size());
    if (const auto after = trim(rest.substr(0, comma)); !after.empty())
        throw input_error(subject, fmt::format("found '{}' after a quoted field, expected a comma", after));
    rest.remove_prefix(comma);
    return field;
}

std::optional<double> number_in(std::string_view text) {
    const std::string_view s = trim(text);
    if (s == "nan" || s == "NaN") return std::nan("");
    double value = 0.0;
    const char* begin = s.data() + (s.starts_with('+') && !s.starts_with("+-") ? 1 : 0);
    const auto [end, status] = std::from_chars(begin, s.data() + s.size(), value);
    if (status != std::errc{} || end != s.data() + s.size() || s.empty()) return std::nullopt;
    return value;
}

std::vector<std::string> split(std::string_view line, std::string_view subject) {
    std::vector<std::string> fields;
    for (;;) {
        fields.push_back(take_field(line, subject));
        if (line.empty()) return fields;
        line.remove_prefix(1);  // the comma
    }
}

}  // namespace

double parse_number(std::string_view text, std::string_view subject) {
    const auto value = number_in(text);
    if (!value) throw input_error(subject, fmt::format("expected a number, found '{}'", trim(text)));
    return *value;
}

std::size_t CsvTable::column(std::string_view name) const {
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns[i] == name) return i;
    throw input_error(path, fmt::format("no column '{}'; the table has {}", name, fmt::join(columns, ", ")));
}

bool CsvTable::has(std::string_view name) const noexcept {
    for (const auto& c : columns)
        if (c == name) return true;
    return false;
}

std::vector<double> CsvTable::numbers(std::string_view name) const {
    const std::size_t c = column(name);
    std::vector<double> out;
    out.reserve(rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const auto value = number_in(rows[r][c]);
        out.push_back(value ? *value
                            : parse_number(rows[r][c], fmt::format("{}:{}: column '{}'", path, row_lines[r], name)));
    }
    return out;
}

CsvTable read_csv(const std::filesystem::path& path) {
    std::ifstream in(path);
    if (!in) throw input_error(path.string(), "cannot open the table");
    CsvTable table;
    table.path = path.string();
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);  // byte order mark of spreadsheet exports
        const auto text = trim(line);
        if (text.empty() || text.front() == '#') continue;
        auto fields = split(text, fmt::format("{}:{}", table.path, number));
        if (table.columns.empty()) {
            table.columns = std::move(fields);
            continue;
        }
        if (fields.size() != table.columns.size())
            throw input_error(fmt::format("{}:{}", table.path, number),
                              fmt::format("found {} fields, expected {}", fields.size(), table.columns.size()));
        table.rows.push_back(std::move(fields));
        table.row_lines.push_back(number);
    }
    if (table.columns.empty()) throw input_error(table.path, "the table is empty");
    return table;
}

}  // namespace pyroscene
