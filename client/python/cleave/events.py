"""What broke in a run: edges, pieces that split, parts that came off.

Of a stream: Session.frames(events=True), then Frame.events. Of a run folder: read_events(path).
"""

import dataclasses
import json
import pathlib

import numpy as np


@dataclasses.dataclass(frozen=True)
class Place:
    """Where and when something gave way."""

    time: float  # s
    rest: np.ndarray  # m, at rest
    position: np.ndarray  # m, when it broke
    energy: float  # J, elastic


@dataclasses.dataclass(frozen=True)
class Piece:
    """A piece under an id that lasts: it stays with the largest part by rest volume."""

    piece: int
    first_node: int  # its smallest node
    node_count: int
    volume: float  # m^3 at rest


@dataclasses.dataclass(frozen=True)
class Separation:
    """A part that came off and is a piece of its own."""

    part: Piece
    place: Place


@dataclasses.dataclass(frozen=True)
class Split:
    """A piece that came apart."""

    kept: Piece  # what goes on under its id
    separations: list  # of Separation
    place: Place


@dataclasses.dataclass(frozen=True)
class Events:
    """What broke in a frame. Rows of the arrays are edges, in the order in which they broke."""

    times: np.ndarray  # s
    edges: np.ndarray  # int32
    nodes: np.ndarray  # edges x 2 int32
    pieces: np.ndarray  # edges x 2 int32, of the nodes at the end of the frame
    rest: np.ndarray  # edges x 3, m
    positions: np.ndarray  # edges x 3, m
    energies: np.ndarray  # J
    splits: list  # of Split
    # Of Piece: all as they were before, by id; only of the first frame of a stream that is begun.
    all_pieces: list = dataclasses.field(default_factory=list)

    @classmethod
    def of_message(cls, message):
        """Of a FrameEvents message."""
        breaks = message.edge_breaks
        return cls._of_rows(
            [(b.place.time, b.edge, b.nodes, b.pieces, b.place.rest, b.place.position, b.place.energy)
             for b in breaks],
            [
                Split(
                    _piece(split.kept),
                    [Separation(_piece(s.part), _place(s.place)) for s in split.separations],
                    _place(split.place),
                )
                for split in message.splits
            ],
            [_piece(piece) for piece in message.pieces],
        )

    @classmethod
    def _of_rows(cls, rows, splits, pieces=()):
        columns = list(zip(*rows)) or [[]] * 7
        return cls(
            np.array(columns[0], float),
            np.array(columns[1], np.int32),
            np.array([list(row) for row in columns[2]], np.int32).reshape(-1, 2),
            np.array([list(row) for row in columns[3]], np.int32).reshape(-1, 2),
            np.array([list(row) for row in columns[4]], float).reshape(-1, 3),
            np.array([list(row) for row in columns[5]], float).reshape(-1, 3),
            np.array(columns[6], float),
            splits,
            list(pieces),
        )


def read_events(path):
    """The Events by frame number of an events.jsonl file, or of the run folder that has it."""
    path = pathlib.Path(path)
    if path.is_dir():
        path = path / "events.jsonl"
    rows = {}
    splits = {}
    pieces = {}
    with path.open() as lines:
        for line in lines:
            event = json.loads(line)
            frame = event["frame"]
            rows.setdefault(frame, [])
            splits.setdefault(frame, [])
            pieces.setdefault(frame, [])
            if event["event"] == "edge_break":
                rows[frame].append(
                    tuple(event[name] for name in
                          ("time", "edge", "nodes", "pieces", "rest", "position", "energy"))
                )
                continue
            part = Piece(event["piece"], event["first_node"], event["node_count"], event["volume"])
            if event["event"] == "piece":
                pieces[frame].append(part)
                continue
            place = Place(event["time"], np.array(event["rest"]), np.array(event["position"]),
                          event["energy"])
            if event["event"] == "split":
                splits[frame].append(Split(part, [], place))
            else:
                splits[frame][-1].separations.append(Separation(part, place))
    return {frame: Events._of_rows(rows[frame], splits[frame], pieces[frame]) for frame in rows}


class PieceNames:
    """The pieces that there are, kept up with events."""

    def __init__(self):
        self._pieces = {}
        self._begun = False

    def begin(self, events):
        """The events, the first time with all pieces that there were before them."""
        if events is None or events.all_pieces or self._begun:
            self._begun = True
            return events
        self._begun = True
        return dataclasses.replace(
            events, all_pieces=[self._pieces[piece] for piece in sorted(self._pieces)]
        )

    def follow(self, events):
        """Takes the events of the next frame; None: nothing is known of them."""
        if events is None:
            return
        if events.all_pieces:
            self._pieces = {piece.piece: piece for piece in events.all_pieces}
        if not self._pieces:
            return  # a session that never told of them
        for split in events.splits:
            self._pieces[split.kept.piece] = split.kept
            for separation in split.separations:
                self._pieces[separation.part.piece] = separation.part


def _piece(message):
    return Piece(message.piece, message.first_node, message.node_count, message.volume)


def _place(message):
    return Place(message.time, np.array(message.rest), np.array(message.position), message.energy)
