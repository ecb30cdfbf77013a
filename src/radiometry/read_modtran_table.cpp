#include <array>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"
#include "radiometry/modtran_columns.h"

namespace pyroscene::radiometry {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        lines.push_back(line);
    }
    return lines;
}

/// A word of a line and the column after its last character: numbers and their names are aligned at the right.
struct Word {
    std::string text;
    std::size_t end = 0;
};

std::vector<Word> words_of(const std::string& line) {
    std::vector<Word> words;
    for (std::size_t i = 0; i < line.size();) {
        if (line[i] == ' ' || line[i] == '\t') {
            ++i;
            continue;
        }
        const auto end = std::min(line.find_first_of(" \t", i), line.size());
        words.push_back({line.substr(i, end - i), end});
        i = end;
    }
    return words;
}

bool is_header(const std::string& line) {
    const auto words = words_of(line);
    return words.size() > 1 && (words[0].text == "FREQ" || words[0].text == "WAVLEN" || words[0].text == "WAVELENGTH");
}

struct Layout {
    std::vector<std::string> names;  ///< normalised
    std::vector<std::size_t> ends;
    std::size_t header_lines = 1;
    bool by_words = false;  ///< direct irradiance: few columns, never blank, header not aligned with them
};

/// Names and columns of the table whose header starts at a line. Transmittance mode has a second line of names.
Layout layout_of(const std::vector<std::string>& lines, std::size_t header) {
    Layout layout;
    const auto names = words_of(lines[header]);
    if (lines[header].find("SOL TR") != std::string::npos) {
        layout.names = {"FREQ", "TRANS", "SOLTR", "SOLAR"};
        layout.by_words = true;
        return layout;
    }
    for (const auto& word : names) {
        layout.names.push_back(normalised_name(word.text));
        layout.ends.push_back(word.end);
    }
    const auto second = header + 1 < lines.size() ? words_of(lines[header + 1]) : std::vector<Word>{};
    if (second.size() < 2 || fortran_number(second[0].text)) return layout;
    // The second line holds every column; names of the first may touch each other (H2-CH4CH4-CH4).
    layout = {{}, {}, 2, false};
    for (const auto& word : second) {
        std::string name;
        for (const auto& upper : names)
            if (upper.end == word.end) name = normalised_name(upper.text);
        layout.names.push_back(layout.ends.empty() ? "FREQ" : name + normalised_name(word.text));
        layout.ends.push_back(word.end);
    }
    return layout;
}

double field(const std::string& line, std::size_t begin, std::size_t width) {
    if (begin >= line.size()) return std::nan("");
    return fortran_number(line.substr(begin, width)).value_or(std::nan(""));
}

/// The cards are echoed above the table. Their number varies with options, so they are counted from the table upwards, and
/// what is read must agree with the table: the spectral limits of card 4.
void read_cards(const std::vector<std::string>& lines, std::size_t begin, std::size_t header, ModtranColumns& c) {
    if (header < begin + 6) return;
    const std::string &card1 = lines[begin], &card2 = lines[begin + 1], &card3 = lines[header - 5],
                      &sun_card = lines[header - 4], &sun_angles = lines[header - 3], &card4 = lines[header - 2];
    if (c.x.empty() || card1.size() < 20) return;
    const double lower = field(card4, 0, 10), upper = field(card4, 10, 10), step = field(card4, 20, 10);
    const double slack = std::max(std::isnan(step) ? 0.0 : step, 1e-3 * std::abs(upper));
    if (!(lower <= c.x.front() + slack && upper >= c.x.back() - slack)) return;
    ModtranGeometry g;
    const double itype = field(card1, 6, 4), mode = field(card1, 10, 5);
    const double sun_geometry = field(sun_card, 0, 5), haze_visibility = field(card2, 30, 10), ground = field(card2, 70, 10);
    if (std::isnan(itype) || std::isnan(mode)) return;
    g.itype = static_cast<int>(itype);
    g.with_sun = mode == 2.0;
    g.h1_km = field(card3, 0, 10);
    g.h2_km = field(card3, 10, 10);
    g.zenith_deg = field(card3, 20, 10);
    if (std::isnan(g.h1_km) || std::isnan(g.h2_km) || std::isnan(g.zenith_deg)) return;
    g.ground_km = std::isnan(ground) ? 0.0 : ground;
    g.visibility_km = std::isnan(haze_visibility) ? 0.0 : haze_visibility;
    const double albedo = card1.size() > 73 ? field(card1, 73, 7) : std::nan("");
    if (!std::isnan(albedo)) g.albedo = albedo;
    g.iparm = std::isnan(sun_geometry) ? -1 : static_cast<int>(sun_geometry);
    const double day = field(sun_card, 10, 5);
    g.day_of_year = day > 0.0 && day <= 366.0 ? static_cast<int>(day) : 0;
    g.parm1 = field(sun_angles, 0, 10);
    g.parm2 = field(sun_angles, 10, 10);
    g.with_sun = g.with_sun && !std::isnan(g.parm1) && !std::isnan(g.parm2);
    set_geometry(g, c.geometry, c.looks_up);
    if (card4.size() > 50 && c.abscissa != ModtranColumns::Abscissa::Wavenumber)
        c.abscissa = card4[50] == 'N' ? ModtranColumns::Abscissa::Nanometre : ModtranColumns::Abscissa::Micrometre;
}

