"""Frames of a capture, once as tshark sees them and once read byte by byte.

The two readings must agree; so a fault in one of them is found, not believed.
"""
import pathlib
import shutil
import struct
import subprocess

COMMANDS = ["NOP", "APRD", "APWR", "APRW", "FPRD", "FPWR", "FPRW", "BRD", "BWR", "BRW",
            "LRD", "LWR", "LRW", "ARMW", "FRMW"]
NOP, APRD, APWR, APRW, FPRD, FPWR, FPRW, BRD, BWR, BRW, LRD, LWR, LRW, ARMW, FRMW = range(15)
LOGICAL = (LRD, LWR, LRW)
OUTBOUND, INBOUND = 2, 1
FIELDS = ["frame.number", "frame.packet_flags_direction", "eth.src", "_ws.malformed", "ecat.cmd",
          "ecat.idx", "ecat.adp", "ecat.ado", "ecat.lad", "ecat.cnt"]


class CaptureError(Exception):
    pass


class Datagram:
    """One datagram; `address` is (adp, ado), or (logical address,)."""
    __slots__ = ("command", "index", "address", "counter", "data")

    def __init__(self, command, index, address, counter, data=b""):
        self.command = command
        self.index = index
        self.address = address
        self.counter = counter
        self.data = data

    def key(self):
        """What must be the same in the judge's two readings of one datagram."""
        return (self.command, self.index, self.address, self.counter)

    def __str__(self):
        where = (f"0x{self.address[0]:08X}" if self.command in LOGICAL else
                 f"{self.address[0]:04X}:{self.address[1]:04X}")
        name = COMMANDS[self.command] if self.command < len(COMMANDS) else str(self.command)
        return f"{name} {where} index {self.index}"


class Frame:
    __slots__ = ("number", "direction", "source_seen", "malformed", "datagrams")

    def __init__(self, number, direction, source_seen, malformed, datagrams):
        self.number = number
        self.direction = direction
        self.source_seen = source_seen
        self.malformed = malformed
        self.datagrams = datagrams

    def clone(self):
        """A copy that may be damaged; data bytes are shared, nobody changes those."""
        return Frame(self.number, self.direction, self.source_seen, self.malformed,
                     [Datagram(d.command, d.index, d.address, d.counter, d.data)
                      for d in self.datagrams])

    def returned(self):
        return self.direction == INBOUND


def packets(path):
    """(direction, bytes) of every enhanced packet block of a little-endian pcapng file."""
    raw = memoryview(pathlib.Path(path).read_bytes())
    at = 0
    while at + 12 <= len(raw):
        kind, length = struct.unpack_from("<II", raw, at)
        if length < 12 or length % 4 or at + length > len(raw):
            raise CaptureError(f"{path}: block at byte {at} has length {length}")
        if struct.unpack_from("<I", raw, at + length - 4)[0] != length:
            raise CaptureError(f"{path}: block at byte {at} has two different lengths")
        if kind == 6:
            size = struct.unpack_from("<I", raw, at + 20)[0]
            options = at + 28 + (size + 3) // 4 * 4
            yield direction_of(raw, options, at + length - 4), bytes(raw[at + 28:at + 28 + size])
        at += length
    if at != len(raw):
        raise CaptureError(f"{path}: {len(raw) - at} bytes behind the last block")


def direction_of(raw, at, end):
    while at + 4 <= end:
        code, length = struct.unpack_from("<HH", raw, at)
        if code == 2 and length == 4:
            return struct.unpack_from("<I", raw, at + 4)[0] & 3
        if code == 0:
            break
        at += 4 + (length + 3) // 4 * 4
    return 0


def datagrams_of(frame, number):
    """The datagrams of one Ethernet frame, read by their lengths."""
    if frame[12:14] != b"\x88\xa4":
        raise CaptureError(f"frame {number}: not EtherCAT")
    header = struct.unpack_from("<H", frame, 14)[0]
    at, end = 16, 16 + (header & 0x7FF)
    more, datagrams = end > 16, []
    while more:
        if at + 12 > end or end > len(frame):
            raise CaptureError(f"frame {number}: a datagram is longer than the frame")
        command, index, adp, ado, length, _ = struct.unpack_from("<BBHHHH", frame, at)
        size = length & 0x7FF
        more = bool(length & 0x8000)
        if at + 12 + size > end:
            raise CaptureError(f"frame {number}: a datagram is longer than the frame")
        address = (adp | ado << 16,) if command in LOGICAL else (adp, ado)
        counter = struct.unpack_from("<H", frame, at + 10 + size)[0]
        datagrams.append(Datagram(command, index, address, counter, frame[at + 10:at + 10 + size]))
        at += 12 + size
    return datagrams


def tshark_rows(path):
    """One tuple of field texts for each EtherCAT frame."""
    program = shutil.which("tshark")
    if program is None:
        raise CaptureError("tshark is not installed (apt-get install tshark)")
    command = [program, "-r", str(path), "-Y", "ecat", "-T", "fields", "-E", "separator=|",
               "-E", "occurrence=a"]
    for field in FIELDS:
        command += ["-e", field]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise CaptureError(f"tshark: {done.stderr.strip()}")
    for line in done.stdout.splitlines():
        yield line.split("|")


def numbers(text):
    return [int(part, 0) for part in text.split(",")] if text else []


def frame_from_row(row):
    """tshark lists a field only where a datagram has it: logical ones have no adp and ado."""
    number, direction, source, malformed = int(row[0]), int(row[1] or "0", 0) & 3, row[2], row[3]
    commands, indices, adps, ados, lads, counters = (numbers(text) for text in row[4:10])
    adp, ado, lad = iter(adps), iter(ados), iter(lads)
    datagrams = []
    for command, index, counter in zip(commands, indices, counters):
        address = (next(lad),) if command in LOGICAL else (next(adp), next(ado))
        datagrams.append(Datagram(command, index, address, counter))
    seen = bool(int(source.split(":")[0], 16) & 0x02)
    return Frame(number, direction, seen, bool(malformed), datagrams)


def read(path, problems):
    """All frames; disagreements of the two readings are appended to `problems`."""
    frames = [frame_from_row(row) for row in tshark_rows(path)]
    raw = list(packets(path))
    if len(raw) != len(frames):
        problems.append(f"the file holds {len(raw)} packets, tshark sees {len(frames)} EtherCAT frames")
        return frames
    for frame, (direction, content) in zip(frames, raw):
        own = datagrams_of(content, frame.number)
        if direction != frame.direction or [d.key() for d in own] != [d.key() for d in frame.datagrams]:
            problems.append(f"frame {frame.number}: tshark and the bytes disagree")
            continue
        frame.datagrams = own
    return frames
