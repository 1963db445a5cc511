// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <iostream>

#include "report/report.hpp"
#include "tests/report/synthetic_report.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: report_preview OUT.html\n";
    return 2;
  }
  std::ofstream out(argv[1], std::ios::binary);
  out << opponens::report::render_report(opponens::report::synthetic_report());
  return out.good() ? 0 : 2;
}
