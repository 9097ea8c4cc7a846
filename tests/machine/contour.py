#!/usr/bin/env python3
"""Judges the path of a group: is it the one that was programmed, and within all limits?

usage: contour.py TRACE.csv --machine MACHINE.xml --path FILE.path [--within SECONDS] [--stopped]
                  [--selftest] [--seed N]

The path file says what was programmed, one word and its numbers in a line:
  axes X Y Z        the axes that count, in this order
  start 0 0 0       where the path begins
  corner 0.1        from here on a joint may be cut by so much (0: passed exactly)
  line 20 0 0       straight to a point
  arc 15 5 0 to 20 10 0    through a point to a point
  repeat 4 … end    the lines between so many times

Judged are the rows from the first in which the group moves on a path to the one in which it is in GroupStandby
or GroupDisabled again, or has rested on its path for a while:
- every set position is on the path; only where two elements meet that may be cut, it may be off by as
  much as the deviation, at most half of the shorter one away, and the nearer the sharper the corner
- every joint is passed in its order, within its deviation
- differences of every axis are within its velocity, acceleration and jerk, those of the length G.s
  within the group's, and the length is that of the path travelled
- the path begins and ends exactly where it should, unless it was --stopped; then the differences may
  reach the stop limits of the axes
--selftest makes ten bad traces from the good one and must find each by its own rule.
exit: 0 nothing found, 1 found something, 2 could not run
"""
import argparse
import copy
import csv
import math
import random
import sys

import machine_file

RELATIVE, ULPS = 1e-6, 4
ON_PATH = 1e-6          # mm: how far beside the path a set position may be
CORNER_SLACK = 0.01     # of the deviation: between two cycles the contour is nearer than its chord
LENGTH_SLACK = 0.03     # of a step: a chord is shorter than its arc
REST = 50               # cycles without motion that end a path
MAX_SHOWN = 40
ENDED = ("GroupStandby", "GroupDisabled")


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return math.fsum(x * y for x, y in zip(a, b))


def norm(a):
    return math.sqrt(dot(a, a))


def along(a, b, share):
    return [x + (y - x) * share for x, y in zip(a, b)]


class Line:
    def __init__(self, start, end):
        self.start, self.end = start, end
        self.length = norm(sub(end, start))

    def direction(self, length):
        return [(e - s) / self.length for s, e in zip(self.start, self.end)]

    def nearest(self, point):
        """(distance, length from the start) of the nearest point of the line"""
        way = sub(self.end, self.start)
        share = min(1.0, max(0.0, dot(sub(point, self.start), way) / dot(way, way)))
        return norm(sub(point, along(self.start, self.end, share))), share * self.length


class Arc:
    """Through three points."""

    def __init__(self, start, via, end):
        self.start, self.end = start, end
        a, b = sub(via, start), sub(end, start)
        aa, bb, ab = dot(a, a), dot(b, b), dot(a, b)
        twice = 2 * (aa * bb - ab * ab)
        share_a, share_b = bb * (aa - ab) / twice, aa * (bb - ab) / twice
        self.centre = [s + share_a * x + share_b * y for s, x, y in zip(start, a, b)]
        radial = sub(start, self.centre)
        self.radius = norm(radial)
        self.u = [x / self.radius for x in radial]
        side = sub(via, self.centre)
        side = sub(side, [dot(side, self.u) * x for x in self.u])
        self.w = [x / norm(side) for x in side]
        self.angle = self._angle(end)
        if self._angle(via) > self.angle:  # the point lies on the other side: the long way round
            self.w = [-x for x in self.w]
            self.angle = self._angle(end)
        self.length = self.radius * self.angle

    def _angle(self, point):
        radial = sub(point, self.centre)
        return math.atan2(dot(radial, self.w), dot(radial, self.u)) % (2 * math.pi)

    def direction(self, length):
        angle = length / self.radius
        return [math.cos(angle) * w - math.sin(angle) * u for u, w in zip(self.u, self.w)]

    def nearest(self, point):
        angle = self._angle(point)
        if angle > self.angle:
            angle = self.angle if angle - self.angle < 2 * math.pi - angle else 0.0
        on = [c + self.radius * (math.cos(angle) * x + math.sin(angle) * y)
              for c, x, y in zip(self.centre, self.u, self.w)]
        return norm(sub(point, on)), angle * self.radius


