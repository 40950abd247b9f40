"""Predictor 2 of Cleave's frame streams: core/stream/FORMAT.md sections 6.5 and 7.

Arrays of coordinates are (places, 3) int64 in the order of places.
"""

import numpy as np

from cleave.near_places import NearPlaces, in_cubes
from cleave.visible import VisiblePlaces

MAX_QUANTISED = 2**30 - 1
UNITS_PER_STEP = 64

_STENCIL = 8
_ENOUGH_NEAR = 7
_BATCH = 20000  # places whose candidates are held at once


class NodeOrder:
    """Section 7.1. nodes: mesh node of each place; begins: first place of each group, and the end."""

    def __init__(self, rest):
        low = rest.min(axis=0)
        side = max((rest.max(axis=0) - low).max(), 2.0**-1022)
        grid = ((rest - low) / side * 2097151).astype("u8")
        codes = np.zeros(len(rest), "u8")
        for axis in range(3):
            for bit in range(21):
                codes |= ((grid[:, axis] >> np.uint64(bit)) & np.uint64(1)) << np.uint64(
                    3 * bit + axis
                )
        curve = np.lexsort((np.arange(len(rest)), codes))
        differ = codes[curve[1:]] ^ codes[curve[:-1]]
        levels = np.zeros(len(rest), int)
        levels[0] = 64
        for bit in range(63):
            levels[1:][differ >= np.uint64(1) << np.uint64(bit)] = bit + 1
        groups, members, before, top = [], [], 0, None
        tops = []
        for level in range(64, -1, -1):
            of_level = np.flatnonzero(levels == level)
            if len(of_level) == 0:
                continue
            top = level if top is None else top
            members.append(of_level)
            size = sum(map(len, members))
            if 20 * size >= before:
                groups.append(np.sort(np.concatenate(members)))
                tops.append(top)
                before += size
                members, top = [], None
        if members:
            groups.append(np.sort(np.concatenate(members)))
            tops.append(top)
        self.nodes = curve[np.concatenate(groups)]
        self.grid = grid[self.nodes].astype("i8")
        self.begins = np.concatenate(([0], np.cumsum([len(group) for group in groups])))
        self.cube_bits = [(top + 2) // 3 for top in tops]
        self.group = np.repeat(np.arange(len(groups)), [len(group) for group in groups])


class Stencils:
    """Sections 7.2 to 7.5: pieces, stencils and weights of one set of broken edges, at first of
    none. ends: the places of each edge; visible: whether each place is, all but with tets, which a
    surface view has."""

    def __init__(self, order, rest, edges, tets=None):
        self._order = order
        self._rest = rest[order.nodes]
        place = np.empty(len(rest), int)
        place[order.nodes] = np.arange(len(rest))
        self.ends = place[np.asarray(edges, int).reshape(-1, 2)]
        self.places = np.full((len(rest), _STENCIL), -1)
        self.weights = np.zeros((len(rest), _STENCIL), "i8")
        self._in_space = np.ones(len(rest), bool)
        self._broken = None
        self.visible = np.ones(len(rest), bool)
        self._all_visible = None
        if tets is not None:
            self._all_visible = VisiblePlaces(len(rest), self.ends, place[np.asarray(tets, int)])
            outer = self._all_visible.of(np.empty(0, int))
            self._near = NearPlaces(order, self._rest, self.ends, outer)
        self.set_broken(np.empty(0, int))

    def set_broken(self, broken):
        """Brings everything to this set of broken edges. Returns the places with new stencils."""
        if self._broken is not None and np.array_equal(broken, self._broken):
            return np.empty(0, int)
        count = len(self._rest)
        whole = np.ones(len(self.ends), bool)
        whole[broken] = False
        ends = self.ends[whole]
        both = np.concatenate((ends, ends[:, ::-1]))
        both = both[np.lexsort((both[:, 1], both[:, 0]))]
        self._neighbours = both[:, 1]
        self._offsets = np.searchsorted(both[:, 0], np.arange(count + 1))
        if self._all_visible is not None:
            self.visible = self._all_visible.of(broken)
        self._find_pieces(ends)
        grows = self._broken is not None and np.isin(self._broken, broken).all()
        if self._all_visible is None and grows:
            # A superset of those that can change: around the breaks, and what was found in space.
            near = np.unique(self.ends[np.setdiff1d(broken, self._broken)])
            touched = self._in_space.copy()
            touched[near] = True
            touched[self._expand(near)[1]] = True
            touched = np.flatnonzero(touched)
        else:
            touched = np.flatnonzero(self.visible)
        for at in range(0, len(touched), _BATCH):
            if self._all_visible is None:
                self._search(touched[at : at + _BATCH])
            else:
                self._choose_near(touched[at : at + _BATCH], whole)
        self._broken = np.array(broken)
        return touched

    @property
    def of_labels(self):
        """Of each place those by which its label is coded (6.2), as long as no edge is broken."""
        if self._all_visible is None:
            return self.places
        return self._near.first(_STENCIL)

    def blend(self, at, positions):
        """The blends of these places, none of which leads."""
        sums = np.einsum("ij,ijk->ik", self.weights[at], positions[self.places[at]])
        return np.clip((sums + 16384) >> 15, -MAX_QUANTISED, MAX_QUANTISED)

    def fill(self, fresh, positions, rest):
        """Section 6.5: where places that have come into view were in a frame without them."""
        group = self._order.group
        known = self.visible.copy()
        known[fresh] = False
        for at in np.split(fresh, np.flatnonzero(np.diff(group[fresh])) + 1):
            leads = self.places[at, 0] < 0
            for leader in at[leads]:
                one, other = self.ends[(self.ends == leader).any(axis=1)].T
                near = np.where(one == leader, other, one)
                near = near[known[near]]
                moved = positions[near.min()] - rest[near.min()] if len(near) > 0 else 0
                positions[leader] = np.clip(rest[leader] + moved, -MAX_QUANTISED, MAX_QUANTISED)
            at = at[~leads]
            detail = rest[at] - self.blend(at, rest)
            filled = self.blend(at, positions) + detail
            positions[at] = np.clip(filled, -MAX_QUANTISED, MAX_QUANTISED)

    def _find_pieces(self, ends):
        leader = np.arange(len(self._rest))
        while True:
            low = np.minimum(leader[ends[:, 0]], leader[ends[:, 1]])
            new = leader.copy()
            for side in (0, 1):
                np.minimum.at(new, leader[ends[:, side]], low)
            while not np.array_equal(new[new], new):
                new = new[new]
            if np.array_equal(new, leader):
                break
            leader = new
        self.leaders, self.piece = np.unique(leader, return_inverse=True)
        if self._all_visible is not None:
            seen = np.flatnonzero(self.visible)
            pieces, first = np.unique(self.piece[seen], return_index=True)
            self.leaders = np.full(len(self.leaders), -1)
            self.leaders[pieces] = seen[first]
        self._leader = self.leaders[self.piece]

    def _expand(self, at):
        """Pairs (position in `at`, place that an unbroken edge joins to it)."""
        sizes = self._offsets[at + 1] - self._offsets[at]
        owners = np.repeat(np.arange(len(at)), sizes)
        within = np.arange(len(owners)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        return owners, self._neighbours[self._offsets[at][owners] + within]

    def _search(self, at):
        coarse_end = self._order.begins[self._order.group[at]]

        def coarser(owners, others):
            keep = others < coarse_end[owners]
            return owners[keep], others[keep]

        owners, others = self._expand(at)
        found = coarser(owners, others)
        few = np.bincount(found[0], minlength=len(at)) < _ENOUGH_NEAR
        between_owners, between = owners[few[owners]], others[few[owners]]
        owners, others = self._expand(between)
        found = _unique(*_join(found, coarser(between_owners[owners], others)))
        few &= np.bincount(found[0], minlength=len(at)) < _STENCIL
        self._in_space[at] = few
        found = found[0][~few[found[0]]], found[1][~few[found[0]]]
        for larger in range(3):
            few = np.bincount(found[0], minlength=len(at)) < _STENCIL
            few &= self._in_space[at]
            owners, others = in_cubes(self._order, at, np.flatnonzero(few), larger)
            same = self.piece[others] == self.piece[at[owners]]
            found = _unique(*_join(found, (owners[same], others[same])))
        self._choose(at, *self._with_leaders(at, found))

    def _choose_near(self, at, whole):
        owners, near, edges = self._near.of(at)
        usable = self.visible[near] & (self.piece[near] == self.piece[at[owners]])
        usable &= np.append(whole, True)[edges].all(axis=1)
        self._choose(at, *self._with_leaders(at, (owners[usable], near[usable])))

    def _with_leaders(self, at, found):
        lonely = np.bincount(found[0], minlength=len(at)) == 0
        lonely &= self._leader[at] != at
        return _join(found, (np.flatnonzero(lonely), self._leader[at[lonely]]))

    def _choose(self, at, owners, others):
        offset = self._rest[others] - self._rest[at[owners]]
        square = offset[:, 0] * offset[:, 0] + offset[:, 1] * offset[:, 1]
        square = square + offset[:, 2] * offset[:, 2]
        sorting = np.lexsort((others, square, owners))
        owners, others = owners[sorting], others[sorting]
        offset, square = offset[sorting], square[sorting]
        rank = np.arange(len(owners)) - np.searchsorted(owners, owners)
        near = rank < _STENCIL
        owners, others, rank = owners[near], others[near], rank[near]
        places = np.full((len(at), _STENCIL), -1)
        offsets = np.zeros((len(at), _STENCIL, 3))
        squares = np.zeros((len(at), _STENCIL))
        places[owners, rank] = others
        offsets[owners, rank] = offset[near]
        squares[owners, rank] = square[near]
        there = places >= 0
        self.weights[at] = _weights(there, offsets, squares)
        first = places[:, :1]
        self.places[at] = np.where(there, places, first)


def _join(one, other):
    return np.concatenate((one[0], other[0])), np.concatenate((one[1], other[1]))


def _unique(owners, others):
    pairs = np.unique(owners.astype("i8") << 32 | others)
    return pairs >> 32, pairs & 0xFFFFFFFF


def _weights(there, offsets, squares):
    """Section 7.4. Sums run over the stencil's places in order; absent ones add zero."""
    with np.errstate(all="ignore"):
        h = squares.max(axis=1)
        xx = yy = zz = np.full(len(there), 1e-4)
        xy = xz = yz = bx = by = bz = np.zeros(len(there))
        g = np.zeros(there.shape)
        for j in range(_STENCIL):
            dx, dy, dz = offsets[:, j].T
            u = squares[:, j] / h
            g[:, j] = 1 / (u * u + 0.02)
            f = np.where(there[:, j], g[:, j] / h, 0)
            fx, fy, fz = f * dx, f * dy, f * dz
            xx, xy, xz = xx + fx * dx, xy + fx * dy, xz + fx * dz
            yy, yz, zz = yy + fy * dy, yz + fy * dz, zz + fz * dz
            bx, by, bz = bx + fx, by + fy, bz + fz
        lxy, lxz = xy / xx, xz / xx
        myy, myz = yy - lxy * xy, yz - lxy * xz
        lyz = myz / myy
        mzz = (zz - lxz * xz) - lyz * myz
        cy = by - lxy * bx
        cz = (bz - lxz * bx) - lyz * cy
        vz = cz / mzz
        vy = cy / myy - lyz * vz
        vx = (bx / xx - lxy * vy) - lxz * vz
        w = np.zeros(there.shape)
        total = np.zeros(len(there))
        for j in range(_STENCIL):
            dx, dy, dz = offsets[:, j].T
            w[:, j] = np.where(there[:, j], g[:, j] * (1 - (dx * vx + dy * vy + dz * vz)), 0)
            total = total + w[:, j]
        shares = np.floor(w / total[:, None] * 32768 + 0.5)
        fits = ((np.abs(shares) <= 2.0**18) | ~there).all(axis=1)
    counts = there.sum(axis=1)
    alike = np.where(there, 32768 // np.maximum(counts, 1)[:, None], 0)
    weights = np.where(there & fits[:, None], np.where(fits[:, None], shares, 0), 0)
    weights = np.where(fits[:, None], weights, alike).astype("i8")
    weights[:, 0] += np.where(counts > 0, 32768 - weights.sum(axis=1), 0)
    return weights


class Predictor:
    """Section 6.5. Holds the stencils of one mesh; a state's arrays are given to each call."""

    def __init__(self, rest, edges, tets=None):
        self.order = NodeOrder(rest)
        self.stencils = Stencils(self.order, rest, edges, tets)

    def decode(self, key, motion, residuals, rest, last, before):
        """Positions of a frame from residuals of all places (0 where pieces hold) and q of rest, of
        the base frame and of the one before it (both None in a key frame)."""
        stencils, begins = self.stencils, self.order.begins
        residuals = residuals << motion.shifts[stencils.piece, None]
        q = np.zeros((len(rest), 3), "i8")
        held = motion.holds[stencils.piece]
        leads = stencils.places[:, 0] < 0
        start = np.flatnonzero(leads & stencils.visible)
        ahead = (
            rest
            if key
            else np.clip(2 * last - before, -MAX_QUANTISED, MAX_QUANTISED)
        )
        q[start] = ahead[start] + UNITS_PER_STEP * residuals[start]
        if not key:
            q[start] = np.where(held[start, None], last[start], q[start])
        for group, (a, b, c) in enumerate(motion.continuations):
            at = np.arange(begins[group], begins[group + 1])
            at = at[~leads[at] & stencils.visible[at]]
            blend = stencils.blend(at, q)
            ahead = c * (rest[at] - stencils.blend(at, rest))
            if a != 0:
                ahead += a * (last[at] - stencils.blend(at, last))
            if b != 0:
                ahead += b * (before[at] - stencils.blend(at, before))
            predicted = np.clip(blend + ((ahead + 32) >> 6), -MAX_QUANTISED, MAX_QUANTISED)
            q[at] = predicted + UNITS_PER_STEP * residuals[at]
            if not key:
                q[at] = np.where(held[at, None], last[at], q[at])
            if np.abs(q[at]).max(initial=0) > MAX_QUANTISED:
                break  # out of range; the caller refuses the frame
        return q
