"""Meshes on their way to a server and back: named by content, sent in checked chunks, resumed."""

import hashlib
import time

import grpc
import zstandard

from cleave.checksums import crc32c
from cleave.errors import ATTEMPTS, CleaveError, delay
from cleave.stubs import asset_pb2

_CHUNK_BYTES = 256 * 1024
_CALL_SECONDS = 30
_STREAM_SECONDS = 3600


def upload(client, kind, message):
    """Sends a message as an asset of a kind unless the server has it, and returns its name."""
    data = message.SerializeToString(deterministic=True)
    digest = asset_pb2.Digest(sha256=hashlib.sha256(data).digest(), size_bytes=len(data))
    for attempt in range(1, ATTEMPTS + 1):
        missing = client._call(
            client._assets.FindMissingAssets, asset_pb2.FindMissingAssetsRequest(digests=[digest])
        ).missing
        if not missing:
            break
        try:
            _send(client._assets, kind, data, digest)
        except CleaveError as error:
            if error.code != grpc.StatusCode.UNAVAILABLE or attempt == ATTEMPTS:
                raise
            time.sleep(delay(attempt))
    return digest.sha256.hex()


def download(client, asset):
    """The bytes of an asset, checked against its name."""
    data = bytearray()
    try:
        for chunk in client._assets.DownloadAsset(
            asset_pb2.DownloadAssetRequest(asset=asset), timeout=_STREAM_SECONDS
        ):
            if chunk.offset != len(data) or chunk.crc32c != crc32c(chunk.payload):
                raise CleaveError(grpc.StatusCode.DATA_LOSS, "a chunk of the mesh is damaged")
            data += chunk.payload
    except grpc.RpcError as error:
        raise CleaveError.of(error) from None
    if hashlib.sha256(data).hexdigest() != asset:
        raise CleaveError(grpc.StatusCode.DATA_LOSS, "the mesh received is not the one asked for")
    return bytes(data)


def _send(stub, kind, data, digest):
    # Named after the content: a later process goes on where this one stopped.
    upload_id = "mesh-" + digest.sha256.hex()[:40]
    try:
        begin = stub.QueryUploadStatus(
            asset_pb2.QueryUploadStatusRequest(upload_id=upload_id), timeout=_CALL_SECONDS
        ).committed_size
    except grpc.RpcError as error:
        if error.code() != grpc.StatusCode.NOT_FOUND:
            raise CleaveError.of(error) from None
        begin = 0
    compressor = zstandard.ZstdCompressor(level=3)

    def chunks():
        for offset in range(begin, len(data), _CHUNK_BYTES):
            raw = data[offset : offset + _CHUNK_BYTES]
            request = asset_pb2.UploadAssetRequest(
                upload_id=upload_id,
                offset=offset,
                raw_size=len(raw),
                payload=compressor.compress(raw),
                crc32c=crc32c(raw),
                finish=offset + len(raw) == len(data),
            )
            if offset == begin:
                request.spec.kind = kind
                request.spec.digest.CopyFrom(digest)
                request.spec.compression = asset_pb2.COMPRESSION_ZSTD
            yield request

    try:
        stub.UploadAsset(chunks(), timeout=_STREAM_SECONDS)
    except grpc.RpcError as error:
        raise CleaveError.of(error) from None
