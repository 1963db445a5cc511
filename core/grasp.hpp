// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace opponens {

struct Contact {
  std::string link;      ///< hand link that touches
  Eigen::Vector3d p_OC;  ///< m
  Eigen::Vector3d n_O;   ///< unit, pointing into the object
  double mu = 0.5;       ///< friction coefficient
};

enum class ContactModel { frictionless, point_with_friction, soft_finger };
enum class ForceUnit { normal, force };  ///< edge force of normal component 1 (GraspIt!'s), or of length 1 (FRoGGeR's)
enum class WrenchNorm { l1, linf };
enum class FrictionCone {
  pyramid,    ///< the convention's edges
  quadratic,  ///< the exact circular cone (soft finger: ellipsoid): what pyramids of more and more edges tend to
};
enum class ClosureState {
  force_closure,      ///< the origin is strictly inside the wrench hull
  not_force_closure,  ///< the origin is outside or on the boundary of a full-dimensional hull
  rank_deficient,     ///< the wrenches do not span R^6
  below_incumbent,    ///< given up: epsilon is less than the request asked for; closure is not decided. Never stored
};

/// What a quality value means; stored with every value (design: "Grasp quality").
struct QualityConvention {
  ContactModel model = ContactModel::point_with_friction;
  double mu = 0.5;
  int edges = 8;  ///< cone edges per contact; with a quadratic cone still those of l* and of certificates
  ForceUnit unit = ForceUnit::normal;
  WrenchNorm norm = WrenchNorm::l1;
  double rho = 1.0;             ///< m, torque is divided by it
  double torsion_radius = 0.0;  ///< m, soft finger only: the torque semi-axis of the friction ellipsoid
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m, in O: the point torques are taken about
  FrictionCone cone = FrictionCone::pyramid;
};

struct GraspQuality {
  ClosureState state = ClosureState::rank_deficient;
  std::optional<double> epsilon;  ///< radius of the largest origin-centred ball in the wrench hull; negative: minus the
                                  ///< distance of the origin to the hull; nullopt when the set is rank deficient
  std::optional<double> min_weight;  ///< l*: max l with W a = 0, 1'a = 1, a >= l; nullopt when W a = 0 has no solution
  std::optional<double> volume;      ///< of the wrench hull; nullopt when not computed
  Eigen::Matrix<double, 6, 1> direction = Eigen::Matrix<double, 6, 1>::Zero();  ///< facet normal that decides epsilon
  QualityConvention convention;
  /// The true epsilon is at least epsilon and at most epsilon + |epsilon| epsilon_gap; zero but for quadratic cones.
  double epsilon_gap = 0.0;
  bool force_closure() const { return state == ClosureState::force_closure; }
};

/// Errors that a grasp may meet: independent, normal, of zero mean.
struct GraspNoise {
  double position = 0.005;  ///< m, standard deviation of each coordinate of the object's position
  double angle = 0.05;      ///< rad, standard deviation of each coordinate of the object's rotation vector
  double friction = 0.05;   ///< standard deviation of the friction coefficient, one error for all contacts
  int samples = 100;
};

/// Quality under pose and friction errors, by Monte Carlo (grasp/robust_quality.hpp says how a disturbed grasp closes).
struct RobustQuality {
  GraspNoise noise;
  double force_closure = 0.0;      ///< share of the samples that are force closure ...
  double force_closure_low = 0.0;  ///< ... and the ends of its 95 % Clopper-Pearson interval
  double force_closure_high = 0.0;
  double epsilon_mean = 0.0;  ///< a sample that is not force closure counts as 0
  double epsilon_low = 0.0;   ///< 5 % quantile of the same
};

enum class GraspOrigin {
  searched,  ///< found by grasp/grasp_search.hpp
  imported,  ///< given; held to the same checks
};

/// One force of a certificate, in O, and how much of it is taken.
struct CertificateEdge {
  int contact = 0;                                  ///< index into the contacts
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< inside the contact's friction cone, exactly and as stored
  double torsion = 0.0;     ///< m, soft finger only: the torque about the contact is torsion * n_O
  std::string coefficient;  ///< positive integer in decimal digits, of any length
};

/// Proof of force closure of a contact model. With every double read as the rational number that it is, and wrenches
/// w = [f; p_OC x f + torsion n_O], each edge lies inside its contact's stored cone, sum coefficient w = 0, and the
/// wrenches have rank 6: they positively span all forces and torques (about any point, in any unit of torque).
/// Nothing follows about the world, only about the stored contacts. Made by grasp/certificate.hpp.
struct Certificate {
  std::vector<CertificateEdge> edges;   ///< few: at least 7
  std::optional<double> epsilon_bound;  ///< epsilon is no larger, for certain; from the quality's direction
};

/// One way for the arm to bring the hand there: inverse kinematics of both poses on the same branch.
struct ArmSolution {
  Eigen::VectorXd q_pregrasp;  ///< [a] rad
  Eigen::VectorXd q_grasp;     ///< [a] rad
};

/// A grasp of a given object along the synergies of a group. n hand joints, k synergies, m contacts.
struct Grasp {
  std::string group;
  Eigen::VectorXd coefficients;                                     ///< [k] synergy coordinates c, scaled units
  Eigen::VectorXd slack;                                            ///< [n] rad: q_grasp - scale .* (center + axes c)
  Eigen::VectorXd q_grasp;                                          ///< [n] rad, contacts touching
  Eigen::VectorXd q_pregrasp;                                       ///< [n] rad, fingers opened along the synergies
  Eigen::Isometry3d X_OH = Eigen::Isometry3d::Identity();           ///< hand (palm) in the object, grasping
  Eigen::Isometry3d X_OH_pregrasp = Eigen::Isometry3d::Identity();  ///< hand retreated
  std::vector<Contact> contacts;
  GraspQuality quality;
  std::optional<Certificate> certificate;  ///< of force closure; nullopt: not asked for, or there is none
  bool synergy_grasp = true;               ///< slack norm within the stated bound; otherwise "free"
  std::optional<RobustQuality> robust;     ///< beside the nominal quality; nullopt: not asked for
  GraspOrigin origin = GraspOrigin::searched;
  std::vector<ArmSolution> arm_solutions;  ///< filled by Algorithm 1; empty: not reachable or not yet asked
};

}  // namespace opponens
