// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "grasp/close_hand.hpp"

namespace opponens::grasp {

struct Clearance {
  double value = std::numeric_limits<double>::infinity();  ///< m
  int link = -1;  ///< the link that is nearest to the object; -1: something else is nearer, or all is far
  Eigen::Vector3d p_O = Eigen::Vector3d::Zero();  ///< that link's nearest point
};

/// What a moving part of the hand looks out for.
enum class Watch {
  object,
  surroundings,  ///< object, support and obstacles
  everything,    ///< and the hand's other links
};

/// Least distance of the links' sampled points to what they watch for; obstacles less 3 mm and other links less 1 mm,
/// so that a closing finger stops short of them. At most 5 cm. Keeps its memory between calls: one per thread.
class ClearanceProbe {
 public:
  explicit ClearanceProbe(const ClosingScene& scene) : scene_(scene) {}

  Clearance operator()(const HandPose& pose, const std::vector<int>& links, Watch watch);

  /// Of the last pose asked for.
  const std::vector<Eigen::Isometry3d>& link_poses() const { return X_HL_; }

 private:
  struct Near {
    double rough;
    int link;
    Eigen::Vector3d p_O;
  };
  void look_at_object(const Eigen::Isometry3d& X_OH, std::size_t link, Clearance& least);
  void look_at_obstacles(const Eigen::Isometry3d& X_OH, std::size_t link, Clearance& least) const;
  void look_at_hand(std::size_t link, Clearance& least) const;

  const ClosingScene& scene_;
  std::vector<Eigen::Isometry3d> X_HL_;
  std::vector<Near> near_;
};

}  // namespace opponens::grasp
