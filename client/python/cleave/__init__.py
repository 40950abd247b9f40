"""Client of the Cleave fracture simulator."""

import pkgutil

# cleave.v1, which make_stubs.py generates, may lie in another folder of the path.
__path__ = pkgutil.extend_path(__path__, __name__)
