// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace opponens {

/// Why an answer does not exist. A caller's broken contract is not a Failure: see core/require.hpp.
enum class FailureCode {
  too_few_samples,  ///< a statistic needs more samples than were given
  degenerate,       ///< nothing varies: no direction, no variance, no extent
  out_of_reach,     ///< no inverse kinematics solution inside the limits
  not_converged,    ///< an iterative solver stopped without meeting its tolerance
  invalid_input,    ///< the input's content does not allow the computation; detail says where
  not_found,        ///< a named thing is absent
};

struct Failure {
  FailureCode code;
  std::string detail;  ///< one sentence for a person, with the values
};

template <typename T>
using Result = tl::expected<T, Failure>;

inline tl::unexpected<Failure> failure(FailureCode code, std::string detail) {
  return tl::make_unexpected(Failure{code, std::move(detail)});
}

}  // namespace opponens
