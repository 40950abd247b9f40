"""A fine mesh that goes with the frames of a coarse simulation, as numpy arrays. Needs numpy.

    fine = EmbeddedVertices(mesh.positions, mesh.tets, vertices)
    for frame in session.frames():
        moved = fine.move(frame.positions, frame.broken_edges)
        whole = triangles[~fine.torn(triangles)]
"""

import numpy as np

from cleave.stream import edges_of

_TET_EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
_NEAREST_NODES = 6  # whose tets a vertex is looked for in
_BLOCK = 4_000_000  # distances at a time
_STRETCH = (0.2, 5.0)


class EmbeddedVertices:
    """Vertices of a fine mesh round a body, bound to its tets, each moving with its side of cracks.

    A vertex goes with the tet that it lies in (outside, with one of the nearest) and belongs to the
    node that weighs most there. While unbroken edges join the tet's nodes it is interpolated; else it
    moves with the nodes x on its own side, as the mean of x + F (X_vertex - X), F the mean deformation
    gradient of the unseparated tets at the node, its stretches held within [0.2, 5]. That is the rule
    of `cleave export --render-mesh`, which cuts the mesh as well; here triangles stay whole, and
    `torn` tells which lie across a crack.

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
        own = np.argmax(self.weights, axis=1)
        self.nodes = np.take_along_axis(self._tets[self.tets], own[:, None], axis=1)[:, 0]
        self._own = own
        self._gradients = np.tile(np.eye(3), (len(self._rest), 1, 1))
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
        apart = np.flatnonzero(~self._owners.all(axis=1))
        if len(apart) > 0:
            self._find_gradients(positions)
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
        order = np.argsort(self._tets.ravel(), kind="stable")
        around = order // 4
        starts = np.searchsorted(self._tets.ravel()[order], np.arange(len(self._rest) + 1))
        used = np.flatnonzero(np.diff(starts) > 0)
        near = min(_NEAREST_NODES, len(used))
        tets = np.zeros(count, "i8")
        weights = np.zeros((count, 4))
        block = max(1, _BLOCK // len(used))
        for begin in range(0, count, block):
            part = self.rest_vertices[begin : begin + block]
            square = ((part[:, None, :] - self._rest[used][None, :, :]) ** 2).sum(axis=2)
            nearest = used[np.argpartition(square, near - 1, axis=1)[:, :near]]
            for i, point in enumerate(part):
                found = np.unique(np.concatenate([around[starts[n] : starts[n + 1]] for n in nearest[i]]))
                offsets = point - self._rest[self._tets[found, 0]]
                inner = np.einsum("tij,tj->ti", self._inverses[found], offsets)
                each = np.column_stack([1 - inner.sum(axis=1), inner])
                best = np.argmax(each.min(axis=1))
                tets[begin + i] = found[best]
                weights[begin + i] = each[best]
        return tets, weights

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
        live = np.flatnonzero(self._live)
        corners = positions[self._tets[live]]
        shape = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
        gradients = self._six_volumes[live, None, None] * (shape @ self._inverses[live])
        sums = np.zeros((len(self._rest), 3, 3))
        volumes = np.zeros(len(self._rest))
        for k in range(4):
            np.add.at(sums, self._tets[live, k], gradients)
            np.add.at(volumes, self._tets[live, k], self._six_volumes[live])
        has = volumes > 0  # the others keep the last
        u, stretches, v = np.linalg.svd(sums[has] / volumes[has, None, None])
        self._gradients[has] = (u * np.clip(stretches, *_STRETCH)[:, None, :]) @ v

    def _carried(self, vertices, positions):
        nodes = self._tets[self.tets[vertices]]
        offsets = self.rest_vertices[vertices][:, None, :] - self._rest[nodes]
        each = positions[nodes] + np.einsum("nkij,nkj->nki", self._gradients[nodes], offsets)
        owners = self._owners[vertices]
        return np.einsum("nk,nki->ni", owners / owners.sum(axis=1, keepdims=True), each)