bool may_be_blank(const std::string& name) { return name == "THRMLSCT" || name == "SINGSCAT" || name == "DRCTRFLT"; }

void read_row(const std::string& line, const std::string& where, const Layout& layout, ModtranColumns& c) {
    const auto words = layout.by_words ? words_of(line) : std::vector<Word>{};
    if (layout.by_words && words.size() < layout.names.size())
        throw input_error(where, fmt::format("{} numbers, expected {}", words.size(), layout.names.size()));
    for (std::size_t k = 0; k < layout.names.size(); ++k) {
        const std::size_t begin = k > 0 && !layout.by_words ? layout.ends[k - 1] : 0;
        const std::string text = layout.by_words        ? words[k].text
                                 : begin >= line.size() ? std::string()
                                                        : line.substr(begin, layout.ends[k] - begin);
        auto value = fortran_number(text);
        const bool blank = text.find_first_not_of(' ') == std::string::npos;
        if (blank && may_be_blank(layout.names[k])) value = 0.0;
        if (!value) throw input_error(where, fmt::format("column {} reads '{}', expected a number", layout.names[k], text));
        if (k == 0)
            c.x.push_back(*value);
        else
            c.columns[layout.names[k]].push_back(*value);
    }
}

}  // namespace

std::vector<AtmosphereRun> read_modtran_table(const std::string& path, const std::string& text, const RunHints& hints,
                                              const Spectrum& sun) {
    const auto lines = lines_of(text);
    std::vector<AtmosphereRun> runs;
    std::size_t begin = 0;  // first card of the run
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!is_header(lines[i])) continue;
        const auto layout = layout_of(lines, i);
        ModtranColumns c;
        c.source = fmt::format("{}:{}", path, i + 1);
        if (layout.names[0] != "FREQ") c.abscissa = ModtranColumns::Abscissa::Micrometre;
        std::size_t row = i + layout.header_lines;
        for (; row < lines.size(); ++row) {
            if (lines[row].find_first_not_of(' ') == std::string::npos) continue;
            const auto first = fortran_number(words_of(lines[row])[0].text);
            if (first && *first == -9999.0) break;
            read_row(lines[row], fmt::format("{}:{}", path, row + 1), layout, c);
        }
        if (row == lines.size())
            throw input_error(path, fmt::format("the table of line {} ends without -9999: the file is cut off", i + 1));
        if (c.abscissa != ModtranColumns::Abscissa::Wavenumber && !c.x.empty() && c.x.back() > 150.0)
            c.abscissa = ModtranColumns::Abscissa::Nanometre;
        read_cards(lines, begin, i, c);
        runs.push_back(to_run(c, hints, sun));
        begin = row + 1;
        i = row;
    }
    if (runs.empty()) throw input_error(path, "no line starts with FREQ or WAVLEN: this is no MODTRAN tape7 table");
    return runs;
}

}  // namespace pyroscene::radiometry
