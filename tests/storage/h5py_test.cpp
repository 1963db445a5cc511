// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <stdio.h>

#include "storage/codec.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = ::popen(command.c_str(), "r");
  char buffer[4096];
  while (std::size_t count = ::fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, count);
  return ::pclose(pipe) == 0 ? text : "failed: " + text;
}

std::string hex(double value) {
  char text[40];
  ::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(value)));
  return text;
}

/// The script knows docs/file_format.md only: it takes every object apart with h5py and works out its content hash.
TEST(H5py, AloneReadsAStoreAndFindsTheSameHashes) {
  if (output_of("/usr/bin/python3 -c 'import h5py' 2>&1") != "") GTEST_SKIP() << "python3-h5py is absent";
  const TemporaryDirectory directory;
  Store store(directory / "store", true);
  Demonstration demonstration;
  demonstration.id = "s1_caf\xC3\xA9_r1";
  demonstration.labels = {{"subject", "1"}, {"object", "caf\xC3\xA9"}};
  demonstration.time = Eigen::VectorXd::LinSpaced(100, 0.0, 1.98);
  demonstration.joint_names = {"T_ROT", "I_MCP", "I_PIP", "I_DIP", "M_MCP", "M_PIP"};
  demonstration.q_h = Eigen::MatrixXd::Random(100, 6);
  const Provenance provenance{"ingest", {}, {{"a.csv", std::string(64, 'a')}}, "{\"rate\": 50}", 1ULL << 63U, "0.1.0"};
  std::vector<Record> records{encode(demonstration, provenance)};
  Rng rng = stream(6, "h5py");
  for (int i = 0; i < 50; ++i) records.push_back(any_record(rng));
  std::string expected;
  for (const auto& id : store.commit(records)) expected += id + "\n";
  expected += "s1_caf\xC3\xA9_r1 caf\xC3\xA9 1 recorded\n100 6 " + hex(demonstration.q_h(0, 1)) + " " +
              hex(demonstration.q_h(99, 5)) + " I_PIP\n" + "ingest a.csv " + std::to_string(1ULL << 63U) + "\n";
  const std::string script = std::string(OPPONENS_SOURCE_DIR) + "/tests/storage/read_with_h5py.py";
  EXPECT_EQ(output_of("/usr/bin/python3 " + script + " " + (directory / "store").string() + " 2>&1"), expected);
}

}  // namespace
}  // namespace opponens::storage::test
