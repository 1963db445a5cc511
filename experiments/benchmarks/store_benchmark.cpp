// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Opening a store of 100,000 recordings (84 samples x 16 channels) and reading one, and its peer in the same run: one
// HDF5 file with 100,000 groups, opened with the plain C API, one group read. Both with a warm cache. The store and the
// file are made in the temporary folder at the start (a minute or two; OPPONENS_BENCHMARK_RECORDINGS changes how many).
#include <benchmark/benchmark.h>
#include <hdf5.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/rng.hpp"
#include "storage/codec.hpp"
#include "storage/store.hpp"

namespace {

using namespace opponens;
namespace fs = std::filesystem;

constexpr Eigen::Index kSamples = 84;
constexpr Eigen::Index kChannels = 16;

int recordings() {
  const char* const text = std::getenv("OPPONENS_BENCHMARK_RECORDINGS");
  return text == nullptr ? 100000 : std::atoi(text);
}

Demonstration recording(int number, Rng& rng) {
  Demonstration demonstration;
  demonstration.id = "recording " + std::to_string(number);
  demonstration.labels = {{"subject", std::to_string(number % 50)}, {"object", "cup"}, {"source", "benchmark"}};
  demonstration.time = Eigen::VectorXd::LinSpaced(kSamples, 0.0, 1.66);
  for (Eigen::Index j = 0; j < kChannels; ++j) demonstration.joint_names.push_back("joint_" + std::to_string(j));
  demonstration.q_h = Eigen::MatrixXd::NullaryExpr(kSamples, kChannels, [&] { return rng.normal(); });
  return demonstration;
}

/// Folder, store and peer of the whole run.
struct Fixture {
  fs::path folder = fs::temp_directory_path() / ("opponens-benchmark-" + std::to_string(::getpid()));
  std::string wanted;
  std::string wanted_group;
  int count = recordings();

  Fixture() {
    fs::create_directories(folder);
    Rng rng = stream(1, "store benchmark");
    storage::Store store(folder / "store", true);
    const hid_t file = H5Fcreate((folder / "peer.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    std::vector<storage::Record> records;
    for (int i = 0; i < count; ++i) {
      const Demonstration demonstration = recording(i, rng);
      write_group(file, demonstration);
      records.push_back(storage::encode(demonstration, {"simulate", {}, {}, "{}", 1, "0.1.0"}));
      if (records.size() < 2000 && i + 1 < count) continue;
      const auto ids = store.commit(records);
      if (i >= count / 2 && wanted.empty()) wanted = ids.front();
      records.clear();
    }
    wanted_group = "recording " + std::to_string(count / 2);
    H5Fclose(file);
  }
  ~Fixture() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }

  static void write_group(hid_t file, const Demonstration& demonstration) {
    const hid_t group = H5Gcreate2(file, demonstration.id.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t shape[] = {static_cast<hsize_t>(kSamples), static_cast<hsize_t>(kChannels)};
    const hid_t space = H5Screate_simple(2, shape, nullptr);
    const hid_t dataset = H5Dcreate2(group, "q_h", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, demonstration.q_h.data());
    H5Dclose(dataset);
    H5Sclose(space);
    H5Gclose(group);
  }
};

const Fixture& fixture() {
  static const Fixture made;
  return made;
}

void store_open_and_read_one(benchmark::State& state) {
  const Fixture& made = fixture();
  for (auto _ : state) {
    const storage::Store store(made.folder / "store", false);
    const storage::Record record = store.read(made.wanted);
    benchmark::DoNotOptimize(storage::decode_demonstration(record).q_h.sum());
  }
  state.counters["recordings"] = made.count;
}
BENCHMARK(store_open_and_read_one)->Unit(benchmark::kMillisecond);

/// Without any check of what is read, and knowing the group's name.
void peer_hdf5_open_and_read_one(benchmark::State& state) {
  const Fixture& made = fixture();
  for (auto _ : state) {
    const hid_t file = H5Fopen((made.folder / "peer.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t dataset = H5Dopen2(file, (made.wanted_group + "/q_h").c_str(), H5P_DEFAULT);
    Eigen::MatrixXd q(kSamples, kChannels);
    H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, q.data());
    benchmark::DoNotOptimize(q.sum());
    H5Dclose(dataset);
    H5Fclose(file);
  }
}
BENCHMARK(peer_hdf5_open_and_read_one)->Unit(benchmark::kMillisecond);

void store_list(benchmark::State& state) {
  const storage::Store store(fixture().folder / "store", false);
  for (auto _ : state) benchmark::DoNotOptimize(store.list("demonstration").size());
}
BENCHMARK(store_list)->Unit(benchmark::kMillisecond);

/// What the peer has to do to know the same: names only.
void peer_hdf5_list(benchmark::State& state) {
  const hid_t file = H5Fopen((fixture().folder / "peer.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  for (auto _ : state) {
    std::vector<std::string> names;
    H5Literate(file, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, collect, &names);
    benchmark::DoNotOptimize(names.size());
  }
  H5Fclose(file);
}
BENCHMARK(peer_hdf5_list)->Unit(benchmark::kMillisecond);

/// All recordings in order of commit, every content hash checked.
void store_read_all(benchmark::State& state) {
  const storage::Store store(fixture().folder / "store", false);
  const auto entries = store.list("demonstration");
  for (auto _ : state) {
    double sum = 0.0;
    for (const auto& entry : entries) sum += storage::decode_demonstration(store.read(entry.id)).q_h.sum();
    benchmark::DoNotOptimize(sum);
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(entries.size()) *
                          kSamples * kChannels * 8);
}
BENCHMARK(store_read_all)->Unit(benchmark::kSecond)->Iterations(1);

/// The same through libhdf5, without any check.
void peer_hdf5_read_all(benchmark::State& state) {
  const hid_t file = H5Fopen((fixture().folder / "peer.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const int count = fixture().count;
  Eigen::MatrixXd q(kSamples, kChannels);
  for (auto _ : state) {
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
      const hid_t dataset = H5Dopen2(file, ("recording " + std::to_string(i) + "/q_h").c_str(), H5P_DEFAULT);
      H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, q.data());
      H5Dclose(dataset);
      sum += q.sum();
    }
    benchmark::DoNotOptimize(sum);
  }
  H5Fclose(file);
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * count * kSamples * kChannels * 8);
}
BENCHMARK(peer_hdf5_read_all)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
