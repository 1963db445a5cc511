// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/report.hpp"

#include <fstream>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/report_input.hpp"
#include "core/require.hpp"

namespace opponens::cli {

int report(const ReportOptions& options, const Console& console) {
  const storage::Store store(options.common.store, false);
  const std::string page = opponens::report::render_report(report_input(store));
  std::ofstream file(options.out, std::ios::binary);
  file << page;
  file.close();
  if (!file) throw InputError(options.out.string() + ": cannot write the report there");
  console.say("wrote " + options.out.string() + " (" + std::to_string(page.size() / 1024) + " kB)");
  Json result = document("report");
  result.update({{"report", options.out.string()}, {"bytes", page.size()}});
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
