"""Coarser places round a place: core/stream/FORMAT.md section 7.3."""

import numpy as np

_OUTER = 16
_BATCH = 2048


class NearPlaces:
    """Those from which a surface view may predict a place, and the edges that lead there. ends: the
    places of each edge of the mesh; outer: whether each place is visible where no edge is broken."""

    def __init__(self, order, rest, ends, outer):
        rows = []
        for group in range(len(order.begins) - 1):
            first, end = order.begins[group : group + 2]
            if first == 0:
                continue
            wanted = 24 << min(int(len(rest) // first).bit_length() // 3, 5)
            for begin in range(first, end, _BATCH):
                at = np.arange(begin, min(begin + _BATCH, end))
                owners, others = _nearest(order, rest, at, wanted)
                if outer[at].any():
                    more, outer_others = _nearest(order, rest, at[outer[at]], _OUTER, outer)
                    more = np.flatnonzero(outer[at])[more]
                    pairs = np.concatenate((owners, more)) << 32
                    pairs = np.unique(pairs | np.concatenate((others, outer_others)))
                    owners, others = pairs >> 32, pairs & 0xFFFFFFFF
                    owners, others = _by_distance(rest, at, owners, others)
                rows.append((at[owners], others))
        owners = np.concatenate([owners for owners, _ in rows] + [np.empty(0, int)])
        self._places = np.concatenate([others for _, others in rows] + [np.empty(0, int)])
        self._begins = np.searchsorted(owners, np.arange(len(rest) + 1))
        self._edges = np.full((len(owners), 2), len(ends))
        both = np.concatenate((ends, ends[:, ::-1]))
        sorting = np.lexsort((both[:, 1], both[:, 0]))
        ids = np.tile(np.arange(len(ends)), 2)[sorting]
        for first in range(0, len(owners), 16 * _BATCH):
            some = slice(first, first + 16 * _BATCH)
            self._edges[some] = _edges_to(both[sorting], ids, owners[some], self._places[some])

    def of(self, at):
        """The near places of these: triples (position in `at`, place, ids of its two edges), nearest
        first. The ids are those of one edge twice, or the number of edges where there is none."""
        sizes = self._begins[at + 1] - self._begins[at]
        owners = np.repeat(np.arange(len(at)), sizes)
        within = np.arange(len(owners)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        rows = self._begins[at][owners] + within
        return owners, self._places[rows], self._edges[rows]

    def first(self, count):
        """Of each place the first `count`, -1 where there are fewer."""
        rows = self._begins[:-1, None] + np.arange(count)
        there = rows < self._begins[1:, None]
        return np.where(there, np.append(self._places, -1)[np.where(there, rows, -1)], -1)


def in_cubes(order, at, wanting, larger, among=None):
    """Pairs (position in `at`, coarser place): of those at the positions `wanting`, what is in the 27
    cubes round each, which are 2^larger times as wide as the least. among: whether each place counts."""
    owners, others = [np.empty(0, int)], [np.empty(0, int)]
    groups = order.group[at[wanting]]
    for group in np.unique(groups):
        bits = order.cube_bits[group] + larger
        if bits > 21:
            continue
        mine = wanting[groups == group]
        coarse = np.arange(order.begins[group])
        if among is not None:
            coarse = coarse[among[coarse]]
        keys = _cube_key(order.grid[coarse] >> bits)
        sorting = np.argsort(keys, kind="stable")
        keys, coarse = keys[sorting], coarse[sorting]
        cubes = order.grid[at[mine]] >> bits
        for offset in np.ndindex(3, 3, 3):
            cube = cubes + np.array(offset) - 1
            inside = ((cube >= 0) & (cube < 1 << (21 - bits))).all(axis=1)
            key = _cube_key(cube[inside])
            first = np.searchsorted(keys, key, "left")
            sizes = np.searchsorted(keys, key, "right") - first
            owner = np.repeat(mine[inside], sizes)
            within = np.arange(len(owner)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
            owners.append(owner)
            others.append(coarse[np.repeat(first, sizes) + within])
    return np.concatenate(owners), np.concatenate(others)


def _cube_key(cube):
    return (cube[:, 0] << 42) | (cube[:, 1] << 21) | cube[:, 2]


def _nearest(order, rest, at, wanted, among=None):
    """The nearest coarser places of these, which are of one group: pairs as in_cubes gives."""
    owners, others = np.empty(0, int), np.empty(0, int)
    for larger in range(4):
        few = np.bincount(owners, minlength=len(at)) < 2 * wanted
        more_owners, more = in_cubes(order, at, np.flatnonzero(few), larger, among)
        replaced = np.zeros(len(at), bool)  # larger cubes hold what smaller ones do
        replaced[more_owners] = True
        kept = ~replaced[owners]
        owners = np.concatenate((owners[kept], more_owners))
        others = np.concatenate((others[kept], more))
    owners, others = _by_distance(rest, at, owners, others)
    near = np.arange(len(owners)) - np.searchsorted(owners, owners) < wanted
    return owners[near], others[near]


def _by_distance(rest, at, owners, others):
    offset = rest[others] - rest[at[owners]]
    square = offset[:, 0] * offset[:, 0] + offset[:, 1] * offset[:, 1]
    square = square + offset[:, 2] * offset[:, 2]
    sorting = np.lexsort((others, square, owners))
    return owners[sorting], others[sorting]


def _edges_to(both, ids, owners, places):
    """The two edges of each pair. both: every edge in both directions, sorted; ids: of which edge."""
    found = np.full((len(owners), 2), len(ids) // 2)
    if len(ids) == 0:
        return found
    keys = both[:, 0] << 32 | both[:, 1]

    def rows_of(one, other):
        wanted = one << 32 | other
        row = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        return np.where(keys[row] == wanted, row, -1)

    # All ways over a place between, the lowest of these first.
    begins = np.searchsorted(both[:, 0], owners)
    sizes = np.searchsorted(both[:, 0], owners, "right") - begins
    pair = np.repeat(np.arange(len(owners)), sizes)
    to = begins[pair] + np.arange(len(pair)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    on = rows_of(both[to, 1], places[pair])
    pair, to, on = pair[on >= 0], to[on >= 0], on[on >= 0]
    pair, lowest = np.unique(pair, return_index=True)
    found[pair] = np.stack((ids[to[lowest]], ids[on[lowest]]), axis=1)
    direct = rows_of(owners, places)
    found[direct >= 0] = ids[direct[direct >= 0]][:, None]
    return found
