// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string_view>
#include <tuple>

#include "report/sections.hpp"

namespace opponens::report {
namespace {

/// Objects made by one command with the same settings: 180 recordings of one ingest are one entry.
struct Batch {
  std::vector<const ProvenanceItem*> items;
};

using Key = std::tuple<int, std::string, std::string, std::string, std::uint64_t, std::string>;

/// The chain is read from the path back to the recordings.
int rank(const std::string& kind) {
  constexpr std::array<std::string_view, 5> kOrder{"path", "grasp", "synergy_set", "hand_demonstration",
                                                   "demonstration"};
  const auto found = std::find(kOrder.begin(), kOrder.end(), kind);
  return static_cast<int>(found - kOrder.begin());
}

std::map<Key, Batch> batches(const std::vector<ProvenanceItem>& items) {
  std::map<Key, Batch> sorted;
  for (const auto& item : items) {
    sorted[{rank(item.kind), item.kind, item.command, item.parameters, item.seed, item.program_version}]
        .items.push_back(&item);
  }
  for (auto& [key, batch] : sorted) {
    std::sort(batch.items.begin(), batch.items.end(), [](const ProvenanceItem* a, const ProvenanceItem* b) {
      return std::tie(a->name, a->id) < std::tie(b->name, b->id);
    });
  }
  return sorted;
}

/// Ids behind one another, all with their names when few.
Markup id_list(const std::vector<const ProvenanceItem*>& items) {
  Markup list{"<p>"};
  for (const auto* item : items) {
    list += identifier(item->id);
    if (!item->name.empty()) list += text(concat({" (", item->name, ")"}));
    list.html += item == items.back() ? "" : ", ";
  }
  list.html += "</p>\n";
  constexpr std::size_t kFew = 8;
  return items.size() <= kFew ? list : details(concat({"all ", std::to_string(items.size()), " ids"}), list);
}

Markup inputs_of(const std::vector<const ProvenanceItem*>& items) {
  std::vector<std::string> ids;
  std::map<std::string, std::string> files;
  for (const auto* item : items) {
    ids.insert(ids.end(), item->inputs.begin(), item->inputs.end());
    files.insert(item->files.begin(), item->files.end());
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  Markup out;
  constexpr std::size_t kShown = 6;
  if (!ids.empty()) {
    out.html += concat({"<p>Made from ", std::to_string(ids.size()), ids.size() == 1 ? " object: " : " objects: "});
    for (std::size_t i = 0; i < std::min(kShown, ids.size()); ++i) {
      out.html += i == 0 ? "" : ", ";
      out += identifier(ids[i]);
    }
    out.html += ids.size() > kShown ? ", \u2026</p>\n" : "</p>\n";
  }
  if (!files.empty()) {
    Table table("Outside files", {"file", "SHA-256"});
    for (const auto& [file, hash] : files) table.row({text(file), identifier(hash)});
    out += details(concat({std::to_string(files.size()), files.size() == 1 ? " outside file" : " outside files"}),
                   table.str());
  }
  return out;
}

std::string kind_words(const std::string& kind, std::size_t count) {
  std::string words = kind;
  std::replace(words.begin(), words.end(), '_', ' ');
  if (count == 1) return words;
  return concat({std::to_string(count), " ", words, "s"});
}

}  // namespace

Markup provenance_section(const ReportInput& input) {
  if (input.provenance.empty()) return note("No provenance was given.");
  Markup out = paragraph(
      "What was made from what, from the path back to the recordings. An id is the SHA-256 of the object's content; "
      "hover "
      "for the whole of it.");
  for (const auto& [key, batch] : batches(input.provenance)) {
    const auto& first = *batch.items.front();
    out.html += "<div class=\"card\">\n";
    out += subheading(kind_words(first.kind, batch.items.size()));
    out += id_list(batch.items);
    out.html += concat({"<p>command <code>", escape(first.command), "</code> \u00B7 seed ", std::to_string(first.seed),
                        " \u00B7 version ", escape(first.program_version), "</p>\n"});
    if (!first.parameters.empty()) {
      out += details("parameters", Markup{concat({"<pre>", escape(first.parameters), "</pre>\n"})});
    }
    out += inputs_of(batch.items);
    out.html += "</div>\n";
  }
  return out;
}

Markup verification_section(const ReportInput& input) {
  if (!input.verification) return note("Nothing has been verified yet: run `opponens verify`.");
  const auto& part = *input.verification;
  Markup out;
  if (!part.checks.empty()) {
    out.html += "<ul>\n";
    for (const auto& check : part.checks) out.html += concat({"<li>", escape(check), "</li>\n"});
    out.html += "</ul>\n";
  }
  const auto failed =
      std::count_if(part.verdicts.begin(), part.verdicts.end(), [](const Verdict& v) { return !v.passed; });
  out.html += concat({"<p>", std::to_string(part.checked), " objects checked, ",
                      badge(failed == 0, concat({std::to_string(failed), " failed"})).html, ".</p>\n"});
  if (part.worst_clearance) {
    out += paragraph(concat({"Worst clearance along all paths: ", fixed(1000.0 * *part.worst_clearance, 2), " mm",
                             part.worst_pair.empty() ? "" : " between ", part.worst_pair, "."}));
  }
  Table table("Failures", {"object", "kind", "reason"});
  for (const auto& verdict : part.verdicts) {
    if (!verdict.passed) table.row({identifier(verdict.id), text(verdict.kind), text(verdict.reason)});
  }
  if (!table.empty()) out += table.str();
  return out;
}

Markup run_section(const ReportInput& input) {
  Markup out{concat({kRunLogBegin, "\n"})};
  if (input.run) {
    for (const auto& [planner, seconds] : input.run->planning_seconds) {
      out += paragraph(concat({"Planning time (Table 2's second column), ", planner, ": ", fixed(seconds, 3),
                               " s of CPU per run in the mean, without loading and shortcuts."}));
    }
    Table table("Commands", {"command", "date (UTC)", "wall clock (s)", "CPU (s)", "threads", "host"});
    for (const auto& one : input.run->commands) {
      table.row({text(one.name), text(one.date), text(fixed(one.wall_seconds, 2)), text(fixed(one.cpu_seconds, 2)),
                 text(std::to_string(one.threads)), text(one.host)});
    }
    if (!table.empty()) out += table.str();
    if (!input.run->log.empty()) {
      out += details("run log as it is stored", Markup{concat({"<pre>", escape(input.run->log), "</pre>\n"})});
    }
  } else {
    out += note("No run log was given.");
  }
  out.html += concat({kRunLogEnd, "\n"});
  return out;
}

}  // namespace opponens::report
