"""A small client of the Cleave service: meshes, sessions, frames as numpy arrays.

    with Client("unix:/tmp/cleave.sock") as client:
        session = client.create_session("bar", load_scene("bar.scene.json"))
        session.run()
        for frame in session.frames():
            print(frame.number, frame.time, frame.positions.shape, len(frame.broken_edges))

Needs grpcio, protobuf, numpy and zstandard, and the stubs that make_stubs.py generates.
"""

import dataclasses
import pathlib
import time
import uuid

import grpc
import numpy as np
from google.protobuf import json_format, text_format

from cleave import pictures
from cleave.answers import Curve, ImpurityPreview, Mesh, Probe, RenderMesh
from cleave.assets import download, upload
from cleave.errors import ATTEMPTS, CleaveError, SimulationFailed, delay  # noqa: F401
from cleave.region import Region  # noqa: F401
from cleave.rungs import rung_number
from cleave.session import Session
from cleave.sizes import check_size
from cleave.stubs import (
    asset_pb2,
    asset_pb2_grpc,
    frame_pb2_grpc,
    impurity_pb2,
    impurity_pb2_grpc,
    material_pb2,
    material_pb2_grpc,
    scene_pb2,
    server_pb2,
    server_pb2_grpc,
    session_pb2,
    session_pb2_grpc,
)

_CALL_SECONDS = 30
_REQUEST_BYTES = 1024  # of a request besides the scene or picture in it


def load_scene(path):
    """The Scene message of a .scene.json or .textproto file. Errors name what is wrong."""
    path = pathlib.Path(path)
    if path.suffix == ".json":
        return json_format.Parse(path.read_text(), scene_pb2.Scene())
    return text_format.Parse(path.read_text(), scene_pb2.Scene())


