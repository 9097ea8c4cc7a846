"""Counts a program's instructions with callgrind and compares them with stored figures.

instruction_gate.py PROGRAM FIGURES.json TOOLCHAIN WORK... [--store]

A work `solve-3` is what `PROGRAM solve 3` does a thousand times in the function countedSolve. Fails when a figure is exceeded by more than 3 %. Figures are kept per compiler and processor; where there are
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
TIMES = 1000


def instructions(program, work):
    what, size = work.split("-")
    function = f"counted{what.capitalize()}"
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(
            ["valgrind", "--tool=callgrind", "--collect-atstart=no", f"--toggle-collect={function}",
             f"--callgrind-out-file={os.path.join(folder, 'out')}", program, what, size],
            capture_output=True, text=True, check=True)
    counted = re.search(r"Collected : (\d+)", run.stderr)
    return int(counted.group(1)) // TIMES


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--store"]
    program, figures_file, toolchain = arguments[:3]
    works = arguments[3:]
    if shutil.which("valgrind") is None:
        print("valgrind is not installed")
        return 77
    with open(figures_file, encoding="utf-8") as file:
        figures = json.load(file)
    measured = {work: instructions(program, work) for work in works}
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
