"""Which part of a message makes it too large to be sent."""

import grpc

from cleave.errors import CleaveError


def _parts(message, path):
    """(path, bytes or nearly, message or None) of what a message holds."""
    for field, value in message.ListFields():
        name = f"{path}.{field.name}"
        if field.message_type is None or field.message_type.GetOptions().map_entry:
            yield name, 8 * len(value) if hasattr(value, "append") else 0, None
        elif hasattr(value, "ByteSize"):
            yield name, value.ByteSize(), value
        else:
            for k, item in enumerate(value):
                yield f"{name}[{k}]", item.ByteSize(), item


def check_size(scene, most):
    """Raises CleaveError (RESOURCE_EXHAUSTED) for a Scene of more than `most` bytes; names what is large."""
    size = scene.ByteSize()
    if size <= most:
        return
    path, part, message = "scene", size, scene
    while message is not None:
        largest = max(_parts(message, path), key=lambda found: found[1], default=None)
        if largest is None or largest[1] < size / 2:
            break
        path, part, message = largest
    raise CleaveError(
        grpc.StatusCode.RESOURCE_EXHAUSTED,
        "",
        [(path, f"holds {part / 2**20:.1f} MiB; a scene travels in {most / 2**20:.1f} MiB")],
    )