class Client:
    """A connection to a server: HOST:PORT or unix:PATH. Use it as a context manager.

    Raises CleaveError (UNAVAILABLE) where no server answers within `connect_seconds`.
    """

    def __init__(self, address, connect_seconds=10):
        self._channel = grpc.insecure_channel(
            address,
            options=[
                ("grpc.keepalive_time_ms", 20_000),
                ("grpc.keepalive_timeout_ms", 10_000),
                ("grpc.enable_http_proxy", 0),
                # The parts that come off in one frame may take more than gRPC's 4 MiB.
                ("grpc.max_receive_message_length", 256 << 20),
            ],
        )
        self._assets = asset_pb2_grpc.AssetServiceStub(self._channel)
        self._frames = frame_pb2_grpc.FrameServiceStub(self._channel)
        self._impurities = impurity_pb2_grpc.ImpurityServiceStub(self._channel)
        self._materials = material_pb2_grpc.MaterialServiceStub(self._channel)
        self._servers = server_pb2_grpc.ServerServiceStub(self._channel)
        self._sessions = session_pb2_grpc.SessionServiceStub(self._channel)
        try:
            self.server = self._call(
                self._servers.GetServerInfo,
                server_pb2.GetServerInfoRequest(client_version="cleave python"),
                seconds=connect_seconds,
                wait=True,
            )
        except CleaveError as error:
            self.close()
            if error.code not in (grpc.StatusCode.DEADLINE_EXCEEDED, grpc.StatusCode.UNAVAILABLE):
                raise
            raise CleaveError(
                grpc.StatusCode.UNAVAILABLE,
                f"no server answers at {address} within {connect_seconds} s",
            ) from error

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._channel.close()

    def upload_mesh(self, positions, tets, regions=None, region_names=None):
        """Sends a mesh (nodes x 3, tets x 4, a region id a tet or None) and returns its asset name.

        What the server has is not sent again.
        """
        message = scene_pb2.TetMesh(
            positions=np.asarray(positions, np.float64).ravel(),
            tets=np.asarray(tets, np.uint32).ravel(),
        )
        if regions is not None:
            message.tet_regions.extend(int(region) for region in regions)
        for region, name in sorted((region_names or {}).items()):
            message.regions.add(id=region, name=name)
        return upload(self, asset_pb2.ASSET_KIND_TET_MESH, message)

    def upload_render_mesh(self, points, triangles, uvs=None):
        """Sends a triangle mesh that viewers show in place of a body's surface; returns its asset name.

        points: n x 3, where the body rests; triangles: m x 3 point ids, counterclockwise from outside;
        uvs: m x 3 x 2 texture coordinates of the corners, or None. The name goes into a scene's
        render_mesh.asset. What the server has is not sent again.
        """
        message = scene_pb2.RenderMesh(
            points=np.asarray(points, np.float64).ravel(),
            triangles=np.asarray(triangles, np.uint32).ravel(),
            uvs=[] if uvs is None else np.asarray(uvs, np.float32).ravel(),
        )
        return upload(self, asset_pb2.ASSET_KIND_RENDER_MESH, message)

    def create_session(self, session_id, scene, threads=0, validate_only=False, rung=None):
        """Creates a session of a Scene message; with validate_only returns its Plan instead.

        `rung` is what it keeps of its frames, and so the finest that viewers can have: "preview",
        "standard", "fine" or "lossless". Without it: as scene.output.tolerance says, or standard.
        """
        check_size(scene, self._most_bytes())
        response = self._call(
            self._sessions.CreateSession,
            session_pb2.CreateSessionRequest(
                session_id=session_id,
                scene=scene,
                threads=threads,
                validate_only=validate_only,
                rung=rung_number(rung),
                request_id=uuid.uuid4().hex,
            ),
            seconds=300,
        )
        if validate_only:
            return response.plan
        return Session(self, response.session.name)

    def session(self, name):
        """A session that is there already, by id or name."""
        name = name if name.startswith("sessions/") else f"sessions/{name}"
        session = Session(self, name)
        session.state()
        return session

    def sessions(self):
        """All sessions, as messages."""
        request = session_pb2.ListSessionsRequest()
        found = []
        while True:
            page = self._call(self._sessions.ListSessions, request)
            found += page.sessions
            request.page_token = page.next_page_token
            if not request.page_token:
                return found

    def presets(self):
        """The material presets of the server, as messages by name."""
        answer = self._call(
            self._materials.ListMaterialPresets, material_pb2.ListMaterialPresetsRequest()
        )
        return {preset.name: preset for preset in answer.presets}

    def probe(
        self,
        material,
        deformation_gradients=(),
        pull_directions=(),
        fibre_directions=(),
        point=None,
        stress=scene_pb2.FRACTURE_STRESS_UNSPECIFIED,
        largest_strain=None,
        samples=100,
    ):
        """Evaluates a material without a mesh: the name of a preset, or a Material message.

        Gradients are n x 3 x 3, directions n x 3. Without gradients and directions bars are pulled
        along the fibres and across them, or along x. Returns a Probe.
        """
        if isinstance(material, str):
            material = scene_pb2.Material(preset=material)
        answer = self._call(
            self._materials.ProbeMaterial,
            material_pb2.ProbeMaterialRequest(
                material=material,
                stress=stress,
                point=[] if point is None else point,
                fibre_directions=np.ravel(fibre_directions),
                deformation_gradients=np.ravel(deformation_gradients),
                pull_directions=np.ravel(pull_directions),
                largest_strain=largest_strain,
                samples=samples,
            ),
        )
        curves = [
            Curve(
                end=material_pb2.CurveEnd.Name(curve.end).removeprefix("CURVE_END_"),
                youngs_modulus=curve.youngs_modulus,
                **{
                    field.name: np.array(getattr(curve, field.name))
                    for field in dataclasses.fields(Curve)
                    if field.name not in ("end", "youngs_modulus")
                },
            )
            for curve in answer.curves
        ]
        return Probe(
            answer.material,
            np.array([point.energy for point in answer.points]),
            np.array([point.plastic_strain for point in answer.points]),
            np.array([point.stress for point in answer.points]).reshape(-1, 3, 3),
            np.array([point.tangent for point in answer.points]).reshape(-1, 3, 3, 3, 3),
            curves,
        )

    def preview_impurity(self, scene, with_edges=False, picture=None):
        """Bakes the impurities of a Scene message on its mesh; nothing is simulated.

        Returns an ImpurityPreview. Layers must hold what they are made of: the files that a layer may
        name are read by the command line only; `trace_drawing` makes curves of a picture.

        picture: have the server draw the body, impurities in magenta on yellow, as a PNG file: a dict of
        `width` in pixels (16 to 1920; default 960), `azimuth` and `elevation` of the camera in degrees; {}
        for the defaults.
        """
        check_size(scene, self._most_bytes())
        request = impurity_pb2.PreviewImpurityRequest(scene=scene, with_edges=with_edges)
        if picture is not None:
            request.picture.SetInParent()
            request.picture.MergeFrom(impurity_pb2.PictureOptions(**picture))
        answer = self._call(self._impurities.PreviewImpurity, request, seconds=300)
        return ImpurityPreview(
            np.array(answer.potencies),
            answer.edge_count,
            answer.affected_edges,
            answer.weakest,
            answer.strongest,
            np.array(answer.edge_nodes, np.int32).reshape(-1, 2),
            np.array(answer.weakenings),
            np.array(answer.strengths),
            list(answer.warnings),
            answer.picture_png,
        )

    def trace_drawing(self, pixels, threshold=0.5, bright=False, keep_width=False, tolerance=0.5):
        """The curves of a SegmentPattern along the lines of a picture, a list of DrawnCurve messages.

        pixels: rows from the top, h x w (grey), h x w x 3 (RGB) or h x w x 4 (RGBA, over white), as bytes or
        as floats from 0 to 1: what matplotlib, Pillow and imageio read. What is darker than `threshold` is
        drawn, or brighter with `bright`. With keep_width curves are as wide as lines; they stray from the
        middle of these by at most `tolerance` pixels. Units are the picture's width, from its middle.
        """
        grey = pictures.grey(pixels)
        most = self._most_bytes()
        if grey.size > most:
            raise ValueError(f"pixels: {grey.size} are more than the {most} that a call can send")
        answer = self._call(
            self._impurities.TraceDrawing,
            impurity_pb2.TraceDrawingRequest(
                width=grey.shape[1],
                height=grey.shape[0],
                pixels=grey.tobytes(),
                image=scene_pb2.ImageDrawing(
                    threshold=threshold, bright=bright, keep_width=keep_width, tolerance=tolerance
                ),
            ),
            seconds=300,
        )
        return list(answer.curves)

    def download_mesh(self, asset, unit_scale=1.0):
        """The Mesh of an asset name; positions times unit_scale."""
        message = scene_pb2.TetMesh.FromString(download(self, asset))
        return Mesh(
            np.array(message.positions, np.float64).reshape(-1, 3) * unit_scale,
            np.array(message.tets, np.int32).reshape(-1, 4),
        )

    def download_render_mesh(self, asset, unit_scale=1.0):
        """The RenderMesh of an asset name; points times unit_scale."""
        message = scene_pb2.RenderMesh.FromString(download(self, asset))
        uvs = np.array(message.uvs, np.float32).reshape(-1, 3, 2) if message.uvs else None
        return RenderMesh(
            np.array(message.points, np.float64).reshape(-1, 3) * unit_scale,
            np.array(message.triangles, np.int32).reshape(-1, 3),
            uvs,
        )

    def _most_bytes(self):
        return self.server.limits.max_message_bytes - _REQUEST_BYTES

    def _call(self, method, request, seconds=_CALL_SECONDS, wait=False):
        """A call that is safe to repeat, repeated while the server is away."""
        for attempt in range(1, ATTEMPTS + 1):
            try:
                return method(request, timeout=seconds, wait_for_ready=wait)
            except grpc.RpcError as error:
                if error.code() != grpc.StatusCode.UNAVAILABLE or attempt == ATTEMPTS:
                    raise CleaveError.of(error) from None
                time.sleep(delay(attempt))
