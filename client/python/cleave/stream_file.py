"""Files of frames: core/stream/FORMAT.md, sections 8 and 9."""

import dataclasses
import struct

from cleave.checksums import crc32c
from cleave.frames import (
    KEY,
    DamagedError,
    FrameHeader,
    StreamHeader,
    UnsupportedError,
    split_frame,
)


@dataclasses.dataclass(frozen=True)
class IndexRow:
    """FORMAT.md section 9."""

    frame: int
    epoch: int
    kind: int
    segment: int
    offset: int
    length: int
    time: float
    state_hash: int
    broken_edges: int
    fragments: int

    SIZE = 80
    _LAYOUT = struct.Struct("<qIB3xI4xQQdQQq4xI")

    @classmethod
    def parse(cls, data):
        """Reads one row, or returns None if it is torn or damaged."""
        if len(data) < cls.SIZE or crc32c(data[: cls.SIZE - 4]) != cls._LAYOUT.unpack(data)[-1]:
            return None
        return cls(*cls._LAYOUT.unpack(data)[:-1])


class StreamFile:
    """A .clv file in memory, finished or not: header_bytes, header, rows, has_footer."""

    def __init__(self, data):
        self._data = bytes(data)
        self.header_bytes = self._data[: StreamHeader.size_of(self._data)]
        self.header = StreamHeader.parse(self.header_bytes)
        self.rows = self._read_footer()
        self.has_footer = self.rows is not None
        if self.rows is None:
            self.rows = self._walk()

    def frame_bytes(self, row):
        """The frame that a row names."""
        data = self._data[row.offset : row.offset + row.length]
        header = FrameHeader.parse(data)
        if (header.frame, header.epoch, header.state_hash) != (
            row.frame,
            row.epoch,
            row.state_hash,
        ):
            raise DamagedError(f"the frame at byte {row.offset} is not frame {row.frame}")
        return data

    def seek(self, position, decoder):
        """Brings the decoder to the frame at this position of rows, from its key frame."""
        row = self.rows[position]
        key = position
        while self.rows[key].kind != KEY:
            key -= 1
            if key < 0 or self.rows[key].epoch != row.epoch:
                raise DamagedError(f"no key frame stands before frame {row.frame}")
        for at in range(key, position + 1):
            decoder.apply(self.frame_bytes(self.rows[at]))

    def _read_footer(self):
        if len(self._data) < len(self.header_bytes) + 40 or self._data[-4:] != b"CLVE":
            return None
        offset, size, checksum = struct.unpack_from("<QQI", self._data, len(self._data) - 24)
        index = self._data[offset : offset + size]
        if (
            offset + size + 24 != len(self._data)
            or size < 16
            or crc32c(index + self._data[-24:-8]) != checksum
            or struct.unpack_from("<4sIQ", index)
            != (b"CLVI", IndexRow.SIZE, (size - 16) // IndexRow.SIZE)
        ):
            return None
        rows = [
            IndexRow.parse(index[at : at + IndexRow.SIZE])
            for at in range(16, len(index), IndexRow.SIZE)
        ]
        whole = all(row is not None and row.offset + row.length <= offset for row in rows)
        return rows if whole else None

    def _walk(self):
        rows, at = [], len(self.header_bytes)
        while True:
            try:
                header = FrameHeader.parse(self._data[at : at + FrameHeader.SIZE])
                split_frame(self._data[at : at + header.frame_bytes])
            except DamagedError:
                return rows
            except UnsupportedError:
                pass  # whole, but of a later version
            rows.append(
                IndexRow(
                    header.frame,
                    header.epoch,
                    header.kind,
                    0,
                    at,
                    header.frame_bytes,
                    header.time,
                    header.state_hash,
                    header.broken_edges,
                    header.fragments,
                )
            )
            at += header.frame_bytes
