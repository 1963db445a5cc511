// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/demonstration.hpp"
#include "core/grasp.hpp"
#include "core/path.hpp"
#include "core/synergies.hpp"
#include "storage/record.hpp"

namespace opponens::storage {

// One encode/decode pair per stored core type. decode throws StorageError naming the missing or misshapen field.

Record encode(const Demonstration& demonstration, const Provenance& provenance);
Record encode(const SynergySet& set, const Provenance& provenance);
Record encode(const Grasp& grasp, const Provenance& provenance);
Record encode(const PlanResult& result, const Provenance& provenance);

/// Kind "demonstration", or "hand_demonstration" for one that was mapped to a robot hand.
Demonstration decode_demonstration(const Record& record);
SynergySet decode_synergy_set(const Record& record);
Grasp decode_grasp(const Record& record);
PlanResult decode_plan_result(const Record& record);

}  // namespace opponens::storage
