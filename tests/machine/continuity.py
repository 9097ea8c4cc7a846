#!/usr/bin/env python3
"""Judges the set-points of a run: does anything jump that must not?

usage: continuity.py TRACE.csv --machine MACHINE.xml [--limits "X velocity=600 jerk=1e5"] [--selftest]
       continuity.py --selftest --machine MACHINE.xml      on a made-up trace of the first axis

For every axis of the trace, in every stretch of cycles in which the drive is in Operation enabled and
in CSP, and the axis neither Disabled nor Homing:
- first, second and third differences of X.set over T, T^2, T^3 are within velocity, the largest of
  acceleration, deceleration and stopDeceleration, and the larger of jerk and stopJerk; allowed on top:
  1e-6 of the limit and 4 ulp of the position over T^n. The axis is at rest where a stretch begins; when
  it begins out of Disabled or Homing, its first row may be the first of a motion already.
- X.target is X.set in drive counts, within one count. Where the counts' origin lies is not in the
  trace; within a stretch it must be one and the same.
- where the axis has just been enabled, set-point and actual position are the same count.
Everywhere: no cycle is missing, and every set-point and position is a finite number.

--selftest makes ten bad traces from the good one and must find each by its own rule.
exit: 0 nothing found, 1 found something, 2 could not run
"""
import argparse
import bisect
import csv
import math
import random
import sys

import machine_file

RELATIVE = 1e-6
ULPS = 4
OPERATION_ENABLED, STATE_MASK, CSP = 0x0027, 0x006F, 8
RESTING_STATES = ("Disabled", "Homing")
NUMBERS = ("set", "setVel", "setAcc", "target", "actual", "actualVel", "lag")
MAX_SHOWN = 40


class Trace:
    """cycle numbers and, for each axis, its columns as lists."""

    def __init__(self, cycles, axes):
        self.cycles = cycles
        self.axes = axes

    def clone(self):
        return Trace(list(self.cycles), {name: {column: list(values) for column, values in axis.items()}
                                         for name, axis in self.axes.items()})


