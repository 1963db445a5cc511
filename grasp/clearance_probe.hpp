// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "grasp/close_hand.hpp"

namespace opponens::grasp {

/// m. A step may always be this long for all that is beside the way: no link is thinner.
inline constexpr double kEnoughRoom = 0.004;

struct Clearance {
  double object;  ///< m
  /// m, from obstacles less 3 mm and the hand's other links less 1 mm. Not looked for beyond `object` (but at least
  /// to kEnoughRoom and at most to 1 cm), nor where the object is penetrated; 5 cm when they are not watched.
  double others;
  int link = -1;                                  ///< that is nearest to the object; -1: it is farther than 5 cm
  Eigen::Vector3d p_O = Eigen::Vector3d::Zero();  ///< that link's nearest point
};

/// What a moving part of the hand looks out for.
enum class Watch {
  object,
  surroundings,  ///< object, support and obstacles
  everything,    ///< and the hand's other links
};

/// Least distances of the links' surface points to what they watch for, at most 5 cm. Beyond 2 mm a point nearer by
/// up to a fifth may be missed. Distances to the object come from its grid; within 2 mm those of the five least points
/// are measured on the mesh. What a link was seen to keep is remembered, so that little is looked at again after a
/// small motion: one probe per closing.
class ClearanceProbe {
 public:
  explicit ClearanceProbe(const ClosingScene& scene);

  Clearance operator()(const HandPose& pose, const std::vector<int>& links, Watch watch);

  /// Of the links from the hand's other links alone, less 1 mm, m.
  double hand_clearance(const HandPose& pose, const std::vector<int>& links);

  /// From now on obstacles and other links may come as near as they are at this pose, but not nearer than the margins
  /// where they are farther: what is too near already must not keep a finger from moving on or away.
  void excuse(const HandPose& pose, const std::vector<int>& links);

  /// Of the last pose asked for.
  const std::vector<Eigen::Isometry3d>& link_poses() const { return X_HL_; }

 private:
  struct Near {
    double rough;
    int link;
    Eigen::Vector3d p_O;
  };
  /// Where a link was when it was last looked at, and how far its points then were at least from what was looked for.
  struct Seen {
    Eigen::Isometry3d X;
    double at_least = -std::numeric_limits<double>::infinity();
  };
  /// How far they are at least now: none has moved further than the link's centre and the turn about it tell.
  double still(const Seen& seen, const Eigen::Isometry3d& X, std::size_t link) const;
  void place(const HandPose& pose);
  void look_at_object(const Eigen::Isometry3d& X_OH, std::size_t link, Clearance& least);
  void measure(Clearance& least);
  void begin_at_last(const Eigen::Isometry3d& X_OH, const std::vector<int>& links, Clearance& least) const;
  /// The lesser of `least` and the link's distance less the margin.
  double from_obstacles(const Eigen::Isometry3d& X_OH, std::size_t link, double least);
  double from_hand(std::size_t link, double least);
  template <typename Distance>
  double nearest(const Distance& distance, std::size_t link, const Eigen::Isometry3d& X, double margin, double least,
                 Seen& seen) const;

  const ClosingScene& scene_;
  std::vector<Eigen::Isometry3d> X_HL_;
  std::vector<Eigen::Vector3d> center_H_;  ///< of the links' bounding spheres
  std::vector<Near> near_;
  std::vector<Seen> object_seen_;     ///< by link, from the object
  std::vector<Seen> obstacles_seen_;  ///< by link, from support and obstacles
  std::vector<Seen> hand_seen_;       ///< by link and other link
  int last_link_ = -1;                ///< that was nearest to the object when last asked
  Eigen::Vector3d last_p_L_ = Eigen::Vector3d::Zero();
  double obstacle_margin_;
  double self_margin_;
};

}  // namespace opponens::grasp
