"""Counts the planner's instructions with callgrind and compares them with stored figures.

instruction_gate.py PROGRAM FIGURES.json TOOLCHAIN [--store]

Fails when a figure is exceeded by more than 3 %. Figures are kept per compiler and processor; where there are
none for this one, or no valgrind, the test is skipped (exit 77). --store writes the figures measured.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

ALLOWANCE = 0.03
WORK = [("solve", axes) for axes in (1, 3, 6)] + [("sample", 3)]


def instructions(program, what, axes):
    function = {"solve": "countedSolve", "sample": "countedSample"}[what]
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(
            ["valgrind", "--tool=callgrind", "--collect-atstart=no", f"--toggle-collect={function}",
             f"--callgrind-out-file={os.path.join(folder, 'out')}", program, what, str(axes)],
            capture_output=True, text=True, check=True)
    counted = re.search(r"Collected : (\d+)", run.stderr)
    return int(counted.group(1)) // 1000


def main():
    program, figures_file, toolchain = sys.argv[1:4]
    if shutil.which("valgrind") is None:
        print("valgrind is not installed")
        return 77
    with open(figures_file, encoding="utf-8") as file:
        figures = json.load(file)
    measured = {f"{what}-{axes}": instructions(program, what, axes) for what, axes in WORK}
    if "--store" in sys.argv:
        figures[toolchain] = measured
        with open(figures_file, "w", encoding="utf-8") as file:
            json.dump(figures, file, indent=2, sort_keys=True)
            file.write("\n")
        return 0
    if toolchain not in figures:
        print(f"no figures for {toolchain}; measured {measured}")
        return 77
    failed = False
    for name, count in measured.items():
        stored = figures[toolchain][name]
        ratio = count / stored
        print(f"{name:10} {count:8} instructions a call, stored {stored:8}, {ratio - 1:+.1%}")
        failed = failed or ratio > 1 + ALLOWANCE
    if failed:
        print("more than 3 % above the stored figures")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
