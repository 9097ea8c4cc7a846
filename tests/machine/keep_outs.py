#!/usr/bin/env python3
"""Judges the way of a group: does it enter a keep-out of the machine file?

usage: keep_outs.py TRACE.csv --machine MACHINE.xml [--selftest] [--seed N]

In every cycle in which a group with <Obstacles> moves (G.state is GroupMoving):
- its set positions lie in no keep-out grown by its clearance, and neither does the middle between two
  cycles; 1e-6 of a unit is allowed for what rounding does;
- its actual positions lie in no keep-out as it is, without clearance.
And it must have moved at all.

--selftest makes ten bad traces from the good one and must find each.
exit: 0 nothing found, 1 found something, 2 could not run
"""
import argparse
import csv
import math
import random
import sys
import xml.etree.ElementTree as ElementTree

import machine_file

ROUNDING = 1e-6
MAX_SHOWN = 20


class KeepOut:
    """Spans by axis name and, for a cylinder, centre by axis name and radius."""

    def __init__(self, element, clearance):
        self.name = element.get("name")
        own = element.get("clearance")
        self.clearance = float(machine_file.motion(own)) if own else clearance
        self.spans = {}
        for span in element.iter("Span"):
            ends = [span.get("from"), span.get("to")]
            low, high = (float(machine_file.motion(e)) if e else None for e in ends)
            self.spans[span.get("axis")] = (-math.inf if low is None else low,
                                            math.inf if high is None else high)
        self.centre = {c.get("axis"): float(machine_file.motion(c.get("at")))
                       for c in element.iter("Centre")}
        self.radius = float(machine_file.motion(element.get("radius"))) if self.centre else None

    def depth(self, point, clearance):
        """How far inside a point is, 0 on the surface; `point` by axis name."""
        depths = [min(point[axis] - low, high - point[axis]) + clearance
                  for axis, (low, high) in self.spans.items()]
        if self.centre:
            away = math.hypot(*(point[axis] - place for axis, place in self.centre.items()))
            depths.append(self.radius + clearance - away)
        return min(depths)

    def middle(self, point):
        """The point moved to where the keep-out is deepest, on the axes that it names."""
        moved = dict(point)
        for axis, (low, high) in self.spans.items():
            ends = [end for end in (low, high) if math.isfinite(end)]
            reach = 1.0 if len(ends) < 2 else 0.0
            moved[axis] = sum(ends) / len(ends) + (reach if math.isfinite(low) else -reach)
        moved.update(self.centre)
        return moved


class Group:
    def __init__(self, root, obstacles):
        self.name = obstacles.get("group")
        clearance = obstacles.get("clearance")
        common = float(machine_file.motion(clearance)) if clearance else 0.0
        self.keep_outs = [KeepOut(e, common) for e in obstacles if e.tag in ("Box", "Cylinder")]
        group = next(g for g in root.iter("Group") if g.get("name") == self.name)
        self.axes = [member.get("axis") for member in group.iter("Member")]


def read_groups(path):
    root = ElementTree.parse(path).getroot()
    return [Group(root, obstacles) for obstacles in root.iter("Obstacles")]


class Way:
    """Cycles in which the group moved, with its set and actual positions by axis."""

    def __init__(self, cycles, sets, actuals):
        self.cycles, self.sets, self.actuals = cycles, sets, actuals

    def clone(self):
        return Way(list(self.cycles), [dict(p) for p in self.sets], [dict(p) for p in self.actuals])


def read_way(path, group):
    way = Way([], [], [])
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row[group.name + ".state"] != "GroupMoving":
                continue
            way.cycles.append(int(row["cycle"]))
            way.sets.append({axis: float(row[axis + ".set"]) for axis in group.axes})
            way.actuals.append({axis: float(row[axis + ".actual"]) for axis in group.axes})
    return way