class Path:
    def __init__(self, file):
        self.axes, self.elements, self.corners = [], [], []  # corners[i]: behind element i
        self.start, self.corner = None, 0.0
        with open(file, encoding="utf-8") as lines:
            words = [line.partition("#")[0].split() for line in lines]
        self._read([w for w in words if w])
        self.begins = [0.0]
        for element in self.elements:
            self.begins.append(self.begins[-1] + element.length)

    def _read(self, lines):
        at = 0
        while at < len(lines):
            word, rest = lines[at][0], lines[at][1:]
            at += 1
            if word == "axes":
                self.axes = rest
            elif word == "start":
                self.start = self.here = [float(x) for x in rest]
            elif word == "corner":
                self.corner = float(rest[0])
            elif word == "repeat":
                end = lines.index(["end"], at)
                for _ in range(int(rest[0])):
                    self._read(lines[at:end])
                at = end + 1
            elif word == "line":
                self._add(Line(self.here, [float(x) for x in rest]))
            elif word == "arc":
                to = rest.index("to")
                self._add(Arc(self.here, [float(x) for x in rest[:to]], [float(x) for x in rest[to + 1:]]))
            else:
                raise machine_file.MachineError(f"'{word}' is no word of a path file")

    def _add(self, element):
        if self.elements:
            self.corners.append(self.corner)
        self.elements.append(element)
        self.here = element.end

    def reach(self, joint):
        """How far from a joint its contour may be."""
        before, after = self.elements[joint], self.elements[joint + 1]
        half = min(before.length, after.length) / 2
        turn = norm(sub(after.direction(0.0), before.direction(before.length)))
        # Where the direction goes on, a small deviation lasts long.
        return half if turn < 0.1 else min(half, 10 * self.corners[joint] / turn)


class Trace:
    def __init__(self, path, axes, group):
        with open(path, newline="", encoding="utf-8") as file:
            rows = csv.reader(file)
            header = next(rows)
            place = {name: i for i, name in enumerate(header)}
            columns = list(zip(*rows))
        self.cycles = [int(v) for v in columns[place["cycle"]]]
        self.state = list(columns[place[group + ".state"]])
        self.axes = [[float(v) for v in columns[place[axis + ".set"]]] for axis in axes]
        self.s = [float(v) for v in columns[place[group + ".s"]]]

    def point(self, row):
        return [values[row] for values in self.axes]

    def stretch(self):
        """Rows from the last at rest before the group moves to the first at rest behind."""
        # A direct motion is on no path.
        moving = [i for i, state in enumerate(self.state) if state == "GroupMoving"]
        onway = next((i for i in moving if self.s[i] != self.s[i - 1]), None)
        if onway is None:
            raise machine_file.MachineError("the group never moves on a path")
        begin, rested = onway - 1, 0
        for row in range(onway, len(self.state)):
            gone = self.s[row] != self.s[begin]
            rested = rested + 1 if gone and self.s[row] == self.s[row - 1] else 0
            if self.state[row] in ENDED or rested > REST:
                return begin, row
        return begin, len(self.state)

    def cut(self, begin, end):
        part = copy.copy(self)
        part.cycles, part.state, part.s = self.cycles[begin:end], self.state[begin:end], self.s[begin:end]
        part.axes = [values[begin:end] for values in self.axes]
        return part


