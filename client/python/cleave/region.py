"""What a viewer of frames looks at."""

import dataclasses

from cleave.rungs import rung_number


@dataclasses.dataclass(frozen=True)
class Region:
    """Pieces with one of the nodes, and those of which a node is now within the box (least and
    largest corner, m). Others are as coarse as `outside`: a rung's name, or m."""

    nodes: tuple = ()
    box: tuple = None
    outside: object = None  # preview's accuracy

    def put_into(self, message):
        """Fills a RegionOfInterest."""
        message.nodes.extend(self.nodes)
        if self.box is not None:
            message.box.min.extend(self.box[0])
            message.box.max.extend(self.box[1])
        if isinstance(self.outside, str):
            message.outside_rung = rung_number(self.outside)
        elif self.outside is not None:
            message.outside_tolerance = self.outside
