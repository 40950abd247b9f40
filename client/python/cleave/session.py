"""A session of the Cleave service: run it, and follow its frames."""

import time
import uuid

import grpc
import numpy as np

from cleave.answers import Frame
from cleave.errors import ATTEMPTS, CleaveError, SimulationFailed, delay
from cleave.events import Events, PieceNames
from cleave.rungs import rung_number
from cleave.stream import FrameDecoder, split_frame
from cleave.stubs import frame_pb2, session_pb2


class Session:
    """One simulation on the server."""

    def __init__(self, client, name):
        self._client = client
        self.name = name

    def state(self):
        """The Session message: state, head_frame, goal_frame, progress, scene, error."""
        return self._client._call(
            self._client._sessions.GetSession, session_pb2.GetSessionRequest(name=self.name)
        )

    def run(self, until_frame=0, stop_on_fracture=False):
        """Starts running towards a goal and returns at once; frames() follows."""
        return self._client._call(
            self._client._sessions.RunSession,
            session_pb2.RunSessionRequest(
                name=self.name,
                goal=session_pb2.RunGoal(
                    until_frame=until_frame, stop_on_fracture=stop_on_fracture
                ),
                request_id=uuid.uuid4().hex,
            ),
        )

    def step(self, frames=1, seconds=600):
        """Advances by some frames and returns the response message."""
        head = max(0, self.state().head_frame)
        return self._client._call(
            self._client._sessions.StepSession,
            session_pb2.StepSessionRequest(name=self.name, frames=frames, expected_head=head),
            seconds=seconds,
        )

    def pause(self, abort_step=False):
        """Stops the run after the frame in work, or at once."""
        return self._client._call(
            self._client._sessions.PauseSession,
            session_pb2.PauseSessionRequest(name=self.name, abort_step=abort_step),
        )

    def delete(self):
        """Removes the session and its frames; repeating it is no error."""
        self._client._call(
            self._client._sessions.DeleteSession,
            session_pb2.DeleteSessionRequest(name=self.name, allow_missing=True),
        )

    def mesh(self):
        """The Mesh (metres) that node and edge ids of frames refer to."""
        mesh = self.state().scene.mesh
        scale = mesh.unit_scale if mesh.HasField("unit_scale") else 1.0
        return self._client.download_mesh(mesh.asset, scale)

    def render_mesh(self):
        """The scene's RenderMesh (metres), which viewers show in place of the body's surface, or None.

            shown = session.render_mesh()
            fine = EmbeddedVertices(mesh.positions, mesh.tets, shown.points)
        """
        scene = self.state().scene
        if not scene.HasField("render_mesh"):
            return None
        source = scene.render_mesh
        scale = source.unit_scale if source.HasField("unit_scale") else 1.0
        return self._client.download_render_mesh(source.asset, scale)

    def frames(
        self,
        first_frame=0,
        stop_frame=None,
        mesh=None,
        events=False,
        rung=None,
        tolerance=None,
        latest=False,
        region=None,
        surface=False,
    ):
        """Yields every Frame once, in order, until the run reaches its goal or is paused.

        Goes on after cuts of the connection. `mesh` spares fetching it. With `events` frames tell
        what broke in them. `rung` ("preview", "standard", "fine", "lossless") or `tolerance` (m) is
        the accuracy that will do, by default all that the session keeps; frames tell the tolerance that they
        have. With `latest` a slow reader skips to the newest key frame, whose `left_out` tells what it
        missed. In a `region` (a Region) the accuracy is exactly what was asked for, at least twice what
        is kept, and coarser elsewhere: frames tell the tolerances of their nodes. With `surface` they
        tell only of nodes that surfaces are drawn from (Frame.visible), at least twice as coarsely as
        the session keeps them. Raises CleaveError
        (FAILED_PRECONDITION) for more than is kept, SimulationFailed after the last frame of a run that failed.
        """
        mesh = mesh or self.mesh()
        decoder = None
        pieces = PieceNames()
        attempt = 0
        while True:
            request = frame_pb2.StreamFramesRequest(
                session=self.name, first_frame=first_frame, events=events, latest=latest
            )
            if rung is not None:
                request.rung = rung_number(rung)
            if tolerance is not None:
                request.tolerance = tolerance
            if surface:
                request.view = frame_pb2.FRAME_VIEW_SURFACE
            if region is not None:
                region.put_into(request.region)
            if stop_frame is not None:
                request.stop_frame = stop_frame
            if decoder is not None and decoder.frame >= 0:
                request.first_frame = decoder.frame + 1
                request.resume.epoch = decoder.epoch
                request.resume.frame = decoder.frame
                request.resume.state_hash = decoder.state_hash
            stream = self._client._frames.StreamFrames(request)
            try:
                data = b""
                gap = None
                broken = frame_pb2.FrameEvents()
                for message in stream:
                    event = message.WhichOneof("event")
                    if event == "start" and decoder is None:
                        given = message.start.tolerance
                        decoder = FrameDecoder(
                            message.start.header, mesh.positions, mesh.edges(), tets=mesh.tets
                        )
                        kept = given - decoder.header.tolerance if region is not None else 0.0
                    elif event == "events":
                        if broken.frame not in (0, message.events.frame):
                            raise CleaveError(
                                grpc.StatusCode.DATA_LOSS,
                                f"events of frame {message.events.frame} came between those of "
                                f"frame {broken.frame} and the frame",
                            )
                        broken.MergeFrom(message.events)
                    elif event == "gap":
                        gap = message.gap
                    elif event == "chunk":
                        data += message.chunk.payload
                        if len(data) < message.chunk.frame_bytes:
                            continue
                        header, _ = split_frame(data)
                        # A server that cannot resume begins at a key frame before.
                        known = header.epoch == decoder.epoch and header.frame <= decoder.frame
                        left_out, gap = _left_out(gap, header, decoder), None
                        if not known:
                            decoder.apply(data)
                        told = Events.of_message(broken) if events and not known else None
                        data = b""
                        attempt = 0
                        if not known and decoder.frame >= first_frame:
                            yield Frame(
                                decoder.frame,
                                decoder.time,
                                decoder.fragments,
                                _known_positions(decoder),
                                decoder.broken_edges.copy(),
                                pieces.begin(told),
                                given,
                                None if region is None else decoder.tolerances + kept,
                                left_out,
                                None if decoder.visible is None else decoder.visible.copy(),
                            )
                        pieces.follow(told)
                        broken.Clear()
                    elif event == "end":
                        if message.end.reason == frame_pb2.END_REASON_FAILED:
                            raise SimulationFailed(f"{self.name}: {message.end.message}")
                        if message.end.reason != frame_pb2.END_REASON_SHUTDOWN:
                            return
            except grpc.RpcError as error:
                if error.code() != grpc.StatusCode.UNAVAILABLE:
                    raise CleaveError.of(error) from None
            finally:
                stream.cancel()
            attempt += 1
            if attempt >= ATTEMPTS:
                raise CleaveError(grpc.StatusCode.UNAVAILABLE, "the frame stream was cut")
            time.sleep(delay(attempt))


def _known_positions(decoder):
    positions = decoder.positions.copy()
    if decoder.visible is not None:
        positions[~decoder.visible] = np.nan
    return positions


def _left_out(gap, header, decoder):
    """(first, last) of the frames that a viewer missed before the frame of a header, or None."""
    if gap is None:
        return None
    if header.frame != gap.last_frame + 1:
        raise CleaveError(
            grpc.StatusCode.DATA_LOSS,
            f"frames up to {gap.last_frame} are left out, but frame {header.frame} came",
        )
    # A server that cannot resume counts from the key frame where it began.
    first = gap.first_frame
    if header.epoch == decoder.epoch:
        first = max(first, decoder.frame + 1)
    return (first, gap.last_frame) if first <= gap.last_frame else None
