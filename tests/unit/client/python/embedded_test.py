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
