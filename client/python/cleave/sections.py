"""What the bytes of a section of coder 1 say: core/stream/FORMAT.md, section 6."""

import struct

import numpy as np
import zstandard

from cleave.frames import DamagedError, UnsupportedError


def residuals_of_planes(section, planes, count):
    """Byte planes (FORMAT.md section 6.3) to residuals, count x 3."""
    raw = np.frombuffer(decode_parts(section, planes), "u1").reshape(planes, 3, count)
    zigzag = np.zeros((3, count), "u8")
    for plane in range(planes):
        zigzag |= raw[plane].astype("u8") << np.uint64(8 * plane)
    half, odd = (zigzag >> np.uint64(1)).view("i8"), (zigzag & np.uint64(1)).view("i8")
    return (half ^ -odd).T


def decode_parts(section, parts):
    """Coder 1: equal parts, each stored or a zstd frame."""
    if section.coder != 1:
        raise UnsupportedError(f"section coder {section.coder} is not known")
    coded, at, raw = section.coded, 0, []
    if section.raw_bytes > 0:
        part_bytes = section.raw_bytes // parts
        for _ in range(parts):
            size = struct.unpack_from("<I", coded, at)[0] if at + 4 <= len(coded) else 2**32
            part = coded[at + 4 : at + 4 + size]
            at += 4 + size
            if len(part) != size:
                raise DamagedError("a part is longer than its section")
            raw.append(part if size == part_bytes else _decompress(part, part_bytes))
    if at != len(coded):
        raise DamagedError("section is longer than its parts")
    return b"".join(raw)


def _decompress(part, size):
    try:
        if zstandard.frame_content_size(part) != size:
            raise DamagedError("a part is not a zstd frame of the declared size")
        decompressor = zstandard.ZstdDecompressor().decompressobj()
        raw = decompressor.decompress(part)
    except zstandard.ZstdError as error:
        raise DamagedError(f"a part does not decompress: {error}") from error
    if len(raw) != size or not decompressor.eof or decompressor.unused_data:
        raise DamagedError("a part is not one zstd frame of the declared size")
    return raw


def edges_of_gaps(raw, count):
    """Edge ids from LEB128 gaps."""
    data = np.frombuffer(raw, "u1")
    ends = np.flatnonzero(data < 0x80)
    if len(ends) != count or ends[-1] != len(data) - 1:
        raise DamagedError("edge list does not have the length of its count")
    begins = np.concatenate(([0], ends[:-1] + 1))
    lengths = ends - begins + 1
    if lengths.max() > 5 or np.any((lengths > 1) & (data[ends] == 0)):
        raise DamagedError("edge list has a number that is too long")
    gaps = np.zeros(count, "i8")
    for byte in range(int(lengths.max())):
        there = lengths > byte
        gaps[there] |= (data[begins[there] + byte].astype("i8") & 0x7F) << (7 * byte)
    return np.cumsum(gaps + 1) - 1
