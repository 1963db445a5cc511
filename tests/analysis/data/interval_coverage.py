#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Coverage of bootstrap intervals of a cumulative variance, found with numpy alone: what intervals_test.cpp expects.

Usage: interval_coverage.py [DATA_SETS]. Population: 36 recordings, 16 channels, standard deviation 0.8^i; 80 % of each
variance lies between recordings (normal), 20 % within each. Quantity: the share of the first 6 axes. 199 replicates of
whole recordings. Prints how often the 95 % interval holds the true share: basic on the logit, and percentile; and for 5
recordings, where resampling fails, that of the jackknife on the logit beside the basic one, for the share of the first 3."""
import sys

import numpy as np

DATA_SETS = int(sys.argv[1]) if len(sys.argv) > 1 else 10000
CLUSTERS, CHANNELS, KEPT, REPLICATES, DECAY, BETWEEN = 36, 16, 6, 199, 0.8, 0.8
rng = np.random.default_rng(5)
deviation = DECAY ** np.arange(CHANNELS)
within = np.diag((1 - BETWEEN) * deviation**2)
truth = np.sum(deviation[:KEPT] ** 2) / np.sum(deviation**2)


def share(means, weights, kept=KEPT):
    """Share of the first axes; weights [replicates x clusters] sum to 1."""
    centre = weights @ means
    second = np.einsum("rc,ci,cj->rij", weights, means, means, optimize=True)
    covariance = second - centre[:, :, None] * centre[:, None, :] + within
    values = np.linalg.eigvalsh(covariance)[:, ::-1]
    return values[:, :kept].sum(axis=1) / values.sum(axis=1)


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

FEW, FEW_KEPT, T = 5, 3, 2.7764451051977987  # Student's t of 4 degrees of freedom at 97.5 %
truth = np.sum(deviation[:FEW_KEPT] ** 2) / np.sum(deviation**2)
jackknife = basic = 0
for _ in range(DATA_SETS):
    means = rng.normal(size=(FEW, CHANNELS)) * deviation * np.sqrt(BETWEEN)
    estimate = logit(share(means, np.full((1, FEW), 1 / FEW), FEW_KEPT)[0])
    without = logit(share(means, (1 - np.eye(FEW)) / (FEW - 1), FEW_KEPT))
    pseudo = FEW * estimate - (FEW - 1) * without
    jackknife += abs(logit(truth) - pseudo.mean()) <= T * pseudo.std(ddof=1) / np.sqrt(FEW)
    draws = rng.multinomial(FEW, np.full(FEW, 1 / FEW), size=REPLICATES) / FEW
    low, high = np.quantile(logit(share(means, draws, FEW_KEPT)), [0.025, 0.975], method="weibull")
    basic += 2 * estimate - high <= logit(truth) <= 2 * estimate - low
print(f"{FEW} recordings, first {FEW_KEPT}: jackknife {jackknife / DATA_SETS:.4f}, basic {basic / DATA_SETS:.4f}")
