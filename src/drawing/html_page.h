#pragma once

#include <span>
#include <string>
#include <vector>

namespace pyroscene::drawing {

/// One self-contained HTML file: style and pictures are inside, so it opens from a disk without server or network. Follows
/// the reader's light or dark theme; pictures keep their white paper. All texts are plain and escaped here.
class HtmlPage {
public:
    /// \param meta  name and content of <meta> tags
    explicit HtmlPage(const std::string& title, const std::vector<std::pair<std::string, std::string>>& meta = {});

    /// \param level  1 to 4   \param id  anchor; empty = none
    void heading(int level, const std::string& text, const std::string& id = "");
    void paragraph(const std::string& text);
    /// Paragraphs with a coloured edge.
    void notice(const std::string& text);
    /// A click shows it in full size.   \param png  bytes of the picture
    void picture(const std::string& png, const std::string& alt, const std::string& caption);
    /// Columns of numbers are set flush right: all but the first.
    void table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);
    /// Pairs of name and value side by side.
    void facts(const std::vector<std::pair<std::string, std::string>>& pairs);
    /// Links to places of this page, or to files beside it: text and target.
    void links(const std::vector<std::pair<std::string, std::string>>& targets);
    /// Text with its own line breaks, as in a file.
    void preformatted(const std::string& text);
    /// A part that the reader may open: everything until close_details().
    void open_details(const std::string& summary);
    void close_details();
    /// The whole page.
    [[nodiscard]] std::string text() const;

private:
    std::string html_;
};

/// With &, <, > and quotes as entities.
std::string html_escaped(const std::string& text);

}  // namespace pyroscene::drawing
