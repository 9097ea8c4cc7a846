#!/usr/bin/env python3
"""Judges the EtherCAT frames of a run from outside.

usage: working_counters.py CAPTURE.pcapng MACHINE.xml [--selftest] [--seed N]

tshark takes the frames apart; this script computes the working counter of every returned datagram from
the machine file (which devices, with outputs and inputs or not) and from what the master did to them
earlier in the same capture: station addresses, SyncManagers, FMMUs, requested and reported states.
It also wants every frame twice (sent, returned) with the same datagrams, and none malformed.

Where a device may rightly refuse, both answers are right: a mailbox that is full or empty (0 or 1), and
process data of a device that has not yet reported SAFEOP.

--selftest puts ten faults into copies of the capture's decoded frames and must find each.
exit: 0 nothing found, 1 differences (or a fault not found), 2 could not run
"""
import argparse
import collections
import random
import struct
import sys

import capture
from capture import (APRD, APRW, APWR, ARMW, BRD, BRW, BWR, FPRD, FPRW, FPWR, FRMW, LOGICAL, LRD, LRW,
                     LWR, NOP)
import machine_file

REG_STATION, REG_AL_CONTROL, REG_AL_STATUS = 0x0010, 0x0120, 0x0130
REG_FMMU, REG_SYNC_MANAGER, PROCESS_RAM = 0x0600, 0x0800, 0x1000
FMMU_BYTES, SYNC_MANAGER_BYTES = 16 * 16, 8 * 16
PASSES_EVERY_SLAVE = (APRD, APWR, APRW, BRD, BWR, BRW, ARMW)
READS = (APRD, APRW, FPRD, FPRW, BRD, BRW)
WRITES = (APWR, APRW, FPWR, FPRW, BWR, BRW)
SAFEOP, OP = 4, 8
MAX_SHOWN = 40


class Device:
    """One slave controller as far as the master has told it something in this capture."""

    def __init__(self, position, slave):
        self.position = position
        self.slave = slave
        self.station = None
        self.fmmu = bytearray(FMMU_BYTES)
        self.sync_manager = bytearray(SYNC_MANAGER_BYTES)
        self.running = False   # it has reported SAFEOP or OP and was not sent below since

    def write(self, address, data):
        for start, memory in ((REG_FMMU, self.fmmu), (REG_SYNC_MANAGER, self.sync_manager)):
            low = max(start, address)
            high = min(start + len(memory), address + len(data))
            if low < high:
                memory[low - start:high - start] = data[low - address:high - address]
        if address <= REG_STATION and address + len(data) >= REG_STATION + 2:
            self.station = struct.unpack_from("<H", data, REG_STATION - address)[0]
        if address == REG_AL_CONTROL and data and (data[0] & 0x0F) not in (SAFEOP, OP):
            self.running = False

    def mailbox_at(self, address, length):
        """Whether the range touches an active SyncManager in mailbox mode."""
        for at in range(0, SYNC_MANAGER_BYTES, 8):
            start, size, control, _, active = struct.unpack_from("<HHBBB", self.sync_manager, at)
            if active & 1 and size and control & 3 == 2:
                if address < start + size and start < address + length:
                    return True
        return False

    def mapped(self, logical, length):
        """(reads, writes): does an active FMMU of that type overlap the window?"""
        reads = writes = False
        for at in range(0, FMMU_BYTES, 16):
            start, size = struct.unpack_from("<IH", self.fmmu, at)
            kind, active = self.fmmu[at + 11], self.fmmu[at + 12]
            if active & 1 and size and logical < start + size and start < logical + length:
                reads = reads or bool(kind & 1)
                writes = writes or bool(kind & 2)
        return reads, writes