def judge(way, group):
    """Yields one sentence for each fault."""
    if len(way.cycles) < 2:
        yield f"group {group.name} never moves: there is nothing to be judged"
    before = None
    for cycle, place, actual in zip(way.cycles, way.sets, way.actuals):
        points = [("set position", place)]
        if before and before[0] == cycle - 1:
            half = {axis: (place[axis] + before[1][axis]) / 2 for axis in place}
            points.append(("way between two cycles", half))
        before = (cycle, place)
        for keep_out in group.keep_outs:
            for what, point in points:
                if not all(math.isfinite(v) for v in point.values()):
                    yield f"cycle {cycle}: {what} is no number"
                    break
                depth = keep_out.depth(point, keep_out.clearance)
                if depth > ROUNDING:
                    yield f"cycle {cycle}: {what} is {depth:.6g} inside {keep_out.name} with its clearance"
            depth = keep_out.depth(actual, 0.0)
            if depth > ROUNDING:
                yield f"cycle {cycle}: actual position is {depth:.6g} inside {keep_out.name}"


# ---- selftest ----

def spoil(way, group, number, rng):
    """A bad trace: (what is wrong, words that must be found, way)."""
    bad = way.clone()
    row = rng.randrange(1, len(bad.cycles) - 1)
    keep_out = group.keep_outs[number % len(group.keep_outs)]
    kind = ("set", "near", "actual", "between", "nan")[number % 5]
    inside = keep_out.middle(bad.sets[row])
    if kind == "set":
        bad.sets[row] = inside
        return f"a set position in {keep_out.name}", f"inside {keep_out.name} with", bad
    if kind == "near":
        # From the inside outwards to a hundredth of a unit within the grown surface.
        far, near = bad.sets[row], inside
        for _ in range(100):
            point = {a: (far[a] + near[a]) / 2 for a in far}
            if keep_out.depth(point, keep_out.clearance) > 0.01:
                near = point
            else:
                far = point
        bad.sets[row] = near
        return f"a set position too near to {keep_out.name}", f"inside {keep_out.name} with", bad
    if kind == "actual":
        bad.actuals[row] = inside
        return f"an actual position in {keep_out.name}", f"actual position is", bad
    if kind == "between":
        bad.cycles[row] = bad.cycles[row - 1] + 1
        bad.sets[row] = {a: 2 * inside[a] - bad.sets[row - 1][a] for a in inside}
        return f"a step across {keep_out.name}", "way between two cycles", bad
    bad.sets[row][group.axes[0]] = math.nan
    return "a set position that is no number", "is no number", bad


def selftest(way, group, seed):
    clean = list(judge(way, group))
    if clean:
        print("selftest: the trace itself is not clean")
        return report(clean)
    rng = random.Random(seed)
    found = 0
    for number in range(10):
        what, words, bad = spoil(way, group, number, rng)
        by_rule = [p for p in judge(bad, group) if words in p]
        found += bool(by_rule)
        print(f"selftest: {what}: {by_rule[0] if by_rule else 'NOT FOUND'}")
    print(f"selftest: {found} of 10 bad traces found (seed {seed})")
    return 0 if found == 10 else 1


def report(problems):
    for problem in problems[:MAX_SHOWN]:
        print(problem)
    if len(problems) > MAX_SHOWN:
        print(f"… and {len(problems) - MAX_SHOWN} more")
    return 1 if problems else 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("trace")
    parser.add_argument("--machine", required=True)
    parser.add_argument("--selftest", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    try:
        groups = read_groups(arguments.machine)
        if not groups:
            raise machine_file.MachineError(f"{arguments.machine}: no <Obstacles>")
        worst = 0
        for group in groups:
            way = read_way(arguments.trace, group)
            if arguments.selftest:
                worst = max(worst, selftest(way, group, arguments.seed))
                continue
            problems = list(judge(way, group))
            worst = max(worst, report(problems))
            if not problems:
                deepest = max(k.depth(p, k.clearance) for k in group.keep_outs for p in way.sets)
                print(f"group {group.name}: {len(way.cycles)} cycles in motion, nearest "
                      f"{-deepest:.6g} from a keep-out with its clearance")
        return worst
    except (OSError, KeyError, StopIteration, ValueError, ElementTree.ParseError,
            machine_file.MachineError) as error:
        print(f"keep_outs.py: {error!r}", file=sys.stderr)
        return 2


sys.exit(main())
