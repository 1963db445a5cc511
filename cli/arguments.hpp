// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "cli/console.hpp"

namespace opponens::cli {

/// A parsed command line: what to run, or an exit code and a text when there is nothing to run (help, wrong use).
struct Invocation {
  std::function<int(const Console&)> run;
  bool json = false;
  bool quiet = false;
  int exit_code = 0;
  std::string text;
};

Invocation parse_arguments(int argc, char** argv);

}  // namespace opponens::cli
