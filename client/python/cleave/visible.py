"""The places that a surface view carries: core/stream/FORMAT.md section 7.5."""

import numpy as np

_TET_EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
_TET_FACES = ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))


class VisiblePlaces:
    """Of one mesh. ends: the places of each edge; tets: the places of each tet."""

    def __init__(self, places, ends, tets):
        self._ends = ends
        self._tets = tets
        keys = np.sort(ends, axis=1)
        keys = keys[:, 0] << 32 | keys[:, 1]
        sorting = np.argsort(keys)
        self._tet_edges = np.empty((len(tets), 6), int)
        for k, pair in enumerate(_TET_EDGES):
            wanted = np.sort(tets[:, pair], axis=1)
            wanted = wanted[:, 0] << 32 | wanted[:, 1]
            at = np.minimum(np.searchsorted(keys[sorting], wanted), len(keys) - 1)
            self._tet_edges[:, k] = sorting[at]
            if (keys[sorting[at]] != wanted).any():
                raise ValueError("a tet has an edge that is not there")
        faces = np.sort(np.concatenate([tets[:, face] for face in _TET_FACES]), axis=1)
        faces, counts = np.unique(faces, axis=0, return_counts=True)
        self._boundary = np.zeros(places, bool)
        self._boundary[faces[counts == 1]] = True

    def of(self, broken):
        """Whether each place is visible with these edges broken."""
        whole = np.ones(len(self._ends), bool)
        whole[broken] = False
        joined = np.tile(np.arange(4), (len(self._tets), 1))
        for _ in range(3):
            for k, (a, b) in enumerate(_TET_EDGES):
                low = np.minimum(joined[:, a], joined[:, b])
                joins = whole[self._tet_edges[:, k]]
                joined[joins, a] = low[joins]
                joined[joins, b] = low[joins]
        apart = np.zeros(len(self._boundary), bool)
        apart[self._tets[(joined > 0).any(axis=1)]] = True
        visible = self._boundary | apart
        for one, other in ((0, 1), (1, 0)):
            visible[self._ends[apart[self._ends[:, one]], other]] = True
        return visible
