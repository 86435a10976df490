#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tables.py BENCH_DIR [NAME...]: runs the benchmark programs (all, or those named) and prints one Markdown table
each, for bench/results/. Each row is the fastest of five runs, in ns of processor time (or by the clock,
where its name says so) a sample where the program counts samples, else a call; `spread` is how much slower the slowest of the five was. A spread above a few
percent means that the machine was not quiet: then compare nothing."""
import json
import os
import pathlib
import platform
import subprocess
import sys

RUNS = 5


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def rows_of(program):
    """Name -> figures of every run, in the program's order; a figure is (value, unit)."""
    command = [program, f"--benchmark_repetitions={RUNS}", "--benchmark_format=json",
               "--benchmark_enable_random_interleaving=true"]
    report = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    rows = {}
    for entry in sorted(report["benchmarks"], key=lambda e: (e["family_index"], e["per_family_instance_index"])):
        if entry.get("run_type") != "iteration":
            continue
        if entry.get("error_occurred"):
            sys.exit(f"{program}: {entry['name']}: {entry['error_message']}")
        figure = (entry["ns/sample"], "ns/sample") if "ns/sample" in entry else (
            entry["cpu_time"], entry["time_unit"] + "/call")
        rows.setdefault(entry["name"], []).append(figure)
    return rows


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    names = sys.argv[2:] or sorted(path.name for path in folder.glob("*_bench"))
    if not names:
        sys.exit(f"tables.py: no *_bench in {folder}; build the target `benchmarks` of preset release first")
    print(f"{processor()}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f} at the start.\n")
    for name in names:
        print(f"| {name} | fastest of {RUNS} | | spread |\n|---|---|---|---|")
        for row, figures in rows_of(folder / name).items():
            values = [value for value, _ in figures]
            spread = 100 * (max(values) / min(values) - 1)
            print(f"| {row.removesuffix('/real_time')} | {min(values):.3g} | {figures[0][1]} | {spread:.0f} % |")
        print(flush=True)


if __name__ == "__main__":
    main()
