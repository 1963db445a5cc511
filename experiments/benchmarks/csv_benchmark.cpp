// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Speed of reading recordings from CSV, beside plain loops of strtod and of istream over the same bytes, which check
// nothing.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/rng.hpp"
#include "storage/readers/source.hpp"

namespace opponens {
namespace {

namespace fs = std::filesystem;

constexpr int kRows = 100000;

std::string joint(std::size_t number) { return storage::human_hand_channels()[number]; }

/// Time and 23 angles of 6 digits, as gloves write them.
const std::string& text() {
  static const std::string result = [] {
    std::string csv = "t";
    for (std::size_t j = 0; j < 23; ++j) csv.append(",").append(joint(j));
    Rng rng = stream(1, "benchmark/csv");
    char cell[32];
    for (int i = 0; i < kRows; ++i) {
      std::snprintf(cell, sizeof cell, "\n%.3f", 0.01 * i);
      csv += cell;
      for (std::size_t j = 0; j < 23; ++j) {
        std::snprintf(cell, sizeof cell, ",%.6f", rng.normal());
        csv += cell;
      }
    }
    return csv + "\n";
  }();
  return result;
}

/// The text as a file below a folder of its own, and its description.
struct Files {
  fs::path folder = fs::temp_directory_path() / ("opponens-csv-benchmark-" + std::to_string(::getpid()));
  storage::SourceDescription source;
  Files() {
    fs::create_directories(folder);
    std::ofstream(folder / "recording.csv", std::ios::binary) << text();
    std::string yaml = "name: benchmark\nrecordings: {files: 'recording\\.csv'}\ntime: {column: t}\nchannels:\n";
    for (std::size_t j = 0; j < 23; ++j) yaml += "  - {column: " + joint(j) + "}\n";
    source = storage::parse_source(yaml, "benchmark.yaml");
  }
  ~Files() { fs::remove_all(folder); }
};

void set_bytes(benchmark::State& state) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text().size()));
}

/// All of read_source: file, SHA-256, cells, checks, units, time, statistics of the steps.
void read_source(benchmark::State& state) {
  const Files files;
  for (auto _ : state) benchmark::DoNotOptimize(storage::read_source({files.folder}, files.source));
  set_bytes(state);
}
BENCHMARK(read_source)->Unit(benchmark::kMillisecond);

void plain_strtod(benchmark::State& state) {
  const char* const begin = text().data() + text().find('\n');
  for (auto _ : state) {
    std::vector<double> values;
    for (const char* at = begin; *at != '\0';) {
      char* end = nullptr;
      const double value = std::strtod(at, &end);
      if (end == at) break;
      values.push_back(value);
      at = *end == ',' ? end + 1 : end;
    }
    benchmark::DoNotOptimize(values.data());
  }
  set_bytes(state);
}
BENCHMARK(plain_strtod)->Unit(benchmark::kMillisecond);

void plain_istream(benchmark::State& state) {
  for (auto _ : state) {
    std::istringstream in(text().substr(text().find('\n')));
    std::vector<double> values;
    for (double value = 0.0; in >> value; in.get()) values.push_back(value);
    benchmark::DoNotOptimize(values.data());
  }
  set_bytes(state);
}
BENCHMARK(plain_istream)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace opponens
