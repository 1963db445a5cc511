#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Coverage of bootstrap intervals of a cumulative variance, found with numpy alone: what intervals_test.cpp expects.

Usage: interval_coverage.py [DATA_SETS]. Population: 36 recordings, 16 channels, standard deviation 0.8^i; 80 % of each
variance lies between recordings (normal), 20 % within each. Quantity: the share of the first 6 axes. 199 replicates of
whole recordings. Prints how often the 95 % interval holds the true share: basic on the logit, and percentile."""
import sys

import numpy as np

DATA_SETS = int(sys.argv[1]) if len(sys.argv) > 1 else 10000
CLUSTERS, CHANNELS, KEPT, REPLICATES, DECAY, BETWEEN = 36, 16, 6, 199, 0.8, 0.8
rng = np.random.default_rng(5)
deviation = DECAY ** np.arange(CHANNELS)
within = np.diag((1 - BETWEEN) * deviation**2)
truth = np.sum(deviation[:KEPT] ** 2) / np.sum(deviation**2)


def share(means, weights):
    """Share of the first axes; weights [replicates x clusters] sum to 1."""
    centre = weights @ means
    second = np.einsum("rc,ci,cj->rij", weights, means, means, optimize=True)
    covariance = second - centre[:, :, None] * centre[:, None, :] + within
    values = np.linalg.eigvalsh(covariance)[:, ::-1]
    return values[:, :KEPT].sum(axis=1) / values.sum(axis=1)


def logit(p):
    return np.log(p / (1 - p))


basic = percentile = 0
for _ in range(DATA_SETS):
    means = rng.normal(size=(CLUSTERS, CHANNELS)) * deviation * np.sqrt(BETWEEN)
    estimate = share(means, np.full((1, CLUSTERS), 1 / CLUSTERS))[0]
    draws = rng.multinomial(CLUSTERS, np.full(CLUSTERS, 1 / CLUSTERS), size=REPLICATES) / CLUSTERS
    low, high = np.quantile(share(means, draws), [0.025, 0.975], method="weibull")
    percentile += low <= truth <= high
    centre = 2 * logit(estimate)
    basic += centre - logit(high) <= logit(truth) <= centre - logit(low)
print(f"data sets {DATA_SETS}, true share {truth:.6f}, basic {basic / DATA_SETS:.4f}, "
      f"percentile {percentile / DATA_SETS:.4f}")
