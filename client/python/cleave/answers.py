"""What the service answers, as numpy arrays."""

import dataclasses

import numpy as np

from cleave.stream import edges_of


@dataclasses.dataclass(frozen=True)
class Frame:
    """One frame. Arrays are copies that stay as they are."""

    number: int
    time: float  # s
    fragments: int
    positions: np.ndarray  # nodes x 3 float64, m
    broken_edges: np.ndarray  # ascending int32
    events: object = None  # Events (events.py) where they were asked for
    tolerance: float = 0.0  # m, largest error of a coordinate against the simulation
    tolerances: object = None  # the same of each node, in frames with a region of interest
    left_out: tuple = None  # (first, last) frame that was left out before it, with `latest`
    visible: object = None  # of each node, in frames of a surface view; other nodes are at NaN


@dataclasses.dataclass(frozen=True)
class Curve:
    """What a slender bar along a direction does when it is pulled slowly. Arrays are columns."""

    direction: np.ndarray  # unit
    youngs_modulus: float  # Pa, slope at rest
    end: str  # "LARGEST_STRAIN", "TENSILE_STRENGTH", ...: CurveEnd of material.proto
    worst_edge: np.ndarray  # unit, rest direction of the edge that failed or came nearest
    strain: np.ndarray  # change of length over length
    nominal_stress: np.ndarray  # Pa, force over the area at rest
    true_stress: np.ndarray  # Pa, force over the area now
    volume_ratio: np.ndarray
    energy: np.ndarray  # J/m^3
    failure_ratio: np.ndarray  # the worst edge fails at 1
    plastic_strain: np.ndarray  # equivalent


@dataclasses.dataclass(frozen=True)
class Probe:
    """What a material answers."""

    material: object  # Material message, presets as numbers
    energy: np.ndarray  # gradients, J/m^3, elastic
    plastic_strain: np.ndarray  # gradients, equivalent
    stress: np.ndarray  # gradients x 3 x 3, Pa, first Piola-Kirchhoff
    tangent: np.ndarray  # gradients x 3 x 3 x 3 x 3, Pa: [n, i, j, k, l] is dP_ij / dF_kl
    curves: list  # of Curve


@dataclasses.dataclass(frozen=True)
class ImpurityPreview:
    """What impurities do to a body before the first step of a simulation."""

    potencies: np.ndarray  # nodes, alpha
    edge_count: int  # of the mesh
    affected_edges: int  # whose strength impurities change
    weakest: float  # Pa, tensile strength of the weakest edge; 0: cut
    strongest: float  # Pa, inf: never breaks
    edges: np.ndarray  # affected x 2 node ids; this and the next two only with_edges
    weakenings: np.ndarray  # affected, what layers make their strength count
    strengths: np.ndarray  # affected, Pa
    warnings: list  # "field: what"
    picture_png: bytes  # a PNG file, empty where no picture was asked for


@dataclasses.dataclass(frozen=True)
class Mesh:
    """A tetrahedral mesh; node and tet ids are rows."""

    positions: np.ndarray  # nodes x 3 float64
    tets: np.ndarray  # tets x 4 int32

    def edges(self):
        """Node pairs, sorted: row numbers are the edge ids of broken_edges."""
        return edges_of(self.tets)


@dataclasses.dataclass(frozen=True)
class RenderMesh:
    """A fine triangle mesh round a body at rest; EmbeddedVertices moves its points."""

    points: np.ndarray  # n x 3 float64
    triangles: np.ndarray  # m x 3 int32, counterclockwise from outside
    uvs: object  # m x 3 x 2 float32, texture coordinates of the corners, or None
