"""Pictures of impurities on a body, magenta on yellow, with nothing but numpy."""

import struct
import zlib

import numpy as np

_PURE, _IMPURE = np.array([0xE8, 0xC5, 0x3A]), np.array([0xC4, 0x16, 0x8C])
_FACES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))  # turning outward
_TO_LIGHT = np.array([-0.4, 0.5, 0.77])  # across, up, towards the eye
_BACKGROUND = 245


def shown_impurities(preview):
    """How impure each node is shown, from 0 to 1: by potency, and by `weakenings` where there are edges."""
    potencies = np.abs(preview.potencies)
    shown = potencies / potencies.max() if potencies.any() else potencies.astype(float)
    with np.errstate(divide="ignore"):
        change = 1 - np.minimum(preview.weakenings, 1 / preview.weakenings)
    for end in (0, 1):
        np.maximum.at(shown, preview.edges[:, end], change)
    return shown


def draw_impurities(mesh, preview, width=800, azimuth=30, elevation=25):
    """An h x w x 3 array of bytes: the body of a Mesh at rest as seen from far away, z up.

    preview: of the same mesh, best made with_edges. The eye is `azimuth` degrees from x towards y, and
    `elevation` degrees above the horizon. Raises ValueError for a preview of another mesh.
    """
    shown = shown_impurities(preview)
    if len(shown) != len(mesh.positions):
        raise ValueError(f"preview: has {len(shown)} nodes; the mesh has {len(mesh.positions)}")
    turn, lift = np.radians(azimuth), np.radians(elevation)
    right = np.array([-np.sin(turn), np.cos(turn), 0])
    eye = np.array([np.cos(turn) * np.cos(lift), np.sin(turn) * np.cos(lift), np.sin(lift)])
    places = mesh.positions @ np.array([right, np.cross(eye, right), eye]).T
    low, high = places.min(axis=0), places.max(axis=0)
    scale = 0.9 * width / (high[0] - low[0])
    height = int(np.ceil(scale * (high[1] - low[1]) + 0.1 * width))
    middle = (low + high) / 2
    across = width / 2 + scale * (places[:, 0] - middle[0])
    down = height / 2 - scale * (places[:, 1] - middle[1])

    tets = mesh.tets.copy()
    sides = mesh.positions[tets[:, 1:]] - mesh.positions[tets[:, :1]]
    tets[np.linalg.det(sides) < 0, 2:] = mesh.tets[np.linalg.det(sides) < 0, :1:-1]
    faces = np.concatenate([tets[:, face] for face in _FACES])
    _, first, counts = np.unique(np.sort(faces, axis=1), axis=0, return_index=True,
                                 return_counts=True)
    faces = faces[first[counts == 1]]
    corners = places[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    seen = normals[:, 2] > 0
    faces, normals = faces[seen], normals[seen]
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    light = 0.55 + 0.45 * np.clip(normals @ (_TO_LIGHT / np.linalg.norm(_TO_LIGHT)), 0, 1)

    picture = np.full((height, width, 3), _BACKGROUND, np.uint8)
    nearest = np.full((height, width), -np.inf)
    for face, brightness in zip(faces, light):
        x, y, z, share = across[face], down[face], places[face, 2], shown[face]
        left, top = int(max(x.min(), 0)), int(max(y.min(), 0))
        columns = np.arange(left, min(int(x.max()) + 1, width)) + 0.5
        rows = np.arange(top, min(int(y.max()) + 1, height))[:, None] + 0.5
        area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
        if area == 0:
            continue
        second = ((columns - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (rows - y[0])) / area
        third = ((x[1] - x[0]) * (rows - y[0]) - (columns - x[0]) * (y[1] - y[0])) / area
        weights = np.stack([1 - second - third, second, third])
        depth = np.tensordot(z, weights, 1)
        window = np.s_[top : top + rows.shape[0], left : left + columns.shape[0]]
        drawn = (weights >= 0).all(axis=0) & (depth > nearest[window])
        nearest[window][drawn] = depth[drawn]
        impure = np.clip(np.tensordot(share, weights, 1)[drawn], 0, 1)[:, None]
        picture[window][drawn] = brightness * (_PURE + impure * (_IMPURE - _PURE))
    return picture


def write_png(path, picture):
    """Writes an h x w x 3 array of bytes."""
    height, width, _ = picture.shape
    rows = np.zeros((height, 1 + 3 * width), np.uint8)
    rows[:, 1:] = picture.reshape(height, -1)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        file.write(chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(rows.tobytes())))
        file.write(chunk(b"IEND", b""))
