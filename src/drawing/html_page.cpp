#include "drawing/html_page.h"

#include <fmt/format.h>
#include <openssl/evp.h>

namespace pyroscene::drawing {
namespace {

constexpr const char* kStyle = R"css(
:root{color-scheme:light dark;--ink:#1f2328;--dim:#59636e;--paper:#fff;--panel:#f6f8fa;--line:#d1d9e0;--mark:#bc4c00}
@media(prefers-color-scheme:dark){:root{--ink:#e6edf3;--dim:#9198a1;--paper:#0f1419;--panel:#171d24;--line:#333b45;--mark:#f0883e}}
*{box-sizing:border-box}
body{font:15px/1.5 system-ui,-apple-system,"Segoe UI","Liberation Sans",sans-serif;color:var(--ink);background:var(--paper);margin:0}
main{max-width:76rem;margin:0 auto;padding:2rem 1.5rem 4rem}
h1{font-size:1.7rem;line-height:1.25;margin:0 0 .4rem;border-bottom:3px solid var(--mark);padding-bottom:.5rem}
h2{font-size:1.3rem;margin:2.4rem 0 .6rem;border-bottom:1px solid var(--line);padding-bottom:.3rem}
h3{font-size:1.08rem;margin:1.8rem 0 .4rem}
h4{font-size:1rem;margin:1.2rem 0 .3rem;color:var(--dim)}
p{margin:.5rem 0;max-width:60rem}
.scroll{overflow-x:auto}
table{border-collapse:collapse;margin:.6rem 0 1rem;font-variant-numeric:tabular-nums}
th,td{padding:.28rem .8rem;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}
th{color:var(--dim);font-weight:600}
td:first-child,th:first-child{text-align:left}
dl{display:grid;grid-template-columns:repeat(auto-fill,minmax(15rem,1fr));gap:.6rem 1.2rem;background:var(--panel);border:1px solid var(--line);border-radius:6px;padding:.9rem 1.1rem;margin:.8rem 0}
dt{color:var(--dim);font-size:.85rem}
dd{margin:0;font-weight:600;overflow-wrap:anywhere}
figure{margin:.8rem 0 1.2rem}
figure img{max-width:100%;height:auto;background:#fff;border:1px solid var(--line);border-radius:6px}
figcaption{color:var(--dim);font-size:.9rem;max-width:60rem}
figure label{display:block;overflow-x:auto;cursor:zoom-in}
figure input{display:none}
figure input:checked+img{max-width:none;cursor:zoom-out}
.notice{border-left:4px solid var(--mark);background:var(--panel);padding:.4rem .9rem;margin:.4rem 0;max-width:60rem}
a{color:var(--mark)}
pre{background:var(--panel);border:1px solid var(--line);border-radius:6px;padding:.8rem;overflow-x:auto;font-size:.85rem}
nav a{margin-right:1.1rem}
summary{cursor:pointer;color:var(--dim)}
)css";

/// Base64, the form of pictures inside a page.
std::string base64(const std::string& bytes) {
    std::string out(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // the library ends it with a zero
    const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                                       reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
    out.resize(static_cast<std::size_t>(length));
    return out;
}

}  // namespace

std::string html_escaped(const std::string& text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    return out;
}

HtmlPage::HtmlPage(const std::string& title, const std::vector<std::pair<std::string, std::string>>& meta) {
    html_ =
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
    for (const auto& [name, content] : meta)
        html_ += fmt::format("<meta name=\"{}\" content=\"{}\">\n", html_escaped(name), html_escaped(content));
    html_ += fmt::format("<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n", html_escaped(title), kStyle);
    heading(1, title);
}

void HtmlPage::heading(int level, const std::string& text, const std::string& id) {
    const auto anchor = id.empty() ? "" : fmt::format(" id=\"{}\"", html_escaped(id));
    html_ += fmt::format("<h{0}{1}>{2}</h{0}>\n", level, anchor, html_escaped(text));
}

void HtmlPage::paragraph(const std::string& text) { html_ += fmt::format("<p>{}</p>\n", html_escaped(text)); }

void HtmlPage::notice(const std::string& text) { html_ += fmt::format("<p class=\"notice\">{}</p>\n", html_escaped(text)); }

void HtmlPage::picture(const std::string& png, const std::string& alt, const std::string& caption) {
    html_ += fmt::format(
        "<figure><label><input type=\"checkbox\"><img alt=\"{}\" "
        "src=\"data:image/png;base64,{}\"></label>\n<figcaption>{}</figcaption></figure>\n",
        html_escaped(alt), base64(png), html_escaped(caption));
}

void HtmlPage::table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
    html_ += "<div class=\"scroll\"><table><thead><tr>";
    for (const auto& cell : head) html_ += fmt::format("<th>{}</th>", html_escaped(cell));
    html_ += "</tr></thead><tbody>\n";
    for (const auto& row : rows) {
        html_ += "<tr>";
        for (const auto& cell : row) html_ += fmt::format("<td>{}</td>", html_escaped(cell));
        html_ += "</tr>\n";
    }
    html_ += "</tbody></table></div>\n";
}

void HtmlPage::facts(const std::vector<std::pair<std::string, std::string>>& pairs) {
    html_ += "<dl>";
    for (const auto& [name, value] : pairs)
        html_ += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", html_escaped(name), html_escaped(value));
    html_ += "</dl>\n";
}

void HtmlPage::links(const std::vector<std::pair<std::string, std::string>>& targets) {
    html_ += "<nav>";
    for (const auto& [text, target] : targets)
        html_ += fmt::format("<a href=\"{}\">{}</a>\n", html_escaped(target), html_escaped(text));
    html_ += "</nav>\n";
}

void HtmlPage::preformatted(const std::string& text) { html_ += fmt::format("<pre>{}</pre>\n", html_escaped(text)); }

void HtmlPage::open_details(const std::string& summary) {
    html_ += fmt::format("<details><summary>{}</summary>\n", html_escaped(summary));
}
void HtmlPage::close_details() { html_ += "</details>\n"; }

std::string HtmlPage::text() const { return html_ + "</main>\n</body>\n</html>\n"; }

}  // namespace pyroscene::drawing
