#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes pca_golden.txt beside itself with numpy (Debian's python3-numpy): 40 samples of 5 correlated channels, their
mean, the variances (divisor N) and axes of a singular value decomposition of the centred samples.
Format: one matrix after another, "name rows columns" and then the rows."""
import pathlib

import numpy as np

rng = np.random.default_rng(20260722)
mixing = rng.normal(size=(5, 5))
samples = np.round(rng.normal(size=(40, 5)) @ mixing * 0.3 + [0.5, 1.0, -0.2, 0.0, 0.7], 4)
mean = samples.mean(axis=0)
_, singular, axes_t = np.linalg.svd(samples - mean, full_matrices=False)
axes = axes_t.T.copy()
for column in range(axes.shape[1]):  # the largest-magnitude entry is positive
    if axes[np.argmax(np.abs(axes[:, column])), column] < 0:
        axes[:, column] *= -1

with open(pathlib.Path(__file__).with_name("pca_golden.txt"), "w") as out:
    for name, matrix in (("samples", samples), ("mean", mean[None, :]), ("variance", singular[None, :] ** 2 / len(samples)),
                         ("axes", axes)):
        out.write(f"{name} {matrix.shape[0]} {matrix.shape[1]}\n")
        for row in matrix:
            out.write(" ".join(repr(float(v)) for v in row) + "\n")