class Segment:
    """Follows the capture and says which working counters a returned datagram may carry."""

    def __init__(self, slaves):
        self.devices = [Device(i, slave) for i, slave in enumerate(slaves)]

    def addressed(self, command, adp):
        if command in (APRD, APWR, APRW):
            return [d for d in self.devices if (adp + d.position) & 0xFFFF == 0]
        if command in (FPRD, FPWR, FPRW):
            return [d for d in self.devices if d.station == adp]
        if command in (BRD, BWR, BRW):
            return self.devices
        return []

    def expected(self, sent):
        """Set of right working counters for a datagram as it was sent."""
        if sent.command == NOP:
            return {0}
        if sent.command in (ARMW, FRMW):
            return {len(self.devices)}
        if sent.command in LOGICAL:
            return self._expected_logical(sent)
        one = (1 if sent.command in READS else 0) + (2 if sent.command in (APRW, FPRW, BRW) else
                                                     1 if sent.command in WRITES else 0)
        counters = {0}
        for device in self.addressed(sent.command, sent.address[0]):
            refusable = (sent.address[1] >= PROCESS_RAM and
                         device.mailbox_at(sent.address[1], len(sent.data)))
            counters = {c + one for c in counters} | (counters if refusable else set())
        return counters

    def _expected_logical(self, sent):
        counters = {0}
        for device in self.devices:
            reads, writes = device.mapped(sent.address[0], len(sent.data))
            if sent.command == LRW:
                parts = [1] * reads + [2] * writes
            else:
                parts = [1] * (reads if sent.command == LRD else writes)
            for part in parts:
                counted = {c + part for c in counters}
                counters = counted if device.running else counted | counters
        return counters

    def machine_expects(self, sent):
        """With every device running: what the machine file alone says, or None."""
        if sent.command not in LOGICAL or not all(d.running for d in self.devices):
            return None
        mapped = [d.mapped(sent.address[0], len(sent.data)) for d in self.devices]
        if not all(reads >= d.slave.inputs and writes >= d.slave.outputs
                   for d, (reads, writes) in zip(self.devices, mapped)):
            return None  # a window of some devices only, or of mailbox states
        return {LRW: sum(d.slave.inputs + 2 * d.slave.outputs for d in self.devices),
                LRD: sum(d.slave.inputs for d in self.devices),
                LWR: sum(d.slave.outputs for d in self.devices)}[sent.command]

    def learn(self, sent, returned):
        """Takes over what this datagram did to the devices."""
        if returned.counter == 0 or sent.command in LOGICAL:
            return
        devices = self.addressed(sent.command, sent.address[0])
        if sent.command in WRITES:
            for device in devices:
                device.write(sent.address[1], sent.data)
        if sent.command in (APRD, FPRD, BRD) and sent.address[1] == REG_AL_STATUS and returned.data:
            # A broadcast gives the OR of all states: 4, 8 and 12 mean that each is in SAFEOP or OP.
            state = returned.data[0] & 0x0F
            running = (SAFEOP, OP) if sent.command != BRD else (SAFEOP, OP, SAFEOP | OP)
            for device in devices:
                if state in running:
                    device.running = True
                elif sent.command != BRD:
                    device.running = False


def check_pair(segment, frame, answer, problems, certain):
    """One sent frame and its return; `segment` learns from them."""
    if [d.command for d in frame.datagrams] != [d.command for d in answer.datagrams]:
        problems.append(f"frame {answer.number}: datagrams differ from those sent in {frame.number}")
        return 0
    for place, (sent, back) in enumerate(zip(frame.datagrams, answer.datagrams)):
        address = sent.address
        if sent.command in PASSES_EVERY_SLAVE:
            address = ((address[0] + len(segment.devices)) & 0xFFFF, address[1])
        if sent.index != back.index or address != back.address or len(sent.data) != len(back.data):
            problems.append(f"frame {answer.number}: {back} is not the return of {sent}")
            continue
        right = segment.expected(sent)
        by_machine = segment.machine_expects(sent)
        if by_machine is not None:
            right = right & {by_machine}
        if len(right) == 1:
            certain.add((answer.number, place))
        if back.counter not in right:
            wanted = " or ".join(str(c) for c in sorted(right)) or f"{by_machine} by the machine file"
            problems.append(f"frame {answer.number}: {sent}: working counter {back.counter}, "
                            f"right is {wanted}")
        if sent.counter != 0:
            problems.append(f"frame {frame.number}: {sent} was sent with working counter {sent.counter}")
        segment.learn(sent, back)
    return len(frame.datagrams)


