// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "core/require.hpp"

namespace opponens::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMarker = ".opponens-demo";  // this folder's store was made by a demo and may be made anew

/// An empty store folder: what an earlier demo left there is removed, anything else is left alone.
fs::path fresh_store(const fs::path& out) {
  const fs::path store = out / "store";
  std::error_code error;
  if (fs::exists(store, error)) {
    if (!fs::exists(out / kMarker)) {
      throw InputError(store.string() + ": exists and was not made by opponens demo; choose another --out");
    }
    fs::remove_all(store, error);
    if (error) throw InputError(store.string() + ": cannot remove the earlier demo's store: " + error.message());
  }
  fs::create_directories(out, error);
  std::ofstream marker(out / kMarker);
  if (error || !marker) throw InputError(out.string() + ": cannot write there" + (error ? ": " + error.message() : ""));
  return store;
}

}  // namespace

int demo(const DemoOptions& options, const Console& console) {
  const Common common{fresh_store(options.out), options.seed, options.threads};
  const fs::path report_file = options.out / "report.html";
  const Console steps(false, console.json());  // the steps' own documents would follow one another on stdout
  const Console& told = console.json() ? steps : console;

  simulate({.common = common}, told);
  retarget({.common = common}, told);
  analyze({.common = common}, told);
  int code = grasp({.common = common}, told);
  if (code == kDone) code = plan({.common = common}, told);
  const int verified = verify({.common = common}, told);
  report({.common = common, .out = report_file}, told);
  console.say("report: " + report_file.string());
  Json result = document("demo");
  result.update({{"store", common.store.string()}, {"report", report_file.string()}});
  console.document(result.dump());
  return code == kDone ? verified : code;
}

}  // namespace opponens::cli
