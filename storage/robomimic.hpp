// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace opponens::storage {

/// One movement for a robot-learning data set.
struct Episode {
  std::string id;
  std::string name;
  std::string kind;
  std::map<std::string, std::string> labels;
  std::vector<std::string> joint_names;
  Eigen::VectorXd time;  ///< [T] s
  Eigen::MatrixXd q;     ///< [T x n] rad
};

/// Writes HDF5 in the form of robomimic, one episode in memory at a time: /data/demo_0, demo_1, ... each with the
/// attributes num_samples, id, name, kind, labels and joint_names (JSON texts), and the datasets obs/hand_qpos [T x n],
/// obs/time [T], states [T x n] (equal to obs/hand_qpos), actions [T x n] (the configuration at the next sample, the
/// last one its own), rewards and dones [T] (0, but 1 at the last sample). /data has the attributes total and env_args.
class RobomimicWriter {
 public:
  explicit RobomimicWriter(const std::filesystem::path& out);
  ~RobomimicWriter();
  void add(const Episode& episode);
  void finish();  ///< durable and under its final name afterwards

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace opponens::storage
