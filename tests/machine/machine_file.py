"""What the judges of whole-machine runs need from a machine.xml, read without takt's own reader.

Units are written out in the file (`120 mm`, `2000 mm/s^2`, `1 ms`); numbers are kept as exact fractions
so that a ratio is the ratio that was written.
"""
import fractions
import pathlib
import re
import xml.etree.ElementTree as ElementTree

MICRO = ("us", "\u00b5s", "\u03bcs")
TIME_UNITS = {"ns": fractions.Fraction(1, 10**9), **dict.fromkeys(MICRO, fractions.Fraction(1, 10**6)),
              "ms": fractions.Fraction(1, 1000), "s": fractions.Fraction(1), "min": fractions.Fraction(60)}
# What an axis in mm or deg may be told in, in mm or deg.
LENGTH_UNITS = {"mm": fractions.Fraction(1), "cm": fractions.Fraction(10), "m": fractions.Fraction(1000),
                **dict.fromkeys(("um", "\u00b5m", "\u03bcm"), fractions.Fraction(1, 1000)),
                "deg": fractions.Fraction(1), "\u00b0": fractions.Fraction(1)}
RAMPS_PER_SECOND = 10.0  # the jerk of an axis that is told none: acceleration builds up in 100 ms
COUNTS_AS_DELIVERED = {"CD300": "10000", "RA": "32768"}
POWERS = {"": 1, "^2": 2, "\u00b2": 2, "^3": 3, "\u00b3": 3}


class MachineError(Exception):
    """The machine file does not say what a judge must know."""


def number(text):
    """'1.25 mm/s' -> (5/4, 'mm/s'); a unit may be missing."""
    match = re.fullmatch(r"\s*([-+]?[0-9]*\.?[0-9]+(?:[eE][-+]?[0-9]+)?)\s*"
                         r"([^\W\d_]+(?:/[a-z]+(?:\^[0-9]|[\u00b2\u00b3])?)?|%|\u00b0[^ ]*)?\s*", text)
    if not match:
        raise MachineError(f"'{text}' is not a number with a unit")
    return fractions.Fraction(match.group(1)), match.group(2) or ""


def ratio(text):
    """'1/10' or '2.5' -> exact fraction."""
    above, _, below = text.replace(":", "/").partition("/")
    return number(above)[0] / (number(below)[0] if below else 1)


def whole(text):
    """Decimal, or hexadecimal as 0x1A or #x1A."""
    try:
        return int(text.strip().replace("#x", "0x").replace("#X", "0x"), 0)
    except ValueError:
        raise MachineError(f"'{text}' is not a whole number") from None


def seconds(text):
    value, unit = number(text)
    if unit not in TIME_UNITS:
        raise MachineError(f"'{text}' is not a time; allowed: {', '.join(TIME_UNITS)}")
    return value * TIME_UNITS[unit]


def motion(text):
    """'0.5 m/s' -> 500 (mm/s): a length or angle, per time where the unit says so."""
    value, unit = number(text)
    if unit == "rpm":
        return value * 6  # deg/s
    length, _, rate = unit.partition("/")
    match = re.fullmatch("(s|min)(.*)", rate) if rate else None
    if length not in LENGTH_UNITS or (rate and (not match or match.group(2) not in POWERS)):
        raise MachineError(f"'{text}' has no unit of motion")
    value *= LENGTH_UNITS[length]
    return value / TIME_UNITS[match.group(1)] ** POWERS[match.group(2)] if match else value


class Axis:
    """Scaling as an exact ratio (counts per user unit, signed) and the limits as doubles."""

    def __init__(self, element, drive_types):
        self.name = element.get("name")
        scaling = child(element, "Scaling", self.name)
        counts = scaling.get("countsPerTurn")
        if counts is None:
            counts = self._counts_as_delivered(drive_types[child(element, "Drive", self.name).get("slave")])
        turn = motion(attribute(scaling, "perTurn", self.name))
        self.counts_per_unit = whole(counts) * ratio(scaling.get("gear", "1")) / turn
        if scaling.get("reversed", "false").strip() in ("true", "1"):
            self.counts_per_unit = -self.counts_per_unit
        modulo = scaling.get("modulo")
        self.modulo = float(motion(modulo)) if modulo else None
        limits = child(element, "Limits", self.name)

        def limit(name, default=None):
            text = limits.get(name)
            return float(motion(text)) if text is not None else default

        self.velocity = limit("velocity")
        self.acceleration = limit("acceleration")
        self.deceleration = limit("deceleration", self.acceleration)
        if self.velocity is None or self.acceleration is None:
            raise MachineError(f"axis {self.name}: velocity and acceleration limits are needed")
        steepest = max(self.acceleration, self.deceleration)
        self.jerk = limit("jerk", RAMPS_PER_SECOND * steepest)
        self.stop_deceleration = limit("stopDeceleration", steepest)
        self.stop_jerk = limit("stopJerk", self.jerk)


    def _counts_as_delivered(self, drive_type):
        for prefix, counts in COUNTS_AS_DELIVERED.items():
            if drive_type.startswith(prefix):
                return counts
        raise MachineError(f"axis {self.name}: <Scaling> has no countsPerTurn")


