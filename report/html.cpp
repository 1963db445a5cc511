// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/html.hpp"

#include <algorithm>
#include <cstddef>

#include "core/require.hpp"

namespace opponens::report {
namespace {

/// A number, with thin spaces between thousands and one of the units that the tables use.
bool looks_numeric(std::string_view html) {
  constexpr std::string_view kThinSpace = "\u202F";
  std::size_t at = 0;
  while (at < html.size()) {
    if (html.substr(at).starts_with(kThinSpace)) {
      at += kThinSpace.size();
    } else if ((html[at] >= '0' && html[at] <= '9') || html[at] == '-' || html[at] == '.') {
      ++at;
    } else {
      break;
    }
  }
  const std::string_view unit = html.substr(at);
  return at > 0 && (unit.empty() || unit == " %" || unit == " s" || unit == " rad");
}

}  // namespace

std::string_view style_sheet() {
  return R"(:root{color-scheme:light dark;--bg:#fff;--fg:#1c2126;--soft:#5a636d;--rule:#d5dae0;--card:#f6f7f9;--sky:#f3f5f8;
--s0:#0072b2;--s1:#d55e00;--s2:#009e73;--s3:#cc79a7;--s4:#7a5c00;--s5:#56a0d3;--s6:#e69f00;--s7:#444;--paper:#8a9099;
--good:#1a7f37;--bad:#b42318;--warn:#fff3cd;--warnfg:#664d03}
@media (prefers-color-scheme:dark){:root{--bg:#15181c;--fg:#e4e7ea;--soft:#a3abb4;--rule:#363c43;--card:#1e2227;--sky:#cfd4da;
--s0:#4fa8e0;--s1:#ff8a3d;--s2:#3ecf9f;--s3:#e79cc8;--s4:#d0a93a;--s5:#8cc4ea;--s6:#f5bd4d;--s7:#c4c9cf;--paper:#9aa1aa;
--good:#4ac26b;--bad:#ff7b72;--warn:#3d3000;--warnfg:#ffe08a}}
*{box-sizing:border-box}
body{margin:0;background:var(--bg);color:var(--fg);font:15px/1.5 system-ui,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
main{max-width:1100px;margin:0 auto;padding:24px 20px 60px}
h1{font-size:28px;line-height:1.2;margin:0 0 8px}h2{font-size:21px;margin:44px 0 10px;padding-top:10px;border-top:1px solid var(--rule)}
h3{font-size:16px;margin:24px 0 6px}p{margin:8px 0;max-width:80ch}a{color:var(--s0)}
.lead{font-size:16px}.note{color:var(--soft)}
.banner{background:var(--warn);color:var(--warnfg);border-left:6px solid #e0a800;padding:10px 16px;margin:16px 0;border-radius:4px}
.banner strong{font-size:17px;letter-spacing:.03em}
nav ol{columns:2;max-width:640px;padding-left:24px;margin:8px 0}
.scroll{overflow-x:auto}table{border-collapse:collapse;margin:12px 0;font-size:13.5px;min-width:min(460px,100%)}
caption{text-align:left;color:var(--soft);padding-bottom:4px}
th,td{padding:4px 12px 4px 0;border-bottom:1px solid var(--rule);text-align:left;vertical-align:top}
thead th{font-weight:600;vertical-align:bottom;border-bottom:2px solid var(--rule)}tbody th{font-weight:500}
th.num{text-align:right}td.num{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
code,pre{font:12.5px/1.45 ui-monospace,"DejaVu Sans Mono",Menlo,Consolas,monospace}
pre{background:var(--card);padding:10px 12px;border-radius:4px;overflow-x:auto;white-space:pre-wrap;overflow-wrap:anywhere}
figure{margin:12px 0;break-inside:avoid}figure svg{max-width:100%;height:auto;display:block}
figcaption{color:var(--soft);font-size:13px;margin-top:4px;max-width:80ch}
.row{display:flex;flex-wrap:wrap;gap:8px 24px}.row figure{flex:0 1 516px;min-width:0}
.card{background:var(--card);border:1px solid var(--rule);border-radius:6px;padding:12px 14px;break-inside:avoid}
.card h3,.card h4{margin:0 0 6px}.card h4{font-size:15px}.card figure{margin:4px 0}
.views{display:grid;grid-template-columns:repeat(3,1fr);gap:10px}
.about{display:grid;grid-template-columns:3fr 2fr;gap:4px 28px;font-size:13.5px}
.facts{display:grid;grid-template-columns:max-content 1fr;gap:1px 14px;margin:6px 0}.facts dt{color:var(--soft)}.facts dd{margin:0}
p.touching{margin:6px 0 0}ul.touching{list-style:none;margin:0;padding:0}
.dot{display:inline-block;width:10px;height:10px;border-radius:50%;margin-right:5px;border:1px solid #fff}
.legend span{white-space:nowrap}.legend>span{margin-right:14px}
section>.card{margin:12px 0}.card table{margin:6px 0 0;width:100%}
.shots{display:grid;grid-template-columns:1fr 1fr;gap:8px 16px}.shots.small{grid-template-columns:repeat(4,1fr)}
.good{color:var(--good);font-weight:600}.bad{color:var(--bad);font-weight:600}
details{margin:8px 0}summary{cursor:pointer;color:var(--s0)}
svg text{fill:var(--fg);font-family:system-ui,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
.tick{font-size:11px}.axis{font-size:12px}.grid{stroke:var(--rule);stroke-width:.6}
.frame{fill:none;stroke:var(--soft);stroke-width:.8}.sky{fill:var(--sky)}
.solid path{fill:currentColor;stroke:currentColor;stroke-width:7;stroke-linejoin:round}
.cone,.rim{stroke:currentColor;stroke-width:1;stroke-linejoin:round}.cone{fill:currentColor;fill-opacity:.18}.rim{fill:currentColor;fill-opacity:.14;stroke-width:.7}
.axis-of-cone{stroke-width:1.6}
svg .mark{fill:currentColor;font-size:11px;font-weight:700;text-anchor:middle;stroke:#fff;stroke-width:2.6;stroke-linejoin:round;paint-order:stroke}
.trail{fill:none;stroke:#0050b0;stroke-width:1.8}.trail-halo{fill:none;stroke:#fff;stroke-width:3.6;stroke-opacity:.8}
.trail-start{fill:#fff;stroke:#0050b0;stroke-width:1.6}.trail-end{fill:#0050b0}
@media (max-width:700px){.views,.about,.shots,.shots.small{grid-template-columns:1fr}nav ol{columns:1}}
@media print{main{max-width:none;padding:0}.card,.shots figure{break-inside:avoid}h2,h3{break-after:avoid}}
)";
}

Markup paragraph(const Markup& content) { return {concat({"<p>", content.html, "</p>\n"})}; }

Markup note(std::string_view plain) { return {concat({"<p class=\"note\">", escape(plain), "</p>\n"})}; }

Markup subheading(std::string_view plain) { return {concat({"<h3>", escape(plain), "</h3>\n"})}; }

Markup figure(const std::string& svg, std::string_view caption) {
  const std::string words = caption.empty() ? "" : concat({"<figcaption>", escape(caption), "</figcaption>"});
  return {concat({"<figure>", svg, words, "</figure>\n"})};
}

Markup row_of(const std::vector<Markup>& figures, std::string_view css_class) {
  Markup row{concat({"<div class=\"", css_class, "\">\n"})};
  for (const auto& item : figures) row += item;
  row.html += "</div>\n";
  return row;
}

Markup identifier(std::string_view id) {
  return {concat({"<code title=\"", escape(id), "\">", escape(shortened(id)), "</code>"})};
}

Markup badge(bool good, std::string_view word) {
  return {concat({"<span class=\"", good ? "good" : "bad", "\">", escape(word), "</span>"})};
}

Markup details(std::string_view summary, const Markup& content) {
  return {concat({"<details><summary>", escape(summary), "</summary>\n", content.html, "</details>\n"})};
}

Table::Table(std::string_view caption, const std::vector<std::string>& headers)
    : caption_(caption), headers_(headers) {}

void Table::row(const std::vector<Markup>& cells) {
  require(cells.size() == headers_.size(), "a table's row has another number of cells than its head");
  rows_.push_back(cells);
}

Markup Table::str() const {
  std::string html = concat({"<div class=\"scroll\"><table><caption>", escape(caption_), "</caption><thead><tr>"});
  for (std::size_t i = 0; i < headers_.size(); ++i) {
    const bool numeric =
        i > 0 && std::any_of(rows_.begin(), rows_.end(), [&](const auto& row) { return looks_numeric(row[i].html); });
    html += concat({numeric ? "<th scope=\"col\" class=\"num\">" : "<th scope=\"col\">", escape(headers_[i]), "</th>"});
  }
  html += "</tr></thead><tbody>\n";
  for (const auto& row : rows_) {
    html += concat({"<tr><th scope=\"row\">", row.front().html, "</th>"});
    for (std::size_t i = 1; i < row.size(); ++i) {
      html += concat({looks_numeric(row[i].html) ? "<td class=\"num\">" : "<td>", row[i].html, "</td>"});
    }
    html += "</tr>\n";
  }
  return {concat({html, "</tbody></table></div>\n"})};
}

}  // namespace opponens::report
