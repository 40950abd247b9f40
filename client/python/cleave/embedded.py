"""A fine mesh that goes with the frames of a coarse simulation, as numpy arrays. Needs numpy.

    fine = EmbeddedVertices(mesh.positions, mesh.tets, vertices)
    for frame in session.frames():
        moved = fine.move(frame.positions, frame.broken_edges)
        whole = triangles[~fine.torn(triangles)]
"""

import numpy as np

from cleave.stream import edges_of

_TET_EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
_TET_FACES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))
_BLOCK = 1_000_000  # pairs at a time
_SLACK = 1e-9  # what counts as the same: of weights, and of distances by the body's diagonal
_STRETCH = (0.2, 5.0)


class EmbeddedVertices:
    """Vertices of a fine mesh round a body, bound to its tets, each moving with its side of cracks.

    A vertex goes with the lowest tet in which none of its weights is below -1e-9; outside, with the
    lowest of those tets that have a boundary face at most 1e-9 of the body's diagonal farther off than
    the nearest one. It belongs to the node that weighs most there, of those within 1e-9 the smallest.
    While unbroken edges join the tet's nodes it is interpolated; else it moves with the nodes x on its
    own side, as the mean of x + F (X_vertex - X), F the mean deformation gradient of the unseparated
    tets at the node, its stretches held within [0.2, 5]. A node without such tets keeps the last F that
    it had while one of its tets was separated; one that had none is turned as its tets are on the mean.
    That is the rule of `cleave export --render-mesh`, which cuts the mesh as well; here triangles stay
    whole, and `torn` tells which lie across a crack. Positions agree to round-off.

    rest_positions: nodes x 3, tets: tets x 4 (node ids), vertices: n x 3; m, at rest. After each move,
    positions (n x 3, m) and pieces (n, the smallest node of each vertex's piece) are of that frame.
    Raises ValueError for arrays of other shapes and numbers that are not finite. Not thread-safe.
    """

    def __init__(self, rest_positions, tets, vertices):
        self._rest = np.asarray(rest_positions, "f8")
        self._tets = np.asarray(tets, "i8")
        self.rest_vertices = np.array(vertices, "f8")
        if self._rest.ndim != 2 or self._rest.shape[1] != 3:
            raise ValueError(f"rest_positions: shape {self._rest.shape} is not (nodes, 3)")
        if self._tets.ndim != 2 or self._tets.shape[1] != 4 or len(self._tets) == 0:
            raise ValueError(f"tets: shape {self._tets.shape} is not (tets, 4)")
        if self._tets.min() < 0 or self._tets.max() >= len(self._rest):
            raise ValueError(f"tets: a node is outside [0, {len(self._rest)})")
        if self.rest_vertices.ndim != 2 or self.rest_vertices.shape[1] != 3:
            raise ValueError(f"vertices: shape {self.rest_vertices.shape} is not (n, 3)")
        for name, places in ("rest_positions", self._rest), ("vertices", self.rest_vertices):
            bad = np.flatnonzero(~np.isfinite(places).all(axis=1))
            if len(bad) > 0:
                raise ValueError(f"{name}[{bad[0]}]: {places[bad[0]]} is not finite")
        self._edges = edges_of(self._tets)
        self._keys = self._edges[:, 0] << 32 | self._edges[:, 1]
        self._tet_edges = np.stack(
            [self._edge_ids(self._tets[:, a], self._tets[:, b]) for a, b in _TET_EDGES], axis=1
        )
        corners = self._rest[self._tets]
        shape = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
        self._six_volumes = np.linalg.det(shape)
        if not (self._six_volumes > 0).all():
            raise ValueError("tets: one has no positive volume")
        self._inverses = np.linalg.inv(shape)
        self.tets, self.weights = self._locate()
        enough = self.weights.max(axis=1, keepdims=True) - _SLACK
        candidates = np.where(self.weights >= enough, self._tets[self.tets], len(self._rest))
        own = np.argmin(candidates, axis=1)
        self.nodes = np.take_along_axis(self._tets[self.tets], own[:, None], axis=1)[:, 0]
        self._own = own
        self._gradients = np.tile(np.eye(3), (len(self._rest), 1, 1))
        self._has_gradient = np.zeros(len(self._rest), bool)
        self._split = np.zeros(len(self._edges), bool)
        self._node_pieces = np.arange(len(self._rest))
        self._broken = None
        self.positions = self.rest_vertices
        self.pieces = None

    def move(self, positions, broken_edges):
        """Where the vertices are (n x 3, m) when nodes are at `positions` (m) and `broken_edges`
        (ascending ids, as frames have them) are broken. Frames come in order; some may be left out.
        Raises ValueError for arrays of other shapes, positions that are not finite, and edges that are
        not there."""
        positions = np.asarray(positions, "f8")
        if positions.shape != self._rest.shape:
            raise ValueError(f"positions: shape {positions.shape} is not {self._rest.shape}")
        lost = np.flatnonzero(~np.isfinite(positions).all(axis=1))
        if len(lost) > 0:
            raise ValueError(
                f"positions[{lost[0]}]: {positions[lost[0]]} is not finite; a fine mesh needs all nodes, "
                "which frames of a surface view have not"
            )
        broken = np.asarray(broken_edges, "i8")
        if len(broken) > 0 and not 0 <= broken.min() <= broken.max() < len(self._edges):
            raise ValueError(f"broken_edges: an edge is outside [0, {len(self._edges)})")
        if self._broken is None or not np.array_equal(broken, self._broken):
            self._take_apart(broken)
        corners = positions[self._tets[self.tets]]
        moved = np.einsum("nk,nki->ni", self.weights, corners)
        self._find_gradients(positions)
        apart = np.flatnonzero(~self._owners.all(axis=1))
        if len(apart) > 0:
            moved[apart] = self._carried(apart, positions)
        self.positions = moved
        self.pieces = self._node_pieces[self.nodes]
        return moved

    def torn(self, triangles):
        """Which triangles (vertex ids, 3 a row) lie across a crack of the last frame moved to."""
        triangles = np.asarray(triangles, "i8").reshape(-1, 3)
        torn = np.zeros(len(triangles), bool)
        for k in range(3):
            a = self.nodes[triangles[:, k]]
            b = self.nodes[triangles[:, (k + 1) % 3]]
            edge = self._edge_ids(a, b)
            split = np.where(
                edge >= 0, self._split[edge], self._node_pieces[a] != self._node_pieces[b]
            )
            torn |= split & (a != b)
        return torn

    def _edge_ids(self, a, b):
        """Edges between nodes, -1 where there is none."""
        key = np.minimum(a, b) << 32 | np.maximum(a, b)
        place = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
        return np.where(self._keys[place] == key, place, -1)

    def _locate(self):
        count = len(self.rest_vertices)
        tets = np.full(count, len(self._tets))
        for vertices, found in self._neighbours():
            inside = self._weights_in(found, vertices).min(axis=1) >= -_SLACK
            np.minimum.at(tets, vertices[inside], found[inside])
        outside = np.flatnonzero(tets == len(self._tets))
        if len(outside) > 0:
            tets[outside] = self._nearest_tets(self.rest_vertices[outside])
        return tets, self._weights_in(tets, np.arange(count))

    def _weights_in(self, tets, vertices):
        """Barycentric weights (n x 4) of vertices in tets."""
        offsets = self.rest_vertices[vertices] - self._rest[self._tets[tets, 0]]
        inner = np.einsum("tij,tj->ti", self._inverses[tets], offsets)
        return np.column_stack([1 - inner.sum(axis=1), inner])

    def _neighbours(self):
        """Yields pairs (vertices, tets), arrays of one length, among which are those of every vertex
        and a tet that it lies in: those in whose cell of a grid the tet's box has a part."""
        corners = self._rest[self._tets]
        low, high = corners.min(axis=1), corners.max(axis=1)
        start = low.min(axis=0)
        extent = high.max(axis=0) - start
        size = max(1.5 * np.cbrt(extent.prod() / len(self._tets)), extent.max() / 128)
        shape = np.maximum((extent / size).astype("i8") + 1, 1)

        def cells(places):
            return np.clip(np.floor((places - start) / size), 0, shape - 1).astype("i8")

        first = cells(low - 1e-6 * size)
        spans = cells(high + 1e-6 * size) - first + 1
        tets, step = _spread(spans.prod(axis=1))
        span = spans[tets]
        at = first[tets] + np.column_stack(
            [step // (span[:, 1] * span[:, 2]), step // span[:, 2] % span[:, 1], step % span[:, 2]]
        )
        keys = np.ravel_multi_index(at.T, shape)
        order = np.argsort(keys, kind="stable")
        tets = tets[order]
        starts = np.searchsorted(keys[order], np.arange(shape.prod() + 1))
        home = np.ravel_multi_index(cells(self.rest_vertices).T, shape)
        counts = starts[home + 1] - starts[home]
        for begin, end in _blocks(counts):
            row, step = _spread(counts[begin:end])
            yield begin + row, tets[starts[home[begin + row]] + step]

    def _nearest_tets(self, places):
        """For places outside of all tets, the lowest tet with a nearest boundary face."""
        faces = self._tets[:, _TET_FACES].reshape(-1, 3)
        _, first, count = np.unique(
            np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
        )
        of_boundary = first[count == 1]
        corners = self._rest[faces[of_boundary]]
        owners = of_boundary // 4
        centers = corners.mean(axis=1)
        radii = np.linalg.norm(corners - centers[:, None], axis=2).max(axis=1)
        used = self._rest[np.unique(self._tets)]
        slack = _SLACK * np.linalg.norm(used.max(axis=0) - used.min(axis=0))
        found = np.empty(len(places), "i8")
        block = max(1, _BLOCK // len(centers))
        for begin in range(0, len(places), block):
            part = places[begin : begin + block]
            away = np.linalg.norm(part[:, None] - centers, axis=2)
            # A face's centre is in it, so that the nearest face is no farther than any centre.
            near = away - radii <= away.min(axis=1, keepdims=True) + 2 * slack
            row, face = np.nonzero(near)
            distance = _distances(part[row], *corners[face].transpose(1, 0, 2))
            nearest = np.full(len(part), np.inf)
            np.minimum.at(nearest, row, distance)
            tie = distance <= nearest[row] + slack
            lowest = np.full(len(part), len(self._tets))
            np.minimum.at(lowest, row[tie], owners[face[tie]])
            found[begin : begin + block] = lowest
        return found

    def _take_apart(self, broken):
        self._broken = broken
        whole = np.ones(len(self._edges), bool)
        whole[broken] = False
        groups = np.tile(np.arange(4), (len(self._tets), 1))
        for _ in range(3):
            for k, (a, b) in enumerate(_TET_EDGES):
                joined = whole[self._tet_edges[:, k]]
                low = np.minimum(groups[:, a], groups[:, b])
                groups[joined, a] = low[joined]
                groups[joined, b] = low[joined]
        self._live = (groups == 0).all(axis=1)
        self._split = np.ones(len(self._edges), bool)
        for k, (a, b) in enumerate(_TET_EDGES):
            self._split[self._tet_edges[groups[:, a] == groups[:, b], k]] = False
        mine = groups[self.tets]
        self._owners = mine == np.take_along_axis(mine, self._own[:, None], axis=1)
        pieces = np.arange(len(self._rest))
        ends = self._edges[whole]
        while True:
            low = np.minimum(pieces[ends[:, 0]], pieces[ends[:, 1]])
            before = pieces.copy()
            for side in range(2):
                np.minimum.at(pieces, ends[:, side], low)
            pieces = pieces[pieces]
            if np.array_equal(pieces, before):
                break
        self._node_pieces = pieces

    def _find_gradients(self, positions):
        wanted = np.zeros(len(self._rest), bool)  # those that may be on one side of a crack
        wanted[self._tets[~self._live]] = True
        if not wanted.any():
            return
        whole, has_live = self._mean_gradients(positions, self._live)
        u, stretches, v = np.linalg.svd(whole)
        clamped = (u * np.clip(stretches, *_STRETCH)[:, None, :]) @ v
        held = ((stretches >= _STRETCH[0]) & (stretches <= _STRETCH[1])).all(axis=1)
        now = wanted & has_live  # the others keep the last
        self._gradients[now] = np.where(held[:, None, None], whole, clamped)[now]
        never = wanted & ~has_live & ~self._has_gradient
        if never.any():
            every, _ = self._mean_gradients(positions, np.ones(len(self._tets), bool))
            u, _, v = np.linalg.svd(every[never])
            u[np.linalg.det(u @ v) < 0, :, 2] *= -1
            self._gradients[never] = u @ v
        self._has_gradient |= wanted

    def _mean_gradients(self, positions, counted):
        """Volume-weighted mean deformation gradients of the counted tets at each node, and which nodes
        have any; identity where none."""
        tets = np.flatnonzero(counted)
        corners = positions[self._tets[tets]]
        shape = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
        gradients = self._six_volumes[tets, None, None] * (shape @ self._inverses[tets])
        means = np.tile(np.eye(3), (len(self._rest), 1, 1))
        sums = np.zeros_like(means)
        volumes = np.zeros(len(self._rest))
        for k in range(4):
            np.add.at(sums, self._tets[tets, k], gradients)
            np.add.at(volumes, self._tets[tets, k], self._six_volumes[tets])
        has = volumes > 0
        means[has] = sums[has] / volumes[has, None, None]
        return means, has

    def _carried(self, vertices, positions):
        nodes = self._tets[self.tets[vertices]]
        offsets = self.rest_vertices[vertices][:, None, :] - self._rest[nodes]
        each = positions[nodes] + np.einsum("nkij,nkj->nki", self._gradients[nodes], offsets)
        owners = self._owners[vertices]
        return np.einsum("nk,nki->ni", owners / owners.sum(axis=1, keepdims=True), each)


def _spread(counts):
    """For counts of items a row: the row of every item, and its number in the row."""
    rows = np.repeat(np.arange(len(counts)), counts)
    return rows, np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)


def _blocks(counts):
    """Ranges of rows with about _BLOCK items each, at least a row."""
    ends = np.cumsum(counts)
    begin = 0
    while begin < len(counts):
        before = ends[begin - 1] if begin > 0 else 0
        end = max(begin + 1, int(np.searchsorted(ends, before + _BLOCK, side="right")))
        yield begin, end
        begin = end


def _distances(p, a, b, c):
    """Distances of points from triangles (all n x 3). Source: Ericson, Real-Time Collision Detection,
    5.1.5: the nearest of the triangle's plane within it and its three sides."""
    normal = np.cross(b - a, c - a)
    within = np.ones(len(p), bool)
    nearest = np.full(len(p), np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        side = end - start
        share = np.einsum("ij,ij->i", p - start, side) / np.einsum("ij,ij->i", side, side)
        foot = start + np.clip(share, 0, 1)[:, None] * side
        nearest = np.minimum(nearest, np.linalg.norm(p - foot, axis=1))
        within &= np.einsum("ij,ij->i", np.cross(side, p - start), normal) >= 0
    height = np.abs(np.einsum("ij,ij->i", p - a, normal)) / np.linalg.norm(normal, axis=1)
    return np.where(within, np.minimum(nearest, height), nearest)
