#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark groups spm` against spm1d on the data sets that spm1d brings: the statistic at every point, the threshold and
the probabilities of what is beyond it, by permutation.

spm1d interpolates its threshold between neighbouring values of the null distribution, kinemark takes the one that is
exceeded with the asked probability at most. Where there are few arrangements, neighbours lie far apart: there the row asks
that kinemark's threshold is the least one of spm1d's own distribution that keeps the error. Thresholds are those of one
side (F has none), as spm1d doubles the probability of one side where two count.

Needs Python with spm1d. Finds the program in KINEMARK_PROGRAM; prints rows "PASS|FAIL | check | asked | measured"; exit
status 1 when one fails.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
import spm1d

from rows import PROGRAM, row

ALPHA = 0.05
DRAWS = 200_000  # where there are more arrangements than that: with 50,000 a threshold scatters by a hundredth
FEW = 500


def data_sets():
    """(name, groups of curves, options, spm1d's test) of every one-dimensional data set of the designs that there are."""
    stats, uv1d = spm1d.stats.nonparam, spm1d.data.uv1d
    for module, design in ((uv1d.t1, "one"), (uv1d.tpaired, "paired"), (uv1d.t2, "two"), (uv1d.anova1, "many")):
        for name, kind in vars(module).items():
            if not isinstance(kind, type) or kind.__module__ != module.__name__:
                continue
            first, second = kind().get_data()
            title = f"{name}, {design}"
            if design == "one":
                curves = first - (0.0 if second is None else second)
                yield title, [curves], [], stats.ttest(curves)
            elif design == "paired":
                yield title, [first, second], ["--paired"], stats.ttest_paired(first, second)
            elif design == "two":
                yield title, [first, second], [], stats.ttest2(first, second)
            else:
                yield title, [first[second == k] for k in numpy.unique(second)], [], stats.anova1(first, second)


def run(groups, options):
    """What kinemark says of the groups, and the statistic at each point."""
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for i, curves in enumerate(groups):
            files.append(Path(folder) / f"group{i}.csv")
            numpy.savetxt(files[-1], curves, delimiter=",", fmt="%.17g")
        done = subprocess.run([PROGRAM, "groups", "spm", *map(str, files), *options, "--json", "--quiet"], capture_output=True,
                              text=True, timeout=900, check=False)
    if done.returncode:
        raise SystemExit(f"kinemark groups spm: {done.stderr}")
    found = json.loads(done.stdout)
    return found, numpy.array([numpy.nan if v is None else v for v in found["values"]])


def judge(name, groups, options, test):
    possible = test.nPermUnique
    exact = possible <= DRAWS
    numpy.random.seed(1)
    one_way = len(groups) > 2
    theirs = test.inference(ALPHA, iterations=-1 if exact else DRAWS, force_iterations=True,
                            **({} if one_way else {"two_tailed": False}))
    ours, values = run(groups, [*options, "--arrangements", str(DRAWS), *([] if one_way else ["--one-sided"])])
    good = row(numpy.nanmax(numpy.abs(values - theirs.z) / (1 + numpy.abs(theirs.z))) <= 1e-9, f"{name}: statistic at every point",
               "1e-9 of spm1d's", f"{numpy.nanmax(numpy.abs(values - theirs.z) / (1 + numpy.abs(theirs.z))):.1e}")
    count = f"{possible} arrangements" if exact else f"{DRAWS} of {possible:.3g} arrangements"
    if possible >= FEW:
        difference = 100 * (ours["threshold"] / theirs.zstar - 1)
        good &= row(abs(difference) <= 1, f"{name}: threshold, {count}", "1 % of spm1d's",
                    f"{ours['threshold']:.4f} against {theirs.zstar:.4f}: {difference:+.2f} %")
    else:
        null = numpy.array(theirs.PDF0)
        tolerance = 1e-9 * abs(ours["threshold"])
        beyond, with_it = (null > ours["threshold"] + tolerance).mean(), (null >= ours["threshold"] - tolerance).mean()
        good &= row(beyond <= ALPHA < with_it, f"{name}: threshold, {count}",
                    "the least of spm1d's distribution that is exceeded in 5 % at most",
                    f"{ours['threshold']:.4f}, exceeded in {100 * beyond:.1f} %, reached in {100 * with_it:.1f} %; spm1d's {theirs.zstar:.4f}, "
                    f"exceeded in {100 * (null > theirs.zstar).mean():.1f} %")
    pairs = list(zip([c.P for c in theirs.clusters], [s["p"] for s in ours["spans"]], strict=False))
    same = len(theirs.clusters) == len(ours["spans"])
    if possible >= FEW or same:
        worst = max((abs(a - b) for a, b in pairs), default=0.0)
        good &= row(same and worst <= 0.005, f"{name}: probability of each span", "as many, 0.005",
                    f"{len(ours['spans'])} and {len(theirs.clusters)}, {worst:.4f}")
    return good


def main():
    good = True
    for name, groups, options, test in data_sets():
        good &= judge(name, groups, options, test)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
