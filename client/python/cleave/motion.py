"""What frames of predictor 2 say about their prediction: core/stream/FORMAT.md section 6.4."""

import struct

import numpy as np

from cleave.residuals import CLASSES, GOES_ON

MAX_SHIFT = 20


class Motion:
    """Section 6.4. holds: whether each piece does; shifts: by how many powers of two each piece is
    coarser; continuations: (a, b, c) of each group; classes: of each group, with coder 2, or None."""

    _NAMED = ((64, 0, 0), (128, -64, 0), (96, -32, 0), (0, 0, 64))

    def __init__(self, raw, key, rans, regions, pieces, groups):
        """Raises ValueError for bytes that are not a motion."""
        self.holds = np.zeros(pieces, bool)
        self.shifts = np.zeros(pieces, "i8")
        self.continuations = [self._NAMED[3]] * groups
        at = 1
        if not raw or raw[0] > (7 if regions else 3) or (key and raw[0] & 1):
            raise ValueError("motion section has values out of range")
        if raw[0] & 1:
            self.holds = _bits(raw, at, pieces)
            at += (pieces + 7) // 8
        if raw[0] & 4:
            if at >= len(raw) or not 1 <= raw[at] <= MAX_SHIFT:
                raise ValueError("motion section has values out of range")
            self.shifts = raw[at] * _bits(raw, at + 1, pieces).astype("i8")
            at += 1 + (pieces + 7) // 8
        if not key:
            self.continuations = []
            for _ in range(groups):
                choice = raw[at] if at < len(raw) else 255
                at += 1
                if choice < 4:
                    self.continuations.append(self._NAMED[choice])
                    continue
                if choice != 4 or at + 6 > len(raw):
                    raise ValueError("motion section has values out of range")
                listed = struct.unpack_from("<hhh", raw, at)
                if max(map(abs, listed)) > 256:
                    raise ValueError("motion section has values out of range")
                self.continuations.append(listed)
                at += 6
        self.classes = None
        has_classes = raw[0] & 2 != 0
        if has_classes != rans and (key or has_classes):
            raise ValueError("motion section has values out of range")
        if has_classes:
            self.classes = np.frombuffer(raw[at : at + groups], "u1")
            known = (self.classes < CLASSES) | (not key and self.classes == GOES_ON)
            if len(self.classes) != groups or not known.all():
                raise ValueError("motion section has values out of range")
            at += groups
        if at != len(raw):
            raise ValueError("motion section is longer than its groups")


def _bits(raw, at, pieces):
    size = (pieces + 7) // 8
    if len(raw) < at + size:
        raise ValueError("motion section is truncated")
    bits = np.unpackbits(np.frombuffer(raw, "u1", size, at), bitorder="little")
    if bits[pieces:].any():
        raise ValueError("motion section has values out of range")
    return bits[:pieces].astype(bool)
