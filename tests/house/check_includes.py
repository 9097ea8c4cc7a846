#!/usr/bin/env python3
"""Fails on any include between rooms that rooms.txt does not allow.

usage: check_includes.py SOURCE_DIR            checks the tree
       check_includes.py SOURCE_DIR --selftest shows that a forbidden include is found
"""
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]takt/([a-z_]+)/([^>"]+)[>"]')


def read_table(path):
    table = {}
    for line in path.read_text().splitlines():
        line = line.split("#")[0].strip()
        if line:
            room, allowed = line.split(":")
            table[room.strip()] = set(allowed.split())
    return table


def violations(table, room, name, lines):
    """Yields (line number, reason) for each include that `room` must not make."""
    is_params = name.endswith("_params.hpp")
    allowed = {"core"} if is_params else table[room] | {room}
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target, header = match.groups()
        if target in allowed:
            continue
        if is_params and target == room and header.endswith("_params.hpp"):
            continue
        if "params" in allowed and header.endswith("_params.hpp"):
            continue
        yield number, f"{room} may not include <takt/{target}/{header}>; allowed: {' '.join(sorted(allowed))}"


def rooms(root, table):
    for room in table:
        for folder in (root / room, root / "runtime" / room):
            if folder.is_dir():
                yield room, folder


def main():
    root = pathlib.Path(sys.argv[1])
    table = read_table(pathlib.Path(__file__).with_name("rooms.txt"))
    if "--selftest" in sys.argv:
        found = list(violations(table, "twin", "x.cpp", ["#include <takt/fieldbus/master.hpp>"]))
        params = list(violations(table, "axis", "axis_params.hpp", ["#include <takt/planner/profile.hpp>"]))
        clean = list(violations(table, "axis", "x.cpp", ["#include <takt/planner/profile.hpp>"]))
        sys.exit(0 if len(found) == 1 and len(params) == 1 and not clean else 1)
    bad = files = 0
    for room, folder in rooms(root, table):
        for path in sorted(folder.rglob("*")):
            if path.suffix not in (".hpp", ".cpp"):
                continue
            files += 1
            for number, reason in violations(table, room, path.name, path.read_text().splitlines()):
                print(f"{path.relative_to(root)}:{number}: {reason}")
                bad += 1
    print(f"{files} files checked, {bad} forbidden includes")
    sys.exit(1 if bad or files == 0 else 0)


main()
