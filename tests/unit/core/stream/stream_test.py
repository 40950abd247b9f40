"""The Python decoder against the golden stream and against damage."""

import hashlib
import os
import pathlib
import struct
import unittest

import numpy as np

from cleave import checksums, stream

GOLDEN = pathlib.Path(__file__).resolve().parent / "golden"
TOLERANCES = [1e-3] * 12 + [1e-4]  # m, by frame, of streams that are not exact


def _make_right(frame):
    """Lengths and checksums of a damaged frame, as far as they lead."""
    struct.pack_into("<Q", frame, 8, len(frame))
    struct.pack_into("<I", frame, 84, checksums.crc32c(bytes(frame[:84])))
    at = 88
    while at + 24 <= len(frame):
        coded = min(struct.unpack_from("<I", frame, at + 8)[0], len(frame) - at - 24)
        struct.pack_into("<I", frame, at + 8, coded)
        covered = bytes(frame[at : at + 20] + frame[at + 24 : at + 24 + coded])
        struct.pack_into("<I", frame, at + 20, checksums.crc32c(covered))
        at += 24 + coded


class GoldenTests:
    """What holds for each of the golden streams."""

    NAME = ""

    def load(self, kind):
        return (GOLDEN / f"{self.NAME}.{kind}").read_bytes()

    def new_decoder(self):
        return stream.FrameDecoder(
            self.file.header_bytes, self.rest, self.edges, tets=self.tets
        )

    def setUp(self):
        self.data = self.load("clv")
        self.file = stream.StreamFile(self.data)
        self.rest = np.frombuffer(self.load("rest")).reshape(-1, 3)
        self.edges = None
        if self.file.header.predictor == 2:
            self.edges = np.frombuffer(self.load("edges"), "<i4").reshape(-1, 2)
        self.tets = None
        if self.file.header.view == 2:
            self.tets = np.frombuffer(self.load("tets"), "<i4").reshape(-1, 4)
        self.coarse = 0
        self.decoder = self.new_decoder()

    def test_every_frame_decodes_to_the_same_bits_as_in_cpp(self):
        expected = np.frombuffer(self.load("expected"))
        expected = expected.reshape(len(TOLERANCES), -1, 3)
        digest = hashlib.sha256()
        self.assertTrue(self.file.has_footer)
        for row, positions, tolerance in zip(self.file.rows, expected, TOLERANCES):
            self.decoder.apply(self.file.frame_bytes(row))
            if self.file.header.predictor == 3:
                self.assertEqual(self.decoder.positions.tobytes(), positions.tobytes())
                tolerance = 1e-6  # of float32
            self.assertEqual(self.decoder.state_hash, row.state_hash)
            self.assertEqual(len(self.decoder.broken_edges), row.broken_edges)
            coarse = self.decoder.tolerances > tolerance * 1.001
            if self.file.header.regions:
                self.assertLessEqual(self.decoder.tolerances.max(), 0.02)
                self.coarse += coarse.sum()
                tolerance = self.decoder.tolerances[:, None]
            seen = slice(None) if self.decoder.visible is None else self.decoder.visible
            for decoded in (self.decoder.positions, self.decoder.positions.astype("f4")):
                error = np.abs(decoded - positions)[seen]
                self.assertLessEqual((error / tolerance).max(), 1)
            digest.update(self.decoder.positions.astype("<f8").tobytes())
        self.assertEqual(digest.digest(), self.load("decoded_sha256"))

    def test_seeking_to_every_frame_equals_decoding_straight(self):
        straight = []
        for row in self.file.rows:
            self.decoder.apply(self.file.frame_bytes(row))
            straight.append((self.decoder.positions.tobytes(), self.decoder.broken_edges.tobytes()))
        count = len(straight)
        for position in (5 * at % count for at in range(count)):  # each once, to and fro
            self.file.seek(position, self.decoder)
            self.assertEqual(self.decoder.state_hash, self.file.rows[position].state_hash)
            sought = (self.decoder.positions.tobytes(), self.decoder.broken_edges.tobytes())
            self.assertEqual(sought, straight[position], position)

    def test_a_file_torn_at_any_byte_of_a_frame_keeps_all_frames_before(self):
        frames = [self.file.frame_bytes(row) for row in self.file.rows]
        shortest = min(range(1, len(frames)), key=lambda at: len(frames[at]))
        # The shortest frame in a whole file, the last behind that one alone: walks take their time.
        whole = self.file.rows[shortest].offset
        before = self.file.header_bytes + frames[shortest]
        for kept, start, frame in (
            (shortest, self.data[:whole], frames[shortest]),
            (1, before, frames[-1]),
        ):
            for size in range(len(frame)):
                torn = stream.StreamFile(start + frame[:size])
                self.assertFalse(torn.has_footer)
                self.assertEqual(len(torn.rows), kept, size)
            self.assertEqual(len(stream.StreamFile(start + frame).rows), kept + 1)
        torn = stream.StreamFile(self.data[: whole + 5])
        self.assertEqual(torn.rows, self.file.rows[:shortest])

    def test_a_torn_footer_is_made_anew(self):
        end = self.file.rows[-1].offset + self.file.rows[-1].length
        for size in range(end, len(self.data), 131):
            torn = stream.StreamFile(self.data[:size])
            self.assertFalse(torn.has_footer)
            self.assertEqual(torn.rows, self.file.rows)

    def test_every_damaged_byte_is_refused_and_changes_nothing(self):
        good = self.file.frame_bytes(self.file.rows[1])
        self.file.seek(0, self.decoder)
        before = self.decoder.positions
        for at in range(len(good)):
            with self.assertRaises(stream.StreamError):
                self.decoder.apply(good[:at])
            with self.assertRaises(stream.StreamError):
                self.decoder.apply(good[:at] + bytes([good[at] ^ 0x20]) + good[at + 1 :])
        self.assertIs(self.decoder.positions, before)
        self.decoder.apply(good)

    def test_forgeries_with_right_checksums_are_refused(self):
        position = 6
        good = self.file.frame_bytes(self.file.rows[position])
        self.file.seek(position - 1, self.decoder)
        header, sections = stream.split_frame(good)
        at = 88
        for section in sections:
            for offset in range(at, at + 24 + len(section.coded)):
                if at + 20 <= offset < at + 24:
                    continue
                forged = bytearray(good)
                forged[offset] ^= 0x81
                covered = forged[at : at + 20] + forged[at + 24 : at + 24 + len(section.coded)]
                struct.pack_into("<I", forged, at + 20, checksums.crc32c(bytes(covered)))
                with self.assertRaises(stream.StreamError):
                    self.decoder.apply(bytes(forged))
            at += 24 + len(section.coded)
        self.assertEqual(self.decoder.apply(good), header)

    def test_random_forgeries_of_every_frame_are_refused_or_right(self):
        random = np.random.default_rng(7)
        hashes = {row.state_hash for row in self.file.rows}
        frames = [self.file.frame_bytes(row) for row in self.file.rows]
        for position, good in enumerate(frames):
            for _ in range(10):
                forged = bytearray(good)
                for _ in range(random.integers(1, 4)):
                    other = frames[random.integers(len(frames))]
                    at = int(random.integers(88, max(len(forged), 89)))
                    start = int(random.integers(len(other)))
                    size = int(random.integers(1, 20))
                    forged[at : at + size] = (
                        other[start : start + size] if random.integers(2) else random.bytes(size)
                    )
                _make_right(forged)
                before = self.decoder.state_hash
                try:
                    self.decoder.apply(bytes(forged))
                except stream.StreamError:
                    self.assertEqual(self.decoder.state_hash, before)
                else:
                    self.assertIn(self.decoder.state_hash, hashes)
                    self.file.seek(position - 1, self.decoder) if position else None
            self.decoder.apply(good)

    def test_frames_in_a_wrong_place_and_other_meshes_are_refused(self):
        with self.assertRaises(stream.WrongStateError):
            self.decoder.apply(self.file.frame_bytes(self.file.rows[1]))
        with self.assertRaises(stream.WrongStateError):
            stream.FrameDecoder(self.file.header_bytes, self.rest + 1e-12, self.edges)


