// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "core/require.hpp"
#include "storage/codec.hpp"
#include "storage/codec_fields.hpp"

namespace opponens::storage {
namespace {

constexpr std::array<std::string_view, 3> kModels{"frictionless", "point_with_friction", "soft_finger"};
constexpr std::array<std::string_view, 2> kUnits{"normal", "force"};
constexpr std::array<std::string_view, 2> kNorms{"l1", "linf"};
constexpr std::array<std::string_view, 2> kCones{"pyramid", "quadratic"};
constexpr std::array<std::string_view, 3> kStates{"force_closure", "not_force_closure", "rank_deficient"};
constexpr std::array<std::string_view, 2> kGraspOrigins{"searched", "imported"};

void encode_quality(Record& record, const GraspQuality& quality) {
  require(quality.state != ClosureState::below_incumbent, "encode: a quality that was given up is not stored");
  auto& fields = record.fields;
  const QualityConvention& convention = quality.convention;
  fields["quality.state"] = enum_text(kStates, quality.state);
  if (quality.epsilon) fields["quality.epsilon"] = *quality.epsilon;
  if (quality.min_weight) fields["quality.min_weight"] = *quality.min_weight;
  if (quality.volume) fields["quality.volume"] = *quality.volume;
  if (quality.epsilon_gap != 0.0) fields["quality.epsilon_gap"] = quality.epsilon_gap;
  fields["quality.direction"] = Eigen::VectorXd(quality.direction);
  fields["convention.model"] = enum_text(kModels, convention.model);
  fields["convention.mu"] = convention.mu;
  fields["convention.edges"] = std::int64_t{convention.edges};
  // Absent means pyramid, which is all there was before.
  if (convention.cone != FrictionCone::pyramid) fields["convention.cone"] = enum_text(kCones, convention.cone);
  fields["convention.unit"] = enum_text(kUnits, convention.unit);
  fields["convention.norm"] = enum_text(kNorms, convention.norm);
  fields["convention.rho"] = convention.rho;
  fields["convention.torsion_radius"] = convention.torsion_radius;
  fields["convention.origin"] = Eigen::VectorXd(convention.origin);
}

GraspQuality decode_quality(const Record& record, const FieldReader& read) {
  GraspQuality quality;
  QualityConvention& convention = quality.convention;
  quality.state = read.enumerator<ClosureState>("quality.state", kStates);
  quality.epsilon = read.optional_number("quality.epsilon");
  quality.min_weight = read.optional_number("quality.min_weight");
  quality.volume = read.optional_number("quality.volume");
  quality.epsilon_gap = read.optional_number("quality.epsilon_gap").value_or(0.0);
  read.expect(read.vector("quality.direction").size() == 6, "quality.direction", "6 values");
  quality.direction = read.vector("quality.direction");
  convention.model = read.enumerator<ContactModel>("convention.model", kModels);
  convention.mu = read.number("convention.mu");
  convention.edges = read.small_integer("convention.edges");
  if (record.fields.contains("convention.cone"))
    convention.cone = read.enumerator<FrictionCone>("convention.cone", kCones);
  convention.unit = read.enumerator<ForceUnit>("convention.unit", kUnits);
  convention.norm = read.enumerator<WrenchNorm>("convention.norm", kNorms);
  convention.rho = read.number("convention.rho");
  convention.torsion_radius = read.number("convention.torsion_radius");
  read.expect(read.vector("convention.origin").size() == 3, "convention.origin", "3 values");
  convention.origin = read.vector("convention.origin");
  return quality;
}

void encode_robust(Record& record, const RobustQuality& robust) {
  auto& fields = record.fields;
  fields["robust.noise_position"] = robust.noise.position;
  fields["robust.noise_angle"] = robust.noise.angle;
  fields["robust.noise_friction"] = robust.noise.friction;
  fields["robust.samples"] = std::int64_t{robust.noise.samples};
  fields["robust.force_closure"] = robust.force_closure;
  fields["robust.force_closure_low"] = robust.force_closure_low;
  fields["robust.force_closure_high"] = robust.force_closure_high;
  fields["robust.epsilon_mean"] = robust.epsilon_mean;
  fields["robust.epsilon_low"] = robust.epsilon_low;
}

RobustQuality decode_robust(const FieldReader& read) {
  RobustQuality robust;
  robust.noise.position = read.number("robust.noise_position");
  robust.noise.angle = read.number("robust.noise_angle");
  robust.noise.friction = read.number("robust.noise_friction");
  robust.noise.samples = read.small_integer("robust.samples");
  robust.force_closure = read.number("robust.force_closure");
  robust.force_closure_low = read.number("robust.force_closure_low");
  robust.force_closure_high = read.number("robust.force_closure_high");
  robust.epsilon_mean = read.number("robust.epsilon_mean");
  robust.epsilon_low = read.number("robust.epsilon_low");
  return robust;
}

void encode_contacts(Record& record, const std::vector<Contact>& contacts) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  std::vector<std::string> links;
  Eigen::MatrixXd points(count, 3);
  Eigen::MatrixXd normals(count, 3);
  Eigen::VectorXd friction(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Contact& contact = contacts[static_cast<std::size_t>(i)];
    links.push_back(contact.link);
    points.row(i) = contact.p_OC.transpose();
    normals.row(i) = contact.n_O.transpose();
    friction[i] = contact.mu;
  }
  record.fields["contact.link"] = links;
  record.fields["contact.p_OC"] = points;
  record.fields["contact.n_O"] = normals;
  record.fields["contact.mu"] = friction;
}

std::vector<Contact> decode_contacts(const FieldReader& read) {
  const std::vector<std::string>& links = read.texts("contact.link");
  const Eigen::MatrixXd& points = read.matrix("contact.p_OC");
  const Eigen::MatrixXd& normals = read.matrix("contact.n_O");
  const Eigen::VectorXd& friction = read.vector("contact.mu");
  const auto count = static_cast<Eigen::Index>(links.size());
  read.expect(points.rows() == count && points.cols() == 3, "contact.p_OC", "[contacts x 3]");
  read.expect(normals.rows() == count && normals.cols() == 3, "contact.n_O", "[contacts x 3]");
  read.expect(friction.size() == count, "contact.mu", "one value per contact");
  std::vector<Contact> contacts;
  for (Eigen::Index i = 0; i < count; ++i) {
    contacts.push_back({links[static_cast<std::size_t>(i)], points.row(i), normals.row(i), friction[i]});
  }
  return contacts;
}

void encode_certificate(Record& record, const std::optional<Certificate>& certificate) {
  if (!certificate) return;
  const auto count = static_cast<Eigen::Index>(certificate->edges.size());
  Eigen::VectorXd contacts(count);
  Eigen::MatrixXd forces(count, 3);
  Eigen::VectorXd torsions(count);
  std::vector<std::string> coefficients;
  for (Eigen::Index i = 0; i < count; ++i) {
    const CertificateEdge& edge = certificate->edges[static_cast<std::size_t>(i)];
    contacts[i] = edge.contact;
    forces.row(i) = edge.force.transpose();
    torsions[i] = edge.torsion;
    coefficients.push_back(edge.coefficient);
  }
  record.fields["certificate.contact"] = contacts;
  record.fields["certificate.force"] = forces;
  record.fields["certificate.torsion"] = torsions;
  record.fields["certificate.coefficient"] = coefficients;
  if (certificate->epsilon_bound) record.fields["certificate.epsilon_bound"] = *certificate->epsilon_bound;
}

/// None where the field of coefficients is absent. Whether it holds is for verify to say, not for a reader.
std::optional<Certificate> decode_certificate(const Record& record, const FieldReader& read) {
  if (!record.fields.contains("certificate.coefficient")) return std::nullopt;
  const std::vector<std::string>& coefficients = read.texts("certificate.coefficient");
  const Eigen::VectorXd& contacts = read.vector("certificate.contact");
  const Eigen::MatrixXd& forces = read.matrix("certificate.force");
  const Eigen::VectorXd& torsions = read.vector("certificate.torsion");
  const auto count = static_cast<Eigen::Index>(coefficients.size());
  read.expect(contacts.size() == count, "certificate.contact", "one value per coefficient");
  read.expect(forces.rows() == count && forces.cols() == 3, "certificate.force", "[coefficients x 3]");
  read.expect(torsions.size() == count, "certificate.torsion", "one value per coefficient");
  Certificate certificate;
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool index =
        contacts[i] >= 0.0 && contacts[i] <= std::numeric_limits<int>::max() && contacts[i] == std::floor(contacts[i]);
    read.expect(index, "certificate.contact", "indices of contacts");
    certificate.edges.push_back(
        {static_cast<int>(contacts[i]), forces.row(i), torsions[i], coefficients[static_cast<std::size_t>(i)]});
  }
  certificate.epsilon_bound = read.optional_number("certificate.epsilon_bound");
  return certificate;
}

