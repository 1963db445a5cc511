// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/report.hpp"

#include <fstream>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/report_input.hpp"
#include "core/require.hpp"

namespace opponens::cli {

namespace {

/// Every picture of the page as an SVG file of its own; how many.
int write_pictures(const std::string& page, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const auto pictures = opponens::report::svg_files(page);
  for (const auto& picture : pictures) {
    std::ofstream file(folder / picture.name, std::ios::binary);
    file << picture.content;
    file.close();
    if (error || !file) throw InputError((folder / picture.name).string() + ": cannot write the picture there");
  }
  return static_cast<int>(pictures.size());
}

}  // namespace

int report(const ReportOptions& options, const Console& console) {
  const storage::Store store(options.common.store, false);
  const std::string page = opponens::report::render_report(report_input(store));
  std::ofstream file(options.out, std::ios::binary);
  file << page;
  file.close();
  if (!file) throw InputError(options.out.string() + ": cannot write the report there");
  const int pictures = options.svg.empty() ? 0 : write_pictures(page, options.svg);
  console.say("wrote " + options.out.string() + " (" + std::to_string(page.size() / 1024) + " kB)");
  if (!options.svg.empty()) {
    console.say("wrote " + std::to_string(pictures) + " pictures to " + options.svg.string());
  }
  Json result = document("report");
  result.update({{"report", options.out.string()}, {"bytes", page.size()}, {"pictures", pictures}});
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
