"""Coder 2 of Cleave's frame streams: core/stream/FORMAT.md section 6.6."""

import struct

import numpy as np

CLASSES = 16
GOES_ON = 255  # a group's class: its places go on from their activities
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


def _frequencies(counts):
    counts = [int(count) for count in counts]
    total = sum(counts)
    frequencies = [
        1 + (count * (4096 - len(counts)) // total if total else 0) for count in counts
    ]
    frequencies[counts.index(max(counts))] += 4096 - sum(frequencies)
    return frequencies


def slots_of(frequencies):
    """Of one alphabet: (symbol, first slot, frequency) of each slot."""
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

    def begin(self, key, group_classes, groups):
        """Starts a frame. group_classes: the motion's, or None; groups: of each place."""
        return _FrameDecoder(self, key, group_classes, groups)


class _FrameDecoder:
    """Decodes the chunks of one frame."""

    def __init__(self, history, key, group_classes, groups):
        self._activities = history.activities.copy()
        if group_classes is not None:
            classes = np.asarray(group_classes, int)[groups]
            begins = classes != GOES_ON
            self._activities[begins] = _ACTIVITIES[classes[begins]]
        self._begin = _PRIOR if key else (history.masks, history.tokens)
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
        return after

    def _table(self, alphabet, index):
        table = self._slots[alphabet].get(index)
        if table is None:
            table = self._slots[alphabet][index] = slots_of(
                _frequencies(self._begin[alphabet][index])
            )
        return table

    def _decode(self, coded, classes):
        reader = RansReader(coded)
        residuals = []
        masks, tokens = self._added
        for index in classes:
            mask = reader.take(self._table(0, index))
            masks[index, mask] += 1
            for axis in range(3):
                if not mask >> axis & 1:
                    residuals.append(0)
                    continue
                m = reader.take(self._table(1, index))
                tokens[index, m] += 1
                negative = reader.bits(1)
                if m >= 16:
                    low = 3 + (m - 16) // 2
                    m = (2 + m % 2) << low | reader.bits(low)
                residuals.append(-m - 1 if negative else m + 1)
        reader.finish()
        return residuals


class RansReader:
    """Section 6.6, "Bytes". Raises ValueError for what is not there."""

    def __init__(self, coded):
        if len(coded) < 20:
            raise ValueError("rANS bytes are truncated")
        count, *self._states = struct.unpack_from("<5I", coded)
        if len(coded) < 20 + 2 * count or min(self._states) < 2**16:
            raise ValueError("rANS bytes are truncated")
        self._words = np.frombuffer(coded, "<u2", count, 20)[::-1].tolist()
        plain = np.frombuffer(coded, "u1", offset=20 + 2 * count)
        self._plain = np.unpackbits(plain, bitorder="little").tolist()
        self._plain_at = 0
        self._at = 0

    def take(self, slots):
        """The next symbol, by what slots_of made of its frequencies."""
        state = self._states[self._at]
        symbol, first, frequency = slots[state & 4095]
        state = frequency * (state >> 12) + (state & 4095) - first
        if state < 2**16:
            if not self._words:
                raise ValueError("rANS bytes are truncated")
            state = state << 16 | self._words.pop()
        self._states[self._at] = state
        self._at = (self._at + 1) & 3
        return symbol

    def bits(self, count):
        """The next plain bits, the first lowest."""
        end = self._plain_at + count
        if end > len(self._plain):
            raise ValueError("rANS bytes are truncated")
        value = 0
        for bit in reversed(self._plain[self._plain_at : end]):
            value = value << 1 | bit
        self._plain_at = end
        return value

    def finish(self):
        """Everything must have been used but the filling of the last byte."""
        left = self._plain[self._plain_at :]
        if self._words or self._states != [2**16] * 4 or len(left) >= 8 or any(left):
            raise ValueError("rANS bytes do not end with their section")
