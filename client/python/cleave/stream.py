"""Decodes Cleave's frame streams, as core/stream/FORMAT.md specifies them.

Needs numpy and zstandard. A stream holds no mesh: give its rest positions (metres, float64) and
edges (edges_of makes them of tets).

    with open("run.clv", "rb") as file:
        stream = StreamFile(file.read())
    decoder = FrameDecoder(stream.header_bytes, rest_positions, edges_of(tets))
    for row in stream.rows:
        decoder.apply(stream.frame_bytes(row))
        print(decoder.frame, decoder.time, decoder.positions.shape, len(decoder.broken_edges))
"""

import dataclasses
import hashlib
import math
import struct

import numpy as np
import zstandard

from cleave.checksums import crc32c, xxh3_64
from cleave.interpolation import UNITS_PER_STEP, Motion, Predictor
from cleave.labels import PieceLabels
from cleave.residuals import ResidualHistory

MAX_QUANTISED = 2**30 - 1
MAX_TOPOLOGY_EDGES = 262144

KEY, DELTA, HOLD = 1, 2, 3
_TOPOLOGY_DELTA, _TOPOLOGY_CHECKPOINT, _POSITIONS, _MOTION, _LABELS = 1, 2, 3, 4, 5
_REST, _LAST, _LINEAR, _INTERPOLATION = 1, 2, 3, 4
_KNOWN_IDS = ((1, 1, 1, 1), (2, 2, 1, 1), (2, 2, 2, 1))  # order, predictor, coder, view


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
    chunk_nodes: int
    keyframe_interval: int
    tolerance: float
    domain_bound: float
    frames_per_second: float
    bbox_min: tuple
    bbox_max: tuple
    origin: tuple

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
        if required != 0:
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
        if ids not in _KNOWN_IDS:
            raise UnsupportedError(f"order, predictor, coder, view are {ids}: not known together")
        header = cls(
            *values[7:12],
            *ids[1:3],
            *values[16:21],
            values[21:24],
            values[24:27],
            values[27:30],
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
            or not header.tolerance > 0
            or header.fragments < 0
            or header.frame_bytes < cls.SIZE + 24 * header.sections
        ):
            raise DamagedError("frame header has values that no frame has")
        return header


@dataclasses.dataclass(frozen=True)
class _Section:
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
        if kind in (_TOPOLOGY_DELTA, _TOPOLOGY_CHECKPOINT, _POSITIONS, _MOTION, _LABELS):
            sections.append(_Section(kind, coder, prediction, raw, first, count, coded))
        elif not kind & 0x8000:
            raise UnsupportedError(f"section type {kind} is not known")
    if at != len(data):
        raise DamagedError("frame is longer than its sections")
    return header, sections


