// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/frogger_grasps/reproduce.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <vector>

namespace opponens {
namespace {

constexpr double kZero = 1e-6;     // a published value below is no force closure worth a ratio
constexpr double kSameGap = 2e-5;  // m, a grasp whose largest gap is the published one to this is reconstructed

struct Differences {
  std::vector<double> min_weight, epsilon;  ///< relative
  void print(const char* which) const {
    const auto largest = [](const std::vector<double>& v) {
      return v.empty() ? 0.0 : *std::max_element(v.begin(), v.end());
    };
    std::printf(" | %s %3zu: l* median %.1e max %.1e, epsilon median %.1e max %.1e", which, min_weight.size(),
                median(min_weight), largest(min_weight), median(epsilon), largest(epsilon));
  }
};

double mesh_difference(const FroggerObject& object) {
  const Eigen::Matrix3Xd vertices = tangent_rotation().transpose() * object.target.mesh->vertices;
  const double low = (vertices.rowwise().minCoeff() - object.reference.lower).cwiseAbs().maxCoeff();
  const double high = (vertices.rowwise().maxCoeff() - object.reference.upper).cwiseAbs().maxCoeff();
  return std::max(low, high);
}

}  // namespace

int reproduce(const Folders& folders, const robot::RobotModel& hand, std::ostream& csv) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folders.reference)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path().filename().string());
  }
  std::sort(files.begin(), files.end());
  csv << "file,grasp,published_min_weight,min_weight,published_epsilon,epsilon,published_gap_mm,gap_mm,reconstructed,"
         "force_closure\n";
  int open = 0;
  for (const std::string& file : files) {
    const FroggerObject object = load_object(folders, file, hand, false);
    Differences all, same;
    int closed = 0;
    for (const ReferenceGrasp& grasp : object.reference.valid) {
      const Posture posture = posture_of(grasp);
      const auto model = grasp::TipModel::fixed_point;
      const Score ours = score(object, tip_contacts(hand, object.surface, object.target, model, posture,
                                                    NormalRule::distance, object.reference.mu));
      const double gap = largest_gap(hand, object.surface, object.target, model, posture);
      const bool reconstructed = std::abs(gap - grasp.surface_violation) <= kSameGap;
      closed += ours.force_closure ? 1 : 0;
      for (Differences* set : {&all, reconstructed ? &same : nullptr}) {
        if (set == nullptr) continue;
        if (grasp.min_weight > kZero) set->min_weight.push_back(std::abs(ours.min_weight / grasp.min_weight - 1.0));
        if (grasp.epsilon > kZero) set->epsilon.push_back(std::abs(ours.epsilon / grasp.epsilon - 1.0));
      }
      csv << file << ',' << grasp.index << ',' << grasp.min_weight << ',' << ours.min_weight << ',' << grasp.epsilon
          << ',' << ours.epsilon << ',' << 1e3 * grasp.surface_violation << ',' << 1e3 * gap << ',' << reconstructed
          << ',' << ours.force_closure << '\n';
    }
    const int valid = static_cast<int>(object.reference.valid.size());
    open += valid - closed;
    std::printf("%-34s mesh %.2f mm | valid %3d of %3d, force closure %3d", file.c_str(), 1e3 * mesh_difference(object),
                valid, object.reference.tried, closed);
    all.print("all");
    same.print("reconstructed");
    std::printf("\n");
    std::fflush(stdout);
  }
  return open;
}

}  // namespace opponens
