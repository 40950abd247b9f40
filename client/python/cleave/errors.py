"""What a client can be told, and how often it asks again."""

from cleave.stubs import error_details_pb2, status_pb2

ATTEMPTS = 8


class CleaveError(Exception):
    """What the server answered. `faults` lists (field, description) where it named fields."""

    def __init__(self, code, message, faults=()):
        self.code = code
        self.faults = list(faults)
        lines = [f"{field}: {text}" for field, text in self.faults] or [message]
        super().__init__("\n".join(lines))

    @classmethod
    def of(cls, error):
        faults = []
        for key, value in error.trailing_metadata() or ():
            if key != "grpc-status-details-bin":
                continue
            rich = status_pb2.Status.FromString(value)
            for detail in rich.details:
                bad_request = error_details_pb2.BadRequest()
                if detail.Unpack(bad_request):
                    faults += [(v.field, v.description) for v in bad_request.field_violations]
        return cls(error.code(), error.details(), faults)


class SimulationFailed(Exception):
    """The run cannot go on; the frames so far have been given."""


def delay(attempt):
    """Seconds before the next attempt."""
    return min(5.0, 0.2 * 2 ** (attempt - 1))
