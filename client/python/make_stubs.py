#!/usr/bin/python3
"""Generates the Python messages and service stubs (cleave.v1, google.rpc) from proto/.

Needs protoc and grpc_python_plugin (Debian: protobuf-compiler, protobuf-compiler-grpc).
"""

import argparse
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
PROTO = HERE.parent.parent / "proto"


def make_stubs(into):
    plugin = shutil.which("grpc_python_plugin")
    if plugin is None or shutil.which("protoc") is None:
        raise SystemExit("protoc and grpc_python_plugin are needed: apt-get install "
                         "protobuf-compiler protobuf-compiler-grpc")
    into.mkdir(parents=True, exist_ok=True)
    protos = sorted((PROTO / "cleave" / "v1").glob("*.proto"))
    protos += sorted((PROTO / "google" / "rpc").glob("*.proto"))
    subprocess.run(
        ["protoc", f"-I{PROTO}", f"--python_out={into}", f"--grpc_out={into}",
         f"--plugin=protoc-gen-grpc={plugin}", *map(str, protos)],
        check=True,
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--into", type=pathlib.Path, default=HERE,
                        help="folder to put on PYTHONPATH; default: beside this file")
    make_stubs(parser.parse_args().into)
    sys.exit(0)