def read_trace(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        header = next(rows, None)
        if not header or header[:2] != ["cycle", "t_ns"]:
            raise machine_file.MachineError(f"{path}: the first columns are not cycle, t_ns")
        columns = list(zip(*rows)) or [[] for _ in header]
    axes = {}
    for name, values in zip(header[2:], columns[2:]):
        axis, _, quantity = name.rpartition(".")
        if axis + ".set" not in header:
            continue  # a group: its axes are judged
        values = list(values)
        if quantity in NUMBERS:
            values = [float(v) for v in values]
        elif quantity in ("statusword", "mode"):
            values = [int(v) for v in values]
        axes.setdefault(axis, {})[quantity] = values
    return Trace([int(v) for v in columns[0]], axes)


class Limits:
    def __init__(self, axis, override):
        self.order = [override.get("velocity", axis.velocity),
                      override.get("acceleration",
                                   max(axis.acceleration, axis.deceleration, axis.stop_deceleration)),
                      override.get("jerk", max(axis.jerk, axis.stop_jerk))]


RULES = ("velocity", "acceleration", "jerk")


def stretches(axis):
    """(first row, row behind the last) of each stretch in which the axis owns the motion."""
    begin = None
    for row, (state, word, mode) in enumerate(zip(axis["state"], axis["statusword"], axis["mode"])):
        active = (word & STATE_MASK == OPERATION_ENABLED and mode == CSP and
                  state not in RESTING_STATES)
        if active and begin is None:
            begin = row
        if not active and begin is not None:
            yield begin, row
            begin = None
    if begin is not None:
        yield begin, len(axis["state"])


def unfolded(values, period):
    """A modulo position without its jumps by one period."""
    if period is None:
        return values
    out, turns = [], 0.0
    for i, value in enumerate(values):
        if i:
            turns -= round((value - values[i - 1]) / period) * period
        out.append(value + turns)
    return out


def resting_place(before, values, cycle_time, limits):
    """Where the axis rested before the stretch; `before` is the set position one row earlier.

    A motion that begins in the first row has come J T^3 / 6 by then, and 7 times as far in the next
    cycle; homing may have moved the origin at the same moment, so the row before does not tell the place.
    """
    if before is None or before == values[0] or len(values) < 2:
        return values[0]
    step, most = values[1] - values[0], limits.order[2] * cycle_time ** 3
    begins = most < abs(step) <= most * 7 / 6 * (1 + RELATIVE) + ULPS * math.ulp(values[1])
    return values[0] - step / 7 if begins else values[0]


def check_differences(name, cycles, values, cycle_time, limits, before=None):
    """Divided differences against the limits; `values` begin at rest."""
    rest = [resting_place(before, values, cycle_time, limits)] * 3
    points = rest + values
    difference = points
    for order, (rule, limit) in enumerate(zip(RULES, limits.order), 1):
        difference = [b - a for a, b in zip(difference, difference[1:])]
        scale = cycle_time ** order
        for i, d in enumerate(difference):
            rate = abs(d) / scale
            if rate <= limit:
                continue
            last = i + order - len(rest)  # the row that completes this difference
            largest = max(abs(v) for v in points[i:i + order + 1])
            if rate > limit * (1 + RELATIVE) + ULPS * math.ulp(largest) / scale:
                yield (f"cycle {cycles[last]}: {name}: {rule} {d / scale:.9g} of the set position, "
                       f"limit {limit:.9g}")


def common_origin(deviations):
    """The origin that explains most targets as rounded set positions (window of one count)."""
    ordered = sorted(deviations)
    best, origin = 0, ordered[0]
    for i, low in enumerate(ordered):
        end = bisect.bisect_right(ordered, low + 1.0 + 1e-6)
        if end - i > best:
            best, origin = end - i, (low + ordered[end - 1]) / 2
    return origin


def check_targets(name, cycles, sets, targets, counts_per_unit):
    deviations = [target - value * counts_per_unit for value, target in zip(sets, targets)]
    origin = common_origin(deviations)
    for cycle, deviation in zip(cycles, deviations):
        if abs(deviation - origin) > 1.0 + 1e-6:
            yield (f"cycle {cycle}: {name}: target is {deviation - origin:.3f} counts away from the "
                   f"set position")


def check_axis(name, trace, cycle_time, axis, limits):
    columns = trace.axes[name]
    factor = float(axis.counts_per_unit)
    for begin, end in stretches(columns):
        cycles = trace.cycles[begin:end]
        sets = unfolded(columns["set"][begin:end], axis.modulo)
        if not all(math.isfinite(v) for v in sets + columns["target"][begin:end]):
            continue  # already reported; a difference to NaN says nothing
        before = columns["set"][begin - 1] if begin > 0 else None
        yield from check_differences(name, cycles, sets, cycle_time, limits, before)
        yield from check_targets(name, cycles, sets, columns["target"][begin:end], factor)
        enabled = begin > 0 and columns["statusword"][begin - 1] & STATE_MASK != OPERATION_ENABLED
        if begin > 0 and (enabled or columns["state"][begin - 1] == "Disabled"):
            rest = resting_place(before, sets, cycle_time, limits)
            apart = (rest - columns["actual"][begin]) * factor
            if abs(apart) > 0.5:
                yield (f"cycle {cycles[0]}: {name}: first target after enabling is {apart:.3f} counts "
                       f"away from the actual position")


def judge(trace, machine, override):
    """Yields one sentence for each fault."""
    for before, cycle in zip(trace.cycles, trace.cycles[1:]):
        if cycle != before + 1:
            yield f"cycle {cycle}: comes after cycle {before}"
    for name, columns in trace.axes.items():
        for quantity in NUMBERS:
            for cycle, value in zip(trace.cycles, columns[quantity]):
                if not math.isfinite(value):
                    yield f"cycle {cycle}: {name}.{quantity} is {value}"
        axis = machine.axis(name)
        yield from check_axis(name, trace, machine.cycle, axis, Limits(axis, override.get(name, {})))


# ---- selftest ----

def jerk_path(jerks, cycle_time):
    """Positions of a path that begins at rest, one constant jerk for each cycle."""
    s = v = a = 0.0
    path = []
    for j in jerks:
        s += cycle_time * (v + cycle_time * (a / 2 + cycle_time * j / 6))
        v += cycle_time * (a + cycle_time * j / 2)
        a += cycle_time * j
        path.append(s)
    return path


def pulse(height, cycles, rest):
    """Jerks that reach an acceleration, hold it for `rest` cycles and take it away again."""
    return [height] * cycles + [0.0] * rest + [-height] * cycles


def over_limit(order, limits, cycle_time):
    """Jerks of a motion from rest to rest that passes one limit, and only that one, by 0.1 %."""
    velocity, acceleration, jerk = limits.order
    beyond = 1.001
    if order == 3:
        there = pulse(jerk * beyond, 3, 0)
    elif order == 2:
        steps = math.ceil(acceleration * beyond / (jerk * cycle_time))
        there = pulse(acceleration * beyond / (steps * cycle_time), steps, 2)
    else:
        steps = math.ceil(0.9 * acceleration / (jerk * cycle_time))
        top = velocity * beyond / cycle_time
        hold = max(0, math.ceil(top / (0.9 * acceleration)) - steps)
        # velocity = height * steps * (steps + hold) * T^2
        there = pulse(top / (steps * (steps + hold) * cycle_time), steps, hold)
    return there + [0.0] * 3 + [-j for j in there]


class Spoiler:
    """Makes bad traces out of a good one; `name` is the axis that moves most."""

    def __init__(self, trace, machine, override, rng):
        self.trace, self.rng, self.cycle_time = trace, rng, machine.cycle
        self.name = max(trace.axes, key=lambda n: self._travel(trace.axes[n]))
        self.axis = machine.axis(self.name)
        self.limits = Limits(self.axis, override.get(self.name, {}))
        self.factor = float(self.axis.counts_per_unit)

    @staticmethod
    def _travel(columns):
        return sum(abs(columns["set"][i] - columns["set"][i - 1])
                   for b, e in stretches(columns) for i in range(b + 1, e))

    def _moving(self, columns):
        """A row in motion with the end of its stretch: one of the fastest twentieth."""
        rows = [(abs(columns["set"][i] - columns["set"][i - 1]), i, end)
                for begin, end in stretches(columns) for i in range(begin + 1, end - 1)]
        rows.sort(reverse=True)
        _, row, end = self.rng.choice(rows[:max(1, len(rows) // 20)])
        return row, end

    def _shift(self, columns, row, offset):
        columns["set"][row] += offset
        columns["target"][row] += round(offset * self.factor)

    def step(self, trace, columns):
        row, end = self._moving(columns)
        for i in range(row, end):
            self._shift(columns, i, self.limits.order[0] * self.cycle_time * 2)

    def velocity_jump(self, trace, columns):
        row, end = self._moving(columns)
        for i in range(row, end):
            self._shift(columns, i, 0.1 * self.limits.order[0] * self.cycle_time * (i - row))

    def insert(self, order):
        def apply(trace, columns):
            rows = [(i, end) for begin, end in stretches(columns) for i in range(begin + 4, end)
                    if len(set(columns["set"][i - 4:i + 1])) == 1]
            row, end = self.rng.choice(rows)
            path = jerk_path(over_limit(order, self.limits, self.cycle_time), self.cycle_time)
            for other in trace.axes.values():
                for values in other.values():
                    values[row + 1:row + 1] = [values[row]] * len(path)
            trace.cycles[:] = range(trace.cycles[0], trace.cycles[0] + len(trace.cycles) + len(path))
            for i in range(row + 1, end + len(path)):
                self._shift(columns, i, path[min(i - row, len(path)) - 1])
        return apply

    def target_off(self, trace, columns):
        columns["target"][self._moving(columns)[0]] += self.rng.choice((-2, 2))

    def target_repeated(self, trace, columns):
        row = self._moving(columns)[0]
        columns["target"][row] = columns["target"][row - 1]

    def not_a_number(self, trace, columns):
        columns["set"][self._moving(columns)[0]] = math.nan

    def first_target(self, trace, columns):
        begin = next(b for b, _ in stretches(columns) if b > 0)
        columns["actual"][begin] += 3 / abs(self.factor)

    def missing_cycle(self, trace, columns):
        row = self.rng.randrange(1, len(trace.cycles) - 1)
        del trace.cycles[row]
        for other in trace.axes.values():
            for values in other.values():
                del values[row]

    def faults(self):
        """(what is wrong, words of the rule that must find it, how it is made)"""
        return [("a step of the set position", "velocity", self.step),
                ("a jump of the velocity", "acceleration", self.velocity_jump),
                ("velocity 0.1 % over the limit", "velocity", self.insert(1)),
                ("acceleration 0.1 % over the limit", "acceleration", self.insert(2)),
                ("jerk 0.1 % over the limit", "jerk", self.insert(3)),
                ("a target two counts off", "counts away from the set", self.target_off),
                ("a target sent twice", "counts away from the set", self.target_repeated),
                ("a set position that is no number", "is nan", self.not_a_number),
                ("a first target beside the actual position", "first target", self.first_target),
                ("a missing cycle", "comes after cycle", self.missing_cycle)]


def selftest(trace, machine, override, seed):
    clean = list(judge(trace, machine, override))
    if clean:
        print("selftest: the trace itself is not clean")
        return report(clean)
    spoiler = Spoiler(trace, machine, override, random.Random(seed))
    found = 0
    faults = spoiler.faults()
    for what, words, apply in faults:
        damaged = trace.clone()
        apply(damaged, damaged.axes[spoiler.name])
        by_rule = [p for p in judge(damaged, machine, override) if words in p]
        found += bool(by_rule)
        print(f"selftest: {what}: {by_rule[0] if by_rule else 'NOT FOUND'}")
    print(f"selftest: {found} of {len(faults)} bad traces found on axis {spoiler.name} (seed {seed})")
    return 0 if found == len(faults) and starts_are_judged(machine) else 1


def starts_are_judged(machine):
    """A motion that begins in the first cycle after a state of rest is good at full jerk and not beyond."""
    right = True
    for state in RESTING_STATES:
        good = list(judge(abrupt_start(machine, state), machine, {}))
        bad = [p for p in judge(abrupt_start(machine, state, 1.001), machine, {}) if "jerk" in p]
        print(f"selftest: a motion straight out of {state}: {good[0] if good else 'clean'}; with 0.1 % more "
              f"jerk: {bad[0] if bad else 'NOT FOUND'}")
        right = right and not good and bool(bad)
    return right


def abrupt_start(machine, out_of, jerk_part=1.0):
    """The first axis of the machine leaves a state of rest with the first cycle of a motion at full jerk,
    and homing has moved its origin in that same cycle."""
    trace = made_up_trace(machine)
    name = next(iter(machine.axes))
    columns = trace.axes[name]
    limits = Limits(machine.axis(name), {})
    factor = float(machine.axis(name).counts_per_unit)
    jerks = over_limit(3, limits, machine.cycle)
    jerks = [j / 1.001 * jerk_part for j in jerks]
    path = jerk_path(jerks, machine.cycle)
    begin = columns["state"].index("DiscreteMotion")
    origin = 0.0 if out_of == "Homing" else columns["set"][begin]
    rows = range(begin, len(columns["set"]))
    for i in rows:
        columns["set"][i] = origin + path[min(i - begin, len(path) - 1)]
        columns["target"][i] = float(round(columns["set"][i] * factor))
        columns["actual"][i] = columns["set"][i - 1] if i > begin else origin
    if out_of == "Homing":
        for i in range(begin - 10, begin):
            columns["state"][i] = "Homing"
            columns["statusword"][i] = 0x1637
    return trace


def made_up_trace(machine):
    """The first axis of the machine: off, enabled, there and back at the limits, off."""
    name = next(iter(machine.axes))
    axis = machine.axis(name)
    limits = Limits(axis, {})
    factor = float(axis.counts_per_unit)
    steps = math.ceil(0.8 * axis.acceleration / (axis.jerk * machine.cycle))
    jerk = min(axis.jerk, 0.8 * axis.acceleration / (steps * machine.cycle))
    hold = max(0, math.floor(0.9 * limits.order[0] / (jerk * steps * machine.cycle ** 2)) - steps)
    there = pulse(jerk, steps, hold) + [0.0] * 200 + pulse(-jerk, steps, hold)
    jerks = [0.0] * 50 + there + [0.0] * 50 + [-j for j in there] + [0.0] * 50
    start = 4711
    sets = [start / factor] * 20 + [start / factor + s for s in jerk_path(jerks, machine.cycle)]
    sets += [sets[-1]] * 20
    running = range(20, 20 + len(jerks))
    columns = {"set": sets, "actual": list(sets), "target": [float(round(s * factor)) for s in sets],
               "state": ["DiscreteMotion" if i in running else "Disabled" for i in range(len(sets))],
               "statusword": [0x1637 if i in running else 0x0650 for i in range(len(sets))]}
    columns["mode"] = [CSP] * len(sets)
    for other in ("setVel", "setAcc", "actualVel", "lag"):
        columns[other] = [0.0] * len(sets)
    return Trace(list(range(1, len(sets) + 1)), {name: columns})


def report(problems):
    for problem in problems[:MAX_SHOWN]:
        print(problem)
    if len(problems) > MAX_SHOWN:
        print(f"… and {len(problems) - MAX_SHOWN} more")
    return 1 if problems else 0


def read_limits(texts):
    """'X velocity=600 jerk=1e5' -> {'X': {'velocity': 600.0, …}}"""
    override = {}
    for text in texts:
        name, *pairs = text.split()
        for pair in pairs:
            rule, _, value = pair.partition("=")
            if rule not in RULES:
                raise machine_file.MachineError(f"'{rule}' is no limit; allowed: {', '.join(RULES)}")
            override.setdefault(name, {})[rule] = float(value)
    return override


def main():
    parser = argparse.ArgumentParser(description="judges the set positions of a trace")
    parser.add_argument("trace", nargs="?")
    parser.add_argument("--machine", required=True)
    parser.add_argument("--limits", action="append", default=[], help='"X velocity=600 jerk=1e5"')
    parser.add_argument("--selftest", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    if options.trace is None and not options.selftest:
        parser.error("a trace is needed")
    try:
        machine = machine_file.Machine(options.machine)
        override = read_limits(options.limits)
        trace = read_trace(options.trace) if options.trace else made_up_trace(machine)
        if options.selftest:
            return selftest(trace, machine, override, options.seed)
        problems = list(judge(trace, machine, override))
    except (OSError, ValueError, KeyError, SyntaxError, machine_file.MachineError) as error:
        print(f"continuity: {type(error).__name__}: {error}", file=sys.stderr)
        return 2
    stretch_count = sum(1 for axis in trace.axes.values() for _ in stretches(axis))
    print(f"{len(trace.cycles)} cycles, {len(trace.axes)} axes, {stretch_count} stretches of motion, "
          f"{len(problems)} faults")
    if stretch_count == 0:
        problems.append("no axis was ever enabled: nothing was checked")
    return report(problems)


if __name__ == "__main__":
    sys.exit(main())
