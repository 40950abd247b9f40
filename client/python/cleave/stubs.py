"""The messages and services that make_stubs.py generates, in one place to import them from."""

try:
    from cleave.v1 import (  # noqa: F401
        asset_pb2,
        asset_pb2_grpc,
        frame_pb2,
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
    from google.rpc import error_details_pb2, status_pb2  # noqa: F401
except ImportError as error:
    raise ImportError("the stubs are missing: run client/python/make_stubs.py once") from error