class FrameDecoder:
    """Holds the state of a stream and applies frames to it. A bad frame changes nothing.

    After each apply: frame, epoch, time (s), fragments, positions (nodes x 3 float64, m),
    broken_edges (ascending int32) and state_hash are of that frame.
    """

    def __init__(self, header_bytes, rest_positions, edges=None, max_nodes=64_000_000):
        self.header = StreamHeader.parse(bytes(header_bytes))
        if self.header.nodes > max_nodes:
            raise StreamError(f"stream of {self.header.nodes} nodes is above {max_nodes}")
        rest = np.ascontiguousarray(rest_positions, dtype="<f8")
        if (
            rest.shape != (self.header.nodes, 3)
            or hashlib.sha256(rest.tobytes()).digest() != self.header.rest_sha256
        ):
            raise WrongStateError("rest positions are not those of the stream's mesh")
        self._header_bytes = bytes(header_bytes)
        self._rest = rest
        self._predictor = None
        if self.header.predictor == 2:
            edges = _checked_edges(edges, self.header)
            self._predictor = Predictor(rest, edges)
            self._rest = rest[self._predictor.order.nodes]
            self._labels = PieceLabels(self._predictor)
        self._history = ResidualHistory(0)
        self._previous = None
        self._quantised = None
        self._tolerance = None
        self.frame = -1
        self.epoch = 0
        self.time = 0.0
        self.fragments = 0
        self.broken_edges = np.empty(0, "<i4")
        self.positions = None
        self.state_hash = 0

    def apply(self, data):
        """Decodes one whole frame and returns its header."""
        header, sections = split_frame(bytes(data))
        self._check_base(header)
        topology = [s for s in sections if s.type not in (_POSITIONS, _MOTION)]
        if sections[: len(topology)] != topology:
            raise DamagedError("topology sections stand behind others")
        others = sections[len(topology) :]
        broken = self._decode_topology(header, topology)
        history = self._history
        if header.kind == HOLD:
            if sections:
                raise DamagedError("a hold frame has sections")
            quantised = self._quantised
        elif self._predictor is not None:
            quantised, history = self._interpolate(header, others, broken)
        else:
            quantised = self._decode_positions(header, others)
        if header.state_hash != self._hash(header, quantised, broken):
            raise DamagedError(f"frame {header.frame} fails its state hash")

        self._previous = self._quantised
        if header.kind == KEY:
            self._previous = None if self._predictor is None else quantised
        self._quantised = quantised
        self._history = history
        self._tolerance = header.tolerance
        self.frame = header.frame
        self.epoch = header.epoch
        self.time = header.time
        self.fragments = header.fragments
        self.broken_edges = broken
        self.state_hash = header.state_hash
        unit = self.header.unit(header.tolerance)
        positions = np.asarray(self.header.origin) + quantised.astype("f8") * unit
        if self._predictor is not None:
            by_place, positions = positions, np.empty_like(positions)
            positions[self._predictor.order.nodes] = by_place
        self.positions = positions
        return header

    def _check_base(self, header):
        if header.broken_edges > self.header.edges:
            raise DamagedError("frame has more broken edges than the mesh has edges")
        if header.kind == KEY:
            if not self.header.allows(header.tolerance):
                raise DamagedError(f"frame has a tolerance of {header.tolerance} m")
        elif (header.epoch, header.base_frame, header.tolerance) != (
            self.epoch,
            self.frame,
            self._tolerance,
        ):
            raise WrongStateError(
                f"frame {header.frame} of epoch {header.epoch} applies to frame "
                f"{header.base_frame}; the decoder is at frame {self.frame} of epoch {self.epoch}"
            )

    def _decode_topology(self, header, sections):
        expected = _TOPOLOGY_CHECKPOINT if header.kind == KEY else _TOPOLOGY_DELTA
        broken = [] if header.kind == KEY else [self.broken_edges]
        known = sum(len(ids) for ids in broken)
        if header.kind == KEY and self._predictor is not None and sections:
            if sections[0].type == _LABELS:
                broken = [self._decode_labels(sections[0])]
                sections = sections[1:]
        last = -1
        for section in sections:
            known += section.count
            if (
                section.type != expected
                or section.first != 0
                or section.prediction != 0
                or not 1 <= section.count <= MAX_TOPOLOGY_EDGES
                or not section.count <= section.raw_bytes <= 5 * section.count
                or known > header.broken_edges
            ):
                raise DamagedError("topology section does not fit its frame")
            ids = _from_gaps(_decode_parts(section, 1), section.count)
            if ids[0] <= last or ids[-1] >= self.header.edges:
                raise DamagedError("a broken edge is out of order or range")
            last = ids[-1]
            broken.append(ids.astype("<i4"))
        union = np.unique(np.concatenate(broken)) if broken else np.empty(0, "<i4")
        if len(union) != header.broken_edges:
            raise DamagedError("frame does not list the broken edges that it declares")
        return union

    def _decode_labels(self, section):
        nodes = self.header.nodes
        if (
            (section.first, section.prediction, section.count) != (0, 0, nodes)
            or (section.coder, section.raw_bytes) != (2, nodes)
        ):
            raise DamagedError("topology labels do not fit their frame")
        try:
            return self._labels.decode(section.coded).astype("<i4")
        except ValueError as error:
            raise DamagedError(str(error)) from error

    def _decode_positions(self, header, chunks):
        nodes, chunk_nodes = self.header.nodes, self.header.chunk_nodes
        if len(chunks) != -(-nodes // chunk_nodes):
            raise DamagedError("frame lacks positions or has too many")
        if header.kind == KEY:
            predictions = {_REST: self._quantised_rest(header)}
        else:
            predictions = {_LAST: self._quantised}
            if self._previous is not None:
                linear = 2 * self._quantised.astype("i8") - self._previous
                predictions[_LINEAR] = np.clip(linear, -MAX_QUANTISED, MAX_QUANTISED)
        quantised = np.empty((nodes, 3), "<i4")
        for index, chunk in enumerate(chunks):
            first = index * chunk_nodes
            count = min(chunk_nodes, nodes - first)
            planes, rest = divmod(chunk.raw_bytes, 3 * count)
            if (
                chunk.type != _POSITIONS
                or (chunk.first, chunk.count) != (first, count)
                or rest != 0
                or planes > 4
                or chunk.prediction not in predictions
            ):
                raise DamagedError("positions section does not fit its frame")
            residuals = _residuals_of_planes(chunk, planes, count)
            values = predictions[chunk.prediction][first : first + count].astype("i8") + residuals
            if np.abs(values).max() > MAX_QUANTISED:
                raise DamagedError("a decoded coordinate is out of range")
            quantised[first : first + count] = values
        return quantised

    def _quantised_rest(self, header):
        unit = self.header.unit(header.tolerance)
        return np.floor((self._rest - self.header.origin) / unit + 0.5)

    def _interpolate(self, header, sections, broken):
        """FORMAT.md sections 6.4 and 6.5: positions and the history after them."""
        nodes, chunk_nodes = self.header.nodes, self.header.chunk_nodes
        stencils, groups = self._predictor.stencils, len(self._predictor.order.begins) - 1
        if len(sections) != 1 + -(-nodes // chunk_nodes):
            raise DamagedError("frame lacks positions or has too many")
        stencils.set_broken(broken)
        pieces = len(stencils.leaders)
        motion = sections[0]
        if (
            (motion.type, motion.prediction, motion.first) != (_MOTION, 0, 0)
            or motion.count != groups
            or not 1 <= motion.raw_bytes <= 1 + (pieces + 7) // 8 + 8 * groups
        ):
            raise DamagedError("motion section does not fit its frame")
        key = header.kind == KEY
        has_classes = self.header.coder == 2 and (key or self._history.fresh)
        try:
            motion = Motion(_decode_parts(motion, 1), key, has_classes, pieces, groups)
        except ValueError as error:
            raise DamagedError(str(error)) from error
        history = self._history
        if self.header.coder == 2:
            history = history.begin(key, motion.classes, self._predictor.order.group)

        moving = ~motion.holds[stencils.piece]
        residuals = np.zeros((nodes, 3), "i8")
        for index, chunk in enumerate(sections[1:]):
            first = index * chunk_nodes
            count = min(chunk_nodes, nodes - first)
            coded = np.flatnonzero(moving[first : first + count]) + first
            if (
                (chunk.type, chunk.prediction) != (_POSITIONS, _INTERPOLATION)
                or (chunk.first, chunk.count) != (first, count)
                or chunk.coder != self.header.coder
            ):
                raise DamagedError("positions section does not fit its frame")
            if self.header.coder == 2:
                try:
                    residuals[coded] = history.decode(chunk.raw_bytes, chunk.coded, coded)
                except ValueError as error:
                    raise DamagedError(str(error)) from error
            else:
                planes, rest = divmod(chunk.raw_bytes, max(3 * len(coded), 1))
                if rest != 0 or planes > 4:
                    raise DamagedError("positions section does not fit its frame")
                residuals[coded] = _residuals_of_planes(chunk, planes, len(coded))
        before = None if self._previous is None else self._previous.astype("i8")
        last = None if self._quantised is None else self._quantised.astype("i8")
        q = self._predictor.decode(
            key,
            motion,
            residuals,
            self._quantised_rest(header).astype("i8"),
            last,
            before,
        )
        if np.abs(q).max() > MAX_QUANTISED:
            raise DamagedError("a decoded coordinate is out of range")
        return q.astype("<i4"), history.finish() if self.header.coder == 2 else history

    def _hash(self, header, quantised, broken):
        fields = struct.pack(
            "<qQddqQ",
            header.frame,
            header.epoch,
            header.time,
            header.tolerance,
            header.fragments,
            len(broken),
        )
        return xxh3_64(self._header_bytes + fields + quantised.tobytes() + broken.tobytes())


def edges_of(tets):
    """The edges of tets (node ids, 4 a row) as Cleave numbers them: FORMAT.md section 1."""
    tets = np.asarray(tets, "i8").reshape(-1, 4)
    corners = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    pairs = np.concatenate([tets[:, pair] for pair in corners])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def _checked_edges(edges, header):
    edges = np.empty((0, 2), "i8") if edges is None else np.asarray(edges, "i8").reshape(-1, 2)
    keys = edges[:, 0] << 32 | edges[:, 1]
    fits = len(edges) == header.edges and (np.diff(keys) > 0).all()
    if fits and len(edges) > 0:
        fits = edges[:, 0].min() >= 0 and edges[:, 1].max() < header.nodes
        fits = fits and (edges[:, 0] < edges[:, 1]).all()
    if not fits:
        raise WrongStateError("edges are not those of the stream's mesh")
    return edges


def _residuals_of_planes(section, planes, count):
    """Byte planes (FORMAT.md section 6.3) to residuals, count x 3."""
    raw = np.frombuffer(_decode_parts(section, planes), "u1").reshape(planes, 3, count)
    zigzag = np.zeros((3, count), "i8")
    for plane in range(planes):
        zigzag |= raw[plane].astype("i8") << (8 * plane)
    return ((zigzag >> 1) ^ -(zigzag & 1)).T


def _decode_parts(section, parts):
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


def _from_gaps(raw, count):
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


@dataclasses.dataclass(frozen=True)
class IndexRow:
    """FORMAT.md section 9."""

    frame: int
    epoch: int
    kind: int
    segment: int
    offset: int
    length: int
    time: float
    state_hash: int
    broken_edges: int
    fragments: int

    SIZE = 80
    _LAYOUT = struct.Struct("<qIB3xI4xQQdQQq4xI")

    @classmethod
    def parse(cls, data):
        """Reads one row, or returns None if it is torn or damaged."""
        if len(data) < cls.SIZE or crc32c(data[: cls.SIZE - 4]) != cls._LAYOUT.unpack(data)[-1]:
            return None
        return cls(*cls._LAYOUT.unpack(data)[:-1])


class StreamFile:
    """A .clv file in memory, finished or not: header_bytes, header, rows, has_footer."""

    def __init__(self, data):
        self._data = bytes(data)
        self.header_bytes = self._data[: StreamHeader.size_of(self._data)]
        self.header = StreamHeader.parse(self.header_bytes)
        self.rows = self._read_footer()
        self.has_footer = self.rows is not None
        if self.rows is None:
            self.rows = self._walk()

    def frame_bytes(self, row):
        """The frame that a row names."""
        data = self._data[row.offset : row.offset + row.length]
        header = FrameHeader.parse(data)
        if (header.frame, header.epoch, header.state_hash) != (
            row.frame,
            row.epoch,
            row.state_hash,
        ):
            raise DamagedError(f"the frame at byte {row.offset} is not frame {row.frame}")
        return data

    def seek(self, position, decoder):
        """Brings the decoder to the frame at this position of rows, from its key frame."""
        row = self.rows[position]
        key = position
        while self.rows[key].kind != KEY:
            key -= 1
            if key < 0 or self.rows[key].epoch != row.epoch:
                raise DamagedError(f"no key frame stands before frame {row.frame}")
        for at in range(key, position + 1):
            decoder.apply(self.frame_bytes(self.rows[at]))

    def _read_footer(self):
        if len(self._data) < len(self.header_bytes) + 40 or self._data[-4:] != b"CLVE":
            return None
        offset, size, checksum = struct.unpack_from("<QQI", self._data, len(self._data) - 24)
        index = self._data[offset : offset + size]
        if (
            offset + size + 24 != len(self._data)
            or size < 16
            or crc32c(index + self._data[-24:-8]) != checksum
            or struct.unpack_from("<4sIQ", index)
            != (b"CLVI", IndexRow.SIZE, (size - 16) // IndexRow.SIZE)
        ):
            return None
        rows = [
            IndexRow.parse(index[at : at + IndexRow.SIZE])
            for at in range(16, len(index), IndexRow.SIZE)
        ]
        whole = all(row is not None and row.offset + row.length <= offset for row in rows)
        return rows if whole else None

    def _walk(self):
        rows, at = [], len(self.header_bytes)
        while True:
            try:
                header = FrameHeader.parse(self._data[at : at + FrameHeader.SIZE])
                split_frame(self._data[at : at + header.frame_bytes])
            except DamagedError:
                return rows
            except UnsupportedError:
                pass  # whole, but of a later version
            rows.append(
                IndexRow(
                    header.frame,
                    header.epoch,
                    header.kind,
                    0,
                    at,
                    header.frame_bytes,
                    header.time,
                    header.state_hash,
                    header.broken_edges,
                    header.fragments,
                )
            )
            at += header.frame_bytes
