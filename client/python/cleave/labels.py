"""Topology labels of Cleave's frame streams: core/stream/FORMAT.md section 6.2."""

import numpy as np

from cleave.residuals import RansReader, slots_of

_NEW, _LISTED = 254, 255


class PieceLabels:
    """Decodes labels for one mesh. `stencils` have seen no broken edge yet."""

    def __init__(self, stencils):
        self._ends = stencils.ends
        places = stencils.of_labels
        there = places >= 0
        there[:, 1:] &= places[:, 1:] != places[:, :1]  # unused ones repeat the first
        self._earlier = [row[ok].tolist() for row, ok in zip(places, there)]

    def decode(self, coded):
        """The edges between labels, ascending. Raises ValueError for damaged bytes."""
        if len(coded) < 64:
            raise ValueError("topology labels are truncated")
        frequencies = np.frombuffer(coded, "<u2", 32).reshape(8, 4).astype(int)
        if (frequencies == 0).any() or (frequencies.sum(axis=1) != 4096).any():
            raise ValueError("topology labels have frequencies that do not add up")
        slots = [slots_of(of_context) for of_context in frequencies.tolist()]
        reader = RansReader(coded[64:])
        labels, so_far = [], 0
        for earlier in self._earlier:
            ranked, context = _ranked([labels[at] for at in earlier])
            k = reader.take(slots[context])
            if k == 3:
                k = reader.bits(8)
            if k == _NEW:
                labels.append(so_far)
                so_far += 1
                continue
            if k == _LISTED:
                label = reader.bits(32)
            else:
                label = ranked[k] if k < len(ranked) else so_far
            if label >= so_far:
                raise ValueError("topology labels name a label that is not there")
            labels.append(label)
        reader.finish()
        labels = np.array(labels)
        return np.flatnonzero(labels[self._ends[:, 0]] != labels[self._ends[:, 1]])


def _ranked(labels):
    """The labels from the most frequent on, and the context."""
    counts = {}  # keeps the order of first appearance
    for label in labels:
        counts[label] = counts.get(label, 0) + 1
    ranked = sorted(counts, key=counts.get, reverse=True)  # stable: ties keep their order
    if len(ranked) < 2:
        return ranked, sum(1 for least in (1, 3) if sum(counts.values()) >= least)
    return ranked, 7 - min(counts[ranked[0]] - counts[ranked[1]], 4)
