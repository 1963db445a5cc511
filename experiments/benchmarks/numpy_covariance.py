# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
"""numpy.cov beside statistics_benchmark, on arrays of the same size, layout and distribution (README.md).

Usage: /usr/bin/python3 numpy_covariance.py BUILD/experiments/benchmarks/statistics_benchmark
"""
import json
import os
import subprocess
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")
import numpy  # noqa: E402  (the threads of its BLAS are set before it is loaded)

ROWS, COLUMNS = 2_000_000, 16


def best_seconds(call, repetitions=7):
    best = float("inf")
    for _ in range(repetitions):
        begin = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - begin)
    return best


def main():
    q = numpy.asfortranarray(numpy.random.default_rng(1).random((ROWS, COLUMNS)))
    rates = {"numpy.sum": ROWS / best_seconds(lambda: q.sum()), "numpy.cov": ROWS / best_seconds(lambda: numpy.cov(q, rowvar=False))}
    del q
    output = subprocess.run(
        [sys.argv[1], "--benchmark_filter=sum|covariance", "--benchmark_format=json", "--benchmark_repetitions=7"],
        check=True, capture_output=True, text=True).stdout
    for one in json.loads(output)["benchmarks"]:
        if one["run_type"] == "iteration":
            name = one["run_name"].replace("/real_time", "")
            rates[name] = max(rates.get(name, 0.0), one["items_per_second"])
    for name, rate in rates.items():
        print(f"{name:26} {rate / 1e6:7.1f} M rows/s {rate * COLUMNS * 8 / 1e9:6.1f} GB/s")
    print(f"covariance / numpy.cov      {rates['covariance/1'] / rates['numpy.cov']:.1f}")
    print(f"covariance / sum_in_order   {rates['covariance/1'] / rates['sum_in_order']:.2f}")
    print(f"covariance / sum_vectorised {rates['covariance/1'] / rates['sum_vectorised']:.2f}")


if __name__ == "__main__":
    main()