class TemporalZstdTest(GoldenTests, unittest.TestCase):
    NAME = "temporal_zstd"


class InterpolationZstdTest(GoldenTests, unittest.TestCase):
    NAME = "interpolation_zstd"

    def test_a_mesh_with_other_edges_is_refused(self):
        for edges in (None, self.edges[:-1], self.edges[::-1], self.edges + 1):
            with self.assertRaises(stream.WrongStateError):
                stream.FrameDecoder(self.file.header_bytes, self.rest, edges)


class InterpolationRansTest(GoldenTests, unittest.TestCase):
    NAME = "interpolation_rans"


class InterpolationLabelsTest(GoldenTests, unittest.TestCase):
    NAME = "interpolation_labels"

    def test_some_key_frames_have_labels(self):
        types = [
            section.type
            for row in self.file.rows
            for section in stream.split_frame(self.file.frame_bytes(row))[1]
        ]
        self.assertIn(5, types)


class InterpolationRegionTest(GoldenTests, unittest.TestCase):
    NAME = "interpolation_region"

    def test_some_nodes_are_coarse(self):
        self.test_every_frame_decodes_to_the_same_bits_as_in_cpp()
        self.assertGreater(self.coarse, 500)


class InterpolationSurfaceTest(GoldenTests, unittest.TestCase):
    NAME = "interpolation_surface"

    def test_nodes_come_into_view_where_the_body_breaks(self):
        counts = []
        for row in self.file.rows:
            self.decoder.apply(self.file.frame_bytes(row))
            counts.append(self.decoder.visible.sum())
        self.assertEqual(counts[0], 200 - 6 * 3 * 3)
        self.assertEqual(counts[:10], sorted(counts[:10]))
        self.assertEqual(counts[-1], 200)

    def test_tets_of_another_mesh_are_refused(self):
        other = self.tets.copy()
        other[0, 3] = other[40, 3]
        for tets in (None, self.tets[:-1], other, self.tets - 1):
            with self.assertRaises(stream.WrongStateError):
                stream.FrameDecoder(self.file.header_bytes, self.rest, self.edges, tets=tets)


class ExactZstdTest(GoldenTests, unittest.TestCase):
    NAME = "exact_zstd"


class ChecksumsTest(unittest.TestCase):
    def test_crc32c_is_castagnoli_for_every_way_through(self):
        self.assertEqual(checksums.crc32c(b"123456789"), 0xE3069283)
        data = os.urandom(5000)
        for size in (0, 1, 63, 255, 256, 257, 319, 320, 5000):
            register = 0xFFFFFFFF
            for byte in data[:size]:
                register ^= byte
                for _ in range(8):
                    register = (register >> 1) ^ (0x82F63B78 if register & 1 else 0)
            self.assertEqual(checksums.crc32c(data[:size]), register ^ 0xFFFFFFFF)


if __name__ == "__main__":
    unittest.main()
