#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pyroscene {

/// A small text table: '#' comment lines, one header row, then rows of as many fields. A field may stand in double quotes
/// (RFC 4180), but not run over several lines.
struct CsvTable {
    std::string path;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
    std::vector<int> row_lines;  ///< 1-based line number of each row in the file

    /// Position of a column. Throws an input error that lists the columns there are.
    [[nodiscard]] std::size_t column(std::string_view name) const;
    [[nodiscard]] bool has(std::string_view name) const noexcept;
    /// One column as numbers. Throws an input error naming file and line for a field that is no number.
    [[nodiscard]] std::vector<double> numbers(std::string_view name) const;
};

/// Reads a table. Throws an input error naming file and line (missing file, ragged row, no header,
/// open quote).
CsvTable read_csv(const std::filesystem::path& path);

/// A full-string number, or an input error "subject: expected a number, found ...".
double parse_number(std::string_view text, std::string_view subject);

}  // namespace pyroscene
