"""Coder 2 of Cleave's frame streams: core/stream/FORMAT.md section 6.6."""

import struct

import numpy as np

CLASSES = 16
_MASKS, _TOKENS = 8, 58
_THRESHOLDS = np.array([1, 2, 3, 4, 6, 9, 14, 20, 32, 48, 80, 128, 224, 448, 1024])
_ACTIVITIES = np.array([0, 1, 2, 3, 5, 7, 11, 17, 25, 39, 62, 101, 170, 316, 680, 2400])


def _prior():
    masks = np.zeros((CLASSES, _MASKS), "i8")
    tokens = np.zeros((CLASSES, _TOKENS), "i8")
    for index, a in enumerate(map(int, _ACTIVITIES)):
        every = 48 + a
        for mask in range(_MASKS):
            bits = bin(mask).count("1")
            masks[index, mask] = 256 * a**bits * 48 ** (3 - bits) // every**3
        reach = [2**32]
        for _ in range(16):
            reach.append(reach[-1] * a // every)
        half = reach[8]
        for j in range(16, _TOKENS, 2):
            reach.append(reach[j] * half >> 32)
            reach.append(reach[j] * reach[j] >> 32)
            half = reach[j]
        tokens[index] = [(reach[j] - reach[j + 1]) >> 24 for j in range(_TOKENS)]
    return masks, tokens


_PRIOR = _prior()


def _ranges(counts):
    """Of one alphabet: (symbol, first slot, frequency) of each slot."""
    counts = [int(count) for count in counts]
    total = sum(counts)
    frequencies = [
        1 + (count * (4096 - len(counts)) // total if total else 0) for count in counts
    ]
    frequencies[counts.index(max(counts))] += 4096 - sum(frequencies)
    slots, start = [], 0
    for symbol, frequency in enumerate(frequencies):
        slots += [(symbol, start, frequency)] * frequency
        start += frequency
    return slots


class ResidualHistory:
    """What coder 2 remembers. Never changed: a frame makes a new one."""

    def __init__(self, places):
        self.activities = np.zeros(places, "i8")
        self.masks, self.tokens = _PRIOR
        self.fresh = True

    def begin(self, key, group_classes, groups):
        """Starts a frame. group_classes: the motion's, in a fresh frame; groups: of each place."""
        return _FrameDecoder(self, key, group_classes, groups)


class _FrameDecoder:
    """Decodes the chunks of one frame."""

    def __init__(self, history, key, group_classes, groups):
        if group_classes is None:
            self._activities = history.activities.copy()
            self._begin = (history.masks, history.tokens)
        else:
            self._activities = _ACTIVITIES[np.asarray(group_classes)][groups]
            self._begin = _PRIOR
        self._key = key
        self._added = (np.zeros((CLASSES, _MASKS), "i8"), np.zeros((CLASSES, _TOKENS), "i8"))
        self._slots = ({}, {})

    def decode(self, raw_bytes, coded, places):
        """Residuals of these places, len(places) x 3. Raises ValueError for damaged bytes."""
        classes = np.searchsorted(_THRESHOLDS, self._activities[places], "right")
        if raw_bytes == 0 and not coded:
            residuals = np.zeros((len(places), 3), "i8")
            np.add.at(self._added[0], (classes, 0), 1)
        elif raw_bytes != 12 * len(places):
            raise ValueError("positions section does not fit its frame")
        else:
            residuals = np.array(self._decode(coded, classes.tolist()), "i8").reshape(-1, 3)
        sizes = np.minimum(np.abs(residuals).sum(axis=1), 4095)
        self._activities[places] = (3 * self._activities[places] + 16 * sizes) >> 2
        return residuals

    def finish(self):
        """The history after the frame."""
        after = ResidualHistory(0)
        after.activities = self._activities
        after.masks, after.tokens = (
            begin * 3 // 4 + added for begin, added in zip(self._begin, self._added)
        )
        after.fresh = self._key
        return after

    def _table(self, alphabet, index):
        table = self._slots[alphabet].get(index)
        if table is None:
            table = self._slots[alphabet][index] = _ranges(self._begin[alphabet][index])
        return table

    def _decode(self, coded, classes):
        if len(coded) < 20:
            raise ValueError("residuals are truncated")
        count, *states = struct.unpack_from("<5I", coded)
        if len(coded) < 20 + 2 * count or min(states) < 2**16:
            raise ValueError("residuals are truncated")
        words = np.frombuffer(coded, "<u2", count, 20).tolist()
        words.reverse()
        bits = _PlainBits(coded[20 + 2 * count :])
        at = 0

        def take(slots):
            nonlocal at
            state = states[at]
            symbol, first, frequency = slots[state & 4095]
            state = frequency * (state >> 12) + (state & 4095) - first
            if state < 2**16:
                if not words:
                    raise ValueError("residuals are truncated")
                state = state << 16 | words.pop()
            states[at] = state
            at = (at + 1) & 3
            return symbol

        residuals = []
        masks, tokens = self._added
        for index in classes:
            mask = take(self._table(0, index))
            masks[index, mask] += 1
            for axis in range(3):
                if not mask >> axis & 1:
                    residuals.append(0)
                    continue
                m = take(self._table(1, index))
                tokens[index, m] += 1
                negative = bits.take(1)
                if m >= 16:
                    low = 3 + (m - 16) // 2
                    m = (2 + m % 2) << low | bits.take(low)
                residuals.append(-m - 1 if negative else m + 1)
        if words or states != [2**16] * 4 or not bits.finished():
            raise ValueError("residuals do not end with their section")
        return residuals


class _PlainBits:
    """The bits of bytes, the lowest of a byte first."""

    def __init__(self, data):
        self._bits = np.unpackbits(np.frombuffer(data, "u1"), bitorder="little").tolist()
        self._at = 0

    def take(self, count):
        """The next bits, the first lowest."""
        end = self._at + count
        if end > len(self._bits):
            raise ValueError("residuals are truncated")
        value = 0
        for bit in reversed(self._bits[self._at : end]):
            value = value << 1 | bit
        self._at = end
        return value

    def finished(self):
        """True if only the filling of the last byte is left."""
        return len(self._bits) - self._at < 8 and not any(self._bits[self._at :])
