// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/robomimic.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/require.hpp"
#include "storage/hdf5_wrappers.hpp"
#include "storage/posix_file.hpp"

namespace opponens::storage {
namespace {

/// The configuration that the movement has reached one sample later; the last sample stays where it is.
Eigen::MatrixXd next_rows(const Eigen::MatrixXd& q) {
  Eigen::MatrixXd next = q;
  if (q.rows() > 1) next.topRows(q.rows() - 1) = q.bottomRows(q.rows() - 1);
  return next;
}

}  // namespace

struct RobomimicWriter::Parts {
  std::filesystem::path out;
  Draft draft;
  std::optional<hdf5::Handle> file{};
  std::optional<hdf5::Handle> data{};
  std::int64_t episodes = 0;
  std::int64_t samples = 0;

  explicit Parts(const std::filesystem::path& path) : out(path), draft(path) {}
  void begin();
  void add(const Episode& episode);
  void finish();
};

void RobomimicWriter::Parts::begin() {
  file.emplace(hdf5::create_on_disk(draft.path().string()));
  data.emplace(hdf5::create_group(*file, "data"));
  const nlohmann::json environment = {{"env_name", "opponens"}, {"type", 2}, {"env_kwargs", nlohmann::json::object()}};
  hdf5::write_attribute(*data, "env_args", environment.dump());
}

void RobomimicWriter::Parts::add(const Episode& episode) {
  const hdf5::Handle demo = hdf5::create_group(*data, "demo_" + std::to_string(episodes++));
  hdf5::write_attribute(demo, "num_samples", static_cast<std::int64_t>(episode.q.rows()));
  hdf5::write_attribute(demo, "id", episode.id);
  hdf5::write_attribute(demo, "name", episode.name);
  hdf5::write_attribute(demo, "kind", episode.kind);
  hdf5::write_attribute(demo, "labels", nlohmann::json(episode.labels).dump());
  hdf5::write_attribute(demo, "joint_names", nlohmann::json(episode.joint_names).dump());
  const hdf5::Handle obs = hdf5::create_group(demo, "obs");
  hdf5::write_dataset(obs, "hand_qpos", episode.q);
  hdf5::write_dataset(obs, "time", episode.time);
  hdf5::write_dataset(demo, "states", episode.q);
  hdf5::write_dataset(demo, "actions", next_rows(episode.q));
  Eigen::VectorXd last = Eigen::VectorXd::Zero(episode.q.rows());
  if (last.size() > 0) last(last.size() - 1) = 1.0;
  hdf5::write_dataset(demo, "rewards", last);
  hdf5::write_dataset(demo, "dones", last);
  samples += episode.q.rows();
}

void RobomimicWriter::Parts::finish() {
  hdf5::write_attribute(*data, "total", samples);
  hdf5::flush(*file);
  data->finish();
  file->finish();
}

RobomimicWriter::RobomimicWriter(const std::filesystem::path& out) {
  const auto lock = hdf5::lock_library();
  auto parts = std::make_unique<Parts>(out);  // so that its handles are closed under the lock when it throws
  hdf5::write_to(out, [&] { parts->begin(); });
  parts_ = std::move(parts);
}

RobomimicWriter::~RobomimicWriter() {
  const auto lock = hdf5::lock_library();
  parts_.reset();
}

void RobomimicWriter::add(const Episode& episode) {
  require(episode.time.size() == episode.q.rows() &&
              static_cast<Eigen::Index>(episode.joint_names.size()) == episode.q.cols(),
          [&] { return "RobomimicWriter: '" + episode.name + "': time, joint_names and q do not fit"; });
  const auto lock = hdf5::lock_library();
  hdf5::write_to(parts_->out, [&] { parts_->add(episode); });
}

void RobomimicWriter::finish() {
  const auto lock = hdf5::lock_library();
  hdf5::write_to(parts_->out, [&] { parts_->finish(); });
  sync_file(parts_->draft.path());
  parts_->draft.complete();
}

}  // namespace opponens::storage