def judge(frames, slaves, problems, certain=None):
    """Returns (frames sent, datagrams compared); every difference goes to `problems`.

    `certain` collects (frame number, place) of the counters for which only one value is right."""
    certain = set() if certain is None else certain
    segment = Segment(slaves)
    waiting = collections.deque()
    sent = compared = 0
    for frame in frames:
        if frame.malformed:
            problems.append(f"frame {frame.number}: malformed")
        if frame.returned() != frame.source_seen:
            problems.append(f"frame {frame.number}: the source address says "
                            f"{'returned' if frame.source_seen else 'sent'}, the direction does not")
        if not frame.returned():
            sent += 1
            waiting.append(frame)
            continue
        indices = [d.index for d in frame.datagrams]
        while waiting and [d.index for d in waiting[0].datagrams] != indices:
            problems.append(f"frame {waiting.popleft().number}: never came back")
        if not waiting:
            problems.append(f"frame {frame.number}: came back without having been sent")
            continue
        compared += check_pair(segment, waiting.popleft(), frame, problems, certain)
    problems.extend(f"frame {frame.number}: never came back" for frame in waiting)
    if sent == 0:
        problems.append("no frame was sent")
    return sent, compared


def corruptions(rng, certain):
    """Ten ways in which a capture can be wrong; each changes `frames` in place.

    Counters are changed only where one value alone is right: nobody can tell a mailbox that was full
    from one that was made to look so."""
    def pick(frames, wanted):
        """A returned datagram past the first quarter of the capture, where the counter is certain."""
        return rng.choice([d for i, f in enumerate(frames) if f.returned() and i > len(frames) // 4
                           for place, d in enumerate(f.datagrams)
                           if wanted(d) and (f.number, place) in certain])

    def counter(commands, change):
        def apply(frames):
            datagram = pick(frames, lambda d: d.command in commands)
            datagram.counter = change(datagram.counter)
        return apply

    def any_frame(frames, returned):
        return rng.choice([i for i, f in enumerate(frames) if f.returned() == returned and
                           i > len(frames) // 4])

    def other_index(frames):
        datagram = pick(frames, lambda d: True)
        datagram.index = (datagram.index + 1) & 0xFF

    def other_register(frames):
        datagram = pick(frames, lambda d: d.command not in LOGICAL)
        datagram.address = (datagram.address[0], datagram.address[1] ^ 0x0002)

    def other_command(frames):
        datagram = pick(frames, lambda d: d.command == LRW)
        datagram.command = LRD

    def mark_malformed(frames):
        frames[any_frame(frames, True)].malformed = True

    return [
        ("process data one short", counter((LRW,), lambda c: c - 1)),
        ("process data one too many", counter((LRW,), lambda c: c + 1)),
        ("process data of nobody", counter((LRW,), lambda c: 0)),
        ("broadcast one short", counter((BRD, BWR), lambda c: c - 1)),
        ("clock distribution one too many", counter((FRMW, ARMW), lambda c: c + 1)),
        ("another index", other_index),
        ("another register", other_register),
        ("another command", other_command),
        ("a frame that never came back", lambda frames: frames.pop(any_frame(frames, True))),
        ("a malformed frame", mark_malformed),
    ]


def selftest(frames, slaves, seed):
    rng = random.Random(seed)
    clean, certain = [], set()
    judge(frames, slaves, clean, certain)
    if clean:
        print("selftest: the capture itself is not clean")
        return report(clean)
    found = 0
    faults = corruptions(rng, certain)
    for name, apply in faults:
        damaged = [frame.clone() for frame in frames]
        apply(damaged)
        problems = []
        judge(damaged, slaves, problems)
        found += bool(problems)
        print(f"selftest: {name}: {problems[0] if problems else 'NOT FOUND'}")
    print(f"selftest: {found} of {len(faults)} faults found (seed {seed})")
    return 0 if found == len(faults) else 1


def report(problems):
    for problem in problems[:MAX_SHOWN]:
        print(problem)
    if len(problems) > MAX_SHOWN:
        print(f"… and {len(problems) - MAX_SHOWN} more")
    return 1 if problems else 0


def main():
    parser = argparse.ArgumentParser(description="judges working counters of a capture")
    parser.add_argument("capture")
    parser.add_argument("machine")
    parser.add_argument("--selftest", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    problems = []
    try:
        slaves = machine_file.Machine(options.machine).slaves
        frames = capture.read(options.capture, problems)
    except (OSError, SyntaxError, capture.CaptureError, machine_file.MachineError) as error:
        print(f"working_counters: {error}", file=sys.stderr)
        return 2
    if options.selftest:
        return report(problems) or selftest(frames, slaves, options.seed)
    sent, compared = judge(frames, slaves, problems)
    print(f"{len(frames)} frames, {sent} sent, {compared} working counters compared, "
          f"{len(problems)} differences")
    return report(problems)


if __name__ == "__main__":
    sys.exit(main())
