"""A small writer of PX4 logs by the ULog file format specification (docs.px4.io, "ULog File Format"): formats, topics, data."""

import struct

MAGIC = bytes([0x55, 0x4C, 0x6F, 0x67, 0x01, 0x12, 0x35, 0x01])
TYPES = {"uint64_t": "Q", "float": "f", "double": "d", "int32_t": "i"}


def message(kind, content):
    return struct.pack("<HB", len(content), ord(kind)) + content


def _packed(kind):
    """Format of a field, ``float[3]`` of an array."""
    name, _, count = kind.rstrip("]").partition("[")
    return TYPES[name] * int(count or 1)


def write(path, start_us, topics):
    """Write topics: name → (fields as [(type, name)], instances as lists of rows; a row begins with its time in us)."""
    content = MAGIC + struct.pack("<Q", start_us) + message("B", bytes(40))
    for name, (fields, _) in topics.items():
        said = "".join(f"{kind} {field};" for kind, field in [("uint64_t", "timestamp"), *fields])
        content += message("F", f"{name}:{said}".encode())
    rows, number = [], 0
    for name, (fields, instances) in topics.items():
        layout = "<Q" + "".join(map(_packed, (kind for kind, _ in fields)))
        for instance, data in enumerate(instances):
            content += message("A", struct.pack("<BH", instance, number) + name.encode())
            rows += [(row[0], message("D", struct.pack("<H", number) + struct.pack(layout, *row))) for row in data]
            number += 1
    content += b"".join(one for _, one in sorted(rows, key=lambda each: each[0]))
    path.write_bytes(content)
    return path