void encode_arm_solutions(Record& record, const std::vector<ArmSolution>& solutions) {
  const auto count = static_cast<Eigen::Index>(solutions.size());
  const Eigen::Index joints = solutions.empty() ? 0 : solutions.front().q_grasp.size();
  Eigen::MatrixXd pregrasp(count, joints);
  Eigen::MatrixXd grasp(count, joints);
  for (Eigen::Index i = 0; i < count; ++i) {
    const ArmSolution& solution = solutions[static_cast<std::size_t>(i)];
    require(solution.q_grasp.size() == joints && solution.q_pregrasp.size() == joints,
            "encode: the arm solutions of a grasp differ in their number of joints");
    pregrasp.row(i) = solution.q_pregrasp.transpose();
    grasp.row(i) = solution.q_grasp.transpose();
  }
  record.fields["arm.q_pregrasp"] = pregrasp;
  record.fields["arm.q_grasp"] = grasp;
}

std::vector<ArmSolution> decode_arm_solutions(const FieldReader& read) {
  const Eigen::MatrixXd& pregrasp = read.matrix("arm.q_pregrasp");
  const Eigen::MatrixXd& grasp = read.matrix("arm.q_grasp");
  read.expect(pregrasp.rows() == grasp.rows() && pregrasp.cols() == grasp.cols(), "arm.q_grasp",
              "the shape of arm.q_pregrasp");
  std::vector<ArmSolution> solutions;
  for (Eigen::Index i = 0; i < grasp.rows(); ++i) solutions.push_back({pregrasp.row(i), grasp.row(i)});
  return solutions;
}

