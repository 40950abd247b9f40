"""Tests of cleave.embedded."""

import itertools
import unittest

import numpy as np

from cleave.embedded import EmbeddedVertices
from cleave.stream import edges_of


def box(cells):
    """A box of unit cells of six tets each: positions, tets."""
    shape = np.array(cells) + 1
    index = np.arange(shape.prod()).reshape(shape)
    positions = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), -1).reshape(-1, 3)
    tets = []
    for cell in itertools.product(*map(range, cells)):
        for axes in itertools.permutations(range(3)):
            at = np.array(cell)
            tet = [index[tuple(at)]]
            for axis in axes:
                at = at + np.eye(3, dtype=int)[axis]
                tet.append(index[tuple(at)])
            edges = (positions[tet[1:]] - positions[tet[0]]).astype(float)
            tets.append(tet if np.linalg.det(edges) > 0 else [tet[1], tet[0], *tet[2:]])
    return positions.astype("f8"), np.array(tets)


class EmbeddedVerticesTest(unittest.TestCase):
    def setUp(self):
        self.rest, self.tets = box((4, 2, 2))
        self.edges = edges_of(self.tets)
        generator = np.random.default_rng(3)
        self.vertices = generator.uniform((0, 0, 0), (4, 2, 2), (300, 3))
        self.fine = EmbeddedVertices(self.rest, self.tets, self.vertices)

    def crossing(self, height):
        """Edges between the layers x = 1 and x = 2, up to a height z."""
        ends = self.rest[self.edges]
        across = (ends[:, 0, 0] < 1.5) != (ends[:, 1, 0] < 1.5)
        return np.flatnonzero(across & (ends[:, :, 2].max(axis=1) <= height))

    def test_vertices_lie_in_their_tets_and_follow_affine_motions(self):
        self.assertGreaterEqual(self.fine.weights.min(), -1e-12)
        np.testing.assert_allclose(self.fine.weights.sum(axis=1), 1, atol=1e-12)
        turn = np.array([[0.8, -0.5, 0.1], [0.4, 1.1, 0.2], [0.0, 0.1, 0.9]])
        moved = self.fine.move(self.rest @ turn.T + 2, [])
        np.testing.assert_allclose(moved, self.vertices @ turn.T + 2, atol=1e-12)
        self.assertEqual(set(self.fine.pieces), {0})

    def test_each_piece_takes_its_vertices_along_rigidly(self):
        right = self.rest[:, 0] > 1.5
        turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        positions = np.where(right[:, None], self.rest @ turn.T + 5, self.rest)
        moved = self.fine.move(positions, self.crossing(9))
        on_right = right[self.fine.nodes]
        self.assertEqual(len(set(self.fine.pieces)), 2)
        self.assertTrue(80 < on_right.sum() < 220)
        expected = np.where(on_right[:, None], self.vertices @ turn.T + 5, self.vertices)
        np.testing.assert_allclose(moved, expected, atol=1e-12)

    def test_a_crack_that_cuts_nothing_off_opens_and_tears_triangles_across_it(self):
        pairs = np.array([[1.2, y, z] for y in (0.3, 1.6) for z in (0.1, 1.9)])
        fine = EmbeddedVertices(self.rest, self.tets, np.concatenate([pairs, pairs + (0.6, 0, 0)]))
        triangles = np.array([[i, i + 4, (i + 2) % 4] for i in range(4)])
        positions = self.rest.copy()
        positions[:, 0] += np.where(self.rest[:, 0] > 1.5, 0.4 * (2 - self.rest[:, 2]), 0)
        moved = fine.move(positions, self.crossing(1))
        self.assertEqual(set(fine.pieces), {0})
        gap = moved[4:, 0] - moved[:4, 0]
        self.assertTrue((gap[[0, 2]] > 1.2).all(), gap)  # low: 0.6 and the opening
        self.assertTrue((gap[[1, 3]] < 0.85).all(), gap)  # at the tip and above
        torn = fine.torn(triangles)
        self.assertTrue(torn[[0, 2]].all())
        self.assertFalse(torn[[1, 3]].any())

    def test_vertices_outside_go_with_the_lowest_tet_at_the_nearest_face(self):
        # Most are nearest to a corner, side or diagonal, where several faces are as near.
        places = np.array(list(itertools.product((-0.5, 0, 1, 3.5, 4.5), (-1, 1, 2.5), (-0.2, 0.5, 3))))
        places = places[((places < 0) | (places > (4, 2, 2))).any(axis=1)]
        fine = EmbeddedVertices(self.rest, self.tets, places)
        nearest = np.clip(places, 0, (4, 2, 2))
        for place, tet in zip(nearest, fine.tets):
            # Of a box, the nearest point's own tets are those with a nearest face.
            offsets = place - self.rest[self.tets[:, 0]]
            edges = np.swapaxes(self.rest[self.tets[:, 1:]] - self.rest[self.tets[:, :1]], 1, 2)
            inner = np.linalg.solve(edges, offsets[:, :, None])[:, :, 0]
            each = np.column_stack([1 - inner.sum(axis=1), inner])
            holds = each.min(axis=1) > -1e-12
            # And not those that touch it with a corner or side of no boundary face.
            on_side = np.zeros(len(self.tets), bool)
            for corners in itertools.combinations(range(4), 3):
                ends = self.rest[self.tets[:, corners]]
                flat = (ends == ends[:, :1]).all(axis=1) & ((ends[:, 0] == 0) | (ends[:, 0] == (4, 2, 2)))
                opposite = [k for k in range(4) if k not in corners][0]
                on_side |= flat.any(axis=1) & (np.abs(each[:, opposite]) < 1e-12)
            self.assertEqual(tet, np.flatnonzero(holds & on_side)[0], place)

    def test_vertices_between_tets_and_nodes_go_with_the_lowest(self):
        centers = self.rest[self.tets].mean(axis=1)
        corners = self.rest[self.tets]
        middles = np.concatenate([(corners[:, i] + corners[:, j]) / 2 for i in range(4) for j in range(i)])
        for vertices in centers, middles, self.rest:
            # In places that numbers do not tell exactly.
            fine = EmbeddedVertices(self.rest / 7 + 0.1, self.tets, vertices / 7 + 0.1)
            for vertex, tet, node in zip(vertices, fine.tets, fine.nodes):
                holds = [t for t in range(tet + 1) if self.holds(t, vertex)]
                self.assertEqual(holds, [tet])
                away = np.linalg.norm(self.rest[self.tets[tet]] - vertex, axis=1)
                weights = self.weights_in(tet, vertex)
                self.assertEqual(node, self.tets[tet][weights > weights.max() - 1e-6].min(), away)

    def weights_in(self, tet, vertex):
        edges = (self.rest[self.tets[tet, 1:]] - self.rest[self.tets[tet, 0]]).T
        inner = np.linalg.solve(edges, vertex - self.rest[self.tets[tet, 0]])
        return np.concatenate([[1 - inner.sum()], inner])

    def holds(self, tet, vertex):
        return self.weights_in(tet, vertex).min() > -1e-6

    def test_a_crumb_that_lost_all_tets_at_once_is_turned_as_they_are(self):
        turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        around = np.flatnonzero((self.edges == 0).any(axis=1))
        fine = EmbeddedVertices(self.rest, self.tets, [[0.1, 0.05, 0.02]])
        moved = fine.move(self.rest @ turn.T, around)
        self.assertEqual(fine.nodes[0], 0)
        np.testing.assert_allclose(moved, [[-0.05, 0.1, 0.02]], atol=1e-12)

    def test_other_arrays_are_refused(self):
        with self.assertRaisesRegex(ValueError, "positions: shape"):
            self.fine.move(self.rest[1:], [])
        hidden = self.rest.copy()
        hidden[3] = np.nan
        with self.assertRaisesRegex(ValueError, r"positions\[3\]: .* surface view"):
            self.fine.move(hidden, [])
        with self.assertRaisesRegex(ValueError, "broken_edges: an edge is outside"):
            self.fine.move(self.rest, [len(self.edges)])
        with self.assertRaisesRegex(ValueError, "vertices: shape"):
            EmbeddedVertices(self.rest, self.tets, self.vertices[:, :2])
        with self.assertRaisesRegex(ValueError, r"vertices\[1\]: .* is not finite"):
            EmbeddedVertices(self.rest, self.tets, [[0, 0, 0], [0, np.nan, 0]])
        with self.assertRaisesRegex(ValueError, r"rest_positions\[0\]: .* is not finite"):
            EmbeddedVertices(self.rest * np.inf, self.tets, self.vertices)
        with self.assertRaisesRegex(ValueError, "no positive volume"):
            EmbeddedVertices(self.rest, self.tets[:, [1, 0, 2, 3]], self.vertices)


if __name__ == "__main__":
    unittest.main()
