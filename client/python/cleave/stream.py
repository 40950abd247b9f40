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

import hashlib
import struct

import numpy as np

from cleave.checksums import xxh3_64
from cleave.frames import (
    HOLD,
    KEY,
    LABELS,
    MOTION,
    POSITIONS,
    TOPOLOGY_CHECKPOINT,
    TOPOLOGY_DELTA,
    DamagedError,
    FrameHeader,
    StreamError,
    StreamHeader,
    UnsupportedError,
    WrongStateError,
    split_frame,
)
from cleave.interpolation import MAX_QUANTISED, Predictor
from cleave.labels import PieceLabels
from cleave.motion import Motion
from cleave.residuals import ResidualHistory
from cleave.sections import decode_parts, edges_of_gaps, residuals_of_planes
from cleave.stream_file import IndexRow, StreamFile

__all__ = [
    "DamagedError",
    "FrameDecoder",
    "FrameHeader",
    "IndexRow",
    "StreamError",
    "StreamFile",
    "StreamHeader",
    "UnsupportedError",
    "WrongStateError",
    "edges_of",
    "split_frame",
]

MAX_TOPOLOGY_EDGES = 262144
_REST, _LAST, _LINEAR, _INTERPOLATION = 1, 2, 3, 4


class FrameDecoder:
    """Holds the state of a stream and applies frames to it. A bad frame changes nothing.

    After each apply: frame, epoch, time (s), fragments, positions (nodes x 3 float64, m),
    broken_edges (ascending int32) and state_hash are of that frame; and tolerances (m, a node each):
    the largest errors of positions, more than the frame's tolerance only outside of a region of
    interest. In a surface view, for which it needs tets, visible tells which nodes' positions are known
    (others are given that of a node of their piece); else it is None.
    """

    def __init__(self, header_bytes, rest_positions, edges=None, max_nodes=64_000_000, tets=None):
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
            tets = _checked_tets(tets, self.header) if self.header.view == 2 else None
            try:
                self._predictor = Predictor(rest, edges, tets)
            except ValueError as error:
                raise WrongStateError(f"tets are not those of the stream's mesh: {error}") from None
            self._rest = rest[self._predictor.order.nodes]
            self._labels = PieceLabels(self._predictor.stencils)
        self._history = ResidualHistory(self.header.nodes)
        self._previous = None
        self._quantised = None
        self._tolerance = None
        self._shifts = np.zeros(self.header.nodes if self.header.regions else 0, "u1")
        self.tolerances = None
        self.visible = None
        self._visible = None  # by place
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
        topology = [s for s in sections if s.type not in (POSITIONS, MOTION)]
        if sections[: len(topology)] != topology:
            raise DamagedError("topology sections stand behind others")
        others = sections[len(topology) :]
        broken = self._decode_topology(header, topology)
        history, shifts, last = self._history, self._shifts, self._quantised
        if header.kind == HOLD:
            if sections:
                raise DamagedError("a hold frame has sections")
            quantised = self._quantised
        elif self._predictor is not None:
            quantised, history, shifts, last = self._interpolate(header, others, broken)
        else:
            quantised = self._decode_positions(header, others)
        if header.state_hash != self._hash(header, quantised, broken, shifts):
            raise DamagedError(f"frame {header.frame} fails its state hash")

        self._previous = last
        if header.kind == KEY:
            self._previous = None if self._predictor is None else quantised
        self._quantised = quantised
        self._history = history
        self._shifts = shifts
        self._tolerance = header.tolerance
        self.frame = header.frame
        self.epoch = header.epoch
        self.time = header.time
        self.fragments = header.fragments
        self.broken_edges = broken
        self.state_hash = header.state_hash
        self.tolerances = np.full(self.header.nodes, header.tolerance)
        if self.header.predictor == 3:
            self.positions = _of_ranks(quantised)
            return header
        unit = self.header.unit(header.tolerance)
        positions = np.asarray(self.header.origin) + quantised.astype("f8") * unit
        if self._predictor is not None:
            by_place, positions = positions, np.empty_like(positions)
            if self.header.view == 2:
                by_place = self._show(by_place)
            positions[self._predictor.order.nodes] = by_place
        if self.header.regions:
            self.tolerances[self._predictor.order.nodes] *= 2.0**shifts
        self.positions = positions
        return header

    def _show(self, by_place):
        stencils, nodes = self._predictor.stencils, self._predictor.order.nodes
        stencils.set_broken(self.broken_edges)  # in a hold, after a frame that was refused
        self._visible = stencils.visible
        self.visible = np.empty(len(nodes), bool)
        self.visible[nodes] = self._visible
        leader = stencils.leaders[stencils.piece]
        hidden = ~self._visible & (leader >= 0)
        by_place[hidden] = by_place[leader[hidden]]
        return by_place

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
        expected = TOPOLOGY_CHECKPOINT if header.kind == KEY else TOPOLOGY_DELTA
        broken = [] if header.kind == KEY else [self.broken_edges]
        known = sum(len(ids) for ids in broken)
        if header.kind == KEY and self._predictor is not None and sections:
            if sections[0].type == LABELS:
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
            ids = edges_of_gaps(decode_parts(section, 1), section.count)
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
        exact = self.header.predictor == 3
        if header.kind == KEY:
            rest = _ranks_of(self._rest) if exact else self._quantised_rest(header)
            predictions = {_REST: rest}
        else:
            predictions = {_LAST: self._quantised}
            if self._previous is not None:
                linear = 2 * self._quantised.astype("i8") - self._previous  # wraps if exact
                if not exact:
                    linear = np.clip(linear, -MAX_QUANTISED, MAX_QUANTISED)
                predictions[_LINEAR] = linear
        quantised = np.empty((nodes, 3), "<i8" if exact else "<i4")
        for index, chunk in enumerate(chunks):
            first = index * chunk_nodes
            count = min(chunk_nodes, nodes - first)
            planes, rest = divmod(chunk.raw_bytes, 3 * count)
            if (
                chunk.type != POSITIONS
                or (chunk.first, chunk.count) != (first, count)
                or rest != 0
                or planes > quantised.itemsize
                or chunk.prediction not in predictions
            ):
                raise DamagedError("positions section does not fit its frame")
            residuals = residuals_of_planes(chunk, planes, count)
            values = predictions[chunk.prediction][first : first + count].astype("i8") + residuals
            if exact:
                within = np.isfinite(_of_ranks(values)).all()
            else:
                within = np.abs(values).max() <= MAX_QUANTISED
            if not within:
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
            (motion.type, motion.prediction, motion.first) != (MOTION, 0, 0)
            or motion.count != groups
            or not 1 <= motion.raw_bytes <= 2 + 2 * ((pieces + 7) // 8) + 8 * groups
        ):
            raise DamagedError("motion section does not fit its frame")
        key = header.kind == KEY
        rans = self.header.coder == 2
        try:
            motion = Motion(
                decode_parts(motion, 1), key, rans, self.header.regions, pieces, groups
            )
        except ValueError as error:
            raise DamagedError(str(error)) from error
        history = self._history
        if self.header.coder == 2:
            history = history.begin(key, motion.classes, self._predictor.order.group)

        moving = ~motion.holds[stencils.piece] & stencils.visible
        residuals = np.zeros((nodes, 3), "i8")
        for index, chunk in enumerate(sections[1:]):
            first = index * chunk_nodes
            count = min(chunk_nodes, nodes - first)
            coded = np.flatnonzero(moving[first : first + count]) + first
            if (
                (chunk.type, chunk.prediction) != (POSITIONS, _INTERPOLATION)
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
                residuals[coded] = residuals_of_planes(chunk, planes, len(coded))
        before = None if self._previous is None else self._previous.astype("i8")
        last = None if self._quantised is None else self._quantised.astype("i8")
        rest = self._quantised_rest(header).astype("i8")
        if self.header.view == 2 and not key:
            fresh = np.flatnonzero(stencils.visible & ~self._visible)
            last, before = last.copy(), before.copy()
            if len(fresh) > 0:
                stencils.fill(fresh, last, rest)
                stencils.fill(fresh, before, rest)
        q = self._predictor.decode(key, motion, residuals, rest, last, before)
        if np.abs(q).max() > MAX_QUANTISED:
            raise DamagedError("a decoded coordinate is out of range")
        shifts = motion.shifts[stencils.piece].astype("u1") if self.header.regions else self._shifts
        base = self._quantised if last is None else last.astype("<i4")
        return q.astype("<i4"), history.finish() if self.header.coder == 2 else history, shifts, base

    def _hash(self, header, quantised, broken, shifts):
        fields = struct.pack(
            "<qQddqQ",
            header.frame,
            header.epoch,
            header.time,
            header.tolerance,
            header.fragments,
            len(broken),
        )
        arrays = quantised.tobytes() + broken.tobytes() + shifts.tobytes()
        return xxh3_64(self._header_bytes + fields + arrays)


def _ranks_of(values):
    """FORMAT.md section 4: doubles as their ranks."""
    bits = np.ascontiguousarray(values, "<f8").view("<i8")
    return bits ^ ((bits >> 63) & 0x7FFFFFFFFFFFFFFF)


def _of_ranks(ranks):
    return (ranks ^ ((ranks >> 63) & 0x7FFFFFFFFFFFFFFF)).astype("<i8").view("<f8")


def edges_of(tets):
    """The edges of tets (node ids, 4 a row) as Cleave numbers them: FORMAT.md section 1."""
    tets = np.asarray(tets, "i8").reshape(-1, 4)
    corners = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    pairs = np.concatenate([tets[:, pair] for pair in corners])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def _checked_tets(tets, header):
    tets = np.empty((0, 4), "i8") if tets is None else np.asarray(tets, "i8").reshape(-1, 4)
    if len(tets) != header.tets or tets.min(initial=0) < 0 or tets.max(initial=0) >= header.nodes:
        raise WrongStateError("tets are not those of the stream's mesh")
    return tets


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