class Judge:
    def __init__(self, machine, path, group, within, stopped):
        self.machine, self.path, self.within, self.stopped = machine, path, within, stopped
        limits = machine.group_limits(group)
        self.axis_limits = []
        for name in path.axes:
            axis = machine.axis(name)
            a, j = max(axis.acceleration, axis.deceleration), axis.jerk
            if stopped:
                a, j = max(a, axis.stop_deceleration), max(j, axis.stop_jerk)
            self.axis_limits.append((axis.velocity, a, j))
        # A stop is bounded by the axes alone.
        free = math.inf if stopped else 1.0
        self.path_limits = (limits["velocity"], limits["acceleration"] * free, limits["jerk"] * free)
        self.report = {}

    def differences(self, who, cycles, values, limits):
        cycle = self.machine.cycle
        points = [values[0]] * 3 + values
        difference = points
        for order, (rule, limit) in enumerate(zip(("velocity", "acceleration", "jerk"), limits), 1):
            difference = [b - a for a, b in zip(difference, difference[1:])]
            for i, d in enumerate(difference):
                largest = max(abs(v) for v in points[i:i + order + 1])
                slack = ULPS * 2 ** order * math.ulp(largest) / cycle ** order
                if abs(d) / cycle ** order > limit * (1 + RELATIVE) + slack:
                    yield (f"cycle {cycles[i + order - 3]}: {who} {rule} {d / cycle ** order:.9g}, "
                           f"limit {limit:.9g}")

    def walk(self, trace):
        """Goes along the path with the trace: (row, element, distance, length) of each."""
        at = 0
        for row in range(len(trace.cycles)):
            point = trace.point(row)
            found = [(e,) + self.path.elements[e].nearest(point)
                     for e in range(at, min(at + 3, len(self.path.elements)))]
            best = min(found, key=lambda f: f[1])
            if best[1] < found[0][1] - 1e-12:
                at = best[0]
            yield row, at, *next(f[1:] for f in found if f[0] == at)

    def geometry(self, trace):
        path = self.path
        passed = [math.inf] * len(path.corners)
        last, worst = 0.0, 0.0
        for row, element, distance, length in self.walk(trace):
            allowed = 0.0
            for joint in (element - 1, element):
                if 0 <= joint < len(path.corners):
                    corner = path.elements[joint].end
                    chord = Line(trace.point(max(row - 1, 0)), trace.point(row))
                    beside = chord.nearest(corner)[0] if chord.length > 0 else norm(sub(chord.end, corner))
                    passed[joint] = min(passed[joint], beside)
                    if norm(sub(trace.point(row), corner)) <= path.reach(joint):
                        allowed = max(allowed, path.corners[joint])
            worst = max(worst, distance if allowed == 0.0 else 0.0)
            if not distance <= allowed + ON_PATH:
                yield f"cycle {trace.cycles[row]}: {distance:.6g} off the path, allowed {allowed:.6g}"
            here = path.begins[element] + length
            if here < last - allowed - ON_PATH:
                yield f"cycle {trace.cycles[row]}: goes back from {last:.6g} to {here:.6g}"
            last = max(last, here)
        reached = len(path.elements) if not self.stopped else element
        for joint, beside in enumerate(passed[:max(0, reached - 1)]):
            allowed = path.corners[joint] * (1 + CORNER_SLACK) + 1e-4
            if beside > allowed:
                yield f"joint {joint + 1}: passed at {beside:.6g}, corner deviation {path.corners[joint]:.6g}"
        self.report["off the path elsewhere"] = worst
        self.report["largest corner deviation"] = max(passed[:max(0, reached - 1)], default=0.0)

    def ends(self, trace):
        begin, end = trace.point(0), trace.point(-1)
        if norm(sub(begin, self.path.start)) > 1e-9:
            yield f"the path begins at {begin} instead of {self.path.start}"
        if not self.stopped and norm(sub(end, self.path.elements[-1].end)) > 1e-9:
            yield f"the path ends at {end} instead of {self.path.elements[-1].end}"

    def lengths(self, trace):
        for row in range(1, len(trace.cycles)):
            step = norm(sub(trace.point(row), trace.point(row - 1)))
            said = trace.s[row] - trace.s[row - 1]
            if abs(said - step) > LENGTH_SLACK * abs(said) + 1e-9:
                yield f"cycle {trace.cycles[row]}: length {said:.9g} said, {step:.9g} gone"

    def judge(self, whole):
        for before, cycle in zip(whole.cycles, whole.cycles[1:]):
            if cycle != before + 1:
                yield f"cycle {cycle}: comes after cycle {before}"
        trace = whole.cut(*whole.stretch())
        numbers = trace.axes + [trace.s]
        bad = [(c, v) for values in numbers for c, v in zip(trace.cycles, values) if not math.isfinite(v)]
        for cycle, value in bad:
            yield f"cycle {cycle}: a position is {value}"
        if bad:
            return
        for name, values, limits in zip(self.path.axes, trace.axes, self.axis_limits):
            yield from self.differences(name, trace.cycles, values, limits)
        yield from self.differences("path", trace.cycles, trace.s, self.path_limits)
        yield from self.geometry(trace)
        yield from self.ends(trace)
        yield from self.lengths(trace)
        moved = [i for i in range(1, len(trace.cycles)) if trace.point(i) != trace.point(i - 1)]
        time = (moved[-1] - moved[0] + 1) * self.machine.cycle if moved else 0.0
        self.report["time"] = time
        if self.within is not None and time > self.within + 1e-9:
            yield f"took {time:.3f} s, allowed {self.within:.3f} s"


# ---- selftest ----

