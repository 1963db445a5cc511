// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/pca.hpp"

#include <fstream>
#include <map>

#include <gtest/gtest.h>
#include <Eigen/SVD>

#include "analysis/statistics.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

std::map<std::string, Eigen::MatrixXd> golden() {
  std::ifstream file(std::string(OPPONENS_SOURCE_DIR) + "/tests/analysis/data/pca_golden.txt");
  std::map<std::string, Eigen::MatrixXd> matrices;
  std::string name;
  Eigen::Index rows = 0;
  Eigen::Index columns = 0;
  while (file >> name >> rows >> columns) {
    Eigen::MatrixXd matrix(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i) {
      for (Eigen::Index j = 0; j < columns; ++j) file >> matrix(i, j);
    }
    matrices[name] = matrix;
  }
  return matrices;
}

TEST(PrincipalAxes, EqualNumpysSvd) {
  const auto expected = golden();
  ASSERT_EQ(expected.size(), 4u) << "tests/analysis/data/pca_golden.txt is missing or damaged";
  const SynergyBasis basis = principal_axes(moments(expected.at("samples")));
  EXPECT_TRUE(basis.mean.transpose().isApprox(expected.at("mean"), 1e-14));
  EXPECT_TRUE(basis.variance.transpose().isApprox(expected.at("variance"), 1e-12));
  EXPECT_LT((basis.axes - expected.at("axes")).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_DOUBLE_EQ(basis.count, 40.0);
}

TEST(PrincipalAxes, Invariants) {
  for (int trial = 0; trial < 100; ++trial) {
    Rng rng = test::numbered_stream(7, "pca/", trial);
    const int n = 1 + trial % 16;
    const SampleStatistics s = moments(test::normal_matrix(3 + trial, n, rng) * test::normal_matrix(n, n, rng));
    const SynergyBasis basis = principal_axes(s);
    EXPECT_LT((basis.axes.transpose() * basis.axes - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-12) << trial;
    EXPECT_TRUE((basis.axes * basis.variance.asDiagonal() * basis.axes.transpose()).isApprox(s.covariance, 1e-11));
    EXPECT_GE(basis.variance.minCoeff(), 0.0);
    for (int i = 0; i < n; ++i) {
      EXPECT_GE(basis.variance[std::max(0, i - 1)], basis.variance[i]) << trial;
      Eigen::Index largest = 0;
      basis.axes.col(i).cwiseAbs().maxCoeff(&largest);
      EXPECT_GT(basis.axes(largest, i), 0.0) << trial;
    }
  }
}

TEST(PrincipalAxes, AgreesWithTheSvdOfTheSamples) {
  Rng rng = stream(8, "svd");
  const Eigen::MatrixXd q = test::normal_matrix(300, 16, rng) * test::normal_matrix(16, 16, rng);
  const SynergyBasis basis = principal_axes(moments(q));
  const Eigen::MatrixXd centred = q.rowwise() - q.colwise().mean();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(centred, Eigen::ComputeThinV);
  EXPECT_TRUE(basis.variance.isApprox(svd.singularValues().cwiseAbs2() / 300.0, 1e-11));
  EXPECT_TRUE((basis.axes.transpose() * svd.matrixV()).cwiseAbs().isIdentity(1e-9));
}

TEST(CumulativeVariance, HandComputedAndDegenerate) {
  EXPECT_TRUE(cumulative_variance(Eigen::Vector3d(6, 3, 1)).isApprox(Eigen::Vector3d(0.6, 0.9, 1.0)));
  EXPECT_TRUE(cumulative_variance(Eigen::Vector2d::Zero()) == Eigen::Vector2d::Ones());
  EXPECT_THROW(cumulative_variance(Eigen::Vector2d(1, -1)), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::analysis
