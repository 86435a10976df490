#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times curve evaluation on a grid against SISL, GSL and SciPy, each in a program of its own, in turn.

Every round runs ours and then each peer; what is printed is the least ns of processor time a point over the
rounds, and the median over the rounds of peer / ours in the same round. All evaluate the cubic of peer_curve.h at 65,536
nodes, without and with weights, one thread. Nothing of the peers is linked with ours: SISL is under the AGPL, GSL under the GPL.
Needs the Debian packages libsisl-dev libgsl-dev python3-scipy g++.

usage: compare_curves.py BUILD_DIR/bench/curve_peers_bench [ROUNDS]
"""
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
OURS = {"cubic": "ours_fast_grid/cubic", "rational": "ours_fast_grid/rational_cubic"}


def built(folder, source, libraries):
    program = pathlib.Path(folder) / source.removesuffix(".cpp")
    subprocess.run(["g++", "-std=c++20", "-O3", "-march=x86-64-v3", HERE / source, "-o", program, *libraries],
                   check=True)
    return [program]


def lines_of(command):
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    for line in out.splitlines():
        name, ns, value = line.split()
        yield name, float(ns), float(value)


def ours_of(bench):
    names = "|".join(OURS.values())
    out = subprocess.run([bench, f"--benchmark_filter=^({names})$", "--benchmark_format=json",
                          "--benchmark_min_time=0.1"], check=True, capture_output=True, text=True).stdout
    by_name = {entry["name"]: entry["ns/sample"] for entry in json.loads(out)["benchmarks"]}
    return {form: by_name[name] for form, name in OURS.items()}


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    bench, rounds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) == 3 else 5
    times, ratios, values = {}, {}, {}
    with tempfile.TemporaryDirectory() as folder:
        try:
            commands = [built(folder, "sisl_curve.cpp", ["-lsisl"]),
                        built(folder, "gsl_curve.cpp", ["-lgsl", "-lgslcblas"]),
                        ["/usr/bin/python3", HERE / "scipy_curve.py"]]
            subprocess.run(["/usr/bin/python3", "-c", "import scipy"], check=True)
        except subprocess.CalledProcessError:
            sys.exit("compare_curves.py: apt-get install libsisl-dev libgsl-dev python3-scipy g++")
        for _ in range(rounds):
            ours = ours_of(bench)
            for form, ns in ours.items():
                times.setdefault(f"{form}/ours/fast", []).append(ns)
            for command in commands:
                for name, ns, value in lines_of(command):
                    form = name.split("/")[0]
                    times.setdefault(name, []).append(ns)
                    ratios.setdefault(name, []).append(ns / ours[form])
                    if abs(values.setdefault(form, value) - value) > 1e-12:
                        sys.exit(f"compare_curves.py: {name} has {value}, another {values[form]}")
    print(f"| form / routine / kind | ns a point, least of {rounds} rounds | x ours, median (range) |\n|---|---|---|")
    for name in sorted(times):
        ratio = ratios.get(name)
        shown = "" if ratio is None else (
            f"{statistics.median(ratio):.0f} ({min(ratio):.0f} to {max(ratio):.0f})")
        print(f"| {name} | {min(times[name]):.3g} | {shown} |")


if __name__ == "__main__":
    main()
