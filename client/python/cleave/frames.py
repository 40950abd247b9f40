"""Headers of streams and frames, and the sections that frames are made of: core/stream/FORMAT.md,
sections 3, 5 and 6."""

import dataclasses
import math
import struct

from cleave.checksums import crc32c
from cleave.interpolation import UNITS_PER_STEP

KEY, DELTA, HOLD = 1, 2, 3
TOPOLOGY_DELTA, TOPOLOGY_CHECKPOINT, POSITIONS, MOTION, LABELS = 1, 2, 3, 4, 5
_KNOWN_IDS = ((1, 1, 1, 1), (2, 2, 1, 1), (2, 2, 2, 1), (1, 3, 1, 1), (2, 2, 1, 2), (2, 2, 2, 2))  # order, predictor, coder, view

_REGIONS = 1  # required feature


class StreamError(Exception):
    """What a stream can do wrong."""


class DamagedError(StreamError):
    """The bytes are not what was written."""


class UnsupportedError(StreamError):
    """A later version, or a feature or id that this decoder does not know."""


class WrongStateError(StreamError):
    """A frame that applies to another state, or a stream of another mesh."""


@dataclasses.dataclass(frozen=True)
class StreamHeader:
    """FORMAT.md section 3. Lengths in metres."""

    mesh_sha256: bytes
    rest_sha256: bytes
    nodes: int
    edges: int
    tets: int
    predictor: int
    coder: int
    view: int
    chunk_nodes: int
    keyframe_interval: int
    tolerance: float
    domain_bound: float
    frames_per_second: float
    bbox_min: tuple
    bbox_max: tuple
    origin: tuple
    regions: bool

    _LAYOUT = struct.Struct("<4sHHIIQQ32s32sQQQHHHHIIddd3d3d3d")

    @staticmethod
    def size_of(data):
        """Bytes of the stream header that `data` (12 bytes or more) begins with."""
        if len(data) < 12:
            raise DamagedError("stream header is truncated")
        magic, major, _, size = struct.unpack_from("<4sHHI", data)
        if magic != b"CLVS":
            raise DamagedError("no stream header: the magic is not CLVS")
        if major != 1:
            raise UnsupportedError(f"stream format {major} is not known; this reader knows 1")
        if not 256 <= size <= 65536:
            raise DamagedError(f"stream header of {size} bytes is outside [256, 65536]")
        return size

    @classmethod
    def parse(cls, data):
        """Reads exactly one header."""
        if cls.size_of(data) != len(data):
            raise DamagedError(f"stream header has {len(data)} bytes; it declares another size")
        if struct.unpack_from("<I", data, len(data) - 4)[0] != crc32c(data[:-4]):
            raise DamagedError("stream header fails its checksum")
        values = cls._LAYOUT.unpack_from(data)
        required, ids = values[5], values[12:16]
        if required & ~_REGIONS:
            raise UnsupportedError(f"stream needs features that are not known: {required:#x}")
        at = 252
        while at < len(data) - 4:
            if at + 8 > len(data) - 4:
                raise DamagedError("stream header has a truncated extension")
            kind, _, length = struct.unpack_from("<HHI", data, at)
            at += 8 + length
            if at > len(data) - 4:
                raise DamagedError("stream header has a truncated extension")
            if not kind & 0x8000:
                raise UnsupportedError(f"stream header extension {kind} is required, not known")
        if ids not in _KNOWN_IDS or (required & _REGIONS and ids[1] != 2):
            raise UnsupportedError(f"order, predictor, coder, view are {ids}: not known together")
        header = cls(
            *values[7:12],
            *ids[1:4],
            *values[16:21],
            values[21:24],
            values[24:27],
            values[27:30],
            required & _REGIONS != 0,
        )
        header._check()
        return header

    def _check(self):
        within = (
            1 <= self.nodes < 2**31
            and self.edges < 2**31
            and self.tets < 2**31
            and 1 <= self.chunk_nodes <= 65536
            and 1 <= self.keyframe_interval <= 1000000
            and 1e-3 <= self.frames_per_second <= 1e9
            and all(
                -1e12 <= low <= zero <= high <= 1e12
                for low, zero, high in zip(self.bbox_min, self.origin, self.bbox_max)
            )
            and 0 <= self.domain_bound <= 2.0**22 * self.tolerance
            and self.allows(self.tolerance)
        )
        if not within:
            raise DamagedError("stream header has values out of range")

    def allows(self, tolerance):
        """True if frames of this stream may have the tolerance."""
        if self.predictor == 3:
            return tolerance == 0
        farthest = max(abs(x) for x in self.bbox_min + self.bbox_max)
        finest = 2.0**-23 if self.predictor == 2 else 2.0**-30
        low = max(1e-15, farthest * finest, self.domain_bound * 2.0**-22)
        return low <= tolerance <= 1e9

    def unit(self, tolerance):
        """Grid unit (m) for a frame's tolerance: FORMAT.md section 4."""
        step = 2.0 * (tolerance - self.domain_bound * 2.0**-24) * (1.0 - 2.0**-16)
        return step / UNITS_PER_STEP if self.predictor == 2 else step