class Spoiler:
    def __init__(self, trace, judge, rng):
        self.judge, self.rng = judge, rng
        self.begin, self.end = trace.stretch()
        self.trace = trace

    def straight(self, trace):
        """A row in fast straight motion of one axis alone, and that axis."""
        rows = []
        for i in range(self.begin + 5, self.end - 60):
            steps = [abs(values[i + 1] - values[i]) for values in trace.axes]
            far = [abs(values[i + 40] - values[i]) for values in trace.axes]
            fast = max(range(len(steps)), key=lambda a: steps[a])
            others = sum(steps) - steps[fast] + sum(far) - far[fast]
            if others == 0.0 and steps[fast] > 0.5 * self.judge.axis_limits[fast][0] * self.judge.machine.cycle:
                rows.append((i, fast))
        return self.rng.choice(rows)

    def beside(self, trace):
        row, axis = self.straight(trace)
        trace.axes[(axis + 1) % len(trace.axes)][row] += 2e-5

    def cut_corner(self, trace):
        path = self.judge.path
        joint = self.rng.randrange(len(path.corners))
        corner = path.elements[joint].end
        middle = along(path.elements[joint].start, path.elements[joint + 1].end, 0.5)
        way = sub(middle, corner)
        for row in range(self.begin, self.end):
            away = norm(sub(trace.point(row), corner))
            push = 0.6 * path.corners[joint] * max(0.0, 1 - away / (6 * path.corners[joint]))
            for values, w in zip(trace.axes, way):
                values[row] += push * w / norm(way)

    def backwards(self, trace):
        row, _ = self.straight(trace)
        for values in trace.axes:
            values[row:row + 10] = values[row:row + 10][::-1]

    def too_short(self, trace):
        for values in trace.axes:
            values[self.end - 8:] = [values[self.end - 9]] * (len(values) - self.end + 8)

    def too_fast(self, trace):
        row, _ = self.straight(trace)
        for values in trace.axes + [trace.s]:
            taken = values[row:row + 40:2]
            values[row:row + 40] = taken + [values[row + 40]] * 20

    def skipped_step(self, trace):
        row, _ = self.straight(trace)
        for values in trace.axes + [trace.s]:
            del values[row]
            values.append(values[-1])

    def jerked(self, trace):
        row, axis = self.straight(trace)
        trace.axes[axis][row] += 1e-9 * self.judge.axis_limits[axis][2]

    def wrong_length(self, trace):
        row, _ = self.straight(trace)
        growth = 0.0
        for i in range(row, len(trace.s)):
            if i < row + 40:
                growth += 0.1 * (self.trace.s[i] - self.trace.s[i - 1])
            trace.s[i] += growth

    def path_jerked(self, trace):
        row, _ = self.straight(trace)
        trace.s[row] += 1e-9 * self.judge.path_limits[2]

    def no_number(self, trace):
        trace.axes[0][self.straight(trace)[0]] = math.nan

    def faults(self):
        return [("a position beside the path", "off the path", self.beside),
                ("a corner that is cut too much", "corner deviation", self.cut_corner),
                ("a stretch that is run backwards", "goes back", self.backwards),
                ("a path that ends too early", "the path ends", self.too_short),
                ("an axis that is too fast", "velocity", self.too_fast),
                ("a step that is left out", "acceleration", self.skipped_step),
                ("an axis that jerks", "jerk", self.jerked),
                ("a length that is not that of the path", "said", self.wrong_length),
                ("a path that jerks", "path jerk", self.path_jerked),
                ("a position that is no number", "is nan", self.no_number)]


def selftest(trace, judge, seed):
    spoiler = Spoiler(trace, judge, random.Random(seed))
    found = 0
    for what, words, apply in spoiler.faults():
        damaged = copy.deepcopy(trace)
        apply(damaged)
        by_rule = [p for p in judge.judge(damaged) if words in p]
        found += bool(by_rule)
        print(f"selftest: {what}: {by_rule[0] if by_rule else 'NOT FOUND'}")
    print(f"selftest: {found} of 10 bad traces found (seed {seed})")
    return 0 if found == 10 else 1


def main():
    parser = argparse.ArgumentParser(description="judges the path of a group")
    parser.add_argument("trace")
    parser.add_argument("--machine", required=True)
    parser.add_argument("--path", required=True)
    parser.add_argument("--group", default="G")
    parser.add_argument("--within", type=float)
    parser.add_argument("--stopped", action="store_true")
    parser.add_argument("--selftest", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    try:
        path = Path(options.path)
        trace = Trace(options.trace, path.axes, options.group)
        judge = Judge(machine_file.Machine(options.machine), path, options.group, options.within,
                      options.stopped)
        problems = list(judge.judge(trace))
        print(", ".join(f"{what} {value:.6g}" for what, value in judge.report.items()) +
              f", {len(problems)} faults")
        for problem in problems[:MAX_SHOWN]:
            print(problem)
        if len(problems) > MAX_SHOWN:
            print(f"… and {len(problems) - MAX_SHOWN} more")
        if problems or not options.selftest:
            return 1 if problems else 0
        return selftest(trace, judge, options.seed)
    except (OSError, ValueError, KeyError, IndexError, ZeroDivisionError,
            machine_file.MachineError) as error:
        print(f"contour: {type(error).__name__}: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
