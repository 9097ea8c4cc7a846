#!/usr/bin/env python3
"""Tests of the judges themselves: what they read, and what they must not let pass.

usage: judges_test.py SAMPLE_CAPTURE_PROGRAM
"""
import fractions
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import capture
import continuity
import machine_file
import working_counters

HERE = pathlib.Path(__file__).parent
MACHINE = HERE / "sample" / "machine.xml"


class ReadingTheMachineFile(unittest.TestCase):
    def test_numbers_are_exact_and_carry_their_unit(self):
        self.assertEqual(machine_file.number("0.1 mm/s^2"), (fractions.Fraction(1, 10), "mm/s^2"))
        self.assertEqual(machine_file.number("-3"), (fractions.Fraction(-3), ""))
        self.assertEqual(machine_file.ratio("3/7"), fractions.Fraction(3, 7))

    def test_what_is_no_number_is_refused(self):
        for text in ("", "mm", "1,5 mm", "nan", "0x10 mm"):
            with self.assertRaises(machine_file.MachineError, msg=text):
                machine_file.number(text)

    def test_units_of_motion_become_those_of_the_axis(self):
        for text, value in (("500 mm/s", 500), ("0.5 m/s", 500), ("3 m/min", 50), ("2 m/s^2", 2000),
                            ("2 m/s\u00b2", 2000), ("60 rpm", 360), ("1 mm/s^3", 1), ("90 \u00b0/s", 90),
                            ("360 deg", 360), ("250 um", fractions.Fraction(1, 4))):
            self.assertEqual(machine_file.motion(text), value, text)
        for text in ("5", "5 s", "5 kg/s", "5 mm/h", "5 mm/s^4"):
            with self.assertRaises(machine_file.MachineError, msg=text):
                machine_file.motion(text)

    def test_scaling_and_limits_of_an_axis(self):
        axis = machine_file.Machine(MACHINE).axis("X")
        self.assertEqual(axis.counts_per_unit, 500)
        self.assertEqual((axis.velocity, axis.jerk, axis.stop_jerk), (500.0, 80000.0, 160000.0))

    def test_devices_take_part_as_their_description_says(self):
        slaves = machine_file.Machine(MACHINE).slaves
        self.assertEqual([(s.outputs, s.inputs) for s in slaves], [(True, True)] * 3)


class JudgingATrace(unittest.TestCase):
    def setUp(self):
        self.machine = machine_file.Machine(MACHINE)
        self.trace = continuity.made_up_trace(self.machine)

    def faults(self):
        return list(continuity.judge(self.trace, self.machine, {}))

    def test_a_good_trace_has_no_fault(self):
        self.assertEqual(self.faults(), [])

    def test_a_csv_file_is_read_as_it_was_written(self):
        columns = self.trace.axes["X"]
        order = ["state", "set", "setVel", "setAcc", "target", "actual", "actualVel", "lag", "statusword",
                 "mode"]
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
            file.write("cycle,t_ns," + ",".join(f"X.{c}" for c in order) + "\n")
            for i, cycle in enumerate(self.trace.cycles):
                file.write(f"{cycle},{cycle * 1000000}," +
                           ",".join(str(columns[c][i]) for c in order) + "\n")
            file.flush()
            read = continuity.read_trace(file.name)
        self.assertEqual(read.cycles, self.trace.cycles)
        self.assertEqual(read.axes["X"], columns)

    def test_retaking_the_position_while_off_or_homing_is_allowed(self):
        columns = self.trace.axes["X"]
        for i in range(30, 40):
            columns["state"][i] = "Homing"
        for i in range(35, len(columns["set"])):
            for name, offset in (("set", 300.0), ("actual", 300.0)):
                columns[name][i] += offset
        self.assertEqual(self.faults(), [])

    def test_a_modulo_axis_may_fold(self):
        columns = self.trace.axes["X"]
        self.machine.axes["X"].find("Scaling").set("modulo", "50 mm")
        columns["set"] = [math.fmod(v, 50.0) for v in columns["set"]]
        columns["actual"] = list(columns["set"])
        self.assertEqual(self.faults(), [])

    def test_a_motion_may_begin_in_the_first_row_behind_off_or_homing(self):
        for state in continuity.RESTING_STATES:
            good = continuity.abrupt_start(self.machine, state)
            self.assertEqual(list(continuity.judge(good, self.machine, {})), [], state)
            too_hard = continuity.abrupt_start(self.machine, state, 1.001)
            self.assertTrue(list(continuity.judge(too_hard, self.machine, {})), state)

    def test_a_jump_between_the_last_row_off_and_motion_counts(self):
        columns = self.trace.axes["X"]
        for name, offset in (("set", 3.0), ("actual", 3.0), ("target", 1500.0)):
            columns[name][20] += offset
        self.assertTrue(self.faults())


class JudgingACapture(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name) / "sample.pcapng"
        subprocess.run([sys.argv[1], str(cls.path)], check=True)
        cls.slaves = machine_file.Machine(MACHINE).slaves
        problems = []
        cls.frames = capture.read(cls.path, problems)
        assert not problems, problems

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def judge(self, frames, slaves=None):
        problems = []
        working_counters.judge(frames, slaves or self.slaves, problems)
        return problems

    def test_every_frame_is_read(self):
        self.assertEqual(len(self.frames), 200)
        self.assertEqual(self.judge(self.frames), [])

    def test_a_machine_with_another_number_of_devices_differs(self):
        self.assertTrue(self.judge(self.frames, self.slaves[:2]))

    def test_a_machine_with_a_device_without_inputs_differs(self):
        slaves = self.slaves[:2] + [machine_file.Slave("z", True, False)]
        self.assertTrue(self.judge(self.frames, slaves))

    def test_every_certain_counter_is_compared(self):
        certain = set()
        working_counters.judge(self.frames, self.slaves, [], certain)
        missed = []
        for frame_index, frame in enumerate(self.frames):
            for place in range(len(frame.datagrams)):
                if (frame.number, place) not in certain:
                    continue
                damaged = [f.clone() for f in self.frames]
                damaged[frame_index].datagrams[place].counter += 1
                if not self.judge(damaged):
                    missed.append((frame.number, place))
        self.assertEqual(missed, [])
        self.assertGreater(len(certain), 290)

    def test_a_cut_file_is_refused(self):
        cut = self.path.with_suffix(".cut")
        cut.write_bytes(self.path.read_bytes()[:-6])
        with self.assertRaises(capture.CaptureError):
            list(capture.packets(cut))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