class Slave:
    """One device on the wire and whether it takes part in the process data."""

    def __init__(self, name, outputs, inputs):
        self.name = name
        self.outputs = outputs
        self.inputs = inputs


def child(element, tag, who):
    found = element.find(tag)
    if found is None:
        raise MachineError(f"axis {who}: no <{tag}>")
    return found


def attribute(element, name, who, default=None):
    value = element.get(name, default)
    if value is None:
        raise MachineError(f"axis {who}: <{element.tag}> has no attribute {name}")
    return value


def esi_devices(path):
    """Type name -> (has outputs, has inputs) of every device in an ESI file."""
    devices = {}
    for device in ElementTree.parse(path).getroot().iter("Device"):
        kind = device.find("Type")
        if kind is None or not kind.text:
            continue
        assigned = {tag: any(pdo.get("Sm") is not None for pdo in device.iter(tag))
                    for tag in ("RxPdo", "TxPdo")}
        devices[kind.text.strip()] = (assigned["RxPdo"], assigned["TxPdo"])
    return devices


def eni_network(path):
    """(cycle in seconds, type by slave name, slaves) of a network file."""
    config = ElementTree.parse(path).getroot().find("Config")
    cycle = float(whole(config.findtext("Cyclic/CycleTime"))) * 1e-6
    types, slaves = {}, []
    for element in config.iter("Slave"):
        name = element.findtext("Info/Name").strip()
        types[name] = name[name.rfind("(") + 1:].rstrip(")")
        bits = {tag: whole(element.findtext(f"ProcessData/{tag}/BitLength", "0"))
                for tag in ("Send", "Recv")}
        slaves.append(Slave(name, bits["Send"] > 0, bits["Recv"] > 0))
    return cycle, types, slaves


class Machine:
    def __init__(self, path):
        path = pathlib.Path(path)
        root = ElementTree.parse(path).getroot()
        network = root.find("Network")
        if network is None:
            raise MachineError(f"{path}: no <Network>")
        self.axes = {axis.get("name"): axis for axis in root.iter("Axis")}
        self.groups = {group.get("name"): group for group in root.iter("Group")}
        if network.get("eni") is not None:
            self.cycle, self.drive_types, self.slaves = eni_network(path.parent / network.get("eni"))
            return
        self.cycle = float(seconds(network.get("cycle", "1 ms")))
        devices = {}
        for esi in root.iter("Esi"):
            devices.update(esi_devices(path.parent / esi.get("file")))
        self.drive_types = {s.get("name"): s.get("device", "") for s in network.iter("Slave")}
        self.slaves = [self._slave(element, devices, path) for element in network.iter("Slave")]

    @staticmethod
    def _slave(element, devices, path):
        kind = element.get("device")
        if kind not in devices:
            raise MachineError(f"{path}: slave {element.get('name')}: device {kind} is in no ESI file")
        outputs, inputs = devices[kind]
        for pdo in element.iter("Pdo"):
            index = whole(pdo.get("index", "0"))
            outputs = outputs or 0x1600 <= index < 0x1800
            inputs = inputs or 0x1A00 <= index < 0x1C00
        return Slave(element.get("name"), outputs, inputs)

    def group_limits(self, name):
        """Limits along the path of a group: velocity, acceleration (the larger way), jerk."""
        if name not in self.groups:
            raise MachineError(f"no group {name}; the file has {', '.join(self.groups) or 'none'}")
        limits = child(self.groups[name], "Limits", name)
        up = float(motion(attribute(limits, "acceleration", name)))
        steepest = max(up, float(motion(limits.get("deceleration"))) if limits.get("deceleration") else up)
        jerk = limits.get("jerk")
        return {"velocity": float(motion(attribute(limits, "velocity", name))), "acceleration": steepest,
                "jerk": float(motion(jerk)) if jerk else RAMPS_PER_SECOND * steepest}

    def axis(self, name):
        if name not in self.axes:
            raise MachineError(f"no axis {name}; the file has {', '.join(self.axes) or 'none'}")
        return Axis(self.axes[name], self.drive_types)