@dataclasses.dataclass(frozen=True)
class FrameHeader:
    """FORMAT.md section 5."""

    sections: int
    frame_bytes: int
    frame: int
    base_frame: int
    time: float
    tolerance: float
    fragments: int
    broken_edges: int
    state_hash: int
    epoch: int
    kind: int

    SIZE = 88
    _LAYOUT = struct.Struct("<4sIQqqddqQQIB7xI")

    @classmethod
    def parse(cls, data):
        """Reads the header that `data` begins with."""
        if len(data) < cls.SIZE:
            raise DamagedError("frame header is truncated")
        magic, *values, checksum = cls._LAYOUT.unpack_from(data)
        if magic != b"CLVF":
            raise DamagedError("no frame: the magic is not CLVF")
        if checksum != crc32c(data[: cls.SIZE - 4]):
            raise DamagedError("frame header fails its checksum")
        header = cls(*values)
        base_fits = (
            header.base_frame == header.frame
            if header.kind == KEY
            else 0 <= header.base_frame < header.frame
        )
        if (
            header.kind not in (KEY, DELTA, HOLD)
            or header.frame < 0
            or not base_fits
            or not math.isfinite(header.time)
            or not header.tolerance >= 0
            or header.fragments < 0
            or header.frame_bytes < cls.SIZE + 24 * header.sections
        ):
            raise DamagedError("frame header has values that no frame has")
        return header


@dataclasses.dataclass(frozen=True)
class Section:
    """FORMAT.md section 6."""

    type: int
    coder: int
    prediction: int
    raw_bytes: int
    first: int
    count: int
    coded: bytes


def split_frame(data):
    """Cuts a whole frame into its header and known sections, checksums checked."""
    header = FrameHeader.parse(data)
    if header.frame_bytes != len(data):
        raise DamagedError(f"frame has {len(data)} bytes; it declares {header.frame_bytes}")
    sections = []
    at = FrameHeader.SIZE
    for _ in range(header.sections):
        if at + 24 > len(data):
            raise DamagedError("frame's sections are longer than the frame")
        kind, coder, prediction, raw, size, first, count, checksum = struct.unpack_from(
            "<HBBIIIII", data, at
        )
        coded = data[at + 24 : at + 24 + size]
        if len(coded) != size:
            raise DamagedError("frame's sections are longer than the frame")
        if checksum != crc32c(data[at : at + 20] + coded):
            raise DamagedError("a section fails its checksum")
        at += 24 + size
        if kind in (TOPOLOGY_DELTA, TOPOLOGY_CHECKPOINT, POSITIONS, MOTION, LABELS):
            sections.append(Section(kind, coder, prediction, raw, first, count, coded))
        elif not kind & 0x8000:
            raise UnsupportedError(f"section type {kind} is not known")
    if at != len(data):
        raise DamagedError("frame is longer than its sections")
    return header, sections
