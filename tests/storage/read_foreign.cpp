// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// read_foreign SOURCE.yaml: reads each file named on stdin, one a line, and answers with one line of JSON: the
// recordings' values, or the message of an InputError. A test drives it through many damaged files in one process,
// which must live.
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/require.hpp"
#include "storage/readers/source.hpp"

int main(int argc, char** argv) {
  using namespace opponens;
  if (argc != 2) return 2;
  const auto source = storage::load_source(argv[1]);
  for (std::string path; std::getline(std::cin, path);) {
    nlohmann::json answer;
    try {
      answer["recordings"] = nlohmann::json::array();
      for (const auto& recording : storage::read_source({path}, source)) {
        const auto& motion = recording.demonstration;
        nlohmann::json rows = nlohmann::json::array();
        for (Eigen::Index i = 0; i < motion.q_h.rows(); ++i) {
          std::vector<double> row;
          for (Eigen::Index j = 0; j < motion.q_h.cols(); ++j) row.push_back(motion.q_h(i, j));
          rows.push_back(row);
        }
        answer["recordings"].push_back({{"id", motion.id}, {"labels", motion.labels}, {"values", rows}});
      }
    } catch (const InputError& error) {
      answer = {{"refused", error.what()}};
    }
    std::cout << answer.dump() << std::endl;
  }
  return 0;
}