Eigen::Isometry3d decode_pose(const FieldReader& read, const std::string& name) {
  const Eigen::MatrixXd& matrix = read.matrix(name);
  read.expect(matrix.rows() == 4 && matrix.cols() == 4, name, "[4 x 4]");
  Eigen::Isometry3d pose;
  pose.matrix() = matrix;
  return pose;
}

}  // namespace

Record encode(const Grasp& grasp, const Provenance& provenance) {
  Record record{"grasp", grasp.group, provenance, {}};
  auto& fields = record.fields;
  fields["coefficients"] = grasp.coefficients;
  fields["slack"] = grasp.slack;
  fields["q_grasp"] = grasp.q_grasp;
  fields["q_pregrasp"] = grasp.q_pregrasp;
  fields["X_OH"] = Eigen::MatrixXd(grasp.X_OH.matrix());
  fields["X_OH_pregrasp"] = Eigen::MatrixXd(grasp.X_OH_pregrasp.matrix());
  fields["synergy_grasp"] = std::int64_t{grasp.synergy_grasp ? 1 : 0};
  encode_contacts(record, grasp.contacts);
  encode_quality(record, grasp.quality);
  if (grasp.robust) encode_robust(record, *grasp.robust);
  fields["origin"] = enum_text(kGraspOrigins, grasp.origin);
  encode_certificate(record, grasp.certificate);
  encode_arm_solutions(record, grasp.arm_solutions);
  return record;
}

Grasp decode_grasp(const Record& record) {
  const FieldReader read(record, "grasp");
  Grasp grasp;
  grasp.group = record.name;
  grasp.coefficients = read.vector("coefficients");
  grasp.slack = read.vector("slack");
  grasp.q_grasp = read.vector("q_grasp");
  grasp.q_pregrasp = read.vector("q_pregrasp");
  grasp.X_OH = decode_pose(read, "X_OH");
  grasp.X_OH_pregrasp = decode_pose(read, "X_OH_pregrasp");
  grasp.synergy_grasp = read.integer("synergy_grasp") != 0;
  grasp.contacts = decode_contacts(read);
  grasp.quality = decode_quality(record, read);
  if (record.fields.contains("robust.samples")) grasp.robust = decode_robust(read);
  // Stores written before grasps could be imported do not say it.
  if (record.fields.contains("origin")) grasp.origin = read.enumerator<GraspOrigin>("origin", kGraspOrigins);
  grasp.certificate = decode_certificate(record, read);
  grasp.arm_solutions = decode_arm_solutions(read);
  return grasp;
}

}  // namespace opponens::storage
